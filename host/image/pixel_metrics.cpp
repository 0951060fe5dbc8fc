#include "host/image/colour.h"
#include "host/image/metrics.h"

#include <cmath>
#include <limits>

namespace wedge::image {

namespace {

bool isValidPixel(const RgbImage& image, std::size_t pixel)
{
    const float* rgb = &image.rgb[3 * pixel];
    return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
}

// Mean of error(a, b) over the channels of the pixels that are valid in both images.
template <typename ChannelError>
double meanOverValid(const RgbImage& image, const RgbImage& reference, ChannelError error)
{
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t pixel = 0; pixel < image.rgb.size() / 3; ++pixel) {
        if (!isValidPixel(image, pixel) || !isValidPixel(reference, pixel))
            continue;
        for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
            sum += error(image.rgb[i], reference.rgb[i]);
        count += 3;
    }
    return count ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

double rmse(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    return std::sqrt(meanOverValid(image, reference, [](double a, double b) { return (a - b) * (a - b); }));
}

double relMse(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    return meanOverValid(image, reference, [](double a, double b) { return (a - b) * (a - b) / (b * b + 0.01); });
}

double psnr(const RgbImage& image, const RgbImage& reference)
{
    requireSameSize(image, reference);
    const auto display = [](float value) -> double { return encodeSrgb(clipToDisplay(value)); };
    return -10.0 * std::log10(meanOverValid(image, reference, [&](float a, float b) {
        const double difference = display(a) - display(b);
        return difference * difference;
    }));
}

} // namespace wedge::image
