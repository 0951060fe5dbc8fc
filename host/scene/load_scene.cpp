#include "host/scene/load_scene.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "host/error.h"
#include "host/scene/camera_framing.h"
#include "host/scene/extent.h"
#include "host/scene/geometry_limit.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_reader.h"
#include "host/scene/paths.h"
#include "host/scene/rounding.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "host/scene/textures.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxSceneFile = std::uintmax_t { 64 } << 20;

/// Of the vertices in use.
Extent extentOf(const Mesh& mesh)
{
    Extent extent;
    for (const MeshCorner& corner : mesh.corners)
        extent.add(mesh.positions[static_cast<std::size_t>(corner.position)]);
    return extent;
}

/// A mesh that is too far from the origin for single precision is brought there, with all that furnish() gives it.
Placement placementOf(const Mesh& mesh, const std::string& where, Warnings& warnings)
{
    Placement placement;
    const Extent extent = extentOf(mesh);
    if (mesh.isSingle || extent.distance() < extent.size())
        return placement;
    // A round number that leaves less than half of the size.
    const double step = std::pow(10.0, std::floor(std::log10(extent.size())));
    const glm::dvec3 by = -step * glm::round((0.5 * extent.lo + 0.5 * extent.hi) / step) + 0.0; // not -0
    placement.atOpen = placement.atClose = glm::translate(glm::dmat4(1.0), by);
    warnings.add("places far from the origin",
        fmt::format("{}: the mesh is too far from the origin for single precision, and is moved by [{:.12g}, {:.12g}, "
                    "{:.12g}] m; write a scene file with a transform to place it otherwise",
            where, by.x, by.y, by.z));
    return placement;
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
    const Placement placement = placementOf(mesh, where, warnings);
    const IndexedMesh indexed = indexMesh(mesh, 0);
    addInstance(scene.geometry, indexed, placement, -1, "", where);
    warnOfRounding(indexed, placement.atOpen, where, warnings);
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
