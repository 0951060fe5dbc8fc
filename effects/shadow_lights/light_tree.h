#pragma once

#include "effects/shadow_lights/map_lights.h"

#include <cstddef>
#include <vector>

namespace wedge::render {

/// A map's light from the whole sphere to single places: each part is a directional light with a deviation, and below
/// it are its two halves. As kernels walk it (kernels/light/light_tree.h): every part is followed by all that is below
/// it, WEDGE_TREE_FLOATS numbers each.
/// Returns treeParts(places) * WEDGE_TREE_FLOATS numbers.
std::vector<float> lightTree(const MapPlaces& places);

/// How many parts the tree of so many places has.
constexpr std::size_t treeParts(std::size_t places) { return 2 * places - 1; }

} // namespace wedge::render
