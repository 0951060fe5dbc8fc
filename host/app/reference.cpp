#include "host/app/reference.h"

#include "host/app/console.h"
#include "host/decode/limits.h"
#include "host/error.h"
#include "host/image/read_image.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::app {
namespace {

std::string corners(const image::Window& w) { return fmt::format("{},{},{},{}", w.x0, w.y0, w.x1, w.y1); }

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
    const bool cropped = settings.crop.width() > 0;
    const image::Window part = render::outputWindow(settings);
    const image::Window& stored = file.stored();
    if (file.width() == settings.width && file.height() == settings.height) {
        if (stored.contains(part)) {
            return file.read(part);
        }
        throw Error("reference " + path + " lacks a part of the image", corners(stored) + " and " + corners(part),
            "render with --crop " + corners(stored) + ", or give another reference");
    }
    if (cropped && stored.width() == part.width() && stored.height() == part.height()) {
        return file.read(stored);
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
