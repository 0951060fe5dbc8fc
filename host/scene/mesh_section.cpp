#include "host/scene/mesh_section.h"

#include <map>
#include <set>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/mesh_keys.h"
#include "host/scene/mesh_shapes.h"
#include "host/scene/obj_reader.h"
#include "host/scene/paths.h"
#include "host/scene/smooth_normals.h"
#include "host/scene/transform.h"

namespace wedge::scene {
namespace {

/// The mesh files of a scene, each read once with each material library, and where their materials are in the scene.
class MeshFiles {
public:
    struct Entry {
        Mesh mesh;
        std::uint32_t materialBase = 0;
    };

    /// An empty `library` stands for those that the mesh file names.
    const Entry& get(
        const std::filesystem::path& path, const std::filesystem::path& library, Scene& scene, TextureSet& textures)
    {
        const auto [entry, isNew] = entries_.try_emplace({ path.lexically_normal(), library.lexically_normal() });
        if (isNew) {
            entry->second.mesh = readObj(path, textures, scene.warnings, library);
            entry->second.materialBase = static_cast<std::uint32_t>(scene.materials.size());
            const std::vector<Material>& palette = entry->second.mesh.palette;
            scene.materials.insert(scene.materials.end(), palette.begin(), palette.end());
        }
        return entry->second;
    }

private:
    std::map<std::pair<std::filesystem::path, std::filesystem::path>, Entry> entries_;
};

/// `smooth` is true, false or the greatest angle in degrees. Without it a file's own normals are used as they are.
void applySmoothing(TableReader& table, Mesh& mesh)
{
    if (!table.has("smooth"))
        return;
    if (!table.isBoolean("smooth")) {
        smoothNormals(mesh, static_cast<float>(*table.number("smooth", 0.0, 180.0)));
    } else if (*table.boolean("smooth")) {
        smoothNormals(mesh, 180.0f);
    } else {
        flattenNormals(mesh);
    }
}

/// The index of the scene file's material that `material` names, or `fallback`.
int chosenMaterial(TableReader& table, const std::vector<Material>& materials, std::size_t named, int fallback)
{
    const auto name = table.text("material");
    if (!name)
        return fallback;
    std::set<std::string> names;
    for (std::size_t i = 0; i < named; ++i) {
        if (materials[i].name == *name)
            return static_cast<int>(i);
        names.insert(materials[i].name);
    }
    const std::string near = nearest(*name, names);
    table.fail("material", "is unknown", fmt::format("'{}'", *name),
        near.empty() ? "add a [[material]] of that name" : fmt::format("did you mean '{}'?", near));
}

/// What the triangles of a [[mesh]] become.
struct MeshSource {
    const IndexedMesh& mesh;
    bool hasNameless; ///< some of the file's faces have no material
    std::size_t named; ///< the scene file's own materials come first, this many
};

void addOne(TableReader& table, const MeshSource& source, const Placement& placement, int material,
    const std::string& prefix, Scene& scene)
{
    const std::string where = table.where("file");
    if (material < 0 && source.hasNameless)
        scene.warnings.push_back(where + ": some faces of the mesh have no material, grey is used");
    addInstance(scene.geometry, source.mesh, placement, material, prefix, where);
}

void addInstances(TableReader& table, const MeshSource& source, Scene& scene)
{
    const glm::dmat4 transform = readTransform(table, "transform");
    const MeshKeys keys(table);
    const Placement placed { keys.at(scene.shutterOpen) * transform, keys.at(scene.shutterClose) * transform };
    const int material = chosenMaterial(table, scene.materials, source.named, -1);
    const std::string name = table.text("name").value_or("");
    std::vector<TableReader> instances = table.tables("instances");
    for (TableReader& instance : table.tables("instance"))
        instances.push_back(instance);
    const std::string base = name.empty() ? "" : name + "/";
    if (instances.empty() && !table.has("instances"))
        addOne(table, source, placed, material, base, scene);
    int number = 0;
    for (TableReader& instance : instances) {
        const glm::dmat4 moved = readTransform(instance, "transform");
        const int own = chosenMaterial(instance, scene.materials, source.named, material);
        const std::string label = instance.text("name").value_or(fmt::format("{}", number++));
        instance.finish();
        addOne(table, source, { moved * placed.atOpen, moved * placed.atClose }, own, base + label + "/", scene);
    }
}

/// The file's mesh as it is when the shutter opens, and where it deforms also when it closes.
IndexedMesh readVertices(TableReader& table, const MeshFiles::Entry& entry, const Scene& scene)
{
    Mesh mesh = entry.mesh;
    applySmoothing(table, mesh);
    const MeshShapes shapes(table, mesh, [&](Mesh& shape) { applySmoothing(table, shape); });
    if (shapes.empty())
        return indexMesh(mesh, entry.materialBase);
    const Mesh atClose = shapes.at(scene.shutterClose, mesh);
    return indexMesh(shapes.at(scene.shutterOpen, mesh), entry.materialBase, &atClose);
}

/// Motion that goes nowhere is none.
void forgetRest(Geometry& geometry)
{
    if (geometry.positionsAtClose != geometry.positions || geometry.normalsAtClose != geometry.normals)
        return;
    geometry.positionsAtClose = {};
    geometry.normalsAtClose = {};
}

} // namespace

void readMeshes(TableReader& root, Scene& scene, TextureSet& textures)
{
    MeshFiles files;
    const std::size_t named = scene.materials.size();
    for (TableReader& table : root.tables("mesh")) {
        const std::filesystem::path path = table.require("file", table.path("file"));
        if (lowerExtension(path) != ".obj")
            table.fail("file", "has an unknown format", path.string(), "name a Wavefront .obj file");
        const std::filesystem::path library = table.path("mtl").value_or(std::filesystem::path());
        const MeshFiles::Entry& entry = files.get(path, library, scene, textures);
        const IndexedMesh indexed = readVertices(table, entry, scene);
        addInstances(table, { indexed, entry.mesh.hasNameless, named }, scene);
        table.finish();
    }
    forgetRest(scene.geometry);
}

} // namespace wedge::scene
