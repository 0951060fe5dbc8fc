#include "host/app/rescue.h"

#include "host/text.h"

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace wedge::app {
namespace {

constexpr std::size_t longestName = 100; // so that it stands whole in a line of an error, in which
constexpr std::size_t longestPath = 170; // it can be read and copied
constexpr int mostTries = 1000;

std::string stemOf(const std::string& path)
{
    const std::string stem = std::filesystem::path(path).stem().string();
    return stem.empty() || stem.size() > longestName || printable(stem) != stem ? "wedge" : stem;
}

/// Makes an empty file of a name that is free, which the image then replaces. Returns "" where the folder takes none.
std::string reserve(const std::string& folder, const std::string& stem, const std::string& extension)
{
    for (int i = 1; i <= mostTries; ++i) {
        std::string path =
            fmt::format("{}/{}-rescued{}{}", folder, stem, i == 1 ? "" : fmt::format("-{}", i), extension);
        const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) {
            close(file);
            return path;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    return "";
}

std::string keepIn(
    const std::string& folder, const Output& output, const image::LayeredImage& image, const image::Look& look)
{
    std::string path = reserve(folder, stemOf(output.path), output.format == ImageFormat::Exr ? ".exr" : ".png");
    if (path.empty()) {
        return path;
    }
    try {
        writeImage({ path, output.format }, image, look);
        return path;
    } catch (const std::exception&) {
        unlink(path.c_str());
        return "";
    }
}

} // namespace

std::optional<std::string> rescue(const Output& output, const image::LayeredImage& image, const image::Look& look)
{
    const char* temporary = std::getenv("TMPDIR");
    for (const std::string folder : { ".", temporary == nullptr ? "" : temporary, "/tmp" }) {
        if (folder.empty() || folder.size() + longestName > longestPath) {
            continue;
        }
        if (const std::string path = keepIn(folder, output, image, look); !path.empty()) {
            return path;
        }
    }
    return std::nullopt;
}

} // namespace wedge::app
