#include "host/scene/point_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wedge::scene {
namespace {

constexpr std::uint32_t leafSize = 8;

} // namespace

void PointTree::build(std::span<const glm::dvec2> points)
{
    points_ = points;
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0u);
    leaf_.assign(points.size(), 0);
    on_.assign(points.size(), 0);
    nodes_.assign(1, {});
    nodes_[0].end = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t node = 0; node < nodes_.size(); ++node)
        split(node);
}

void PointTree::fit(Node& node) const
{
    node.origin = points_[order_[node.begin]];
    glm::dvec2 farthest = node.origin;
    const auto distance = [&](const glm::dvec2& p) { return glm::dot(p - node.origin, p - node.origin); };
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const glm::dvec2& point = points_[order_[i]];
        node.lo = glm::min(node.lo, point);
        node.hi = glm::max(node.hi, point);
        if (distance(point) > distance(farthest))
            farthest = point;
    }
    const double length = glm::length(farthest - node.origin);
    if (length > 0.0 && std::isfinite(length))
        node.along = (farthest - node.origin) / length;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const glm::dvec2 d = points_[order_[i]] - node.origin;
        const double along = glm::dot(d, node.along), across = node.along.x * d.y - node.along.y * d.x;
        node.alongLo = std::min(node.alongLo, along);
        node.alongHi = std::max(node.alongHi, along);
        node.acrossLo = std::min(node.acrossLo, across);
        node.acrossHi = std::max(node.acrossHi, across);
    }
}

void PointTree::split(std::uint32_t index)
{
    Node& node = nodes_[index];
    fit(node);
    if (node.end - node.begin <= leafSize) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            leaf_[order_[i]] = index;
        return;
    }
    const int axis = node.hi.x - node.lo.x >= node.hi.y - node.lo.y ? 0 : 1;
    const auto begin = order_.begin() + node.begin, end = order_.begin() + node.end;
    const std::uint32_t middle = (node.begin + node.end) / 2;
    std::nth_element(begin, order_.begin() + middle, end,
        [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    Node first, second;
    first.parent = second.parent = index;
    first.begin = node.begin;
    first.end = second.begin = middle;
    second.end = node.end;
    node.child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(first); // ends the life of `node`
    nodes_.push_back(second);
}

void PointTree::set(std::uint32_t point, bool on)
{
    if ((on_[point] != 0) == on)
        return;
    on_[point] = on;
    for (std::uint32_t node = leaf_[point];; node = nodes_[node].parent) {
        nodes_[node].on += on ? 1u : ~0u;
        if (node == 0)
            return;
    }
}

/// Whether all points of the node are certainly on the right of the line from a to b.
bool PointTree::rightOf(const Node& node, const glm::dvec2& a, const glm::dvec2& b)
{
    const glm::dvec2 left(a.y - b.y, b.x - a.x);
    const double along = glm::dot(left, node.along), across = left.y * node.along.x - left.x * node.along.y;
    const double farAlong = along * (along > 0.0 ? node.alongHi : node.alongLo);
    const double farAcross = across * (across > 0.0 ? node.acrossHi : node.acrossLo);
    const double x = left.x * (node.origin.x - a.x), y = left.y * (node.origin.y - a.y);
    const double scale = std::abs(x) + std::abs(y)
        + (std::abs(left.x) + std::abs(left.y)) * (node.alongHi - node.alongLo + node.acrossHi - node.acrossLo);
    return x + y + farAlong + farAcross < -1e-14 * scale;
}

bool PointTree::apart(const Node& node, const Triangle& t)
{
    const glm::dvec2 lo = glm::min(glm::min(t.a, t.b), t.c), hi = glm::max(glm::max(t.a, t.b), t.c);
    if (node.lo.x > hi.x || node.lo.y > hi.y || node.hi.x < lo.x || node.hi.y < lo.y)
        return true;
    if (node.lo == node.hi && (node.lo == t.a || node.lo == t.c))
        return true;
    return rightOf(node, t.a, t.b) || rightOf(node, t.b, t.c) || rightOf(node, t.c, t.a);
}

} // namespace wedge::scene
