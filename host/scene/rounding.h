#pragma once

#include <string>

#include <glm/glm.hpp>

#include "host/scene/mesh_builder.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// What single precision makes of coordinates of this size: how far apart it tells points.
double spacingAt(double coordinate);

/// Warns of a copy of a mesh that is so far from the origin that single precision shows in its shape, with the size
/// that is lost: an edge of a hundredth of the triangles is off by a twentieth of its length, or one of triangles with
/// a thousandth of the area. where: begins the message ("scene file a.toml:3:8").
void warnOfRounding(const IndexedMesh& mesh, const glm::dmat4& placement, const std::string& where, Warnings& warnings);

/// Warns of a place, say of a camera, that single precision moves by more than `size` m, which is what is small there.
/// what: "camera's eye".
void warnOfRounding(
    const glm::dvec3& place, double size, const std::string& where, const std::string& what, Warnings& warnings);

} // namespace wedge::scene
