#include "benchmarks/harness/bias.h"

#include "benchmarks/common/image_bias.h"

#include <vector>

namespace wedge::benchmark {
namespace {

// Apart from the seeds of errors and baselines.
constexpr std::uint32_t firstSeed = 1001;

} // namespace

Bias measureBias(Lab& lab, const Case& of, bool published, float mu)
{
    render::Settings settings = published ? methodSettings(of, true, {}, mu) : methodSettings(of, false);
    settings.indirect.mu = mu;
    const Reference& reference = lab.reference(settings);
    const Measured one = lab.measure(settings);
    std::vector<image::RgbImage> images;
    double mean = 0;
    for (int i = 0; i < lab.plan().biasSeeds; ++i) {
        images.push_back(lab.render(settings, firstSeed + static_cast<std::uint32_t>(i)));
        mean += meanOf(images.back()) / lab.plan().biasSeeds;
    }
    Bias out { published, mu, one.spp, 0, 0, one.rmse };
    const double truth = meanOf(reference.image);
    out.meanError = truth > 0 ? mean / truth - 1.0 : 0.0;
    out.rms = biasOf(images, reference.image, reference.noise);
    return out;
}

} // namespace wedge::benchmark
