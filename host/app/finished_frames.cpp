#include "host/app/finished_frames.h"

#include "host/files_opened.h"
#include "host/hash.h"
#include "host/image/exr.h"
#include "host/image/png.h"
#include "host/render/metadata.h"

#include <exception>
#include <filesystem>

#include <fmt/format.h>

namespace wedge::app {
namespace {

template <class T>
std::string given(const char* name, const std::optional<T>& value)
{
    return value ? fmt::format("{} {}\n", name, *value) : "";
}

bool isFinishedExr(const std::string& path, const std::string& inputs)
{
    const image::LayeredImage image = image::readExr(path);
    const auto made = image.metadata.find("inputs"), complete = image.metadata.find("complete");
    return made != image.metadata.end() && made->second == image::MetadataValue(inputs)
        && complete != image.metadata.end() && complete->second == image::MetadataValue(1);
}

} // namespace

std::string sequenceInputs(
    const RenderOptions& o, const render::Settings& settings, double framesPerUnit, std::uint64_t contents)
{
    std::string text = fmt::format("{}\n{:016x}\n{}x{}\n{} {} {} {}\nseed {}\nfps {}\n", render::version(), contents,
        settings.width, settings.height, settings.crop.x0, settings.crop.y0, settings.crop.x1, settings.crop.y1,
        settings.seed, framesPerUnit);
    for (const auto& [name, value] : render::describe(settings)) {
        text += fmt::format("{} {}\n", name, value);
    }
    text += fmt::format("antialias {}\nfilter {}\nfast-math {}\nlayers {}\n", settings.antialias,
        static_cast<int>(settings.pixelFilter), o.fastMath, o.layers);
    text += given("aperture", o.aperture) + given("focus", o.focus);
    for (const std::string& change : o.changeTexts) {
        text += change + "\n";
    }
    text += fmt::format("{} {}\n", o.exposureStops, static_cast<int>(o.view.value_or(image::View::Srgb)));
    return fmt::format("{:016x}", hashOf(text));
}

std::string frameInputs(const std::string& sequence, std::uint32_t frame)
{
    return fmt::format("{} frame {}", sequence, frame);
}

bool isFinished(const Output& output, const std::string& inputs)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(output.path, ignored)) {
        return false;
    }
    const FilesLookedAt looking;
    try {
        if (output.format == ImageFormat::Exr) {
            return isFinishedExr(output.path, inputs);
        }
        // A picture that ends early is none.
        return image::pngInputs(output.path) == inputs && image::readPng(output.path).width > 0;
    } catch (const std::exception&) {
        return false; // it is replaced, as any output
    }
}

} // namespace wedge::app
