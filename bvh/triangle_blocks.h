#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

namespace wedge::bvh::detail {

/// The power of two that brings all coordinates of a box to within +-1, and the largest above 1/2: products of
/// four lengths then stay within a float's range whatever the mesh measures. Exact but for what becomes a denormal.
float unitOf(const Box& box);

/// Fills as many blocks as triangles need with them, in their order, in unit. A degenerate one gets its first vertex
/// three times, so that it is never hit. Returns how many are.
std::size_t fillBlocks(
    std::span<const std::uint32_t> triangles, const Mesh& mesh, float unit, shared::TriangleBlock* blocks);

} // namespace wedge::bvh::detail
