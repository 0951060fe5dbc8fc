#include "benchmarks/indirect/bias.h"

#include "benchmarks/indirect/indirect_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace wedge::benchmark {
namespace {

// Apart from the seeds of errors and baselines.
constexpr std::uint32_t firstSeed = 1001;

double meanOf(const image::RgbImage& image)
{
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0) / static_cast<double>(image.rgb.size());
}

} // namespace

double biasOf(const std::vector<image::RgbImage>& images, const image::RgbImage& reference, double referenceNoise)
{
    assert(images.size() >= 2);
    const auto n = static_cast<double>(images.size());
    const std::size_t values = reference.rgb.size();
    double squared = 0, variance = 0; // of the mean's difference, of the mean
    for (std::size_t i = 0; i < values; ++i) {
        double sum = 0, squares = 0;
        for (const image::RgbImage& image : images) {
            const double difference = static_cast<double>(image.rgb[i]) - reference.rgb[i];
            sum += difference;
            squares += difference * difference;
        }
        squared += (sum / n) * (sum / n);
        variance += std::max(0.0, squares - sum * sum / n) / ((n - 1) * n);
    }
    const auto count = static_cast<double>(values);
    return withoutNoise(std::sqrt(std::max(0.0, (squared - variance) / count)), referenceNoise);
}

Bias measureBias(Lab& lab, bool published, float mu, int seeds)
{
    render::Settings settings = published ? render::asPublished(mu) : render::axisAligned();
    settings.bounces = 1;
    settings.indirect.mu = mu;
    const Reference& reference = lab.reference(settings);
    const Measured one = lab.measure(settings);
    std::vector<image::RgbImage> images;
    double mean = 0;
    for (int i = 0; i < seeds; ++i) {
        images.push_back(lab.render(settings, firstSeed + static_cast<std::uint32_t>(i)));
        mean += meanOf(images.back()) / seeds;
    }
    Bias out { published ? "published" : "default", mu, one.spp, 0, 0, one.rmse };
    const double truth = meanOf(reference.image);
    out.meanError = truth > 0 ? mean / truth - 1.0 : 0.0;
    out.rms = biasOf(images, reference.image, reference.noise);
    return out;
}

} // namespace wedge::benchmark
