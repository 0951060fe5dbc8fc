#pragma once

#include "bvh/binary_tree.h"

namespace wedge::bvh::detail {

/// Takes subtrees out of a binary tree and puts them back where they cost least, the ones of largest area first, a
/// share of all nodes in each of some rounds (Meister, Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy
/// Optimization", 2018). It mends what a build from the top cannot foresee. The search is parallel over the subtrees;
/// moves are made in the order of what they gain, so that the result does not depend on threads. Leaves stay what they
/// are. Leaves the tree alone where it would become higher than a traversal's stack allows.
void reinsertSubtrees(BinaryTree& tree, const Config& config);

} // namespace wedge::bvh::detail
