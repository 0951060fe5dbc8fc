#pragma once

#include <vector>

#include "host/scene/shadow_style.h"
#include "host/scene/toml_reader.h"

namespace wedge::scene {

/// Reads the styles, [[light.style]], of a light whose shadows are hard; none where they change nothing, whatever their
/// weights. Throws Error for what is wrong in them.
std::vector<ShadowStyle> readStyles(TableReader& light);

} // namespace wedge::scene
