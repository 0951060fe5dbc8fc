#pragma once

#include "bvh/morton.h"
#include "bvh/reference.h"

#include <tbb/enumerable_thread_specific.h>

#include <vector>

namespace wedge::bvh::detail {

/// A node of the binary tree that the wide one is collapsed from.
struct BinaryNode {
    Box box;
    BinaryNode* children; ///< two, side by side; null for a leaf
    std::uint32_t first, count; ///< of a leaf: its triangles
    std::uint32_t blocks; ///< triangle blocks of the leaves below
    std::uint32_t height; ///< inner nodes on the longest way down, itself included; 0 for a leaf
    std::uint32_t wideNodes; ///< written by the collapse: wide nodes below, itself included
    std::uint32_t shares; ///< 4 bits each for 1 to 8 trees: see leftShare in children.cpp
    float costs[WEDGE_BVH_WIDTH - 1]; ///< of the subtree as at most 1 to 7 trees, relative to the root's area
};

/// Memory for nodes. A thread has its own, so that subtrees need no lock; where a node lies decides nothing.
class NodeArena {
public:
    BinaryNode* allocatePair();

private:
    static constexpr std::size_t slabNodes = 512;
    std::vector<std::unique_ptr<BinaryNode[]>> slabs_;
    std::size_t used_ = slabNodes;
};

struct BinaryTree {
    BinaryNode root {};
    Array<std::uint32_t> triangles; ///< those of each leaf in ascending order
    tbb::enumerable_thread_specific<NodeArena> arenas;
};

/// Inner nodes on the longest path of any binary tree that splitting makes; reinsertion may make it WEDGE_BVH_STACK
/// deep. Deep branches of the SAH fall back to median splits in time, which 2^31 triangles need 31 of.
inline constexpr unsigned maxBinaryHeight = 64;
static_assert(maxBinaryHeight <= WEDGE_BVH_STACK, "a tree collapsed to two children a node must fit the stack");

inline std::uint32_t blocksOf(std::uint32_t triangles) { return (triangles + WEDGE_BLOCK_SIZE - 1) / WEDGE_BLOCK_SIZE; }

/// Splits references, at least one and each a triangle, by binned SAH. room: what their arrays hold.
void buildBinaryTree(
    ReferenceArrays references, std::uint32_t room, const Mesh& mesh, const Config& config, BinaryTree& tree);

/// The same over runs of triangles, each taken for one block.
void buildBinaryTree(MortonRuns runs, const Mesh& mesh, const Config& config, BinaryTree& tree);

} // namespace wedge::bvh::detail
