#include "benchmarks/common/smooth_region.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wedge::benchmark {
namespace {

constexpr int radius = 3; // pixels
constexpr double mostDeviation = 0.05; // of the mean

double luminance(const image::RgbImage& image, std::size_t pixel)
{
    const float* c = image.rgb.data() + 3 * pixel;
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/// Whether the pixels around one are all sampled and nearly alike.
bool smoothAround(const Reference& reference, int x, int y)
{
    double sum = 0, squares = 0, noise = 0, count = 0;
    for (int v = y - radius; v <= y + radius; ++v) {
        for (int u = x - radius; u <= x + radius; ++u) {
            const std::size_t at = static_cast<std::size_t>(v) * static_cast<std::size_t>(reference.image.width)
                + static_cast<std::size_t>(u);
            const float* deviation = reference.deviation.rgb.data() + 3 * at;
            if (std::all_of(deviation, deviation + 3, [](float d) { return d == 0.0f; })) {
                return false;
            }
            const double value = luminance(reference.image, at), off = luminance(reference.deviation, at);
            sum += value;
            squares += value * value;
            noise += off * off;
            count += 1;
        }
    }
    const double mean = sum / count;
    return (squares - noise) / count - mean * mean <= mostDeviation * mostDeviation * mean * mean;
}

} // namespace

std::vector<bool> smoothRegion(const Reference& reference)
{
    const int width = reference.image.width, height = reference.image.height;
    std::vector<bool> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false);
    bool any = false;
    for (int y = radius; y + radius < height; ++y) {
        for (int x = radius; x + radius < width; ++x) {
            if (smoothAround(reference, x, y)) {
                out[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = true;
                any = true;
            }
        }
    }
    return any ? out : std::vector<bool> {};
}

RegionError regionError(const image::RgbImage& image, const Reference& reference, const std::vector<bool>& region)
{
    assert(3 * region.size() == image.rgb.size() && image.rgb.size() == reference.image.rgb.size());
    double squares = 0, noise = 0, count = 0;
    for (std::size_t pixel = 0; pixel < region.size(); ++pixel) {
        if (!region[pixel]) {
            continue;
        }
        for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
            const double error = static_cast<double>(image.rgb[c]) - reference.image.rgb[c];
            const double off = reference.deviation.rgb[c];
            squares += error * error;
            noise += off * off;
            count += 1;
        }
    }
    return { std::sqrt(squares / count), std::sqrt(noise / count) };
}

} // namespace wedge::benchmark
