#include "effects/area_lights/soft_shadows.h"

#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>

namespace wedge::render {
namespace {

float gaussianScale(float sigma)
{
    constexpr float log2e = 1.44269504f;
    return sigma > 0 ? -0.5f * log2e / (sigma * sigma) : 0.0f;
}

} // namespace

bool isSheared(const Settings& s)
{
    // What is filtered has to be a share of the light's samples.
    return s.sheared && s.method == Method::AxisAligned && s.filtering == Filtering::Adaptive
        && s.shading != Shading::Inside;
}

ProfileScore scoreOf(const shared::AreaLight& light)
{
    // Local coordinates are products with the axes' duals.
    const auto dual = [](shared::Vec3 a, shared::Vec3 b) {
        const float aa = shared::vecDot(a, a), ab = shared::vecDot(a, b), bb = shared::vecDot(b, b);
        return shared::vecScale(
            shared::vecSub(shared::vecScale(a, bb), shared::vecScale(b, ab)), 1.0f / (aa * bb - ab * ab));
    };
    // -l'/l of a Gaussian is a cut^2; the rest of the first moment, which is 1, is that of the steps at its ends.
    const bool gaussian = light.profile == WEDGE_PROFILE_GAUSSIAN;
    const double slope = gaussian ? static_cast<double>(light.cut) * light.cut : 0.0;
    double mass = 0, squares = 0, eighths = 0;
    constexpr int points = 4096;
    for (int i = 0; i < points; ++i) {
        const double a = (i + 0.5) / points, squared = a * a, l = std::exp(-0.5 * slope * squared);
        mass += l;
        squares += l * squared;
        eighths += l * squared * squared * squared * squared;
    }
    ProfileScore out;
    out.edge = static_cast<float>(std::clamp(1.0 - slope * squares / mass, 0.0, 1.0));
    out.score.centre = light.centre;
    out.score.inner = static_cast<float>(slope);
    out.score.alongU = dual(light.halfU, light.halfV);
    out.score.alongV = dual(light.halfV, light.halfU);
    out.score.outer = static_cast<float>(out.edge * mass / eighths);
    return out;
}

shared::AnalysisParams withShearedWidths(
    shared::AnalysisParams p, const Settings& settings, const shared::AreaLight& light)
{
    p.mu *= (1.0f + 0.5f * scoreOf(light).edge) / settings.shearedWidth;
    return p;
}

shared::FilterParams withShear(
    shared::FilterParams p, const shared::AnalysisParams& analysis, const shared::AreaLight& light)
{
    // slopeWidth is sigma s / (k mu), so that half of 1 / s is this over it.
    const float half = 0.5f * light.sigma / (analysis.k * analysis.mu);
    const shared::LightScore score = scoreOf(light).score;
    p.shearU = shared::vecScale(score.alongU, half);
    p.shearV = shared::vecScale(score.alongV, half);
    return p;
}

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

Arguments shadowSamples(const FrameBuilder& frame, const ReceiverSet& at, const shared::SampleParams& params,
    const shared::AreaLight& light)
{
    return joined({ at.frame(), graph::value("params", params), graph::value("light", light) }, frame.hierarchy(),
        at.arguments());
}

graph::Argument quadratureOf(const FrameBuilder& frame, std::uint32_t index)
{
    return frame.outside("nodes", "float", frame.scene != nullptr ? &frame.scene->quadratures[index].cl() : nullptr);
}

} // namespace wedge::render
