#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

namespace wedge::bvh::detail {

/// The power of two that brings all coordinates of a box to within +-1, and the largest above 1/2: products of
/// four lengths then stay within a float's range whatever the mesh measures. Exact but for what becomes a denormal.
float unitOf(const Box& box);

/// Whether the cross product of two edges, in floats, is nothing but rounding error, and so has no direction. Without a
/// root: squares of what floats of up to 1 can be stay within a double's range.
inline bool isDegenerate(const float (&a)[3], const float (&b)[3])
{
    const double ax = a[0], ay = a[1], az = a[2], bx = b[0], by = b[1], bz = b[2];
    const double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    const double product = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz);
    return !(x * x + y * y + z * z > degenerateSine * degenerateSine * product);
}

/// Fills as many blocks as triangles need with them, in their order, in unit. A degenerate one gets its first vertex
/// three times, so that it is never hit. Returns how many are.
std::size_t fillBlocks(
    std::span<const std::uint32_t> triangles, const Mesh& mesh, float unit, shared::TriangleBlock* blocks);

} // namespace wedge::bvh::detail
