#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/soft_shadows/run.h"

#include <vector>

namespace wedge::benchmark {

/// "soft_shadows.<scene>.<quantity>"; docs/benchmarks.md lists the quantities.
std::vector<Claim> claimsOf(const SceneResult& result);

/// All numbers behind the claims and the plots; docs/benchmarks.md has the schema.
Json dataOf(const SceneResult& result);

Json dataOf(const Plan& plan);

} // namespace wedge::benchmark
