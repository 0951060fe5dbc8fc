#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Light from beyond the scene, of a picture of the whole sphere or the same everywhere: [environment] of scene files,
/// docs/environment.md.
std::unique_ptr<const Effect> environment();

/// Puts a picture around a scene, in the place of any that it has; null: none.
void setEnvironment(scene::Scene& scene, std::shared_ptr<const EnvironmentPicture> picture);

} // namespace wedge::render
