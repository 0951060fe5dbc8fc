#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/rendering_filters/filter_lab.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// What was measured of a scene.
struct FilteredScene {
    std::string name, origin;
    double beautyNoise = 0, indirectNoise = 0; ///< RMS errors of the references
    double exposure = 1; ///< of the beauty
    std::vector<FilterPoint> points;
};

/// Samples that claims are of, where they were measured; else of the largest count.
inline constexpr int claimedSpp = 64;

std::vector<Claim> claimsOf(const FilteredScene& scene);
Json dataOf(const FilteredScene& scene);
std::string tableOf(const FilteredScene& scene);

} // namespace wedge::benchmark
