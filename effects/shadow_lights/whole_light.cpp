#include "effects/shadow_lights/whole_light.h"

#include "effects/shadow_lights/light_cache.h"
#include "effects/shadow_lights/light_tree.h"
#include "kernels/shared/shadow_lights.h"

#include <cmath>
#include <cstdint>
#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* program = "light/whole_light.cl";

/// Of wholeLobes: twice the square of this number of directions of a lobe, whatever the lights.
constexpr std::uint32_t wholeRings = 16;

/// By so much of the map's mean radiance may what lobes reflect of a part of it be off, about.
constexpr double leastPart = 3e-3;

/// Sums over parts of the map.
WholeLights sumsOfParts(FrameBuilder& f, ReceiverSet& at)
{
    WholeLights whole { f.graph.plane<Radiance>("whole light of matt surfaces", graph::vectors),
        f.graph.plane<Radiance>("whole light of lobes", graph::vectors) };
    f.zero(whole.matt, whole.lobes);
    at.trace("whole light", { program, "wholeLight" },
        joined({ at.frame() }, partsOfMap(f), at.arguments(),
            Arguments { reads("specular", f.surfaces.specular), updates("wholeMatt", whole.matt),
                updates("whole", whole.lobes) }),
        [units = wholeLightUnits(f.settings.environment.shadows)](const graph::Launch&) { return units; });
    return whole;
}

/// Lobes see the map as it is. By tiles, since that takes longer than all shadow rays.
graph::Handle<Radiance> meansOfMap(FrameBuilder& f, ReceiverSet& at)
{
    auto whole = f.graph.plane<Radiance>("whole light of lobes", graph::vectors);
    f.zero(whole);
    at.trace("whole light of lobes", { program, "wholeLobes" },
        joined({ at.frame(), value("rings", wholeRings) }, f.beyond(), at.arguments(),
            Arguments { reads("specular", f.surfaces.specular), updates("whole", whole) }),
        [units = wholeLightUnits(f.settings.environment.shadows)](const graph::Launch&) { return units; });
    return whole;
}

} // namespace

WholeLight wholeLight(const ShadowSettings& settings)
{
    return settings.shadows == Shadows::Additive ? WholeLight::Lights : settings.whole;
}

WholeLights wholeLights(FrameBuilder& frame, ReceiverSet& at)
{
    const WholeLight kind = wholeLight(frame.settings.environment.shadows);
    if (kind == WholeLight::Map) {
        return sumsOfParts(frame, at);
    }
    if (kind == WholeLight::Cache) {
        return cachedLights(frame);
    }
    WholeLights whole;
    if (frame.specular() && kind == WholeLight::Prefiltered) {
        whole.lobes = meansOfMap(frame, at);
    }
    return whole;
}

double wholeLightUnits(const ShadowSettings& settings)
{
    const WholeLight kind = wholeLight(settings);
    const bool ofParts = kind == WholeLight::Map || kind == WholeLight::Cache;
    return ofParts ? 60.0 : kind == WholeLight::Prefiltered ? 2.0 * wholeRings * wholeRings : 0.0;
}

Arguments partsOfMap(FrameBuilder& f)
{
    const EnvironmentPicture& picture = *f.description.picture();
    const PlaceGrid grid = placeGrid(picture.width, picture.height);
    const std::size_t parts = treeParts(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    const graph::Handle<Directions> tree = listOfMap(f, "parts of the map", parts * WEDGE_TREE_FLOATS, lightTree);
    // What happens to lie there in rehearsals is no tree, and might be walked forever.
    const auto walked = [parts = static_cast<std::uint32_t>(parts)](const graph::Launch& launch) -> std::uint32_t {
        return launch.run.rehearsal() ? 0 : parts;
    };
    const double everywhere = f.scene != nullptr ? f.description.lights().beyond->irradiance : 0.0;
    const auto least = static_cast<float>(leastPart * everywhere / (4.0 * std::acos(-1.0)));
    return { graph::made("parts", walked), value("least", least), reads("tree", tree) };
}

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

} // namespace wedge::render
