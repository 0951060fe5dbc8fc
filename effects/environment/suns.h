#pragma once

#include "host/render/environment_table.h"
#include "host/scene/scene.h"

#include <vector>

namespace wedge::render {

/// Takes small bright sources out of a picture, a sun for one: fills suns and, where there are any, `shown`; what they
/// are brighter than their surroundings leaves radiance. Both together have the picture's energy. Which are taken:
/// docs/environment.md.
void separateSuns(EnvironmentPicture& picture);

/// A picture's suns as quads, which subtend at the middle of the box what the suns do: hundreds of the box's diameters
/// away, so that their directions differ little within it. The camera sees them in the picture. None for an empty box.
std::vector<scene::AreaLight> sunLights(const EnvironmentPicture& picture, const scene::Bounds& bounds);

} // namespace wedge::render
