#include "host/image/colour.h"
#include "host/image/metrics.h"

#include "host/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace wedge::image {

std::size_t countInvalidPixels(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    const auto isFinite = [](float value) { return std::isfinite(value); };
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        count += !std::all_of(&image.rgb[i], &image.rgb[i] + 3, isFinite)
            || !std::all_of(&reference.rgb[i], &reference.rgb[i] + 3, isFinite);
    return count;
}

void requireSameSize(const RgbImage& image, const RgbImage& reference)
{
    requireConsistent(image);
    requireConsistent(reference);
    if (image.width != reference.width || image.height != reference.height)
        throw Error("image and reference differ in size",
            fmt::format("{}x{} and {}x{}", image.width, image.height, reference.width, reference.height),
            "compare images of one size");
}

Comparison compare(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    Comparison result;
    result.rmse = rmse(image, reference);
    result.relMse = relMse(image, reference);
    result.psnr = psnr(image, reference);
    result.ssim = ssim(image, reference);
    result.flip = flip(image, reference).mean;
    result.invalidPixels = countInvalidPixels(image, reference);
    return result;
}

} // namespace wedge::image
