#pragma once

#include "bvh/binary_tree.h"

namespace wedge::bvh::detail {

/// Collapses a binary tree into nodes of WEDGE_BVH_WIDTH children and packs the triangles of its leaves into
/// blocks. Writes nodes, blocks and, of the statistics, what they tell.
Bvh collapse(BinaryTree& tree, const Mesh& mesh, const Config& config);

} // namespace wedge::bvh::detail
