#include "bvh/validate.h"

#include <algorithm>
#include <cmath>

namespace wedge::bvh {
namespace {

using shared::BvhNode;
using shared::TriangleBlock;

struct Bounds {
    float lo[3] = { 1e30f, 1e30f, 1e30f }, hi[3] = { -1e30f, -1e30f, -1e30f };
};

Bounds slotBounds(const BvhNode& node, unsigned slot)
{
    return { { node.loX[slot], node.loY[slot], node.loZ[slot] }, { node.hiX[slot], node.hiY[slot], node.hiZ[slot] } };
}

bool contains(const Bounds& outer, const Bounds& inner)
{
    for (int axis = 0; axis < 3; axis++)
        if (inner.lo[axis] < outer.lo[axis] || inner.hi[axis] > outer.hi[axis])
            return false;
    return true;
}

class Validator {
public:
    Validator(const Bvh& bvh, const Mesh& mesh)
        : bvh_(bvh)
        , mesh_(mesh)
        , nodeVisits_(bvh.nodes.size())
        , blockVisits_(bvh.blocks.size())
        , leafBoxes_(mesh.indices.size() / 3)
    {
    }

    std::vector<std::string> run()
    {
        if (bvh_.nodes.empty())
            return { "there is no root" };
        unit_ = bvh_.nodes[0].unit;
        if (!(unit_ > 0) || std::ldexp(1.0f, std::ilogb(unit_)) != unit_)
            problem("the root's unit is not a power of two", 0);
        const unsigned stack = visitNode(0, Bounds { { -1, -1, -1 }, { 1, 1, 1 } });
        if (stack > WEDGE_BVH_STACK)
            problem("the traversal's stack overflows, entries needed", stack);
        if (stack != bvh_.statistics.stackNeeded)
            problem("the statistics have another stack than needed", stack);
        for (std::size_t i = 0; i < nodeVisits_.size(); i++)
            if (nodeVisits_[i] != 1)
                problem("node is reached not once but " + std::to_string(nodeVisits_[i]) + " times", i);
        for (std::size_t i = 0; i < blockVisits_.size(); i++)
            if (blockVisits_[i] != 1)
                problem("block is reached not once but " + std::to_string(blockVisits_[i]) + " times", i);
        checkTriangles();
        return problems_;
    }

private:
    void problem(const std::string& what, std::size_t index)
    {
        if (problems_.size() < 20)
            problems_.push_back(what + ": " + std::to_string(index));
    }

    float vertex(std::size_t triangle, std::size_t corner, std::size_t axis) const
    {
        return mesh_.positions[3 * std::size_t { mesh_.indices[3 * triangle + corner] } + axis];
    }

    bool isValid(std::size_t triangle) const
    {
        for (std::size_t corner = 0; corner < 3; corner++)
            for (std::size_t axis = 0; axis < 3; axis++)
                if (!(std::fabs(vertex(triangle, corner, axis)) <= maxCoordinate))
                    return false;
        return true;
    }

    /// Each valid triangle is in a leaf, and each of its points in the box of one.
    void checkTriangles()
    {
        std::size_t lanes = 0;
        for (std::size_t i = 0; i < leafBoxes_.size(); i++) {
            lanes += leafBoxes_[i].size();
            if (leafBoxes_[i].empty() == isValid(i))
                problem("triangle is in " + std::to_string(leafBoxes_[i].size()) + " lanes", i);
            else if (!leafBoxes_[i].empty() && !isCovered(i))
                problem("the boxes of the leaves do not contain all of triangle", i);
        }
        if (lanes != bvh_.statistics.references)
            problem("the statistics have another number of references than there are", lanes);
    }

    /// Of one box: whether it contains the vertices; of several: whether one of them contains each of many points.
    bool isCovered(std::size_t triangle) const
    {
        const std::vector<Bounds>& boxes = leafBoxes_[triangle];
        const int steps = boxes.size() == 1 ? 1 : 24;
        for (int i = 0; i <= steps; i++)
            for (int j = 0; i + j <= steps; j++) {
                double point[3];
                for (std::size_t axis = 0; axis < 3; axis++)
                    point[axis] = (static_cast<double>(vertex(triangle, 0, axis)) * (steps - i - j)
                                      + static_cast<double>(vertex(triangle, 1, axis)) * i
                                      + static_cast<double>(vertex(triangle, 2, axis)) * j)
                        / steps * static_cast<double>(unit_);
                const auto isWithin = [&](const Bounds& box) {
                    constexpr double rounding = 1e-15; // of the sums above; coordinates are at most 1
                    for (int axis = 0; axis < 3; axis++)
                        if (point[axis] < box.lo[axis] - rounding || point[axis] > box.hi[axis] + rounding)
                            return false;
                    return true;
                };
                if (std::none_of(boxes.begin(), boxes.end(), isWithin))
                    return false;
            }
        return true;
    }

    /// Returns the stack entries that a traversal may need from this node on.
    unsigned visitNode(std::size_t index, const Bounds& outer)
    {
        if (index >= bvh_.nodes.size() || nodeVisits_[index]++ != 0) {
            problem("a child refers to a node that is not there or has another parent", index);
            return 0;
        }
        const BvhNode& node = bvh_.nodes[index];
        unsigned used = 0, below = 0;
        for (unsigned slot = 0; slot < WEDGE_BVH_WIDTH; slot++) {
            const std::uint32_t child = node.child[slot];
            const Bounds bounds = slotBounds(node, slot);
            if (child == WEDGE_BVH_LEAF) {
                if (bounds.lo[0] < bounds.hi[0])
                    problem("an empty slot can be entered in node", index);
                continue;
            }
            used++;
            if (!contains(outer, bounds))
                problem("a box leaves its parent's in node", index);
            if (child & WEDGE_BVH_LEAF)
                visitLeaf(child, bounds);
            else
                below = std::max(below, visitNode(child, bounds));
        }
        return below + (used > 0 ? used - 1 : 0);
    }

    void visitLeaf(std::uint32_t child, const Bounds& bounds)
    {
        const std::size_t first = (child & ~WEDGE_BVH_LEAF) >> 3, count = child & 7u;
        std::uint32_t last = 0;
        for (std::size_t block = first; block < first + count; block++) {
            if (block >= bvh_.blocks.size())
                return problem("a leaf refers to a block that is not there", block);
            blockVisits_[block]++;
            for (unsigned lane = 0; lane < WEDGE_BLOCK_SIZE; lane++) {
                const std::uint32_t triangle = bvh_.blocks[block].triangle[lane];
                checkLane(bvh_.blocks[block], lane, bounds);
                if (triangle < last)
                    problem("the triangles of a leaf are not in order at block", block);
                last = triangle;
            }
        }
    }

    void checkLane(const TriangleBlock& block, unsigned lane, const Bounds& bounds)
    {
        const float v0[3] = { block.v0x[lane], block.v0y[lane], block.v0z[lane] };
        const float v1[3] = { block.v1x[lane], block.v1y[lane], block.v1z[lane] };
        const float v2[3] = { block.v2x[lane], block.v2y[lane], block.v2z[lane] };
        const std::uint32_t triangle = block.triangle[lane];
        const bool unused = triangle == WEDGE_NO_TRIANGLE;
        if (!unused && triangle >= leafBoxes_.size())
            return problem("a lane refers to a triangle that is not there", triangle);
        if (!unused)
            leafBoxes_[triangle].push_back(bounds);
        const bool flat = std::equal(v0, v0 + 3, v1) && std::equal(v0, v0 + 3, v2);
        if (unused && !(flat && v0[0] == 0 && v0[1] == 0 && v0[2] == 0))
            problem("an unused lane is not zero in a leaf at triangle", triangle);
        if (unused)
            return;
        for (std::size_t axis = 0; axis < 3; axis++) {
            const float a = vertex(triangle, 0, axis) * unit_, b = vertex(triangle, 1, axis) * unit_,
                        c = vertex(triangle, 2, axis) * unit_;
            if (v0[axis] != a || (!flat && (v1[axis] != b || v2[axis] != c)))
                problem("a lane has other vertices than triangle", triangle);
        }
    }

    const Bvh& bvh_;
    const Mesh& mesh_;
    float unit_ = 1;
    std::vector<unsigned> nodeVisits_, blockVisits_;
    std::vector<std::vector<Bounds>> leafBoxes_; ///< of each triangle
    std::vector<std::string> problems_;
};

} // namespace

std::vector<std::string> validate(const Bvh& bvh, const Mesh& mesh) { return Validator(bvh, mesh).run(); }

} // namespace wedge::bvh
