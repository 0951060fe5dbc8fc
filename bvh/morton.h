#pragma once

#include "bvh/reference.h"

#include <vector>

namespace wedge::bvh::detail {

/// Triangles in the order of a Morton curve through their centres, in runs of at most a block: the subtrees of a radix
/// tree that are that small.
struct MortonRuns {
    ReferenceArrays references; ///< one a run, whose index is the run's
    std::vector<std::uint32_t> first; ///< of each run, into triangles, and after the last the number of triangles
    std::unique_ptr<std::uint32_t[]> triangles;
};

/// Sorts references of triangles and makes runs of them.
MortonRuns makeMortonRuns(ReferenceArrays references);

} // namespace wedge::bvh::detail
