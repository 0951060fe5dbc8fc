#pragma once

#include <string>

#include "host/scene/scene.h"

namespace wedge::scene {

/// Error when the camera has no direction, its up points along it, or its field of view is not in (0, 180) degrees.
/// where: begins the message ("scene file a.toml:1:1").
void checkCamera(const Camera& camera, const std::string& where);

/// Error when the light has no area or its cut is not in (0, 8]; a warning when its sides are not at right angles.
void checkAreaLight(const AreaLight& light, const std::string& where, std::vector<std::string>& warnings);

/// Warnings about a whole scene: nothing to see, nothing that lights it.
void checkScene(Scene& scene);

} // namespace wedge::scene
