#include "bvh/wide_tree.h"

#include "bvh/children.h"
#include "bvh/triangle_blocks.h"
#include "bvh/wide_node.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace wedge::bvh::detail {
namespace {

using shared::BvhNode;
using shared::TriangleBlock;

constexpr std::uint32_t minParallelBlocks = 256;

/// What a subtree adds to the statistics.
struct Tally {
    double cost = 0; ///< area times cost, summed
    unsigned depth = 0;
    unsigned stackNeeded = 0;
    std::size_t degenerate = 0;
    std::size_t references = 0;
};

class Collapse {
public:
    Collapse(BinaryTree& tree, const Mesh& mesh, const Config& config)
        : tree_(tree)
        , mesh_(mesh)
        , config_(config)
        , unit_(unitOf(tree.root.box))
    {
    }

    Bvh run()
    {
        countNodes(tree_.root, WEDGE_BVH_STACK);
        Bvh bvh;
        bvh.nodes.resize(tree_.root.wideNodes);
        bvh.blocks.resize(tree_.root.blocks);
        nodes_ = bvh.nodes.data();
        blocks_ = bvh.blocks.data();
        const Tally tally = emitNode(tree_.root, WEDGE_BVH_STACK, 0, 0);
        nodes_[0].unit = unit_;
        assert(tally.stackNeeded <= WEDGE_BVH_STACK);
        const double area = tree_.root.box.halfArea();
        bvh.statistics.sahCost = area > 0 ? tally.cost / area : 0;
        bvh.statistics.depth = tally.depth;
        bvh.statistics.stackNeeded = tally.stackNeeded;
        bvh.statistics.degenerate = tally.degenerate;
        bvh.statistics.references = tally.references;
        return bvh;
    }

private:
    /// Calls body(slot) for each child, in parallel where the subtree is large.
    template <typename Body>
    void forEachChild(const BinaryNode& node, const Children& children, const Body& body) const
    {
        if (node.blocks >= minParallelBlocks)
            tbb::parallel_for(0u, children.count, body);
        else
            for (unsigned slot = 0; slot < children.count; slot++)
                body(slot);
    }

    /// Sets wideNodes of every binary node that becomes a wide one; 0 of those that become leaves.
    void countNodes(BinaryNode& node, unsigned budget) const
    {
        const Children children = chooseChildren(node, budget);
        forEachChild(node, children, [&](unsigned slot) {
            BinaryNode& child = *children.nodes[slot];
            if (child.children)
                countNodes(child, budget - (children.count - 1));
            else
                child.wideNodes = 0;
        });
        std::uint32_t below = 1;
        for (unsigned slot = 0; slot < children.count; slot++)
            below += &node == children.nodes[slot] ? 0 : children.nodes[slot]->wideNodes;
        node.wideNodes = below;
    }

    /// Writes the wide node of a binary one to nodes_[index], the ones below it right after, and their blocks from
    /// blocks_[block] on.
    Tally emitNode(BinaryNode& node, unsigned budget, std::uint32_t index, std::uint32_t block) const
    {
        const Children children = chooseChildren(node, budget);
        std::uint32_t childNodes[WEDGE_BVH_WIDTH], childBlocks[WEDGE_BVH_WIDTH];
        std::uint32_t nextNode = index + 1;
        for (unsigned slot = 0; slot < children.count; slot++) {
            const BinaryNode& child = *children.nodes[slot];
            childNodes[slot] = nextNode;
            childBlocks[slot] = block;
            nextNode += child.wideNodes;
            block += child.blocks;
        }
        BvhNode& out = nodes_[index];
        out = {};
        Tally tallies[WEDGE_BVH_WIDTH];
        forEachChild(node, children, [&](unsigned slot) {
            BinaryNode& child = *children.nodes[slot];
            setBox(out, slot, child.box.lo * unit_, child.box.hi * unit_);
            if (child.children) {
                out.child[slot] = childNodes[slot];
                tallies[slot] = emitNode(child, budget - (children.count - 1), childNodes[slot], childBlocks[slot]);
            } else {
                out.child[slot] = WEDGE_BVH_LEAF | childBlocks[slot] << 3 | child.blocks;
                const std::span<const std::uint32_t> triangles(&tree_.triangles[child.first], child.count);
                tallies[slot].degenerate = fillBlocks(triangles, mesh_, unit_, &blocks_[childBlocks[slot]]);
                tallies[slot].references = child.count;
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
            sum.references += tallies[slot].references;
        }
        sum.cost += node.box.halfArea() * config_.traversalCost;
        sum.depth += 1;
        sum.stackNeeded += children.count - 1;
        return sum;
    }

    BinaryTree& tree_;
    const Mesh& mesh_;
    const Config& config_;
    float unit_;
    BvhNode* nodes_ = nullptr;
    TriangleBlock* blocks_ = nullptr;
};

} // namespace

Bvh collapse(BinaryTree& tree, const Mesh& mesh, const Config& config) { return Collapse(tree, mesh, config).run(); }

} // namespace wedge::bvh::detail
