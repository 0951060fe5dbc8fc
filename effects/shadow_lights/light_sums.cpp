#include "effects/shadow_lights/light_sums.h"

#include "effects/shadow_lights/coarse_receivers.h"
#include "effects/shadow_lights/map_lights.h"
#include "effects/shadow_lights/whole_light.h"
#include "host/graph/lists.h"
#include "host/render/sample_slices.h"
#include "kernels/shared/shadow_lights.h"

#include <cmath>
#include <vector>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;

namespace {

constexpr const char* program = "light/shadow_lights.cl";

// Of a pixel between two looks at the cancel flag, where all get rays. Ranking lights costs less each, and is not cut.
constexpr std::uint32_t sliceLights = 96;
static_assert(mostChosenLights == WEDGE_MOST_CHOSEN);

/// Sums of lights: shadowed and unshadowed, R G B each.
constexpr std::uint32_t sumPlanes = 6;

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

std::uint32_t lobePlanes(const ShadowSettings& s) { return widensLobes(s) ? 2 * sumPlanes : sumPlanes; }

/// Of no light yet.
LightSums noLight(FrameBuilder& f, graph::Scale scale)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    LightSums sums { f.graph.plane<Sums>("sums of matt light", graph::floatPlanes(sumPlanes), scale),
        f.graph.plane<Sums>("sums of lobes' light", graph::floatPlanes(lobePlanes(s)), scale),
        f.graph.plane<Count>("lights taken", graph::counts, scale) };
    f.zero(sums.matt, sums.taken);
    if (f.specular()) {
        f.zero(sums.lobes);
    }
    return sums;
}

graph::Argument addsToLobes(const FrameBuilder& f, LightSums& sums)
{
    return f.specular() ? updates("lobeSums", sums.lobes)
                        : graph::absent("lobeSums", graph::floatPlanes(lobePlanes(f.settings.environment.shadows)));
}

/// The passes that trace rays at all receivers that have not taken all lights. units: of a frame's progress
void traceLights(
    FrameBuilder& f, ReceiverSet& at, const graph::Handle<Directions>& lights, double units, LightSums& sums)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    const auto count = static_cast<std::uint32_t>(s.lights);
    // Lights are 4 pi / N apart, and a lobe of the exponent m is about 2 pi / m wide.
    const float spacing = static_cast<float>(count) / (4.0f * std::acos(-1.0f));
    const graph::Argument widest = value("widest", widensLobes(s) ? spacing : 0.0f);
    const auto changed = [&] {
        return graph::together(
            "sums", { updates("taken", sums.taken), updates("mattSums", sums.matt), addsToLobes(f, sums) });
    };
    if (s.chosen > 0) {
        const Surfaces& seen = at.surfaces();
        at.trace("shadow lights", { program, "chosenLights" },
            joined({ at.frame(), widest, graph::unlessEmpty("count", count),
                       value("most", static_cast<std::uint32_t>(s.chosen)) },
                f.hierarchy(), at.arguments(),
                graph::together("reflectances", { reads("diffuse", seen.diffuse), reads("specular", seen.specular) }),
                Arguments { reads("lights", lights) }, changed(), Arguments { at.tallyRays() }),
            [units](const graph::Launch&) { return units; });
        return;
    }
    const SampleSlices slices(0, count, sliceLights, count);
    f.graph.loop("slices of lights", slices.counter(), [&] {
        at.trace("shadow lights", { program, "shadowLights" },
            joined({ at.frame(), widest }, f.hierarchy(), at.arguments(),
                Arguments { reads("lights", lights), slices.last() }, changed(), Arguments { at.tallyRays() }),
            slices.workUnits(units));
    });
}

/// What few pixels say of their neighbours.
void resample(FrameBuilder& f, const CoarseReceivers& few, const LightSums& from, LightSums& to)
{
    const ShadowSettings& s = f.settings.environment.shadows;
    constexpr graph::Reach around = { 1, 1 };
    const Surfaces& seen = f.surfaces;
    const Surfaces& there = few.surfaces();
    f.pixels("shadows of few pixels", PassKind::Filter, { "light/shadow_resampling.cl", "resampleShadows" },
        joined({ f.rectangle(f.analysisParams()), f.graph.grid("coarse", few.scale()),
                   value("lights", static_cast<std::uint32_t>(s.lights)), value("lobePlanes", lobePlanes(s)) },
            graph::together("surfaces",
                { reads("position", seen.position), reads("normal", seen.normal), reads("objectId", seen.objectId),
                    reads("pixelSize", seen.pixelSize), reads("gloss", seen.gloss) }),
            graph::together("receivers",
                { reads("coarsePosition", there.position, around), reads("coarseNormal", there.normal, around),
                    reads("coarseGloss", there.gloss, around), reads("coarseTaken", from.taken, around),
                    reads("coarseMattSums", from.matt, around),
                    f.specular() ? reads("coarseLobeSums", from.lobes, around)
                                 : graph::absent("coarseLobeSums", graph::floatPlanes(lobePlanes(s))),
                    graph::readsAsIs("coarseRays", few.rays()) }),
            graph::together("sums", { updates("taken", to.taken), updates("mattSums", to.matt), addsToLobes(f, to) }),
            Arguments { graph::tallies("rays", f.totals.rays) }));
}

} // namespace

bool widensLobes(const ShadowSettings& settings)
{
    return settings.shadows == Shadows::Ratio && settings.whole != WholeLight::Lights;
}

graph::Argument readsLobes(const char* name, const FrameBuilder& frame, const LightSums& sums)
{
    return frame.specular() ? reads(name, sums.lobes)
                            : graph::absent(name, graph::floatPlanes(lobePlanes(frame.settings.environment.shadows)));
}

LightSums lightSums(FrameBuilder& frame, ReceiverSet& at)
{
    const ShadowSettings& s = frame.settings.environment.shadows;
    const graph::Handle<Directions> lights = listOfLights(frame);
    LightSums sums = noLight(frame, graph::Scale::Full);
    if (s.blockSide > 1) {
        CoarseReceivers few(frame, static_cast<graph::Scale>(s.blockSide));
        LightSums ofFew = noLight(frame, few.scale());
        traceLights(frame, few, lights, s.lights, ofFew);
        few.countRays();
        resample(frame, few, ofFew, sums);
        // What is left are pixels that none of the few is like.
    }
    traceLights(frame, at, lights, s.lights, sums);
    return sums;
}

double lightUnits(const ShadowSettings& settings) { return settings.lights * (settings.blockSide > 1 ? 2.0 : 1.0); }

} // namespace wedge::render
