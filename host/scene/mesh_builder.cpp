#include "host/scene/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

struct CornerHash {
    std::size_t operator()(const MeshCorner& c) const
    {
        std::size_t hash = 0;
        for (const int part : { c.position, c.texcoord, c.normal })
            hash = (hash ^ static_cast<std::uint32_t>(part)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 31;
    }
};

struct SameCorner {
    bool operator()(const MeshCorner& a, const MeshCorner& b) const
    {
        return a.position == b.position && a.texcoord == b.texcoord && a.normal == b.normal;
    }
};

glm::vec3 unitOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 1e-30 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0.0f);
}

void addVertices(Geometry& geometry, const IndexedMesh& mesh, const glm::dmat4& transform, const std::string& where)
{
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(transform)));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(transform * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0));
        const glm::vec3 n = unitOrZero(normalMatrix * glm::dvec3(mesh.normals[i]));
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(p[axis]) <= maxCoordinate))
                throw Error(
                    where + ": a coordinate is beyond 1e12", fmt::format("{:g}", p[axis]), "scale the mesh down");
            geometry.positions.push_back(static_cast<float>(p[axis]));
            geometry.normals.push_back(n[axis]);
        }
        geometry.texcoords.push_back(mesh.texcoords[i].x);
        geometry.texcoords.push_back(mesh.texcoords[i].y);
    }
}

} // namespace

IndexedMesh indexMesh(const Mesh& mesh, std::uint32_t materialBase)
{
    IndexedMesh out;
    std::unordered_map<MeshCorner, std::uint32_t, CornerHash, SameCorner> vertices;
    vertices.reserve(mesh.positions.size());
    for (const MeshCorner& c : mesh.corners) {
        const auto [vertex, isNew] = vertices.emplace(c, static_cast<std::uint32_t>(out.positions.size()));
        out.indices.push_back(vertex->second);
        if (!isNew)
            continue;
        out.positions.push_back(mesh.positions[static_cast<std::size_t>(c.position)]);
        out.normals.push_back(c.normal < 0 ? glm::vec3(0.0f) : mesh.normals[static_cast<std::size_t>(c.normal)]);
        out.texcoords.push_back(
            c.texcoord < 0 ? glm::vec2(0.0f) : mesh.texcoords[static_cast<std::size_t>(c.texcoord)]);
    }
    for (const std::uint32_t material : mesh.materials)
        out.materials.push_back(materialBase + material);
    out.objects = mesh.objects;
    out.objectNames = mesh.objectNames;
    return out;
}

void addInstance(Geometry& geometry, const IndexedMesh& mesh, const glm::dmat4& transform, int material,
    const std::string& prefix, const std::string& where)
{
    const std::size_t firstVertex = geometry.positions.size() / 3;
    const std::size_t firstObject = geometry.objectNames.size() + 1;
    if (firstVertex + mesh.positions.size() > std::numeric_limits<std::uint32_t>::max())
        throw Error(where + ": too many vertices", std::to_string(firstVertex + mesh.positions.size()),
            "use fewer instances; 4294967295 vertices is the most");
    addVertices(geometry, mesh, transform, where);
    const bool mirrored = glm::determinant(glm::dmat3(transform)) < 0.0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        std::uint32_t corners[] = { mesh.indices[t], mesh.indices[t + 1], mesh.indices[t + 2] };
        if (mirrored)
            std::swap(corners[1], corners[2]);
        for (const std::uint32_t corner : corners)
            geometry.indices.push_back(static_cast<std::uint32_t>(firstVertex + corner));
        geometry.materialIds.push_back(material < 0 ? mesh.materials[t / 3] : static_cast<std::uint32_t>(material));
        geometry.objectIds.push_back(static_cast<std::uint32_t>(firstObject + mesh.objects[t / 3]));
    }
    for (const std::string& name : mesh.objectNames)
        geometry.objectNames.push_back(prefix + name);
}

} // namespace wedge::scene
