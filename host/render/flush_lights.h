// Lights that lie in a surface, as a lamp in its ceiling does: by rounding either would be met first. Everywhere it is
// the light.
#pragma once

#include "host/scene/scene.h"

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace wedge::render {

/// A part of a triangle that an emitting triangle lies before: the barycentrics (u, v), the weights of the second and
/// the third corner, at which c + a u + b v > 0 for all three { a, b, c }, metres.
using Cover = std::array<std::array<float, 3>, 3>;

/// The parts of triangles, by their numbers, that emitting triangles lie in; rays pass through them. Neither moves, the
/// covered one does not emit, and the other hides all that is behind it. Of more than some millions of pairs those that
/// are left over are not there. Takes time in proportion to the scene's triangles where lights are few or far apart.
std::map<std::size_t, std::vector<Cover>> coversOf(const scene::Scene& scene);

/// AreaLight::lift of quads, metres: more than one may be apart from the surface that it lies in, which does not move;
/// 0 if it lies in none. Takes time in proportion to the lights times the triangles.
std::vector<float> liftsOf(std::span<const scene::AreaLight> lights, const scene::Geometry& geometry);

} // namespace wedge::render
