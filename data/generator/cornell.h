#pragma once

#include "data/generator/scene_writer.h"

namespace wedge::generator {

/// A Cornell box to put things into: floor y = 0, x in [-1.12, 1.12], y up to 1.68, z in [-1, 1], open towards the
/// camera at +z; a red left and a green right wall, the rest white; a uniform square light below the ceiling. Its
/// materials and its 10 triangles come first.
GeneratedScene cornellBox(const std::string& name, const std::string& comment);

} // namespace wedge::generator
