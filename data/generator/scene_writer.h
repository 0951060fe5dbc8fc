#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "data/generator/obj_writer.h"
#include "host/scene/scene.h"

namespace wedge::generator {

/// One generated scene: what goes into NAME.obj, NAME.mtl and NAME.toml.
struct GeneratedScene {
    std::string name, comment;
    ObjWriter mesh;
    std::vector<scene::Material> materials;
    scene::Camera camera;
    scene::AreaLight light;
    glm::vec3 background { 0.35f, 0.42f, 0.5f };
};

/// A matt material.
scene::Material matt(const std::string& name, const glm::vec3& diffuse);

/// Writes the three files into a folder, which is made where it is missing. Throws Error when it cannot.
void writeScene(const GeneratedScene& scene, const std::filesystem::path& folder);

// The scenes of chapter 3 of Mehta's thesis, made anew at its sizes. The same bytes come out of every run.

GeneratedScene makeGrids(); ///< 200 triangles: three tilted grids of bars over a plane
GeneratedScene makeBench(); ///< 309,000: a garden bench under a leafy tree
GeneratedScene makeTentacles(); ///< 145,000: thin curled tubes over wavy ground
GeneratedScene makeSpheres(); ///< 72,120: spheres over each other and a bowl

} // namespace wedge::generator
