#pragma once

#include "host/render/effect.h"

#include <memory>

#include <glm/glm.hpp>

namespace wedge::test {

/// A sky of one radiance in all directions: the camera sees it, paths that leave the scene do, and surfaces are lit by
/// it. [sky] radiance of scene files, --sky, and a layer of what surfaces reflect of it. An effect that nothing outside
/// of this folder knows of.
std::unique_ptr<const render::Effect> constantSky();

/// The scene under it.
void setSky(scene::Scene& scene, glm::vec3 radiance);

/// Adds the effect and its section, once.
void registerSky();

} // namespace wedge::test
