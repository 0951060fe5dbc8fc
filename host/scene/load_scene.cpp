#include "host/scene/load_scene.h"

#include "host/error.h"
#include "host/scene/camera_framing.h"
#include "host/scene/camera_section.h"
#include "host/scene/geometry_limit.h"
#include "host/scene/material_section.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/mesh_section.h"
#include "host/scene/obj_reader.h"
#include "host/scene/paths.h"
#include "host/scene/scene.h"
#include "host/scene/scene_sections.h"
#include "host/scene/textures.h"
#include "host/scene/toml_reader.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxSceneFile = std::uintmax_t { 64 } << 20;

void readSceneText(const std::string& text, const std::filesystem::path& path, const LoadOptions& options, Scene& scene,
    Warnings& warnings)
{
    const toml::table document = parseToml(text, path);
    TextureSet textures(options.maxTexturePixels);
    TableReader root(document, path, "the scene");
    readImage(root, scene);
    readIntegrator(root, scene);
    readBackground(root, scene);
    readLights(root, scene, warnings);
    readShutter(root, scene);
    readExtensions(root, scene);
    // Materials before the meshes that choose among them, meshes before the camera that may have to frame them.
    scene.materials = readMaterials(root, textures, warnings);
    for (const char* later : { "mesh", "camera" })
        root.has(later);
    root.finish(); // a wrong key is told before large meshes are read
    readMeshes(root, scene, textures, warnings);
    readCamera(root, scene);
    scene.textures = textures.take();
}

void loadBareMesh(const std::filesystem::path& path, const LoadOptions& options, Scene& scene, Warnings& warnings)
{
    TextureSet textures(options.maxTexturePixels);
    const std::string where = "mesh file " + path.string();
    const Mesh mesh = readObj(path, textures, warnings);
    if (mesh.flat == mesh.triangles())
        throw Error(where + " has nothing to see", "no face with an area", "repair the mesh");
    GeometryLimit().add(mesh, 1, 0, where);
    scene.materials = mesh.palette;
    addInstance(scene.geometry, indexMesh(mesh, 0), Placement(), -1, "", where);
    if (mesh.hasNameless)
        warnings.add("meshes without materials", where + ": some faces have no material, grey is used");
    scene.textures = textures.take();
    checkBareMesh(sceneBounds(scene), where);
    furnish(scene);
}

} // namespace

Scene parseScene(const std::string& text, const std::filesystem::path& path)
{
    Scene scene;
    Warnings warnings;
    scene.path = path.string();
    readSceneText(text, path, LoadOptions(), scene, warnings);
    checkScene(scene, warnings);
    scene.warnings = warnings.lines();
    return scene;
}

Scene loadScene(const std::string& path, const LoadOptions& options)
{
    Scene scene;
    Warnings warnings;
    scene.path = path;
    const std::string extension = lowerExtension(path);
    if (extension == ".toml")
        readSceneText(readFile(path, "scene file", maxSceneFile), path, options, scene, warnings);
    else if (extension == ".obj")
        loadBareMesh(path, options, scene, warnings);
    else
        throw Error("scene has an unknown format", path, "name a scene file (.toml) or a mesh (.obj)");
    checkScene(scene, warnings);
    scene.warnings = warnings.lines();
    return scene;
}

} // namespace wedge::scene
