#include "host/scene/smooth_normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

namespace wedge::scene {
namespace {

struct PositionHash {
    std::size_t operator()(const glm::dvec3& p) const
    {
        std::size_t hash = 0;
        for (int i = 0; i < 3; ++i)
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[i] + 0.0)) * 0x9e3779b97f4a7c15ull; // + 0: -0 is 0
        return hash ^ hash >> 29;
    }
};

/// What a corner brings to its position: its triangle's unit normal (double: tiny triangles) and its angle.
struct CornerPlane {
    glm::dvec3 normal { 0.0 };
    double angle = 0.0;
};

std::vector<CornerPlane> cornerPlanes(const Mesh& mesh)
{
    std::vector<CornerPlane> planes(mesh.corners.size());
    for (std::size_t t = 0; t < mesh.corners.size(); t += 3) {
        glm::dvec3 p[3];
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = mesh.positions[static_cast<std::size_t>(mesh.corners[t + i].position)];
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(normal);
        if (!(length > 0.0))
            continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 a = glm::normalize(p[(i + 1) % 3] - p[i]);
            const glm::dvec3 b = glm::normalize(p[(i + 2) % 3] - p[i]);
            planes[t + i] = { normal / length, std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) };
        }
    }
    return planes;
}

/// The corners at each distinct position.
std::vector<std::vector<std::size_t>> cornersByPosition(const Mesh& mesh)
{
    std::unordered_map<glm::dvec3, std::size_t, PositionHash> slots;
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
        const glm::dvec3& position = mesh.positions[static_cast<std::size_t>(mesh.corners[c].position)];
        const auto [slot, isNew] = slots.emplace(position, groups.size());
        if (isNew)
            groups.emplace_back();
        groups[slot->second].push_back(c);
    }
    return groups;
}

/// More corners than this at one position are not compared one by one.
constexpr std::size_t manyCorners = 512;

/// The mean of planes, or `own` where opposite ones cancel.
glm::vec3 meanNormal(const glm::dvec3& sum, const glm::dvec3& own)
{
    return glm::vec3(glm::normalize(glm::length(sum) < 1e-6 ? own : sum));
}

void smoothGroup(
    Mesh& mesh, const std::vector<std::size_t>& group, const std::vector<CornerPlane>& planes, double limit)
{
    const std::size_t firstNew = mesh.normals.size();
    for (const std::size_t c : group) {
        if (mesh.corners[c].normal >= 0 || planes[c].angle <= 0.0)
            continue;
        glm::dvec3 sum(0.0);
        for (const std::size_t other : group) {
            if (glm::dot(planes[c].normal, planes[other].normal) >= limit)
                sum += planes[other].angle * planes[other].normal;
        }
        const glm::vec3 normal = meanNormal(sum, planes[c].normal);
        const auto begin = mesh.normals.begin() + static_cast<std::ptrdiff_t>(firstNew);
        const auto known = std::find(begin, mesh.normals.end(), normal);
        mesh.corners[c].normal = static_cast<int>(known - mesh.normals.begin());
        if (known == mesh.normals.end())
            mesh.normals.push_back(normal);
    }
}

/// Planes whose normals agree to a sixteenth stand for one another, so that there are at most some thousands to
/// compare.
void smoothLargeGroup(
    Mesh& mesh, const std::vector<std::size_t>& group, const std::vector<CornerPlane>& planes, double limit)
{
    struct Cell {
        glm::dvec3 sum { 0.0 }, normal { 0.0 };
        int index = -1; ///< of its smooth normal
    };
    std::map<std::array<int, 3>, Cell> cells;
    const auto cellOf = [&](std::size_t c) -> Cell& {
        const glm::dvec3 rounded = glm::round(16.0 * planes[c].normal);
        return cells[{ static_cast<int>(rounded.x), static_cast<int>(rounded.y), static_cast<int>(rounded.z) }];
    };
    for (const std::size_t c : group) {
        if (planes[c].angle > 0.0)
            cellOf(c).sum += planes[c].angle * planes[c].normal;
    }
    for (auto& [key, cell] : cells)
        cell.normal = glm::normalize(cell.sum);
    for (auto& [key, cell] : cells) {
        glm::dvec3 sum(0.0);
        for (const auto& [otherKey, other] : cells) {
            if (glm::dot(cell.normal, other.normal) >= limit)
                sum += other.sum;
        }
        cell.index = static_cast<int>(mesh.normals.size());
        mesh.normals.push_back(meanNormal(sum, cell.normal));
    }
    for (const std::size_t c : group) {
        if (mesh.corners[c].normal < 0 && planes[c].angle > 0.0)
            mesh.corners[c].normal = cellOf(c).index;
    }
}

} // namespace

void smoothNormals(Mesh& mesh, float maxAngle)
{
    const std::vector<CornerPlane> planes = cornerPlanes(mesh);
    // A little slack lets an angle given exactly, such as 90, include the edges that have it.
    const double limit = std::cos(double { maxAngle } * std::numbers::pi / 180.0) - 1e-6;
    for (const std::vector<std::size_t>& group : cornersByPosition(mesh))
        (group.size() > manyCorners ? smoothLargeGroup : smoothGroup)(mesh, group, planes, limit);
}

void flattenNormals(Mesh& mesh)
{
    mesh.normals.clear();
    for (MeshCorner& corner : mesh.corners)
        corner.normal = -1;
}

} // namespace wedge::scene
