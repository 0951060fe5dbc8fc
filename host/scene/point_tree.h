#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::scene {

/// A tree over points of the plane, each switched on or off, that finds those in a triangle: the corners of a face that
/// can lie in the way of its splitting.
class PointTree {
public:
    /// All points are off at first.
    void build(std::span<const glm::dvec2> points);

    void set(std::uint32_t point, bool on);

    struct Triangle {
        glm::dvec2 a, b, c; ///< counter-clockwise
    };

    /// Whether `blocks` is true for one of the points that are on and near the triangle, a superset of those in it.
    /// Points at a and c are left out. steps: grows by the work done.
    template <class Blocks>
    bool any(const Triangle& triangle, std::size_t& steps, const Blocks& blocks) const
    {
        std::uint32_t stack[64]; // the tree halves the points, so that it is never deeper than 32
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            ++steps;
            if (node.on == 0 || apart(node, triangle))
                continue;
            if (node.child != 0) {
                stack[depth++] = node.child + 1;
                stack[depth++] = node.child;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i, ++steps) {
                if (on_[order_[i]] && blocks(order_[i]))
                    return true;
            }
        }
        return false;
    }

private:
    struct Node {
        glm::dvec2 lo { std::numeric_limits<double>::max() }, hi { std::numeric_limits<double>::lowest() };
        /// A second box, along the points: outlines are thin lines that go any way.
        glm::dvec2 origin { 0.0 }, along { 1.0, 0.0 }; ///< across: along turned to the left
        double alongLo = 0.0, alongHi = 0.0, acrossLo = 0.0, acrossHi = 0.0;
        std::uint32_t begin = 0, end = 0; ///< in order_
        std::uint32_t child = 0, parent = 0; ///< the first of two children; 0: a leaf
        std::uint32_t on = 0;
    };

    void fit(Node& node) const;
    void split(std::uint32_t node);
    static bool rightOf(const Node& node, const glm::dvec2& a, const glm::dvec2& b);
    /// Certainly no point of the node is in the triangle, or all are at a or c.
    static bool apart(const Node& node, const Triangle& triangle);

    std::span<const glm::dvec2> points_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_, leaf_;
    std::vector<std::uint8_t> on_;
};

} // namespace wedge::scene
