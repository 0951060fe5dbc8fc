#include "benchmarks/harness/image_blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wedge::benchmark {
namespace {

/// Along one axis: `count` values a line, `step` apart in the array.
void blurLine(const float* from, float* to, int count, std::size_t step, const std::vector<double>& weights)
{
    const int radius = static_cast<int>(weights.size()) - 1;
    for (int i = 0; i < count; ++i) {
        double sum = 0, weight = 0;
        for (int j = std::max(0, i - radius); j <= std::min(count - 1, i + radius); ++j) {
            const double w = weights[static_cast<std::size_t>(std::abs(i - j))];
            sum += w * from[static_cast<std::size_t>(j) * step];
            weight += w;
        }
        to[static_cast<std::size_t>(i) * step] = static_cast<float>(sum / weight);
    }
}

} // namespace

image::RgbImage blurred(const image::RgbImage& image, double sigma)
{
    if (sigma <= 0) {
        return image;
    }
    std::vector<double> weights;
    for (int i = 0; i <= static_cast<int>(std::ceil(3.0 * sigma)); ++i) {
        weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    }
    image::RgbImage rows = image, out = image;
    const std::size_t row = 3 * static_cast<std::size_t>(image.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        for (std::size_t c = 0; c < 3; ++c) {
            blurLine(image.rgb.data() + y * row + c, rows.rgb.data() + y * row + c, image.width, 3, weights);
        }
    }
    for (std::size_t x = 0; x < row; ++x) {
        blurLine(rows.rgb.data() + x, out.rgb.data() + x, image.height, row, weights);
    }
    return out;
}

} // namespace wedge::benchmark
