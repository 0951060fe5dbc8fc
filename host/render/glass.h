#pragma once

#include "host/scene/scene.h"

#include <cstdint>
#include <vector>

namespace wedge::render {

/// Whether bodies of glass may touch, overlap or lie in one another, or touch other surfaces: paths then follow what
/// they are inside of (kernels/paths/interfaces.h). By boxes around the bodies, so that it may be so where it is not;
/// a body is what vertices connect.
bool hasTouchingGlass(const scene::Scene& scene);

/// Metres: faces of glass as near as this lie in one place. A few roundings of their coordinates.
float touchingDistance(const scene::Scene& scene);

/// MaterialData::medium of the material of that number.
std::uint32_t mediumOf(const scene::Scene& scene, std::uint32_t material);

/// MaterialData::nesting of each material: by the boxes around all that has it, the largest first. What is no glass has
/// 0.
std::vector<std::uint32_t> nestings(const scene::Scene& scene);

/// The bodies of glass that a point is inside of, by MaterialData::medium, from the outermost and at most
/// WEDGE_MOST_MEDIA, when the shutter opens: those that a ray from there leaves without having entered them.
std::vector<std::uint32_t> mediaAt(const scene::Scene& scene, glm::dvec3 point);

} // namespace wedge::render
