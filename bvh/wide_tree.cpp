#include "bvh/wide_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wedge::bvh::detail {
namespace {

using shared::BvhNode;
using shared::TriangleBlock;

constexpr std::uint32_t minParallelSubtree = 2048;

/// The binary nodes that become the children of one wide node.
struct Children {
    std::uint32_t nodes[WEDGE_BVH_WIDTH];
    unsigned count;
};

/// Starts from the two children of the binary node root and opens the one of largest area until the wide node
/// is full. A traversal stacks one child less than a node has and goes on into any of them, and a child of binary
/// height h can always do with h entries (two children a node), so opening stops where that would not fit budget.
/// Requires tree[root].height <= budget, and leaves the same true of each child and budget - (count - 1).
Children openChildren(const BinaryNode* tree, std::uint32_t root, unsigned budget)
{
    if (tree[root].right == 0)
        return { { root }, 1 };
    Children children { { root + 1, tree[root].right }, 2 };
    while (children.count < WEDGE_BVH_WIDTH) {
        unsigned height = 0;
        int largest = -1;
        for (unsigned i = 0; i < children.count; i++) {
            const BinaryNode& child = tree[children.nodes[i]];
            height = std::max(height, child.height);
            if (child.right != 0
                && (largest < 0 || child.box.halfArea() > tree[children.nodes[largest]].box.halfArea()))
                largest = static_cast<int>(i);
        }
        if (largest < 0 || children.count + height > budget)
            break;
        std::uint32_t& opened = children.nodes[largest];
        children.nodes[children.count++] = tree[opened].right;
        opened++;
    }
    return children;
}

/// What a subtree adds to the statistics.
struct Tally {
    double cost = 0; ///< area times cost, summed
    unsigned depth = 0;
    unsigned stackNeeded = 0;
    std::size_t degenerate = 0;
};

void setBox(BvhNode& node, unsigned slot, Float4 lo, Float4 hi)
{
    node.loX[slot] = lo[0];
    node.loY[slot] = lo[1];
    node.loZ[slot] = lo[2];
    node.hiX[slot] = hi[0];
    node.hiY[slot] = hi[1];
    node.hiZ[slot] = hi[2];
}

/// Whether the float cross product of two edges is nothing but rounding error, and so has no direction.
bool isDegenerate(const float e1[3], const float e2[3])
{
    const double a[3] = { e1[0], e1[1], e1[2] }, b[3] = { e2[0], e2[1], e2[2] };
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    const double product = std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]);
    return std::hypot(x, y, z) <= degenerateSine * product;
}

/// The power of two that brings all coordinates of a box to within +-1, and the largest above 1/2: products of
/// four lengths then stay within a float's range whatever the mesh measures. Exact but for what becomes a denormal.
float unitOf(const Box& box)
{
    float largest = 0;
    for (int axis = 0; axis < 3; axis++)
        largest = std::max({ largest, std::fabs(box.lo[axis]), std::fabs(box.hi[axis]) });
    return largest > 0 ? std::ldexp(1.0f, std::min(-std::ilogb(largest) - 1, 126)) : 1.0f;
}

class Collapse {
public:
    Collapse(BinaryNode* tree, std::span<Reference> references, const Mesh& mesh, const Config& config)
        : tree_(tree)
        , references_(references)
        , mesh_(mesh)
        , config_(config)
        , unit_(unitOf(tree[0].box))
    {
    }

    Bvh run()
    {
        countNodes(0, WEDGE_BVH_STACK);
        Bvh bvh;
        bvh.nodes.resize(tree_[0].wideNodes);
        bvh.blocks.resize(tree_[0].blocks);
        nodes_ = bvh.nodes.data();
        blocks_ = bvh.blocks.data();
        nodes_[0].unit = unit_;
        const Tally tally = emitNode(0, WEDGE_BVH_STACK, 0, 0);
        assert(tally.stackNeeded <= WEDGE_BVH_STACK);
        const double area = tree_[0].box.halfArea();
        bvh.statistics.sahCost = area > 0 ? tally.cost / area : 0;
        bvh.statistics.depth = tally.depth;
        bvh.statistics.stackNeeded = tally.stackNeeded;
        bvh.statistics.degenerate = tally.degenerate;
        bvh.statistics.triangles = references_.size();
        return bvh;
    }

private:
    /// Calls body(slot) for each child, in parallel where the subtree is large.
    template <typename Body>
    void forEachChild(const Children& children, std::uint32_t triangles, const Body& body) const
    {
        if (triangles >= minParallelSubtree)
            tbb::parallel_for(0u, children.count, body);
        else
            for (unsigned slot = 0; slot < children.count; slot++)
                body(slot);
    }

    /// Sets wideNodes of every binary node that becomes a wide one.
    void countNodes(std::uint32_t index, unsigned budget) const
    {
        const Children children = openChildren(tree_, index, budget);
        forEachChild(children, tree_[index].count, [&](unsigned slot) {
            if (tree_[children.nodes[slot]].right != 0)
                countNodes(children.nodes[slot], budget - (children.count - 1));
        });
        std::uint32_t below = 1;
        for (unsigned slot = 0; slot < children.count; slot++)
            if (tree_[children.nodes[slot]].right != 0)
                below += tree_[children.nodes[slot]].wideNodes;
        tree_[index].wideNodes = below;
    }

    /// Writes the wide node of tree_[index] to nodes_[node], the ones below it right after, and their blocks from
    /// blocks_[block] on.
    Tally emitNode(std::uint32_t index, unsigned budget, std::uint32_t node, std::uint32_t block) const
    {
        const Children children = openChildren(tree_, index, budget);
        std::uint32_t childNodes[WEDGE_BVH_WIDTH], childBlocks[WEDGE_BVH_WIDTH];
        std::uint32_t nextNode = node + 1;
        for (unsigned slot = 0; slot < children.count; slot++) {
            const BinaryNode& child = tree_[children.nodes[slot]];
            childNodes[slot] = nextNode;
            childBlocks[slot] = block;
            nextNode += child.right != 0 ? child.wideNodes : 0;
            block += child.blocks;
        }
        BvhNode& out = nodes_[node];
        Tally tallies[WEDGE_BVH_WIDTH];
        forEachChild(children, tree_[index].count, [&](unsigned slot) {
            const BinaryNode& child = tree_[children.nodes[slot]];
            setBox(out, slot, child.box.lo * unit_, child.box.hi * unit_);
            if (child.right != 0) {
                out.child[slot] = childNodes[slot];
                tallies[slot] =
                    emitNode(children.nodes[slot], budget - (children.count - 1), childNodes[slot], childBlocks[slot]);
            } else {
                out.child[slot] = WEDGE_BVH_LEAF | childBlocks[slot] << 3 | child.blocks;
                tallies[slot].degenerate = emitLeaf(child, childBlocks[slot]);
                tallies[slot].cost = child.box.halfArea() * child.blocks;
            }
        });
        for (unsigned slot = children.count; slot < WEDGE_BVH_WIDTH; slot++) {
            setBox(out, slot, Box::empty().lo, Box::empty().hi);
            out.child[slot] = WEDGE_BVH_LEAF;
        }
        Tally sum;
        for (unsigned slot = 0; slot < children.count; slot++) {
            sum.cost += tallies[slot].cost;
            sum.depth = std::max(sum.depth, tallies[slot].depth);
            sum.stackNeeded = std::max(sum.stackNeeded, tallies[slot].stackNeeded);
            sum.degenerate += tallies[slot].degenerate;
        }
        sum.cost += tree_[index].box.halfArea() * config_.traversalCost;
        sum.depth += 1;
        sum.stackNeeded += children.count - 1;
        return sum;
    }

    /// Packs the triangles of a leaf, in ascending order so that the first of equal hits is the smallest, into
    /// blocks_ from block on. Returns how many are degenerate.
    std::size_t emitLeaf(const BinaryNode& leaf, std::uint32_t block) const
    {
        const auto range = references_.subspan(leaf.first, leaf.count);
        std::sort(
            range.begin(), range.end(), [](const Reference& a, const Reference& b) { return a.triangle < b.triangle; });
        std::size_t degenerate = 0;
        for (std::uint32_t i = 0; i < leaf.blocks * WEDGE_BLOCK_SIZE; i++) {
            TriangleBlock& out = blocks_[block + i / WEDGE_BLOCK_SIZE];
            if (i < leaf.count)
                degenerate += emitTriangle(out, i % WEDGE_BLOCK_SIZE, range[i].triangle);
            else
                out.triangle[i % WEDGE_BLOCK_SIZE] = WEDGE_NO_TRIANGLE;
        }
        return degenerate;
    }

    /// Returns true if the triangle is degenerate: then all its vertices are the first, so that it is never hit.
    bool emitTriangle(TriangleBlock& out, unsigned lane, std::uint32_t triangle) const
    {
        float v[3][3];
        for (std::size_t corner = 0; corner < 3; corner++) {
            const std::size_t vertex = mesh_.indices[3 * std::size_t { triangle } + corner];
            for (std::size_t axis = 0; axis < 3; axis++)
                v[corner][axis] = mesh_.positions[3 * vertex + axis] * unit_;
        }
        const float e1[3] = { v[1][0] - v[0][0], v[1][1] - v[0][1], v[1][2] - v[0][2] };
        const float e2[3] = { v[2][0] - v[0][0], v[2][1] - v[0][1], v[2][2] - v[0][2] };
        out.v0x[lane] = v[0][0];
        out.v0y[lane] = v[0][1];
        out.v0z[lane] = v[0][2];
        out.triangle[lane] = triangle;
        const bool degenerate = isDegenerate(e1, e2);
        const float* v1 = degenerate ? v[0] : v[1];
        const float* v2 = degenerate ? v[0] : v[2];
        out.v1x[lane] = v1[0];
        out.v1y[lane] = v1[1];
        out.v1z[lane] = v1[2];
        out.v2x[lane] = v2[0];
        out.v2y[lane] = v2[1];
        out.v2z[lane] = v2[2];
        return degenerate;
    }

    BinaryNode* tree_;
    std::span<Reference> references_;
    const Mesh& mesh_;
    const Config& config_;
    float unit_;
    BvhNode* nodes_ = nullptr;
    TriangleBlock* blocks_ = nullptr;
};

} // namespace

Bvh collapse(BinaryNode* tree, std::span<Reference> references, const Mesh& mesh, const Config& config)
{
    return Collapse(tree, references, mesh, config).run();
}

} // namespace wedge::bvh::detail
