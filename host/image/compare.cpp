#include "host/image/colour.h"
#include "host/image/metrics.h"
#include "host/image/read_image.h"

#include "host/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

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

namespace {

void requireSame(std::pair<int, int> image, std::pair<int, int> reference)
{
    if (image != reference)
        throw Error("image and reference differ in size",
            fmt::format("{}x{} and {}x{}", image.first, image.second, reference.first, reference.second),
            "compare images of one size");
}

} // namespace

void requireSameSize(const RgbImage& image, const RgbImage& reference)
{
    requireConsistent(image);
    requireConsistent(reference);
    requireSame({ image.width, image.height }, { reference.width, reference.height });
}

ComparedParts comparedParts(const ImageFile& image, const ImageFile& reference)
{
    const Window &a = image.stored(), &b = reference.stored();
    if (image.whole() != reference.whole()) {
        requireSame({ a.width(), a.height() }, { b.width(), b.height() });
        return { a, b };
    }
    const Window common = a.within(b);
    if (common.empty())
        throw Error("image and reference show different parts of the frame",
            fmt::format("{},{},{},{} and {},{},{},{}", a.x0, a.y0, a.x1, a.y1, b.x0, b.y0, b.x1, b.y1),
            "compare images of one part");
    return { common, common, a != b };
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
