#include "host/scene/mesh_files.h"

#include "host/scene/obj_reader.h"
#include "host/scene/paths.h"

namespace wedge::scene {

const MeshFiles::Entry& MeshFiles::get(const std::filesystem::path& path, const std::filesystem::path& library)
{
    const auto [entry, isNew] = entries_.try_emplace({ path.lexically_normal(), library.lexically_normal() });
    if (isNew) {
        entry->second.mesh = readObj(path, textures_, warnings_, library);
        entry->second.materialBase = static_cast<std::uint32_t>(scene_.materials.size());
        const std::vector<Material>& palette = entry->second.mesh.palette;
        scene_.materials.insert(scene_.materials.end(), palette.begin(), palette.end());
    }
    return entry->second;
}

const Mesh& MeshFiles::shape(const std::filesystem::path& path)
{
    const auto [entry, isNew] = shapes_.try_emplace(path.lexically_normal());
    if (isNew)
        entry->second = readObjShape(path);
    return entry->second;
}

std::filesystem::path readMeshPath(TableReader& table)
{
    const std::filesystem::path path = table.require("file", table.path("file"));
    if (lowerExtension(path) != ".obj")
        table.fail("file", "has an unknown format", path.string(), "name a Wavefront .obj file");
    return path;
}

} // namespace wedge::scene
