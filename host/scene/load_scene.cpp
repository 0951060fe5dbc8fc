#include "host/error.h"
#include "host/scene/camera_framing.h"
#include "host/scene/camera_section.h"
#include "host/scene/material_section.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/mesh_section.h"
#include "host/scene/paths.h"
#include "host/scene/scene.h"
#include "host/scene/scene_sections.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxSceneFile = std::uintmax_t { 64 } << 20;

void loadSceneFile(const std::filesystem::path& path, const LoadOptions& options, Scene& scene)
{
    const toml::table document = parseToml(readFile(path, "scene file", maxSceneFile), path);
    TextureSet textures(options.maxTexturePixels);
    TableReader root(document, path, "the scene");
    readImage(root, scene);
    readIntegrator(root, scene);
    readBackground(root, scene);
    readLights(root, scene);
    readShutter(root, scene);
    // Materials before the meshes that choose among them, meshes before the camera that may have to frame them.
    scene.materials = readMaterials(root, textures, scene.warnings);
    for (const char* later : { "mesh", "camera" })
        root.has(later);
    root.finish(); // a wrong key is told before large meshes are read
    readMeshes(root, scene, textures);
    readCamera(root, scene);
    scene.textures = textures.take();
}

void loadBareMesh(const std::filesystem::path& path, const LoadOptions& options, Scene& scene)
{
    TextureSet textures(options.maxTexturePixels);
    Mesh mesh = readObj(path, textures, scene.warnings);
    scene.materials = mesh.palette;
    addInstance(scene.geometry, indexMesh(mesh, 0), Placement(), -1, "", "mesh file " + path.string());
    if (mesh.hasNameless)
        scene.warnings.push_back("mesh file " + path.string() + ": some faces have no material, grey is used");
    scene.textures = textures.take();
    checkBareMesh(sceneBounds(scene), "mesh file " + path.string());
    furnish(scene);
}

} // namespace

Scene loadScene(const std::string& path, const LoadOptions& options)
{
    Scene scene;
    scene.path = path;
    const std::string extension = lowerExtension(path);
    if (extension == ".toml")
        loadSceneFile(path, options, scene);
    else if (extension == ".obj")
        loadBareMesh(path, options, scene);
    else
        throw Error("scene has an unknown format", path, "name a scene file (.toml) or a mesh (.obj)");
    checkScene(scene);
    return scene;
}

} // namespace wedge::scene
