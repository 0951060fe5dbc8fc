#include "host/scene/mesh_section.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "host/scene/geometry_limit.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/mesh_files.h"
#include "host/scene/mesh_keys.h"
#include "host/scene/mesh_shapes.h"
#include "host/scene/nearest.h"
#include "host/scene/rounding.h"
#include "host/scene/smooth_normals.h"
#include "host/scene/transform.h"

namespace wedge::scene {
namespace {

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

/// The scene file's own materials by name.
class NamedMaterials {
public:
    explicit NamedMaterials(const std::vector<Material>& materials)
    {
        for (const Material& material : materials)
            indices_.emplace(material.name, static_cast<int>(indices_.size()));
    }

    /// The index of the material that the key `material` names, or `fallback`.
    int chosen(TableReader& table, int fallback) const
    {
        const auto name = table.text("material");
        if (!name)
            return fallback;
        if (const auto known = indices_.find(*name); known != indices_.end())
            return known->second;
        std::set<std::string> names;
        for (const auto& [other, index] : indices_)
            names.insert(other);
        const std::string near = nearest(*name, names);
        table.fail("material", "is unknown", fmt::format("'{}'", *name),
            near.empty() ? "add a [[material]] of that name" : fmt::format("did you mean '{}'?", near));
    }

private:
    std::map<std::string, int> indices_;
};

/// What the triangles of a [[mesh]] become.
struct MeshSource {
    const IndexedMesh& mesh;
    bool hasNameless; ///< some of the file's faces have no material
    const NamedMaterials& materials;
};

/// How a copy stands when the shutter opens and closes.
struct PosedMesh {
    Transform atOpen, atClose;
};

void addOne(TableReader& table, const MeshSource& source, const PosedMesh& posed, int material,
    const std::string& prefix, Scene& scene, Warnings& warnings)
{
    const std::string where = table.where("file");
    const bool isSingle = source.mesh.isSingle;
    const Placement placement { posed.atOpen.chosen(isSingle), posed.atClose.chosen(isSingle) };
    if (material < 0 && source.hasNameless)
        warnings.add("meshes without materials", where + ": some faces of the mesh have no material, grey is used");
    addInstance(scene.geometry, source.mesh, placement, material, prefix, where);
    warnOfRounding(source.mesh, placement.atOpen, where, warnings);
}

void addInstances(TableReader& table, const MeshSource& source, Scene& scene, Warnings& warnings)
{
    const Transform transform = readTransform(table, "transform");
    const MeshKeys keys(table);
    const PosedMesh placed { keys.at(scene.shutterOpen) * transform, keys.at(scene.shutterClose) * transform };
    const int material = source.materials.chosen(table, -1);
    const std::string name = table.text("name").value_or("");
    std::vector<TableReader> instances = table.tables("instances");
    for (TableReader& instance : table.tables("instance"))
        instances.push_back(instance);
    const std::string base = name.empty() ? "" : name + "/";
    if (instances.empty() && !table.has("instances"))
        addOne(table, source, placed, material, base, scene, warnings);
    int number = 0;
    for (TableReader& instance : instances) {
        const Transform moved = readTransform(instance, "transform");
        const int own = source.materials.chosen(instance, material);
        const std::string label = instance.text("name").value_or(fmt::format("{}", number++));
        instance.finish();
        addOne(
            table, source, { moved * placed.atOpen, moved * placed.atClose }, own, base + label + "/", scene, warnings);
    }
}

/// The file's mesh as it is when the shutter opens, and where it deforms also when it closes.
IndexedMesh readVertices(TableReader& table, const MeshFiles::Entry& entry, MeshFiles& files, const Scene& scene)
{
    Mesh mesh = entry.mesh;
    applySmoothing(table, mesh);
    const MeshShapes shapes(table, mesh, files, [&](Mesh& shape) { applySmoothing(table, shape); });
    if (shapes.empty())
        return indexMesh(mesh, entry.materialBase);
    const Mesh atClose = shapes.at(scene.shutterClose, mesh);
    return indexMesh(shapes.at(scene.shutterOpen, mesh), entry.materialBase, &atClose);
}

/// Of what the copies of a [[mesh]] put before the names of its objects.
std::size_t nameBytes(TableReader& table, std::size_t copies)
{
    std::size_t bytes = copies * table.text("name").value_or("").size();
    for (const char* key : { "instances", "instance" }) {
        for (TableReader& instance : table.tables(key))
            bytes += instance.text("name").value_or("").size();
    }
    return bytes;
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

SceneMeshes::SceneMeshes(TableReader& root, Scene& scene, TextureSet& textures, Warnings& warnings)
    : files_(scene, textures, warnings)
    , named_(scene.materials)
{
    readFiles(root, warnings);
}

/// Counts also what they will take.
void SceneMeshes::readFiles(TableReader& root, Warnings& warnings)
{
    GeometryLimit limit;
    for (TableReader& table : root.tables("mesh")) {
        const std::filesystem::path path = readMeshPath(table);
        const MeshFiles::Entry& entry = files_.get(path, table.path("mtl").value_or(std::filesystem::path()));
        const std::string where = table.where("file");
        if (entry.mesh.flat == entry.mesh.triangles() && !table.has("shape")) // which may unfold it
            warnings.add("meshes without area", where + ": mesh has no triangle with an area, nothing of it is seen");
        const std::size_t instances = table.count("instances") + table.count("instance");
        const std::size_t copies = std::max<std::size_t>(instances + table.count("shape"), 1);
        limit.add(entry.mesh, copies, nameBytes(table, copies), where);
        meshes_.push_back({ table, entry });
    }
}

void SceneMeshes::place(Scene& scene, Warnings& warnings)
{
    const NamedMaterials named(named_);
    for (auto& [table, entry] : meshes_) {
        const IndexedMesh indexed = readVertices(table, entry, files_, scene);
        addInstances(table, { indexed, entry.mesh.hasNameless, named }, scene, warnings);
        table.finish();
    }
    forgetRest(scene.geometry);
}

bool SceneMeshes::mayMove()
{
    return std::ranges::any_of(
        meshes_, [](MeshTable& mesh) { return mesh.table.has("key") || mesh.table.has("shape"); });
}

} // namespace wedge::scene
