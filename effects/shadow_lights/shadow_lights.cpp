#include "effects/shadow_lights/shadow_lights.h"

#include "effects/shadow_lights/light_tree.h"
#include "effects/shadow_lights/map_lights.h"
#include "host/render/sample_slices.h"
#include "kernels/shared/shadow_lights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
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

/// By so much of the map's mean radiance may what lobes reflect of a part of it be off, about.
constexpr double leastPart = 3e-3;

/// Sums of lights: shadowed and unshadowed, R G B each.
constexpr std::uint32_t sumPlanes = 6;

/// What counts as the map's whole light; of those who add up lights these are all there is.
WholeLight wholeLight(const ShadowSettings& s) { return s.shadows == Shadows::Additive ? WholeLight::Lights : s.whole; }

bool widens(const ShadowSettings& s) { return s.shadows == Shadows::Ratio && s.whole != WholeLight::Lights; }

using NumbersOfMap = std::function<std::vector<float>(const MapPlaces&)>;

/// A list of so many numbers of the frame's map, found when the frame is run.
graph::Handle<Directions> listOfMap(FrameBuilder& f, const char* name, std::size_t numbers, NumbersOfMap found)
{
    auto list = f.graph.list<Directions>(name, graph::floats, numbers);
    f.graph.add({ .name = name,
        .kind = PassKind::Transfer,
        .arguments = { writes("list", list) },
        .domain = graph::Domain::Host,
        .step =
            [picture = f.description.picture(), found = std::move(found), list](graph::Run& run) {
                if (!run.rehearsal()) {
                    run.buffer<float>(list).upload(run.queue(), found(mapPlaces(*picture)));
                }
            },
        .constant = true });
    return list;
}

/// WEDGE_SHADOW_LIGHT_FLOATS of each.
std::vector<float> numbersOf(const std::vector<MapLight>& lights)
{
    std::vector<float> numbers;
    numbers.reserve(lights.size() * WEDGE_SHADOW_LIGHT_FLOATS);
    for (const MapLight& light : lights) {
        for (const glm::vec3& v : { light.towards, light.irradiance }) {
            numbers.insert(numbers.end(), { v.x, v.y, v.z });
        }
    }
    return numbers;
}

/// The lights of the frame's map.
graph::Handle<Directions> listOfLights(FrameBuilder& f)
{
    const auto count = static_cast<std::size_t>(f.settings.environment.shadows.lights);
    requirePlaces(*f.description.picture(), count);
    return listOfMap(f, "lights of the map", count * WEDGE_SHADOW_LIGHT_FLOATS,
        [count](const MapPlaces& places) { return numbersOf(mapLights(places, mapCells(places, count))); });
}

/// What lights bring to pixels.
struct Lit {
    graph::Handle<Sums> matt, lobes;
    graph::Handle<Count> taken;
    /// Without shadows; of no graph where it is that of the lights or, of matt surfaces, what harmonics say.
    graph::Handle<Radiance> wholeMatt, wholeLobes;
};

/// Sums over parts of the map.
void wholeOfMap(FrameBuilder& f, ReceiverSet& at, Lit& lit)
{
    const EnvironmentPicture& picture = *f.description.picture();
    const PlaceGrid grid = placeGrid(picture.width, picture.height);
    const std::size_t parts = treeParts(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    const graph::Handle<Directions> tree = listOfMap(f, "parts of the map", parts * WEDGE_TREE_FLOATS, lightTree);
    // What happens to lie there in rehearsals is no tree, and might be walked forever.
    const auto walked = [parts = static_cast<std::uint32_t>(parts)](const graph::Launch& launch) -> std::uint32_t {
        return launch.run.rehearsal() ? 0 : parts;
    };
    lit.wholeMatt = f.graph.plane<Radiance>("whole light of matt surfaces", graph::vectors);
    lit.wholeLobes = f.graph.plane<Radiance>("whole light of lobes", graph::vectors);
    f.zero(lit.wholeMatt, lit.wholeLobes);
    const double everywhere = f.scene != nullptr ? f.description.lights().beyond->irradiance : 0.0;
    const auto least = static_cast<float>(leastPart * everywhere / (4.0 * std::acos(-1.0)));
    at.trace("whole light", { program, "wholeLight" },
        joined({ at.frame(), graph::made("parts", walked), value("least", least), reads("tree", tree) }, at.arguments(),
            Arguments { reads("specular", f.surfaces.specular), updates("wholeMatt", lit.wholeMatt),
                updates("whole", lit.wholeLobes) }),
        [](const graph::Launch&) { return 1000.0; });
}

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
        f.graph.plane<Count>("lights taken", graph::counts), {}, {} };
    f.zero(lit.matt, lit.taken);
    if (f.specular()) {
        f.zero(lit.lobes);
    }
    // Before lights: a frame that is stopped then has as much of it as there are lights.
    if (wholeLight(s) == WholeLight::Map) {
        wholeOfMap(f, at, lit);
    } else if (f.specular() && wholeLight(s) == WholeLight::Prefiltered) {
        lit.wholeLobes = wholeLobes(f, at);
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
    return lit;
}

/// How the map's whole light and lights are put together.
Arguments combination(const FrameBuilder& f)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    const std::uint32_t ways[] = { 0u, WEDGE_SHADOWS_ADDITIVE, WEDGE_SHADOWS_SUBTRACTIVE, WEDGE_SHADOWS_RATIO };
    const glm::vec3 most(f.scene != nullptr ? f.description.lights().beyond->mostIrradiance : glm::dvec3(0.0));
    return graph::together("combination",
        { value("shadows", ways[static_cast<int>(s.shadows)]),
            value("complete", static_cast<std::uint32_t>(wholeLight(s))),
            value("clamps", s.shadows == Shadows::Subtractive && s.clamp ? 1u : 0u), value("wide", widens(s) ? 1u : 0u),
            value("mostRed", most.r), value("mostGreen", most.g), value("mostBlue", most.b) });
}

graph::Argument orAbsent(const char* name, graph::Handle<Radiance> plane)
{
    return plane.graph != 0 ? reads(name, plane) : graph::absent(name, graph::vectors);
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
                orAbsent("wholeMatt", lit.wholeMatt), orAbsent("whole", lit.wholeLobes), reads("taken", lit.taken),
                updates("lit", radiance), writes("clamped", clamped) }));
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
