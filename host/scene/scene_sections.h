#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

#include <vector>

namespace wedge::scene {

// Each reads one kind of table of a scene file into the scene, and throws Error for what is wrong in it.

void readImage(TableReader& root, Scene& scene);
void readIntegrator(TableReader& root, Scene& scene);
/// [sequence]: frames a unit of time.
void readSequence(TableReader& root, Scene& scene);
void readBackground(TableReader& root, Scene& scene);
/// Lights as they are when the shutter opens, which is known.
void readLights(TableReader& root, Scene& scene, Warnings& warnings);
/// Those of sections.h.
void readExtensions(TableReader& root, Scene& scene, Warnings& warnings);
/// The area lights that they bring into the scene, which has its geometry.
std::vector<AreaLight> lightsOfExtensions(const Scene& scene);

} // namespace wedge::scene
