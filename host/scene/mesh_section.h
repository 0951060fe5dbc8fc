#pragma once

#include "host/scene/scene.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Reads every [[mesh]] of a scene file and adds its instances and their materials to the scene, behind the materials
/// that are already there, which a mesh may choose by name.
void readMeshes(TableReader& root, Scene& scene, TextureSet& textures, Warnings& warnings);

} // namespace wedge::scene
