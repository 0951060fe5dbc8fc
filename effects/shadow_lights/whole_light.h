#pragma once

#include "effects/shadow_lights/map_lights.h"
#include "host/render/receiver_set.h"

#include <functional>
#include <vector>

namespace wedge::render {

/// What counts as the map's whole light in frames of these settings; where lights are added up these are all there is.
WholeLight wholeLight(const ShadowSettings& settings);

/// A map's light as if nothing were hidden, over reflectances: planes of no graph where it is that of the lights or, of
/// matt surfaces, what harmonics say.
struct WholeLights {
    graph::Handle<Radiance> matt, lobes;
};

/// Declares the passes that find it at receivers.
WholeLights wholeLights(FrameBuilder& frame, ReceiverSet& at);
/// Units of work of these, of a frame's progress.
double wholeLightUnits(const ShadowSettings& settings);

/// The tree of the frame's map, by the names that kernels walk it with: `parts`, `least` of lobeLight() and `tree`
/// (kernels/light/light_tree.h). In rehearsals it has no parts.
Arguments partsOfMap(FrameBuilder& frame);

using NumbersOfMap = std::function<std::vector<float>(const MapPlaces&)>;

/// A list of so many numbers of the frame's map, found when the frame is run.
graph::Handle<Directions> listOfMap(FrameBuilder& frame, const char* name, std::size_t numbers, NumbersOfMap found);

} // namespace wedge::render
