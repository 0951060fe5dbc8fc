#pragma once

#include <vector>

#include "host/scene/scene.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Reads every [[material]] of a scene file. Throws Error for two of one name and for textures that cannot be read.
std::vector<Material> readMaterials(TableReader& root, TextureSet& textures, Warnings& warnings);

} // namespace wedge::scene
