#include "benchmarks/indirect/bias.h"

#include "benchmarks/common/image_bias.h"
#include "benchmarks/indirect/indirect_light.h"

#include <vector>

namespace wedge::benchmark {
namespace {

// Apart from the seeds of errors and baselines.
constexpr std::uint32_t firstSeed = 1001;

} // namespace

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
