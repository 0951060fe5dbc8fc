#pragma once

#include <string>

#include "host/scene/scene.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// The largest coordinate of meshes, lights and cameras: products of two edges and a distance must stay finite in
/// single precision.
constexpr double maxCoordinate = 1e12;

/// The largest radius of a bare mesh, so that the light over it is one that checkAreaLight() accepts.
constexpr double maxBareRadius = 1e9;

/// Error when eye and look_at are equal or too near each other for single precision, up points along the view, or the
/// field of view is not in [0.001, 180) degrees. where: begins the message ("scene file a.toml:1:1").
void checkCamera(const Camera& camera, const std::string& where);

/// Error when the light has no area, when its area or its radiance times area is beyond what single precision takes, or
/// when its cut is not in (0, 8]; a warning when its sides are not at right angles.
void checkAreaLight(const AreaLight& light, const std::string& where, Warnings& warnings);

/// Error for a bare mesh that is too large for a light of its own.
void checkBareMesh(const Bounds& bounds, const std::string& where);

/// Warnings about a whole scene: nothing to see, nothing that lights it.
void checkScene(const Scene& scene, Warnings& warnings);

} // namespace wedge::scene
