#pragma once

#include "benchmarks/bvh_build/measure.h"
#include "benchmarks/common/claims.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

struct BuildResults {
    BuildPlan plan;
    std::vector<SceneBuilds> scenes;
    std::vector<std::string> skipped; ///< scenes whose meshes are not there
    device::DeviceInfo machine; ///< the processor, in place of an OpenCL device
};

/// The processor that builds.
device::DeviceInfo describeMachine();

Json resultsOf(const BuildResults& results);
/// Times, ratios and bytes, a line a builder, for a terminal.
std::string tableOf(const SceneBuilds& scene);

} // namespace wedge::benchmark
