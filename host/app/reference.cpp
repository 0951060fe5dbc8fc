#include "host/app/reference.h"

#include "host/app/console.h"
#include "host/error.h"
#include "host/image/read_image.h"

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
    image::ImageFile file(path); // its size is known before it is decoded
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
