#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

namespace wedge::scene {

/// Reads [shutter]: when it opens and closes, and its profile. Without one it is open at time 0 for no time.
void readShutter(TableReader& root, Scene& scene);

/// Reads [camera], its lens and its keys, as they are when the shutter opens and closes: read [shutter] first. Without
/// a [camera], one that frames the scene's meshes: read those and [image] first.
void readCamera(TableReader& root, Scene& scene, Warnings& warnings);

} // namespace wedge::scene
