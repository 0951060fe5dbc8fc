#include "host/scene/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/validate.h"

namespace wedge::scene {
namespace {

/// What a vertex stands for: corners that agree in all of it share one.
using CornerKey = std::array<int, 4>;

struct CornerHash {
    std::size_t operator()(const CornerKey& key) const
    {
        std::size_t hash = 0;
        for (const int part : key)
            hash = (hash ^ static_cast<std::uint32_t>(part)) * 0x9e3779b97f4a7c15ull;
        return hash ^ hash >> 31;
    }
};

glm::vec3 unitOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 1e-30 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0.0f);
}

/// Vertices of a mesh at one time.
struct VertexView {
    const std::vector<glm::dvec3>& positions;
    const std::vector<glm::vec3>& normals;
};

void addVertices(const VertexView& from, const glm::dmat4& transform, const std::string& where,
    std::vector<float>& positions, std::vector<float>& normals)
{
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(transform)));
    for (std::size_t i = 0; i < from.positions.size(); ++i) {
        const glm::dvec3 p(transform * glm::dvec4(from.positions[i], 1.0));
        const glm::vec3 n = unitOrZero(normalMatrix * glm::dvec3(from.normals[i]));
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(p[axis]) <= maxCoordinate))
                throw Error(
                    where + ": a coordinate is beyond 1e12", fmt::format("{:g}", p[axis]), "scale the mesh down");
            positions.push_back(static_cast<float>(p[axis]));
            normals.push_back(n[axis]);
        }
    }
}

void addAllVertices(Geometry& geometry, const IndexedMesh& mesh, const Placement& placement, const std::string& where)
{
    const bool deforms = !mesh.positionsAtClose.empty();
    const bool moves = deforms || placement.atOpen != placement.atClose;
    if (moves && geometry.positionsAtClose.empty()) { // the first that moves: what came before stays where it is
        geometry.positionsAtClose = geometry.positions;
        geometry.normalsAtClose = geometry.normals;
    }
    const VertexView open { mesh.positions, mesh.normals };
    if (moves || !geometry.positionsAtClose.empty()) {
        const VertexView close { mesh.positionsAtClose, mesh.normalsAtClose };
        addVertices(
            deforms ? close : open, placement.atClose, where, geometry.positionsAtClose, geometry.normalsAtClose);
    }
    addVertices(open, placement.atOpen, where, geometry.positions, geometry.normals);
    for (const glm::vec2& t : mesh.texcoords)
        geometry.texcoords.insert(geometry.texcoords.end(), { t.x, t.y });
}

double leastHeightOf(const IndexedMesh& mesh)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const glm::dvec3 &a = mesh.positions[mesh.indices[t]], &b = mesh.positions[mesh.indices[t + 1]],
                         &c = mesh.positions[mesh.indices[t + 2]];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double longest = std::max({ glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c) });
        const double area = glm::dot(normal, normal);
        if (area > 0.0)
            least = std::min(least, area / longest);
    }
    return std::sqrt(least);
}

glm::vec3 normalOf(const Mesh& mesh, int normal)
{
    return normal < 0 ? glm::vec3(0.0f) : mesh.normals[static_cast<std::size_t>(normal)];
}

} // namespace

IndexedMesh indexMesh(const Mesh& mesh, std::uint32_t materialBase, const Mesh* atClose)
{
    IndexedMesh out;
    std::unordered_map<CornerKey, std::uint32_t, CornerHash> vertices;
    vertices.reserve(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
        const MeshCorner& c = mesh.corners[i];
        const int normalAtClose = atClose == nullptr ? -1 : atClose->corners[i].normal;
        const CornerKey key { c.position, c.texcoord, c.normal, normalAtClose };
        const auto [vertex, isNew] = vertices.emplace(key, static_cast<std::uint32_t>(out.positions.size()));
        out.indices.push_back(vertex->second);
        if (!isNew)
            continue;
        out.positions.push_back(mesh.positions[static_cast<std::size_t>(c.position)]);
        out.normals.push_back(normalOf(mesh, c.normal));
        out.texcoords.push_back(
            c.texcoord < 0 ? glm::vec2(0.0f) : mesh.texcoords[static_cast<std::size_t>(c.texcoord)]);
        if (atClose != nullptr) {
            out.positionsAtClose.push_back(atClose->positions[static_cast<std::size_t>(c.position)]);
            out.normalsAtClose.push_back(normalOf(*atClose, normalAtClose));
        }
    }
    for (const std::uint32_t material : mesh.materials)
        out.materials.push_back(materialBase + material);
    out.objects = mesh.objects;
    out.objectNames = mesh.objectNames;
    out.isSingle = mesh.isSingle;
    out.leastHeight = leastHeightOf(out);
    return out;
}

void addInstance(Geometry& geometry, const IndexedMesh& mesh, const Placement& placement, int material,
    const std::string& prefix, const std::string& where)
{
    const std::size_t firstVertex = geometry.positions.size() / 3;
    const std::size_t firstObject = geometry.objectNames.size() + 1;
    if (firstVertex + mesh.positions.size() > std::numeric_limits<std::uint32_t>::max())
        throw Error(where + ": too many vertices", std::to_string(firstVertex + mesh.positions.size()),
            "use fewer instances; 4294967295 vertices is the most");
    addAllVertices(geometry, mesh, placement, where);
    const bool mirrored = glm::determinant(glm::dmat3(placement.atOpen)) < 0.0;
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
