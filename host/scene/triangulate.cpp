#include "host/scene/triangulate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "host/scene/orientation.h"

namespace wedge::scene {
namespace {

/// Faces of 10,000 corners that do not cross themselves need 10 to 100 steps a corner.
constexpr std::size_t mostSteps = 150;

/// Rounding of coordinates makes outlines cross that touch; so much of the area is not worth a word.
constexpr double negligible = 1e-5;

/// How far two halves of a quad face the way that the whole does; below 0 one lies over the other or outside.
double agreement(
    const glm::dvec3& normal, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d)
{
    return std::min(glm::dot(normal, glm::cross(b - a, c - a)), glm::dot(normal, glm::cross(c - a, d - a)));
}

/// In single precision: which of two equal diagonals is the shorter is a matter of rounding.
float squaredLength(const glm::vec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

} // namespace

Split Triangulator::split(std::span<const glm::dvec3> corners)
{
    assert(corners.size() >= 4);
    triangles_.clear();
    if (corners.size() == 4)
        return splitQuad(corners);
    project(corners);
    start();
    bool crossed = windsTwice();
    while (left_ > 2) {
        if (const auto vertex = pop(queue_)) {
            if (isEar(*vertex))
                cut(*vertex);
            else
                push(blocked_, areaAt(*vertex), *vertex);
        } else if (const auto smallest = pop(blocked_)) {
            lost_ += areaAt(*smallest);
            cut(*smallest);
        } else if (!turnRound()) {
            break;
        }
    }
    crossed = crossed || lost_ > negligible * area_;
    return triangles_.empty() ? Split::NoArea : crossed ? Split::Crossed : Split::Whole;
}

Split Triangulator::splitQuad(std::span<const glm::dvec3> corners)
{
    const glm::dvec3 &a = corners[0], &b = corners[1], &c = corners[2], &d = corners[3];
    const glm::dvec3 normal = glm::cross(c - a, d - b);
    const double first = agreement(normal, a, b, c, d), second = agreement(normal, b, c, d, a);
    const double scale = glm::dot(normal, normal);
    const bool shorter = squaredLength(glm::vec3(c - a)) < squaredLength(glm::vec3(d - b));
    const double better = shorter ? first : second, other = shorter ? second : first;
    const bool useShorter = better > 1e-6 * scale || better >= other;
    const std::array<std::array<std::uint32_t, 3>, 2> halves = shorter == useShorter
        ? std::array<std::array<std::uint32_t, 3>, 2> { { { 0, 1, 2 }, { 0, 2, 3 } } }
        : std::array<std::array<std::uint32_t, 3>, 2> { { { 0, 1, 3 }, { 1, 2, 3 } } };
    for (const auto& half : halves) {
        if (!onOneLine(corners[half[0]], corners[half[1]], corners[half[2]]))
            triangles_.push_back(half);
    }
    if (triangles_.empty())
        return Split::NoArea;
    const bool overlaps = (useShorter ? better : other) < -negligible * scale;
    return overlaps || (scale == 0.0 && triangles_.size() == 2) ? Split::Crossed : Split::Whole;
}

/// Drops the axis that the face looks along most, which keeps coordinates as they are: what is simple stays simple.
void Triangulator::project(std::span<const glm::dvec3> corners)
{
    glm::dvec3 normal(0.0), extent(0.0);
    const glm::dvec3& origin = corners[0];
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const glm::dvec3 n = glm::cross(corners[i - 1] - origin, corners[i] - origin);
        normal += n;
        extent += glm::abs(n);
    }
    const auto largest = [](const glm::dvec3& v) { return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2; };
    // A figure of eight may have no normal at all.
    const glm::dvec3 strength = glm::abs(normal);
    const bool clear = strength[largest(strength)] > 1e-6 * extent[largest(extent)];
    const int axis = largest(clear ? strength : extent);
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0.0)
        std::swap(u, v);
    points_.clear();
    for (const glm::dvec3& corner : corners)
        points_.emplace_back(corner[u], corner[v]);
}

void Triangulator::start()
{
    left_ = points_.size();
    const auto count = static_cast<std::uint32_t>(left_);
    ring_.assign(left_, {});
    queue_.clear();
    blocked_.clear();
    stale_.clear();
    hasObstacles_ = false;
    steps_ = 0;
    area_ = lost_ = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
        ring_[i].before = i == 0 ? count - 1 : i - 1;
        ring_[i].after = i + 1 == count ? 0 : i + 1;
        ring_[i].turn = Turn::Convex;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        stale_.push_back(i);
        settle();
    }
}

/// Whether an outline that turns left everywhere goes around more than once, as a pentagram's does.
bool Triangulator::windsTwice() const
{
    std::size_t changes = 0;
    const auto upwards = [&](std::size_t i) {
        const glm::dvec2 d = points_[(i + 1) % points_.size()] - points_[i];
        return d.y > 0.0 || (d.y == 0.0 && d.x > 0.0);
    };
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (ring_[i].turn != Turn::Convex)
            return false;
        changes += upwards(i) != upwards((i + 1) % points_.size());
    }
    return changes > 2;
}

/// Finds out how the outline turns at a vertex. One that adds nothing, because it is where its neighbour is or at the
/// end of a way there and back, leaves.
void Triangulator::classify(std::uint32_t index)
{
    Vertex& vertex = ring_[index];
    const glm::dvec2 &a = points_[vertex.before], &b = points_[index], &c = points_[vertex.after];
    const int turn = orientation(a, b, c);
    vertex.turn = turn > 0 ? Turn::Convex : turn < 0 ? Turn::Reflex : Turn::Straight;
    ++vertex.version;
    const int axis = a.x != b.x ? 0 : 1;
    const bool forwards = a[axis] < b[axis] ? b[axis] < c[axis] : a[axis] > b[axis] && b[axis] > c[axis];
    if (turn == 0 && !forwards) {
        unlink(index);
        return;
    }
    if (vertex.turn == Turn::Convex)
        push(queue_, glm::dot(c - a, c - a), index);
    if (vertex.turn != Turn::Convex && !hasObstacles_) {
        obstacles_.build(points_);
        hasObstacles_ = true;
    }
    if (hasObstacles_)
        obstacles_.set(index, vertex.turn != Turn::Convex);
}

/// Looks again at all vertices whose neighbours changed, and at those whose neighbours leave on that.
void Triangulator::settle()
{
    while (!stale_.empty() && left_ > 2) {
        const std::uint32_t vertex = stale_.back();
        stale_.pop_back();
        if (ring_[vertex].turn != Turn::Gone)
            classify(vertex);
    }
    stale_.clear();
}

void Triangulator::unlink(std::uint32_t index)
{
    Vertex& vertex = ring_[index];
    ring_[vertex.before].after = vertex.after;
    ring_[vertex.after].before = vertex.before;
    vertex.turn = Turn::Gone;
    ++vertex.version;
    --left_;
    if (hasObstacles_)
        obstacles_.set(index, false);
    stale_.push_back(vertex.before);
    stale_.push_back(vertex.after);
}

void Triangulator::cut(std::uint32_t index)
{
    area_ += areaAt(index);
    triangles_.push_back({ ring_[index].before, index, ring_[index].after });
    unlink(index);
    settle();
}

/// Whether nothing of the outline lies in the triangle of a convex vertex and its neighbours. It is enough to look at
/// corners that are not convex: of what reaches into the triangle, the corner nearest to the vertex is not.
bool Triangulator::isEar(std::uint32_t index)
{
    if (left_ == 3 || !hasObstacles_)
        return true;
    if (steps_ > mostSteps * points_.size())
        return false;
    const Vertex& vertex = ring_[index];
    return !obstacles_.any({ points_[vertex.before], points_[index], points_[vertex.after] }, steps_,
        [&](std::uint32_t other) { return blocks(other, index); });
}

bool Triangulator::blocks(std::uint32_t other, std::uint32_t index) const
{
    const Vertex& vertex = ring_[index];
    const glm::dvec2 &a = points_[vertex.before], &b = points_[index], &c = points_[vertex.after];
    const glm::dvec2& p = points_[other];
    if (other == index || p == a || p == c)
        return false;
    if (p != b)
        return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
    // It touches the tip: from outside, unless one of its edges goes into the triangle.
    const auto inside = [&](std::uint32_t end) {
        return orientation(a, b, points_[end]) > 0 && orientation(b, c, points_[end]) > 0;
    };
    return inside(ring_[other].before) || inside(ring_[other].after);
}

void Triangulator::push(std::vector<Candidate>& heap, double size, std::uint32_t vertex) const
{
    heap.push_back({ size, vertex, ring_[vertex].version });
    std::push_heap(heap.begin(), heap.end());
}

/// The smallest candidate whose neighbours are still the same, taken off the heap.
std::optional<std::uint32_t> Triangulator::pop(std::vector<Candidate>& heap) const
{
    while (!heap.empty()) {
        std::pop_heap(heap.begin(), heap.end());
        const Candidate smallest = heap.back();
        heap.pop_back();
        if (ring_[smallest.vertex].version == smallest.version)
            return smallest.vertex;
    }
    return std::nullopt;
}

/// What is left has no convex vertex: a part that the outline goes around the other way. Returns false when it is a
/// line.
bool Triangulator::turnRound()
{
    std::vector<std::uint32_t> rest;
    for (std::uint32_t i = 0; i < ring_.size(); ++i) {
        if (ring_[i].turn != Turn::Gone)
            rest.push_back(i);
    }
    if (std::none_of(rest.begin(), rest.end(), [&](std::uint32_t i) { return ring_[i].turn == Turn::Reflex; }))
        return false;
    double area = 0.0;
    for (const std::uint32_t i : rest) {
        area += doubleArea(points_[rest[0]], points_[i], points_[ring_[i].after]);
        std::swap(ring_[i].before, ring_[i].after);
    }
    lost_ += std::abs(area);
    for (const std::uint32_t i : rest) {
        stale_.push_back(i);
        settle();
    }
    return true;
}

double Triangulator::areaAt(std::uint32_t index) const
{
    const Vertex& vertex = ring_[index];
    return doubleArea(points_[vertex.before], points_[index], points_[vertex.after]);
}

} // namespace wedge::scene
