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

/// A material with a grey Blinn-Phong highlight, the one model that MTL files have here.
scene::Material glossy(const std::string& name, const glm::vec3& diffuse, float specular, float exponent);

/// Writes the three files into a folder, which is made where it is missing. Throws Error when it cannot.
void writeScene(const GeneratedScene& scene, const std::filesystem::path& folder);

// The scenes of chapters 3 and 4 of Mehta's thesis, made anew at its sizes. The same bytes come out of every run.

GeneratedScene makeGrids(); ///< 200 triangles: three tilted grids of bars over a plane
GeneratedScene makeBench(); ///< 309,000: a garden bench under a leafy tree
GeneratedScene makeTentacles(); ///< 145,000: thin curled tubes over wavy ground
GeneratedScene makeSpheres(); ///< 72,120: spheres over each other and a bowl
GeneratedScene makeCornellGlossy(); ///< 16,700: a Cornell box with a glossy vase and two glossy teapots
GeneratedScene makeCornellFigure(); ///< 145,000: a Cornell box with a scaly serpent on a pedestal

} // namespace wedge::generator
