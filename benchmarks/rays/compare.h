#pragma once

#include "benchmarks/rays/ray_sets.h"
#include "bvh/bvh.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A ray on whose hit the two sides differ, and what double precision says.
struct Disagreement {
    std::size_t ray = 0;
    shared::Hit ours {}, theirs {};
    std::string kind; ///< of disagreementKinds()
    std::string right; ///< "ours", "embree", "both" where only rounding decides
    /// How far the ray passes from the nearest edge of the triangle in question, in units of the last place of the
    /// largest coordinate involved.
    double edgeUlps = 0;
    double trueT = 0; ///< of that triangle's plane
};

/// "tie": two triangles at one distance; "edge": the ray passes an edge within rounding; "end": the hit is at an end of
/// the ray within rounding; "rounded t": one triangle, at distances that differ by rounding alone; "unexplained".
const std::vector<std::string>& disagreementKinds();

/// The differences of one ray set. Distances that agree within 1 part in 10^4 on the same triangle are no difference.
struct Comparison {
    std::size_t rays = 0;
    std::vector<Disagreement> disagreements;
    std::size_t count(const std::string& kind) const;
    std::size_t unexplained() const { return count("unexplained"); }
    /// Those in which one side is right beyond rounding or by it, "ours", "embree" or "both".
    std::size_t right(const std::string& side) const;
};

/// Compares nearest hits.
Comparison compareHits(const bvh::Mesh& mesh, const RaySet& set, const std::vector<shared::Hit>& ours,
    const std::vector<shared::Hit>& theirs);

/// Compares whether there is a hit. For rays that differ, the nearest hits are asked for and judged.
Comparison compareOccluded(const bvh::Mesh& mesh, const RaySet& set, const std::vector<std::uint32_t>& ours,
    const std::vector<std::uint32_t>& theirs, const std::function<shared::Hit(const bvh::Ray&)>& ourNearest,
    const std::function<shared::Hit(const bvh::Ray&)>& theirNearest);

} // namespace wedge::benchmark
