#pragma once

#include "bvh/reference.h"

#include <vector>

namespace wedge::bvh::detail {

/// Triangles in the order of a Morton curve through their centres, in runs of at most a block: the subtrees of a radix
/// tree that are that small.
struct MortonRuns {
    ReferenceArrays references; ///< one a run, whose index is the run's
    std::vector<std::uint32_t> first; ///< of each run, into triangles, and after the last the number of triangles
    Array<std::uint32_t> triangles;
};

/// Makes runs of the triangles whose vertices are finite and within maxCoordinate. No triangle has a reference of its
/// own on the way: clearing pages for them would take a quarter of the time.
MortonRuns makeMortonRuns(const Mesh& mesh);

} // namespace wedge::bvh::detail
