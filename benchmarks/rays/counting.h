#pragma once

#include "benchmarks/rays/ray_sets.h"
#include "bvh/bvh.h"

namespace wedge::benchmark {

/// What one ray alone does in a hierarchy, on average.
struct TraversalCounts {
    double nodes = 0; ///< whose 8 boxes are tested
    double blocks = 0; ///< whose 8 triangles are tested
};

/// Counts on the host, with the order of descent that the kernels have, over about `sample` live rays spread over the
/// set.
TraversalCounts countTraversal(const bvh::Bvh& bvh, const RaySet& set, std::size_t sample);

/// The model of what a ray costs at least (docs/benchmarks.md): vector operations of 8 floats that a node and a block
/// take in kernels/trace/intersect.h, and how many of them a core starts in a cycle.
inline constexpr double nodeOperations = 20, blockOperations = 45, operationsPerCycle = 2;

/// Cycles a ray of these counts takes where nothing but the vector units limits it.
double portCycles(const TraversalCounts& counts);

} // namespace wedge::benchmark
