#pragma once

#include <string>

#include <glm/glm.hpp>

#include "host/scene/mesh_builder.h"
#include "host/scene/scene.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// What single precision makes of coordinates of this size: how far apart it tells points.
double spacingAt(double coordinate);

/// Warns of a copy of a mesh that is so far from the origin that single precision shows in its shape, with the size
/// that is lost: a hundredth of the triangles has an edge that is off by a twentieth of the longest one, or triangles
/// with a thousandth of the area one that is off by a twentieth of their height. where: begins the message ("scene file
/// a.toml:3:8").
void warnOfRounding(const IndexedMesh& mesh, const glm::dmat4& placement, const std::string& where, Warnings& warnings);

/// Warns of point lights of a scene that is so far from the origin for its size that single precision shows.
void warnOfRounding(const Scene& scene, Warnings& warnings);

/// Warns of a place, say of a camera, that single precision moves by more than `size` m, which is what is small there.
/// what: "camera's eye".
void warnOfRounding(
    const glm::dvec3& place, double size, const std::string& where, const std::string& what, Warnings& warnings);

} // namespace wedge::scene
