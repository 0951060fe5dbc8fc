#pragma once

#include "benchmarks/harness/scene_result.h"

#include <vector>

namespace wedge::benchmark {

/// "<benchmark>.<scene>.<quantity>"; docs/benchmarks.md lists the quantities.
std::vector<Claim> claimsOf(const Benchmark& benchmark, const SceneResult& result);

/// All numbers behind the claims and the plots; docs/benchmarks.md has the schema.
Json dataOf(const Benchmark& benchmark, const SceneResult& result);

Json dataOf(const Benchmark& benchmark, const MeasurePlan& plan);

} // namespace wedge::benchmark
