#include "benchmarks/common/variants.h"

#include <algorithm>
#include <cmath>

namespace wedge::benchmark {
namespace {

int nearestSquare(double value)
{
    const long side = std::lround(std::sqrt(std::max(0.0, value)));
    return static_cast<int>(side * side);
}

} // namespace

render::Settings uniform(render::Settings settings, double spp, int firstPass)
{
    const bool strata = settings.sampler == render::Sampler::Stratified;
    const int count = strata ? firstPass + nearestSquare(spp - firstPass) : static_cast<int>(std::lround(spp));
    settings.sampling = render::Sampling::Uniform;
    settings.spp = std::max(firstPass, count);
    settings.maxSpp = std::max(settings.maxSpp, settings.spp);
    settings.indirect.maxSpp = std::max(settings.indirect.maxSpp, settings.spp);
    return settings;
}

render::Settings plain(render::Sampler sampler, double spp)
{
    const bool strata = sampler == render::Sampler::Stratified;
    render::Settings out =
        render::monteCarlo(std::max(1, strata ? nearestSquare(spp) : static_cast<int>(std::lround(spp))));
    out.sampler = sampler;
    return out;
}

render::Settings fixed(render::Settings settings, float width)
{
    settings.filtering = render::Filtering::Fixed;
    settings.fixedWidth = width;
    return settings;
}

float bestFixedWidth(Lab& lab, const render::Settings& settings, float start)
{
    constexpr float step = 1.41421356f;
    constexpr float narrowest = 0.25f;
    constexpr float widest = 13.0f; // three of these are the kernel's largest radius, 40 pixels
    const auto error = [&](float width) { return lab.measure(fixed(settings, width)).rmse; };
    float best = start;
    double least = error(start);
    for (const float factor : { step, 1.0f / step }) {
        for (float width = start * factor; width >= narrowest && width <= widest; width *= factor) {
            const double e = error(width);
            if (e >= least) {
                break;
            }
            best = width;
            least = e;
        }
        if (best != start) {
            break; // the error has one minimum: it is not on the other side too
        }
    }
    return best;
}

} // namespace wedge::benchmark
