#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/rendering_filters/stylized_lab.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// With goals where frames have the size that these are stated for.
std::vector<Claim> claimsOf(const StylizedResult& scene, const StylizedPlan& plan);
Json dataOf(const StylizedResult& scene, const StylizedPlan& plan);
std::string tableOf(const StylizedResult& scene, const StylizedPlan& plan);

} // namespace wedge::benchmark
