#include "host/scene/load_scene.h"

#include "host/error.h"
#include "host/scene/camera_framing.h"
#include "host/scene/geometry_limit.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_reader.h"
#include "host/scene/paths.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "host/scene/textures.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxSceneFile = std::uintmax_t { 64 } << 20;

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

std::unique_ptr<SceneFile> readScene(
    const std::string& path, const LoadOptions& options, Scene& scene, Warnings& warnings)
{
    std::unique_ptr<SceneFile> file;
    scene.path = path;
    const std::string extension = lowerExtension(path);
    if (extension == ".toml")
        file = std::make_unique<SceneFile>(readFile(path, "scene file", maxSceneFile), path, options, scene, warnings);
    else if (extension == ".obj")
        loadBareMesh(path, options, scene, warnings);
    else
        throw Error("scene has an unknown format", path, "name a scene file (.toml) or a mesh (.obj)");
    checkScene(scene, warnings);
    scene.warnings = warnings.lines();
    return file;
}

Scene parseScene(const std::string& text, const std::filesystem::path& path)
{
    Scene scene;
    Warnings warnings;
    scene.path = path.string();
    const SceneFile file(text, path, LoadOptions(), scene, warnings);
    checkScene(scene, warnings);
    scene.warnings = warnings.lines();
    return scene;
}

Scene loadScene(const std::string& path, const LoadOptions& options)
{
    Scene scene;
    Warnings warnings;
    readScene(path, options, scene, warnings);
    return scene;
}

} // namespace wedge::scene
