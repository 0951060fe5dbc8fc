#include "effects/shadow_lights/shadow_lights.h"

#include "effects/shadow_lights/map_lights.h"
#include "host/render/sample_slices.h"
#include "kernels/shared/shadow_lights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/shadow_lights.cl";

// Of a pixel between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr std::uint32_t sliceLights = 96;
/// Of wholeLobes: twice the square of this number of directions of a lobe, whatever the lights.
constexpr std::uint32_t wholeRings = 16;

/// Sums of lights: shadowed and unshadowed, R G B each.
constexpr std::uint32_t sumPlanes = 6;

/// The map's whole light is another than that of the lights.
bool isPrefiltered(const ShadowSettings& s)
{
    return s.whole == WholeLight::Prefiltered && s.shadows != Shadows::Additive;
}

bool widens(const ShadowSettings& s) { return s.shadows == Shadows::Ratio && s.whole == WholeLight::Prefiltered; }

/// The lights of the frame's map, found when the frame is run.
graph::Handle<Directions> listOfLights(FrameBuilder& f)
{
    const auto count = static_cast<std::size_t>(f.settings.environment.shadows.lights);
    requirePlaces(*f.description.picture(), count);
    auto list = f.graph.list<Directions>("lights of the map", graph::floats, count * WEDGE_SHADOW_LIGHT_FLOATS);
    f.graph.add({ .name = "lights of the map",
        .kind = PassKind::Transfer,
        .arguments = { writes("lights", list) },
        .domain = graph::Domain::Host,
        .step =
            [picture = f.description.picture(), count, list](graph::Run& run) {
                if (run.rehearsal()) {
                    return;
                }
                std::vector<float> numbers;
                numbers.reserve(count * WEDGE_SHADOW_LIGHT_FLOATS);
                for (const MapLight& light : mapLights(*picture, count)) {
                    for (const glm::vec3& v : { light.towards, light.irradiance }) {
                        numbers.insert(numbers.end(), { v.x, v.y, v.z });
                    }
                }
                run.buffer<float>(list).upload(run.queue(), numbers);
            },
        .constant = true });
    return list;
}

/// What lights bring to pixels.
struct Lit {
    graph::Handle<Sums> matt, lobes;
    graph::Handle<Count> taken;
    graph::Handle<Radiance> whole; ///< of lobes, without shadows; of no graph where it is that of the lights
};

/// Lobes see the map as it is. By tiles, since that takes longer than all shadow rays.
graph::Handle<Radiance> wholeLobes(FrameBuilder& f, ReceiverSet& at)
{
    auto whole = f.graph.plane<Radiance>("whole light of lobes", graph::vectors);
    f.zero(whole);
    at.trace("whole light of lobes", { program, "wholeLobes" },
        joined({ at.frame(), value("rings", wholeRings) }, f.beyond(), at.arguments(),
            Arguments { reads("specular", f.surfaces.specular), updates("whole", whole) }),
        [](const graph::Launch&) { return 2.0 * wholeRings * wholeRings; });
    return whole;
}

graph::Argument ofLobes(const FrameBuilder& f, graph::Handle<Sums>& lobes)
{
    return f.specular() ? updates("lobeSums", lobes) : graph::absent("lobeSums", graph::floatPlanes(sumPlanes));
}

Lit traceLights(FrameBuilder& f, ReceiverSet& at)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    const auto count = static_cast<std::uint32_t>(s.lights);
    const graph::Handle<Directions> lights = listOfLights(f);
    Lit lit { f.graph.plane<Sums>("sums of matt light", graph::floatPlanes(sumPlanes)),
        f.graph.plane<Sums>("sums of lobes' light", graph::floatPlanes(widens(s) ? 2 * sumPlanes : sumPlanes)),
        f.graph.plane<Count>("lights taken", graph::counts), {} };
    f.zero(lit.matt, lit.taken);
    if (f.specular()) {
        f.zero(lit.lobes);
    }
    // Lights are 4 pi / N apart, and a lobe of the exponent m is about 2 pi / m wide.
    const float spacing = static_cast<float>(count) / (4.0f * std::acos(-1.0f));
    const SampleSlices slices(0, count, sliceLights, count);
    f.graph.loop("slices of lights", slices.counter(), [&] {
        at.trace("shadow lights", { program, "shadowLights" },
            joined({ at.frame(), value("widest", widens(s) ? spacing : 0.0f) }, f.hierarchy(), at.arguments(),
                Arguments { reads("lights", lights), slices.last(), updates("taken", lit.taken),
                    updates("mattSums", lit.matt), ofLobes(f, lit.lobes), at.tallyRays() }),
            slices.workUnits(static_cast<double>(count)));
    });
    if (f.specular() && isPrefiltered(s)) {
        lit.whole = wholeLobes(f, at);
    }
    return lit;
}

/// How the map's whole light and lights are put together.
Arguments combination(const FrameBuilder& f)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    const std::uint32_t ways[] = { 0u, WEDGE_SHADOWS_ADDITIVE, WEDGE_SHADOWS_SUBTRACTIVE, WEDGE_SHADOWS_RATIO };
    const glm::vec3 most(f.scene != nullptr ? f.description.lights().beyond->mostIrradiance : glm::dvec3(0.0));
    return graph::together("combination",
        { value("shadows", ways[static_cast<int>(s.shadows)]), value("prefiltered", isPrefiltered(s) ? 1u : 0u),
            value("clamps", s.shadows == Shadows::Subtractive && s.clamp ? 1u : 0u), value("wide", widens(s) ? 1u : 0u),
            value("mostRed", most.r), value("mostGreen", most.g), value("mostBlue", most.b) });
}

void sample(FrameBuilder& f, ReceiverSet& at, graph::Handle<Radiance>& radiance)
{
    Lit lit = traceLights(f, at);
    const ShadowSettings& s = f.settings.environment.shadows;
    const Surfaces& seen = f.surfaces;
    auto clamped = f.graph.plane<Count>("clamped", graph::counts);
    f.pixels("composite", PassKind::Composite, { program, "combineShadowLights" },
        joined({ f.rectangle(f.analysisParams()) }, combination(f), f.beyond(),
            graph::together("surfaces",
                { reads("normal", seen.normal), reads("diffuse", seen.diffuse), reads("specular", seen.specular) }),
            Arguments { reads("mattSums", lit.matt),
                f.specular() ? reads("lobeSums", lit.lobes) : graph::absent("lobeSums", graph::floatPlanes(sumPlanes)),
                lit.whole.graph != 0 ? reads("whole", lit.whole) : graph::absent("whole", graph::vectors),
                reads("taken", lit.taken), updates("lit", radiance), writes("clamped", clamped) }));
    if (s.shadows == Shadows::Subtractive && s.clamp) {
        graph::Handle<Tally>& tally = f.totals.tallies.clamped;
        tally = f.graph.list<Tally>("tally of clamped pixels", tallySums, WEDGE_TALLY_STRIPES);
        f.zero(tally);
        f.count(clamped, false, tally);
    }
}

class ShadowLights : public Effect {
public:
    std::string name() const override { return "shadow lights"; }

    std::optional<Unfiltered> unfiltered(const Settings& settings, const PreparedScene& scene) const override
    {
        const ShadowSettings& s = settings.environment.shadows;
        if (settings.integrator != Integrator::Path || scene.picture() == nullptr || s.shadows == Shadows::Sampled) {
            return std::nullopt;
        }
        return Unfiltered { .name = "shadow lights", .workUnits = static_cast<double>(s.lights), .sample = sample };
    }
};

} // namespace

std::unique_ptr<const Effect> shadowLights() { return std::make_unique<ShadowLights>(); }

} // namespace wedge::render
