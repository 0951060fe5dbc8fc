#pragma once

#include <vector>

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"

namespace wedge::scene {

enum class ShadowKind { Hard, Soft };

/// Reads the styles, [[light.style]], of a light with such shadows, as they are at that time of their keys; none where
/// they change nothing at any time, whatever their weights. Throws Error for what is wrong in them.
std::vector<ShadowStyle> readStyles(TableReader& light, ShadowKind kind, double time);

/// Throws Error for a style of some light in the file that names objects which the scene has not.
void checkObjectNames(TableReader& root, const Geometry& geometry);

} // namespace wedge::scene
