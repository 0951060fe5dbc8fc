#include "effects/area_lights/maaf.h"

#include "effects/area_lights/soft_shadows.h"
#include "host/render/sinks.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/glm.hpp>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

/// Omega_max of (6) times the light's standard deviation, which weights were fitted with; of one component, that of the
/// light itself.
constexpr float bandwidth = 2.0f;
/// Weights are fitted to a profile that is cut at 2 deviations; farther out components over the profile grow without
/// bound.
constexpr float widestCut = 2.5f;
/// What ends in steps makes kinks in shadows, which second derivatives overshoot and no component knows: steps may have
/// this much of the profile's first moment, which a Gaussian's have where it is cut at 1.5 deviations. Cut at a
/// fraction of one it is uniform in all but name.
constexpr float mostEdge = 0.45f;
/// Of a filter of both slopes, over one of s_min that follows no gradients.
constexpr float twoSlopeWidth = 2.1f;

} // namespace

std::optional<Maaf> maafOf(const Settings& settings, const shared::AreaLight& light)
{
    const bool filters = settings.method == Method::AxisAligned && settings.filtering == Filtering::Adaptive
        && settings.slopes == Slopes::Smoothed && settings.shading != Shading::Inside;
    if (!settings.maaf || !filters || light.profile != WEDGE_PROFILE_GAUSSIAN || scoreOf(light).edge > mostEdge) {
        return std::nullopt;
    }
    return *settings.maaf == Maaf::TwoSlope || light.cut <= widestCut ? settings.maaf : std::nullopt;
}

std::string lightOf(Maaf maaf)
{
    const std::string cut = "a Gaussian area light that is cut at 1.5 "; // mostEdge
    return cut + (maaf == Maaf::TwoSlope ? "deviations or beyond" : fmt::format("to {} deviations", widestCut));
}

shared::LightMoments momentsOf(const shared::AreaLight& light)
{
    // The second score is that of the Gaussian, a^2 less its mean, with a factor that makes its second moment 2, as
    // that of l'' is: where the profile is cut it has steps at its ends, too.
    const double slope = static_cast<double>(light.cut) * light.cut;
    double mass = 0, squares = 0, fourths = 0;
    constexpr int points = 4096;
    for (int i = 0; i < points; ++i) {
        const double a = (i + 0.5) / points, l = std::exp(-0.5 * slope * a * a);
        mass += l;
        squares += l * a * a;
        fourths += l * a * a * a * a;
    }
    squares /= mass;
    fourths /= mass;
    shared::LightMoments out {};
    out.first = scoreOf(light).score;
    out.curve = static_cast<float>(2.0 / (fourths - squares * squares));
    out.square = static_cast<float>(squares);
    return out;
}

shared::LightAxes axesOf(const shared::AreaLight& light, int components)
{
    const shared::LightScore score = scoreOf(light).score;
    shared::LightAxes out {};
    out.centre = light.centre;
    out.bandwidth = components == 1 ? 1.0f : bandwidth;
    out.alongU = shared::vecScale(score.alongU, light.cut);
    out.alongV = shared::vecScale(score.alongV, light.cut);
    return out;
}

graph::Format momentsFormat(std::uint32_t channels)
{
    return shortPlanes(channels == 2 ? "short10" : "short5", 5 * channels);
}

graph::Format componentsFormat(int components, std::uint32_t channels)
{
    // Of each channel all weights, and what is seen of them.
    const auto count = static_cast<std::uint32_t>(2 * components * components) * channels;
    switch (count) {
    case 2:
        return shortPairs;
    case 4:
        return shortQuadruples;
    case 18:
        return shortPlanes("short18", count);
    case 36:
        return shortPlanes("short36", count);
    case 50:
        return shortPlanes("short50", count);
    case 100:
        return shortPlanes("short100", count);
    case 98:
        return shortPlanes("short98", count);
    case 196:
        return shortPlanes("short196", count);
    default:
        throw std::logic_error(fmt::format("no format of {} components", components));
    }
}

LayerInfo componentsLayer(const Settings& settings)
{
    LayerInfo layer { "components", {},
        "what each pair of components along a light's axes adds to the part of it that matt surfaces see (--maaf "
        "printed or refitted; of several lights components1, components2, ...)" };
    if (!settings.maaf || *settings.maaf == Maaf::TwoSlope) {
        layer.channels = { "00", "01", "..." };
        layer.absence = "the frame is not filtered by components (--method maaf, --maaf printed or refitted)";
        return layer;
    }
    const int pairs = (settings.components + 1) / 2;
    for (int pair = 0; pair < pairs * pairs; ++pair) {
        layer.channels.push_back(fmt::format("{}{}", pair / pairs, pair % pairs));
    }
    return layer;
}

SlopeWindow slopeWindowOf(const std::optional<Maaf>& maaf)
{
    return maaf && *maaf != Maaf::TwoSlope ? SlopeWindow { .eroded = false, .radius = 2 } : SlopeWindow {};
}

Narrowing narrowingOf(const Settings& settings, const std::optional<Maaf>& maaf)
{
    if (!maaf) {
        return { settings.countWidth, settings.wideBlur, settings.wideBlurExponent };
    }
    return *maaf == Maaf::TwoSlope ? Narrowing { settings.countWidth, 8.0f, 0.5f } : Narrowing {};
}

shared::FilterParams withComponents(shared::FilterParams p)
{
    p.normalCosine = static_cast<float>(std::cos(glm::radians(20.0)));
    return p;
}

shared::AnalysisParams withTwoSlopeWidths(shared::AnalysisParams p, const shared::AreaLight& light)
{
    p.mu *= (1.0f + 0.5f * scoreOf(light).edge) / twoSlopeWidth;
    return p;
}

shared::FilterParams withTwoSlopes(
    shared::FilterParams p, const shared::AnalysisParams& analysis, const shared::AreaLight& light)
{
    // slopeWidth is sigma s / (k mu), so that 1 / s is this over it.
    const float perSlope = light.sigma / (analysis.k * analysis.mu);
    const shared::LightScore score = scoreOf(light).score;
    p.shearU = shared::vecScale(score.alongU, perSlope);
    p.shearV = shared::vecScale(score.alongV, perSlope);
    return p;
}

void componentFilter(FrameBuilder& frame, const shared::FilterParams& params, const shared::AnalysisParams& analysis,
    const shared::AreaLight& light, const graph::Handle<Value>& shown, const graph::Handle<Metres>& beta,
    const ComponentTerm& term, Gathered& out, graph::Handle<Value>* parts)
{
    const Settings& settings = frame.settings;
    const int pixels = static_cast<int>(params.maxRadius);
    const graph::Reach around { .x = pixels, .y = pixels };
    frame.blocks("filter", PassKind::Filter,
        { "filter/components.cl", "filterComponents", {},
            frame.surfaceFormats({ { "WEDGE_COMPONENTS", std::to_string(settings.components) } }) },
        joined({ frame.rectangle(params), value("light", axesOf(light, settings.components)),
                   value("slopesPerWidth", analysis.k * analysis.mu / analysis.sigma),
                   value("floorPerPixel", 1.0f / (analysis.alpha * analysis.sigma)),
                   value("refitted", settings.maaf == Maaf::Refitted ? 1u : 0u), reads("value", shown),
                   reads("beta", beta, around) },
            gathered(frame, around),
            graph::together("term",
                { reads("sums", term.sums, around), reads("components", term.components, around),
                    reads("slopeWidth", term.slopeWidth, around), reads("ratio", term.ratio) }),
            Arguments { writes("filtered", out.value), writes("effective", out.effective),
                parts != nullptr ? updates("parts", *parts) : graph::absent("parts") }));
}

} // namespace wedge::render
