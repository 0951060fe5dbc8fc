#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/rendering_filters/shadow_lab.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// What was measured of a scene.
struct ShadowedScene {
    ShadowScene source;
    double noise = 0; ///< RMS error of the reference by samples
    double exposure = 1;
    int claimedLights = 40;
    std::vector<ShadowPoint> points;
};

std::vector<Claim> claimsOf(const ShadowedScene& scene);
/// Geometric means over the scenes that goals are stated for; empty where none of them is there.
std::vector<Claim> meanClaims(const std::vector<ShadowedScene>& scenes);
Json dataOf(const ShadowedScene& scene);
std::string tableOf(const ShadowedScene& scene);

} // namespace wedge::benchmark
