#include "host/scene/geometry_limit.h"

#include <algorithm>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "host/error.h"

namespace wedge::scene {
namespace {

/// Of scene::Geometry, as if all of it moved.
constexpr std::size_t vertexBytes = 14 * sizeof(float), triangleBytes = 5 * sizeof(std::uint32_t);

/// What the process may have: the machine's memory, or less where a limit is set.
double memoryThere()
{
    double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    for (const auto resource : { RLIMIT_AS, RLIMIT_DATA }) {
        rlimit limit {};
        if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
            bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    }
    return bytes;
}

double bytesOf(const Mesh& mesh)
{
    const std::size_t attributes = std::max({ mesh.positions.size(), mesh.normals.size(), mesh.texcoords.size() });
    std::size_t bytes = std::min(attributes, mesh.corners.size()) * vertexBytes + mesh.triangles() * triangleBytes;
    for (const std::string& name : mesh.objectNames)
        bytes += sizeof(std::string) + name.size();
    return static_cast<double>(bytes);
}

} // namespace

void GeometryLimit::add(const Mesh& mesh, std::size_t copies, std::size_t nameBytes, const std::string& where)
{
    const std::string remedy = "use fewer copies, or simpler meshes";
    if (mesh.triangles() > 0 && copies > (mostTriangles - triangles_) / mesh.triangles())
        throw Error(where + ": the scene has too many triangles",
            fmt::format("{} and {} times {}", triangles_, copies, mesh.triangles()),
            fmt::format("{}; {} is the most", remedy, mostTriangles));
    triangles_ += copies * mesh.triangles();
    bytes_ += static_cast<double>(copies) * bytesOf(mesh)
        + static_cast<double>(nameBytes) * static_cast<double>(mesh.objectNames.size());
    // The other half is for the hierarchy and the picture.
    const double most = 0.5 * memoryThere();
    if (bytes_ > most)
        throw Error(where + ": the scene's meshes take more than half of the memory",
            fmt::format("{:.0f} of {:.0f} MiB", bytes_ / 1048576.0, 2.0 * most / 1048576.0), remedy);
}

} // namespace wedge::scene
