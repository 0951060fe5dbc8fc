#pragma once

#include "bvh/binary_tree.h"

namespace wedge::bvh::detail {

/// The binary nodes that become the children of one wide node.
struct Children {
    BinaryNode* nodes[WEDGE_BVH_WIDTH];
    unsigned count;
};

/// Sets what a subtree costs at best as 1 to 7 wide nodes or leaves side by side, and how, from the same of its two
/// children (Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017).
/// area: of node, relative to the root's; traversalCost: of a node, in tests of a block.
void weighForest(BinaryNode& node, float area, float traversalCost);

/// Sets what an inner node tells of its two children, its box apart.
void completeNode(BinaryNode& node, float area, float traversalCost);

/// The same of a leaf: it is one, whatever the room.
void weighLeaf(BinaryNode& node, float area);

/// The children that cost least. A traversal stacks one child less than a node has and goes on into any of them, and a
/// child of binary height h can always do with h entries (two children a node); where the best children would not fit
/// budget, the largest are opened only while they do. Requires root.height <= budget, and leaves the same true of each
/// child and budget - (count - 1).
Children chooseChildren(BinaryNode& root, unsigned budget);

} // namespace wedge::bvh::detail
