#pragma once

#include "benchmarks/harness/scene_result.h"

namespace wedge::benchmark {

/// Measures a scene as the plan says. Throws Error.
SceneResult measureScene(
    const Benchmark& benchmark, const BenchmarkScene& source, const device::Device& device, const MeasurePlan& plan);

} // namespace wedge::benchmark
