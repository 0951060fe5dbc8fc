#pragma once

#include "bvh/binary_tree.h"

namespace wedge::bvh::detail {

/// Collapses a binary tree into nodes of WEDGE_BVH_WIDTH children and packs the triangles of its leaves into
/// blocks. references are those that tree was built over. Writes nodes, blocks and all statistics but times
/// and skipped triangles.
Bvh collapse(BinaryNode* tree, std::span<Reference> references, const Mesh& mesh, const Config& config);

} // namespace wedge::bvh::detail
