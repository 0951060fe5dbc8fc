#include "effects/area_lights/soft_shadows.h"

#include "kernels/shared/wedge.h"

#include <algorithm>

namespace wedge::render {
namespace {

float gaussianScale(float sigma)
{
    constexpr float log2e = 1.44269504f;
    return sigma > 0 ? -0.5f * log2e / (sigma * sigma) : 0.0f;
}

} // namespace

std::uint32_t lobeDirections(int spp)
{
    constexpr int usual = 256, usualSpp = 28, most = 1 << 12; // more would make launches long
    return static_cast<std::uint32_t>(std::min(most, usual * std::max(usualSpp, std::min(spp, most)) / usualSpp));
}

shared::SampleParams lightSampleParams(const Settings& settings, std::uint32_t index)
{
    shared::SampleParams p {};
    p.shading = static_cast<std::uint32_t>(settings.shading);
    p.sampler = static_cast<std::uint32_t>(settings.sampler);
    p.light = index;
    p.firstPass = settings.method == Method::AxisAligned ? WEDGE_FIRST_PASS_RAYS : 0;
    // A filtered term is visibility of points on the light, and so is a ratio: of directions only those of lobes that
    // are narrower than the light have a part in them (met_light.h).
    const bool plain = settings.method == Method::MonteCarlo && settings.shading == Shading::Inside;
    p.lightSampling = plain ? static_cast<std::uint32_t>(settings.lightSampling) : WEDGE_LIGHTS_SAMPLED;
    return p;
}

shared::AnalysisParams lightParams(shared::AnalysisParams p, const Settings& settings, const shared::AreaLight& light)
{
    p.sigma = light.sigma;
    // A_l = (2 sigma)^2, as section 3.5.1 takes the light's effective width.
    p.lightSize = 2.0f * light.sigma;
    p.k = settings.k;
    p.mu = settings.mu;
    p.alpha = settings.alpha;
    p.fillRadius = static_cast<std::uint32_t>(settings.fillRadius);
    p.fillScale = gaussianScale(settings.fillSigma);
    p.countCap = static_cast<std::uint32_t>(std::max(settings.maxSpp, settings.spp)); // not below the mean
    p.fixedWidth = settings.filtering == Filtering::Fixed ? settings.fixedWidth : 0.0f;
    p.countExponent = settings.countExponent;
    p.varianceFloor = settings.varianceFloor;
    p.varianceSpread = settings.varianceSpread;
    p.lightCentre = light.centre;
    // What nine rays have missed is found in the end, however many are asked for.
    p.leastCount = std::max(WEDGE_FIRST_PASS_RAYS, static_cast<std::uint32_t>(settings.spp) / 16);
    return p;
}

} // namespace wedge::render
