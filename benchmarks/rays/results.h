#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/rays/run.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Everything of a run so far.
struct RayResults {
    RayPlan plan;
    std::vector<std::string> skipped; ///< scenes
    std::vector<RaySceneResult> scenes;
    std::vector<GrowthPoint> growth;
    std::string traversal; ///< our family
    std::string countersProblem; ///< why cycles and instructions were not counted, "" if they were
};

std::vector<Claim> claimsOf(const RaySceneResult& scene);
std::vector<Claim> claimsOf(const std::vector<GrowthPoint>& growth);
std::vector<Claim> claimsOf(const RayResults& results);

/// The file that docs/benchmarks.md describes.
Json resultsOf(const RayResults& results, const device::DeviceInfo& device);

} // namespace wedge::benchmark
