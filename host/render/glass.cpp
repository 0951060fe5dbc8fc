#include "host/render/glass.h"

#include "kernels/shared/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace wedge::render {
namespace {

// Roundings of the largest coordinate, each half a unit in the last place.
constexpr double touchingUlps = 32.0, ulp = 5.96046448e-8;

bool isGlass(const scene::Scene& scene, std::size_t triangle)
{
    return scene.materials[scene.geometry.materialIds[triangle]].specularModel == scene::SpecularModel::Glass;
}

std::size_t triangleCount(const scene::Scene& scene) { return scene.geometry.materialIds.size(); }

glm::vec3 positionOf(const std::vector<float>& positions, std::uint32_t vertex)
{
    return { positions[3 * std::size_t { vertex }], positions[3 * std::size_t { vertex } + 1],
        positions[3 * std::size_t { vertex } + 2] };
}

void extend(scene::Bounds& box, glm::vec3 p)
{
    box.lo = glm::min(box.lo, p);
    box.hi = glm::max(box.hi, p);
}

/// Grows a box by a triangle, from when the shutter opens until it closes.
void extendByTriangle(scene::Bounds& box, const scene::Geometry& g, std::size_t triangle)
{
    for (std::size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
        extend(box, positionOf(g.positions, g.indices[corner]));
        if (!g.positionsAtClose.empty()) {
            extend(box, positionOf(g.positionsAtClose, g.indices[corner]));
        }
    }
}

bool overlap(const scene::Bounds& a, const scene::Bounds& b, float apart)
{
    return glm::all(glm::lessThanEqual(a.lo, b.hi + apart)) && glm::all(glm::lessThanEqual(b.lo, a.hi + apart));
}

struct HashOfPosition {
    std::size_t operator()(const std::array<float, 3>& p) const
    {
        std::size_t hash = 0;
        for (const float x : p) {
            hash = hash * 0x9e3779b97f4a7c15u + std::hash<float>()(x);
        }
        return hash ^ (hash >> 29);
    }
};

/// Triangles of glass by the places of their corners, numbered.
class Bodies {
public:
    explicit Bodies(const scene::Scene& scene)
        : scene_(scene)
    {
        for (std::size_t t = 0; t < triangleCount(scene); ++t) {
            if (isGlass(scene, t)) {
                add(t);
            }
        }
    }

    /// Whether more than two triangles meet at some edge, as those of bodies with a face in common do.
    bool shareEdges()
    {
        std::ranges::sort(edges_);
        for (std::size_t i = 2; i < edges_.size(); ++i) {
            if (edges_[i] == edges_[i - 2]) {
                return true;
            }
        }
        return false;
    }

    /// A box around each body.
    std::vector<scene::Bounds> boxes()
    {
        std::vector<scene::Bounds> out;
        std::unordered_map<std::uint32_t, std::size_t> numbers;
        for (const auto& [triangle, corner] : triangles_) {
            const auto [entry, isNew] = numbers.emplace(root(corner), out.size());
            if (isNew) {
                out.emplace_back();
            }
            extendByTriangle(out[entry->second], scene_.geometry, triangle);
        }
        return out;
    }

private:
    std::uint32_t root(std::uint32_t i)
    {
        while (parents_[i] != i) {
            i = parents_[i] = parents_[parents_[i]];
        }
        return i;
    }

    std::uint32_t placeOf(std::uint32_t vertex)
    {
        const glm::vec3 p = positionOf(scene_.geometry.positions, vertex) + 0.0f; // -0 is where 0 is
        const auto number = static_cast<std::uint32_t>(parents_.size());
        const auto [entry, isNew] = places_.emplace(std::array { p.x, p.y, p.z }, number);
        if (isNew) {
            parents_.push_back(number);
        }
        return entry->second;
    }

    void add(std::size_t triangle)
    {
        std::array<std::uint32_t, 3> c {};
        for (std::size_t i = 0; i < 3; ++i) {
            c[i] = placeOf(scene_.geometry.indices[3 * triangle + i]);
        }
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
            return;
        }
        triangles_.emplace_back(triangle, c[0]);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(c[i], c[(i + 1) % 3]);
            edges_.push_back(std::uint64_t { low } << 32 | high);
            parents_[root(c[i])] = root(c[0]);
        }
    }

    const scene::Scene& scene_;
    std::unordered_map<std::array<float, 3>, std::uint32_t, HashOfPosition> places_;
    std::vector<std::uint32_t> parents_; ///< of places, towards one that stands for its body
    std::vector<std::uint64_t> edges_;
    std::vector<std::pair<std::size_t, std::uint32_t>> triangles_; ///< and the place of a corner
};

/// Whether any two of the boxes overlap. Counts what it looks at in `work`, and gives up by saying so.
bool anyOverlap(std::vector<scene::Bounds>& boxes, float apart, std::size_t& work)
{
    std::ranges::sort(boxes, {}, [](const scene::Bounds& b) { return b.lo.x; });
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].lo.x <= boxes[i].hi.x + apart; ++j) {
            if (work-- == 0 || overlap(boxes[i], boxes[j], apart)) {
                return true;
            }
        }
    }
    return false;
}

struct Face {
    double t;
    std::uint32_t medium;
    bool leaves;
};

/// Where the ray meets a triangle (Moeller and Trumbore 1997).
std::optional<Face> meet(const scene::Scene& scene, std::size_t triangle, glm::dvec3 origin, glm::dvec3 direction)
{
    const scene::Geometry& g = scene.geometry;
    const glm::dvec3 a = positionOf(g.positions, g.indices[3 * triangle]);
    const glm::dvec3 ab = glm::dvec3(positionOf(g.positions, g.indices[3 * triangle + 1])) - a;
    const glm::dvec3 ac = glm::dvec3(positionOf(g.positions, g.indices[3 * triangle + 2])) - a;
    const glm::dvec3 p = glm::cross(direction, ac), s = origin - a, q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(ac, q) / determinant;
    if (determinant == 0.0 || u < 0.0 || v < 0.0 || u + v > 1.0 || !(t > 0.0)) {
        return std::nullopt;
    }
    return Face { t, mediumOf(scene, g.materialIds[triangle]), glm::dot(glm::cross(ab, ac), direction) > 0.0 };
}

} // namespace

bool hasTouchingGlass(const scene::Scene& scene)
{
    constexpr std::size_t mostWork = std::size_t { 1 } << 26;
    if (std::ranges::none_of(
            scene.materials, [](const scene::Material& m) { return m.specularModel == scene::SpecularModel::Glass; })) {
        return false;
    }
    Bodies bodies(scene);
    std::vector<scene::Bounds> boxes = bodies.boxes();
    const float apart = 4.0f * touchingDistance(scene);
    std::size_t work = mostWork;
    if (bodies.shareEdges() || anyOverlap(boxes, apart, work)) {
        return true;
    }
    scene::Bounds all;
    for (const scene::Bounds& box : boxes) {
        extend(all, box.lo);
        extend(all, box.hi);
    }
    for (std::size_t t = 0; t < triangleCount(scene) && !boxes.empty(); ++t) {
        scene::Bounds box;
        extendByTriangle(box, scene.geometry, t);
        if (isGlass(scene, t) || !overlap(box, all, apart)) {
            continue;
        }
        for (const scene::Bounds& body : boxes) {
            if (work-- == 0 || overlap(box, body, apart)) {
                return true;
            }
        }
    }
    return false;
}

float touchingDistance(const scene::Scene& scene)
{
    scene::Bounds all;
    for (std::size_t t = 0; t < triangleCount(scene); ++t) {
        if (isGlass(scene, t)) {
            extendByTriangle(all, scene.geometry, t);
        }
    }
    if (all.empty()) {
        return 0.0f;
    }
    const glm::vec3 most = glm::max(glm::abs(all.lo), glm::abs(all.hi));
    return static_cast<float>(touchingUlps * ulp * std::max({ most.x, most.y, most.z }));
}

std::uint32_t mediumOf(const scene::Scene& scene, std::uint32_t material)
{
    const auto priority = static_cast<std::uint32_t>(scene.materials[material].priority + 128);
    return priority << WEDGE_MEDIUM_PRIORITY_SHIFT | (material & WEDGE_MEDIUM_MATERIAL);
}

std::vector<std::uint32_t> nestings(const scene::Scene& scene)
{
    std::vector<scene::Bounds> boxes(scene.materials.size());
    for (std::size_t t = 0; t < triangleCount(scene); ++t) {
        if (isGlass(scene, t)) {
            extendByTriangle(boxes[scene.geometry.materialIds[t]], scene.geometry, t);
        }
    }
    const auto sizeOf = [&](std::uint32_t i) {
        return boxes[i].empty() ? -1.0f : glm::length(boxes[i].hi - boxes[i].lo);
    };
    std::vector<std::uint32_t> order(boxes.size()), out(boxes.size(), 0);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::ranges::greater(), sizeOf);
    for (std::size_t i = 0; i < order.size(); ++i) {
        out[order[i]] = boxes[order[i]].empty() ? 0 : static_cast<std::uint32_t>(i);
    }
    return out;
}

std::vector<std::uint32_t> mediaAt(const scene::Scene& scene, glm::dvec3 point)
{
    // Along no axis and no diagonal, so that it hardly meets an edge.
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.5773, 0.7071, -0.4083));
    std::vector<Face> faces;
    for (std::size_t t = 0; t < triangleCount(scene); ++t) {
        if (!isGlass(scene, t)) {
            continue;
        }
        if (const std::optional<Face> face = meet(scene, t, point, direction)) {
            faces.push_back(*face);
        }
    }
    std::ranges::stable_sort(faces, {}, &Face::t);
    std::vector<std::uint32_t> entered, inside;
    for (const Face& face : faces) {
        const auto own = std::ranges::find(entered, face.medium);
        if (!face.leaves) {
            entered.push_back(face.medium);
        } else if (own != entered.end()) {
            entered.erase(own);
        } else if (inside.size() < WEDGE_MOST_MEDIA) {
            inside.push_back(face.medium);
        }
    }
    std::ranges::reverse(inside);
    return inside;
}

} // namespace wedge::render
