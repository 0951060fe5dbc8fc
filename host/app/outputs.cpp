#include "host/app/outputs.h"

#include "host/error.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/png.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace wedge::app {
namespace {

ImageFormat formatOf(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(
        extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") {
        return ImageFormat::Exr;
    }
    if (extension == ".png") {
        return ImageFormat::Png;
    }
    throw UsageError("output of unknown format", path.empty() ? "(empty name)" : path, "end its name in .exr or .png");
}

} // namespace

std::vector<Output> planOutputs(const std::vector<std::string>& paths, const std::string& scene)
{
    if (paths.empty()) {
        return { { std::filesystem::path(scene).stem().string() + ".exr", ImageFormat::Exr } };
    }
    std::vector<Output> outputs;
    for (const std::string& path : paths) {
        if (std::ranges::any_of(outputs, [&](const Output& other) { return other.path == path; })) {
            throw UsageError("output is named twice", path, "give each output a name of its own");
        }
        outputs.push_back({ path, formatOf(path) });
    }
    return outputs;
}

void requireWritable(const std::vector<Output>& outputs, const std::string& report)
{
    for (const Output& output : outputs) {
        image::checkWritable(output.path);
    }
    if (!report.empty()) {
        image::checkWritable(report);
    }
}

void writeOutputs(const std::vector<Output>& outputs, const image::LayeredImage& image, float exposureStops)
{
    for (const Output& output : outputs) {
        if (output.format == ImageFormat::Exr) {
            image::writeExr(output.path, image);
        } else {
            image::writePng(output.path, image::beauty(image), exposureStops);
        }
    }
}

void writeText(const std::string& path, const std::string& text)
{
    image::AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace wedge::app
