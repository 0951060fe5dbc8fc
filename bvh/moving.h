#pragma once

#include "bvh/bvh.h"

namespace wedge::bvh {

/// A hierarchy over triangles that move while the shutter is open, each vertex in a straight line at an even pace, in
/// the layout of kernels/shared/bvh_types.h for programs with WEDGE_MOTION. At time t in [0, 1] a box is plane + t
/// move, and contains all that is below it at that time.
struct MovingBvh {
    Array<shared::MovingNode> nodes; ///< as Bvh::nodes
    Array<shared::MovingTriangleBlock> blocks; ///< as Bvh::blocks
    Statistics statistics; ///< sahCost: the mean over time; degenerate: at both ends and halfway
};

/// Builds the hierarchy of mesh, whose positions are those when the shutter opens; positionsAtClose are those when it
/// closes, as many. The tree is that of the triangles halfway, where each is nearest to the mean of where it has been;
/// with spatial splits allowed (Mode::Quality), which moving triangles cannot have, of the trees at the opening,
/// halfway and at the closing the one that costs least over time. Triangles with a vertex that is not finite or beyond
/// maxCoordinate at either end are left out. As deterministic as build(). Asserts that sizes and indices are valid.
MovingBvh buildMoving(const Mesh& mesh, std::span<const float> positionsAtClose, const Config& config = {});

} // namespace wedge::bvh
