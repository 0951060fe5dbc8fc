#include "benchmarks/denoiser/open_image_denoise.h"

#include "host/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace wedge::benchmark {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes with it.
class Folder {
public:
    Folder()
    {
        std::string made = (fs::temp_directory_path() / "wedge-denoise-XXXXXX").string();
        if (::mkdtemp(made.data()) == nullptr) {
            throw Error("folder " + made, "cannot be made", "set TMPDIR to one that can be written");
        }
        path_ = made;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder()
    {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    std::string file(const char* name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

/// For a shell.
std::string quoted(const std::string& text)
{
    std::string out = "'";
    for (const char c : text) {
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return out + "'";
}

/// What the command writes; none where it fails.
std::optional<std::string> outputOf(const std::string& command)
{
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) {
        return {};
    }
    std::string out;
    std::array<char, 256> part {};
    while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr) {
        out += part.data();
    }
    return ::pclose(pipe) == 0 ? std::optional(out) : std::nullopt;
}

void write(const std::string& path, const image::RgbImage& image)
{
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(image.rgb.data()),
        static_cast<std::streamsize>(image.rgb.size() * sizeof(float)));
    if (!file.flush()) {
        throw Error("image " + path, "cannot be written", "set TMPDIR to a folder with room");
    }
}

image::RgbImage colours(const image::LayeredImage& frame, const std::array<const char*, 3>& channels)
{
    image::RgbImage out { frame.width, frame.height, {} };
    const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    out.rgb.resize(3 * pixels);
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>& values = frame.find(channels[c])->values;
        for (std::size_t i = 0; i < pixels; ++i) {
            out.rgb[3 * i + c] = values[i];
        }
    }
    return out;
}

} // namespace

GuidedImage guidedImage(const image::LayeredImage& frame)
{
    return { image::beauty(frame), colours(frame, { "albedo.R", "albedo.G", "albedo.B" }),
        colours(frame, { "normal.X", "normal.Y", "normal.Z" }) };
}

bool OpenImageDenoise::available() const
{
    return outputOf(fmt::format("{} {} 2>/dev/null", quoted(python_), quoted(WEDGE_DENOISE_SCRIPT))).has_value();
}

Denoised OpenImageDenoise::denoise(const GuidedImage& image) const
{
    const Folder folder;
    write(folder.file("color"), image.color);
    write(folder.file("albedo"), image.albedo);
    write(folder.file("normal"), image.normal);
    const std::optional<std::string> milliseconds = outputOf(fmt::format("{} {} {} {} {} {} {} {}", quoted(python_),
        quoted(WEDGE_DENOISE_SCRIPT), image.color.width, image.color.height, quoted(folder.file("color")),
        quoted(folder.file("albedo")), quoted(folder.file("normal")), quoted(folder.file("output"))));
    Denoised out { image.color, 0 };
    std::ifstream file(folder.file("output"), std::ios::binary);
    file.read(reinterpret_cast<char*>(out.image.rgb.data()),
        static_cast<std::streamsize>(out.image.rgb.size() * sizeof(float)));
    char* end = nullptr;
    out.milliseconds = milliseconds ? std::strtod(milliseconds->c_str(), &end) : 0.0;
    const bool whole = end != nullptr && std::string(end).find_first_not_of(" \r\n") == std::string::npos;
    if (!file || !whole || !(out.milliseconds > 0)
        || !std::ranges::all_of(out.image.rgb, [](float v) { return std::isfinite(v); })) {
        throw Error("Open Image Denoise", "has failed", "see what it says above");
    }
    return out;
}

} // namespace wedge::benchmark
