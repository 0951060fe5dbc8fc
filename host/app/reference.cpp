#include "host/app/reference.h"

#include "host/app/console.h"
#include "host/decode/limits.h"
#include "host/error.h"
#include "host/image/read_image.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::app {
namespace {

image::RgbImage cut(const image::RgbImage& image, const image::Window& window)
{
    image::RgbImage out { window.width(), window.height(), {} };
    out.rgb.reserve(static_cast<std::size_t>(out.width) * out.height * 3);
    for (int y = window.y0; y < window.y1; ++y) {
        const auto row = image.rgb.begin() + (static_cast<std::ptrdiff_t>(y) * image.width + window.x0) * 3;
        out.rgb.insert(out.rgb.end(), row, row + static_cast<std::ptrdiff_t>(out.width) * 3);
    }
    return out;
}

} // namespace

image::RgbImage readReference(const std::string& path, const render::Settings& settings)
{
    // Its size is known before it is decoded. As many pixels as the frame has are what was asked for.
    decode::Limits limits = decode::referenceLimits;
    const std::int64_t framePixels = std::int64_t { settings.width } * settings.height;
    limits.pixels = std::max(limits.pixels, framePixels);
    limits.unquestioned = std::max(limits.unquestioned, framePixels);
    limits.remedy = "give one of the frame's size";
    image::ImageFile file(path, limits);
    const image::Window& crop = settings.crop;
    const bool cropped = crop.width() > 0;
    if (file.width() == settings.width && file.height() == settings.height) {
        return cropped ? cut(file.read(), crop) : file.read();
    }
    if (cropped && file.width() == crop.width() && file.height() == crop.height()) {
        return file.read();
    }
    throw Error("reference " + path + " has another size than the image",
        fmt::format("{}x{} and {}x{}", file.width(), file.height(), settings.width, settings.height),
        "render with --size of the reference, or give another reference");
}

void warnOfInvalidPixels(std::size_t invalid, const image::RgbImage& image)
{
    if (invalid > 0) {
        warn(fmt::format("pixels that are not finite in the image or the reference: {} of {}: rmse, relmse and psnr "
                         "leave them out",
            invalid, static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)));
    }
}

std::string describe(const image::Comparison& c)
{
    const std::string invalid = c.invalidPixels > 0 ? fmt::format("  invalid pixels {}", c.invalidPixels) : "";
    return fmt::format("rmse {:.5g}  relmse {:.5g}  psnr {:.2f} dB  ssim {:.4f}  flip {:.4f}{}", c.rmse, c.relMse,
        c.psnr, c.ssim, c.flip, invalid);
}

} // namespace wedge::app
