#include "benchmarks/common/image_bias.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace wedge::benchmark {

double biasOf(const std::vector<image::RgbImage>& images, const image::RgbImage& reference, double referenceNoise)
{
    assert(images.size() >= 2);
    const auto n = static_cast<double>(images.size());
    double squared = 0, variance = 0; // of the mean's difference, of the mean
    for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
        double sum = 0, squares = 0;
        for (const image::RgbImage& image : images) {
            const double difference = static_cast<double>(image.rgb[i]) - reference.rgb[i];
            sum += difference;
            squares += difference * difference;
        }
        squared += (sum / n) * (sum / n);
        variance += std::max(0.0, squares - sum * sum / n) / ((n - 1) * n);
    }
    const auto values = static_cast<double>(reference.rgb.size());
    return withoutNoise(std::sqrt(std::max(0.0, (squared - variance) / values)), referenceNoise);
}

double meanOf(const image::RgbImage& image)
{
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0) / static_cast<double>(image.rgb.size());
}

double withoutNoise(double rmse, double noise) { return std::sqrt(std::max(0.0, rmse * rmse - noise * noise)); }

} // namespace wedge::benchmark
