#include "host/render/flush_lights.h"

#include "host/render/cutouts.h"
#include "host/render/emitters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace wedge::render {
namespace {

using Corners = std::array<glm::dvec3, 3>;

// Roundings of a light's coordinates within which a surface lies in its plane: a millionth of a room's size and more.
// Of the surface's, which may be far larger, what tests of rays may be off by.
constexpr double lightRoundings = 64.0, surfaceRoundings = 8.0;
constexpr double rounding = std::numeric_limits<float>::epsilon();
constexpr std::size_t mostWork = std::size_t { 1 } << 26, mostCovers = std::size_t { 1 } << 22;

double farthest(std::span<const glm::dvec3> corners)
{
    double far = 0;
    for (const glm::dvec3& c : corners) {
        far = std::max(far, std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
    }
    return far;
}

/// Metres within which a surface lies in a light's plane.
double flushWithin(std::span<const glm::dvec3> light, std::span<const glm::dvec3> surface)
{
    return rounding * (lightRoundings * farthest(light) + surfaceRoundings * farthest(surface));
}

Corners cornersOf(const scene::Geometry& g, std::size_t triangle)
{
    return { cornerOf(g, triangle, 0), cornerOf(g, triangle, 1), cornerOf(g, triangle, 2) };
}

bool moves(const scene::Geometry& g, std::size_t triangle)
{
    return movesAt(g, g.indices[3 * triangle]) || movesAt(g, g.indices[3 * triangle + 1])
        || movesAt(g, g.indices[3 * triangle + 2]);
}

/// A polygon's plane. scaled: along its normal, as long as it is large.
struct Plane {
    glm::dvec3 scaled, point;

    glm::dvec3 normal() const { return glm::normalize(scaled); }
    /// Metres to the farthest of the corners.
    double farthestOf(std::span<const glm::dvec3> corners) const
    {
        double far = 0;
        for (const glm::dvec3& c : corners) {
            far = std::max(far, std::abs(glm::dot(normal(), c - point)));
        }
        return far;
    }
};

Plane planeOf(const Corners& c) { return { glm::cross(c[1] - c[0], c[2] - c[0]), c[0] }; }

/// Metres between a light and a surface in one plane, or nothing: they are not in one. By the plane of the larger one,
/// which is the better known.
std::optional<double> apart(
    std::span<const glm::dvec3> light, Plane ofLight, std::span<const glm::dvec3> surface, Plane ofSurface)
{
    const double size = glm::length(ofLight.scaled), surfaceSize = glm::length(ofSurface.scaled);
    if (!(size > 0.0) || !(surfaceSize > 0.0)) {
        return std::nullopt;
    }
    const double far = surfaceSize > size ? ofSurface.farthestOf(light) : ofLight.farthestOf(surface);
    return far <= flushWithin(light, surface) ? std::optional(far) : std::nullopt;
}

/// The polygon's edges, seen from where it is counterclockwise: how far inside of them points are, metres, less a
/// margin.
class Inside {
public:
    Inside(std::span<const glm::dvec3> polygon, glm::dvec3 normal, double margin)
        : polygon_(polygon)
        , normal_(normal)
        , margin_(margin)
    {
    }
    double of(std::size_t edge, glm::dvec3 point) const
    {
        const glm::dvec3 from = polygon_[edge], along = polygon_[(edge + 1) % polygon_.size()] - from;
        return glm::dot(glm::cross(normal_, glm::normalize(along)), point - from) - margin_;
    }
    /// Whether another polygon of the plane lies outside of one of the edges.
    bool excludes(std::span<const glm::dvec3> other) const
    {
        for (std::size_t edge = 0; edge < polygon_.size(); ++edge) {
            if (std::ranges::all_of(other, [&](const glm::dvec3& p) { return !(of(edge, p) > 0.0); })) {
                return true;
            }
        }
        return false;
    }

private:
    std::span<const glm::dvec3> polygon_;
    glm::dvec3 normal_;
    double margin_;
};

/// What of `surface` the light covers, if anything: a little less than the light, so that no ray passes beside it.
std::optional<Cover> coverOf(const Corners& surface, const Corners& light)
{
    const Plane ofLight = planeOf(light), ofSurface = planeOf(surface);
    const std::optional<double> distance = apart(light, ofLight, surface, ofSurface);
    if (!distance) {
        return std::nullopt;
    }
    const Inside inside(light, ofLight.normal(), 2.0 * *distance + 4.0 * rounding * farthest(surface));
    if (inside.excludes(surface) || Inside(surface, ofSurface.normal(), 0.0).excludes(light)) {
        return std::nullopt;
    }
    Cover out;
    for (std::size_t edge = 0; edge < 3; ++edge) {
        const double at = inside.of(edge, surface[0]);
        out[edge] = { static_cast<float>(inside.of(edge, surface[1]) - at),
            static_cast<float>(inside.of(edge, surface[2]) - at), static_cast<float>(at) };
    }
    return out;
}

struct Box {
    glm::vec3 low { std::numeric_limits<float>::max() }, high { std::numeric_limits<float>::lowest() };

    void add(glm::vec3 p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool overlaps(const Box& other) const
    {
        return glm::all(glm::lessThanEqual(low, other.high)) && glm::all(glm::lessThanEqual(other.low, high));
    }
};

/// Boxes of triangles in a tree of halves, for what overlaps them.
class BoxTree {
public:
    /// grownBy: by which part of their farthest coordinate boxes are larger.
    BoxTree(const scene::Geometry& g, std::vector<std::size_t> triangles, double grownBy)
        : triangles_(std::move(triangles))
    {
        boxes_.reserve(triangles_.size());
        for (const std::size_t triangle : triangles_) {
            boxes_.push_back(boxOf(g, triangle, grownBy));
        }
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), std::size_t { 0 });
        if (!order_.empty()) {
            build(0, order_.size());
        }
    }

    static Box boxOf(const scene::Geometry& g, std::size_t triangle, double grownBy)
    {
        const Corners corners = cornersOf(g, triangle);
        const glm::vec3 more(static_cast<float>(grownBy * farthest(corners)));
        Box box;
        for (const glm::dvec3& c : corners) {
            box.add(glm::vec3(c) - more);
            box.add(glm::vec3(c) + more);
        }
        return box;
    }

    /// Calls found(triangle) for each whose box overlaps.
    template <class Found>
    void overlapping(const Box& box, const Found& found) const
    {
        std::array<std::uint32_t, 64> open {};
        std::size_t count = nodes_.empty() ? 0 : 1;
        while (count > 0) {
            const Node& node = nodes_[open[--count]];
            if (!node.box.overlaps(box)) {
                continue;
            }
            if (node.second != 0) {
                open[count++] = node.second;
                open[count++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
                continue;
            }
            for (std::size_t i = node.first; i < node.end; ++i) {
                if (boxes_[order_[i]].overlaps(box)) {
                    found(triangles_[order_[i]]);
                }
            }
        }
    }

private:
    struct Node {
        Box box;
        std::size_t first, end;
        std::uint32_t second; ///< of its children, whose first is next to it; 0: a leaf
    };
    static constexpr std::size_t leafSize = 4;

    void build(std::size_t first, std::size_t end)
    {
        const std::size_t number = nodes_.size();
        Box box, centres;
        for (std::size_t i = first; i < end; ++i) {
            const Box& b = boxes_[order_[i]];
            box.add(b.low);
            box.add(b.high);
            centres.add(0.5f * (b.low + b.high));
        }
        nodes_.push_back({ box, first, end, 0 });
        if (end - first <= leafSize) {
            return;
        }
        const glm::vec3 extent = centres.high - centres.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::size_t middle = first + (end - first) / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle), at(end), [&](std::size_t a, std::size_t b) {
            return boxes_[a].low[axis] + boxes_[a].high[axis] < boxes_[b].low[axis] + boxes_[b].high[axis];
        });
        build(first, middle);
        nodes_[number].second = static_cast<std::uint32_t>(nodes_.size());
        build(middle, end);
    }

    std::vector<std::size_t> triangles_, order_;
    std::vector<Box> boxes_;
    std::vector<Node> nodes_;
};

} // namespace

std::map<std::size_t, std::vector<Cover>> coversOf(const scene::Scene& scene)
{
    const scene::Geometry& g = scene.geometry;
    std::vector<std::size_t> lights, surfaces;
    for (std::size_t t = 0; t < g.materialIds.size(); ++t) {
        if (!mayEmit(scene, t)) {
            surfaces.push_back(t);
        } else if (!isCutout(scene.materials[g.materialIds[t]]) && !moves(g, t)) {
            lights.push_back(t);
        }
    }
    std::map<std::size_t, std::vector<Cover>> out;
    if (lights.empty() || surfaces.empty()) {
        return out;
    }
    const bool lightsAreFewer = lights.size() <= surfaces.size();
    // At least what flushWithin() allows, as boxes are in single precision.
    constexpr double grownBy = 2.0 * rounding * lightRoundings;
    const BoxTree tree(g, lightsAreFewer ? lights : surfaces, grownBy);
    std::size_t work = 0, covers = 0;
    for (const std::size_t outer : lightsAreFewer ? surfaces : lights) {
        tree.overlapping(BoxTree::boxOf(g, outer, grownBy), [&](std::size_t inner) {
            const std::size_t surface = lightsAreFewer ? outer : inner, light = lightsAreFewer ? inner : outer;
            if (++work > mostWork || covers >= mostCovers || moves(g, surface)) {
                return;
            }
            if (const std::optional<Cover> cover = coverOf(cornersOf(g, surface), cornersOf(g, light))) {
                out[surface].push_back(*cover);
                ++covers;
            }
        });
    }
    return out;
}

float liftOf(const scene::AreaLight& light, const scene::Geometry& g)
{
    const glm::dvec3 centre(light.centre), u(light.halfU), v(light.halfV);
    const std::array<glm::dvec3, 4> quad { centre - u - v, centre + u - v, centre + u + v, centre - u + v };
    const Plane ofQuad { 4.0 * glm::cross(u, v), centre };
    const glm::dvec3 normal = ofQuad.normal();
    const double far = farthest(quad);
    // One corner tells of most triangles that they are elsewhere.
    float largest = 0;
    for (const float x : g.positions) {
        largest = std::max(largest, std::abs(x));
    }
    const glm::vec3 along(normal);
    const auto offset = static_cast<float>(glm::dot(normal, centre));
    const auto most = static_cast<float>(4.0 * rounding * (lightRoundings * far + 3.0 * surfaceRoundings * largest));
    double lift = 0;
    for (std::size_t t = 0; t < g.materialIds.size(); ++t) {
        const float* first = &g.positions[3 * std::size_t { g.indices[3 * t] }];
        if (std::abs(along.x * first[0] + along.y * first[1] + along.z * first[2] - offset) > most) {
            continue;
        }
        const Corners surface = cornersOf(g, t);
        const Plane ofSurface = planeOf(surface);
        const std::optional<double> distance = apart(quad, ofQuad, surface, ofSurface);
        if (distance && !Inside(quad, normal, 0.0).excludes(surface)
            && !Inside(surface, ofSurface.normal(), 0.0).excludes(quad)) {
            lift = std::max(lift, 2.0 * *distance + 2.0 * surfaceRoundings * rounding * (far + farthest(surface)));
        }
    }
    return static_cast<float>(lift);
}

} // namespace wedge::render
