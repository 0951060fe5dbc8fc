#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "data/generator/obj_writer.h"
#include "host/image/image.h"
#include "host/scene/scene.h"

namespace wedge::generator {

/// A texture: NAME_<name>.png.
struct GeneratedTexture {
    std::string name;
    image::RgbImage image;
};

/// Where a part is at a time: first turned, then moved.
struct PartKey {
    double time = 0.0;
    glm::vec4 rotate { 0.0f, 1.0f, 0.0f, 0.0f }; ///< an axis and degrees
    glm::vec3 translate { 0.0f };
};

/// The form that a part has at a time.
struct PartShape {
    double time = 0.0;
    ObjWriter mesh;
};

/// What moves: NAME_<name>.obj, or its shapes, NAME_<name>0.obj and so on.
struct MovingPart {
    std::string name;
    ObjWriter mesh; ///< empty where there are shapes
    std::vector<PartKey> keys;
    std::vector<PartShape> shapes;
};

/// One generated scene: what goes into NAME.obj, NAME.mtl, NAME.toml and the files of its textures, moving parts and
/// sky.
struct GeneratedScene {
    std::string name, comment;
    ObjWriter mesh;
    std::vector<scene::Material> materials; ///< their textures are indices into `textures`
    std::vector<GeneratedTexture> textures;
    std::vector<MovingPart> parts;
    double shutterClose = 0.0; ///< it opens at 0
    scene::Camera camera;
    scene::AreaLight light;
    std::vector<scene::AreaLight> furtherLights;
    bool hasLight = true; ///< false: meshes that emit, and neither `light` nor the others
    glm::vec3 background { 0.35f, 0.42f, 0.5f };
    image::RgbImage sky; ///< lights the scene from all around in the place of the background, where it has pixels: a
                         ///< lat-long map, NAME_sky.exr, or of one pixel the same radiance everywhere
    int bounces = 0;
    bool antialias = false;
};

/// Of the mesh and of all parts.
std::size_t triangles(const GeneratedScene& scene);

/// A matt material.
scene::Material matt(const std::string& name, const glm::vec3& diffuse);

/// A material with a grey Blinn-Phong highlight, the one model that MTL files have here.
scene::Material glossy(const std::string& name, const glm::vec3& diffuse, float specular, float exponent);

/// Adds a texture to the scene and returns a material of its colours times `tint`, with a grey highlight.
scene::Material textured(GeneratedScene& scene, const std::string& name, image::RgbImage image, const glm::vec3& tint,
    float specular = 0.0f, float exponent = 1.0f);

/// Writes the scene's files into a folder, which is made where it is missing. Throws Error when it cannot.
void writeScene(const GeneratedScene& scene, const std::filesystem::path& folder);

// The scenes of chapters 3 and 4 of Mehta's thesis, made anew at its sizes. The same bytes come out of every run.

GeneratedScene makeGrids(); ///< 200 triangles: three tilted grids of bars over a plane
GeneratedScene makeBench(); ///< 309,000: a garden bench under a leafy tree
GeneratedScene makeTentacles(); ///< 145,000: thin curled tubes over wavy ground
GeneratedScene makeSpheres(); ///< 72,120: spheres over each other and a bowl
GeneratedScene makeCornellGlossy(); ///< 16,700: a Cornell box with a glossy vase and two glossy teapots
GeneratedScene makeCornellFigure(); ///< 145,000: a Cornell box with a scaly serpent on a pedestal

// Scenes with lens, motion, textures and one bounce of indirect light, at the sizes of chapter 5 and appendix B.

GeneratedScene makeChess(); ///< 21,000: chess pieces, those in the middle in focus
GeneratedScene makeStillLife(); ///< 128,000: fruit, bottles and cloth before a wall out of focus
GeneratedScene makeToasters(); ///< 2,500: toasters on a counter
GeneratedScene makeRoom(); ///< 100,000: a living room behind a plant out of focus
GeneratedScene makeMovingCornell(); ///< a Cornell box with a gliding board, a flying vase and a waving flag
GeneratedScene makeMovingLens(); ///< the same through a lens

// Cut-outs.

GeneratedScene makeCardTree(); ///< 3,300 triangles: a tree whose leaves are pictures with holes on crossed cards

} // namespace wedge::generator
