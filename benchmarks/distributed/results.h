#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/distributed/run.h"

#include <vector>

namespace wedge::benchmark {

/// "<benchmark>.<scene>.<quantity>"; docs/benchmarks.md lists the quantities.
std::vector<Claim> claimsOf(const DistributedResult& result);

/// All numbers behind the claims and the plots; docs/benchmarks.md has the schema.
Json dataOf(const DistributedResult& result);

Json dataOf(const DistributedPlan& plan);

} // namespace wedge::benchmark
