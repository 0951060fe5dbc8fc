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

// Roundings, of where a light is along its normal and of its and the surface's size, within which a surface lies in its
// plane, a millionth of a room's size and more; and what tests of rays are off by. Of surfaces that are far larger,
// only so much counts.
constexpr double planeRoundings = 64.0, rayRoundings = 8.0, mostTimesLarger = 16.0;
constexpr double rounding = std::numeric_limits<float>::epsilon();
// Pairs that are looked at, and covers.
constexpr std::size_t mostWork = std::size_t { 1 } << 24, mostCovers = std::size_t { 1 } << 22;

Corners cornersOf(const scene::Geometry& g, std::size_t triangle)
{
    return { cornerOf(g, triangle, 0), cornerOf(g, triangle, 1), cornerOf(g, triangle, 2) };
}

/// The diagonal of the box around a polygon.
double sizeOf(std::span<const glm::dvec3> corners)
{
    glm::dvec3 low = corners[0], high = corners[0];
    for (const glm::dvec3& c : corners) {
        low = glm::min(low, c);
        high = glm::max(high, c);
    }
    return glm::length(high - low);
}

/// What of a polygon's coordinates is rounded along a normal, metres.
double farthestAlong(std::span<const glm::dvec3> corners, glm::dvec3 normal)
{
    double far = 0;
    for (const glm::dvec3& c : corners) {
        far = std::max(far, glm::dot(glm::abs(c), glm::abs(normal)));
    }
    return far;
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

/// A light and a surface in one plane, metres.
struct Flush {
    double apart; ///< by how much they are not
    double rounding; ///< of tests of rays against either
};

/// Nothing: they are not in one plane. By the plane of the larger one, which is the better known.
std::optional<Flush> flush(std::span<const glm::dvec3> light, const Plane& ofLight, std::span<const glm::dvec3> surface,
    const Plane& ofSurface)
{
    const double area = glm::length(ofLight.scaled), surfaceArea = glm::length(ofSurface.scaled);
    if (!(area > 0.0) || !(surfaceArea > 0.0)) {
        return std::nullopt;
    }
    const bool surfaceIsLarger = surfaceArea > area;
    const double apart = surfaceIsLarger ? ofSurface.farthestOf(light) : ofLight.farthestOf(surface);
    const glm::dvec3 normal = (surfaceIsLarger ? ofSurface : ofLight).normal();
    const double size = sizeOf(light), both = size + std::min(sizeOf(surface), mostTimesLarger * size);
    const double scale = rounding * (farthestAlong(light, normal) + both);
    return apart <= planeRoundings * scale ? std::optional(Flush { apart, rayRoundings * scale }) : std::nullopt;
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
    const std::optional<Flush> both = flush(light, ofLight, surface, ofSurface);
    if (!both) {
        return std::nullopt;
    }
    const Inside inside(light, ofLight.normal(), 8.0 * both->apart + both->rounding);
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
    BoxTree(const scene::Geometry& g, std::vector<std::size_t> triangles)
        : triangles_(std::move(triangles))
    {
        boxes_.reserve(triangles_.size());
        for (const std::size_t triangle : triangles_) {
            boxes_.push_back(boxOf(g, triangle));
        }
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), std::size_t { 0 });
        if (!order_.empty()) {
            build(0, order_.size());
        }
    }

    /// Larger by more than what is in its plane may be off it.
    static Box boxOf(const scene::Geometry& g, std::size_t triangle)
    {
        const Corners corners = cornersOf(g, triangle);
        const glm::dvec3 most = glm::max(glm::max(glm::abs(corners[0]), glm::abs(corners[1])), glm::abs(corners[2]));
        const double far = most.x + most.y + most.z + sizeOf(corners);
        const glm::vec3 more(static_cast<float>(2.0 * rounding * planeRoundings * mostTimesLarger * far));
        Box box;
        for (const glm::dvec3& c : corners) {
            box.add(glm::vec3(c) - more);
            box.add(glm::vec3(c) + more);
        }
        return box;
    }

    /// Calls found(triangle) for each whose box overlaps, until it returns false.
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
                    if (!found(triangles_[order_[i]])) {
                        return;
                    }
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
        if (triangleMoves(g, t)) {
            continue;
        }
        if (!mayEmit(scene, t)) {
            surfaces.push_back(t);
        } else if (!isCutout(scene.materials[g.materialIds[t]])) {
            lights.push_back(t);
        }
    }
    std::map<std::size_t, std::vector<Cover>> out;
    if (lights.empty() || surfaces.empty()) {
        return out;
    }
    const bool lightsAreFewer = lights.size() <= surfaces.size();
    const BoxTree tree(g, lightsAreFewer ? lights : surfaces);
    std::size_t work = 0, covers = 0;
    const auto isSpent = [&] { return work > mostWork || covers > mostCovers; };
    for (const std::size_t outer : lightsAreFewer ? surfaces : lights) {
        tree.overlapping(BoxTree::boxOf(g, outer), [&](std::size_t inner) {
            const std::size_t surface = lightsAreFewer ? outer : inner, light = lightsAreFewer ? inner : outer;
            ++work;
            if (const std::optional<Cover> cover = coverOf(cornersOf(g, surface), cornersOf(g, light))) {
                out[surface].push_back(*cover);
                ++covers;
            }
            return !isSpent();
        });
        if (isSpent()) {
            break;
        }
    }
    return out;
}

namespace {

/// An area light as liftsOf() holds triangles against it.
struct Quad {
    explicit Quad(const scene::AreaLight& light)
        : centre(light.centre)
    {
        const glm::dvec3 c(light.centre), u(light.halfU), v(light.halfV);
        corners = { c - u - v, c + u - v, c + u + v, c - u + v };
        plane = { 4.0 * glm::cross(u, v), c };
        const double shorter = std::min(glm::length(u), glm::length(v)), size = sizeOf(corners);
        const double far = farthestAlong(corners, plane.normal());
        most = static_cast<float>(2.0 * rounding * planeRoundings * (far + (1.0 + mostTimesLarger) * size));
        tilt = static_cast<float>(most / shorter);
        normal = plane.normal();
    }

    /// Whether a triangle may be in its plane, by one corner.
    bool mayLieIn(glm::vec3 corner) const
    {
        const glm::vec3 from = corner - centre;
        const glm::vec3 far = glm::abs(from);
        return std::abs(glm::dot(normal, from)) <= most + tilt * std::max({ far.x, far.y, far.z });
    }

    glm::vec3 centre, normal;
    std::array<glm::dvec3, 4> corners;
    Plane plane;
    float most, tilt; ///< metres off the plane, and more for each metre from the centre
};

} // namespace

std::vector<float> liftsOf(std::span<const scene::AreaLight> lights, const scene::Geometry& g)
{
    const std::vector<Quad> quads(lights.begin(), lights.end());
    std::vector<float> out(lights.size(), 0.0f);
    for (std::size_t t = 0; !quads.empty() && t < g.materialIds.size(); ++t) {
        const float* first = &g.positions[3 * std::size_t { g.indices[3 * t] }];
        const glm::vec3 corner(first[0], first[1], first[2]);
        for (std::size_t i = 0; i < quads.size(); ++i) {
            const Quad& quad = quads[i];
            if (!quad.mayLieIn(corner) || triangleMoves(g, t)) {
                continue;
            }
            const Corners surface = cornersOf(g, t);
            const Plane ofSurface = planeOf(surface);
            const std::optional<Flush> both = flush(quad.corners, quad.plane, surface, ofSurface);
            // What only touches it is beside it.
            if (both && !Inside(quad.corners, quad.plane.normal(), both->rounding).excludes(surface)
                && !Inside(surface, ofSurface.normal(), both->rounding).excludes(quad.corners)) {
                out[i] = std::max(out[i], static_cast<float>(2.0 * (both->apart + both->rounding)));
            }
        }
    }
    return out;
}

} // namespace wedge::render
