#pragma once

#include "benchmarks/rays/frame.h"
#include "benchmarks/rays/scenes.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A build of either side.
struct BuildResult {
    std::string name;
    double seconds = 0, bytesPerTriangle = 0;
};

/// All that was measured of one scene.
struct RaySceneResult {
    std::string name, origin;
    std::size_t triangles = 0;
    std::vector<BuildResult> builds;
    std::vector<ClassResult> classes;
    std::optional<FrameResult> frame;
    std::string noFrame; ///< why there is none
};

/// One size of the growing field.
struct GrowthPoint {
    std::size_t triangles = 0;
    std::vector<ClassResult> classes; ///< primary and diffuse
};

RaySceneResult measureRayScene(const RayScene& source, WedgeTracer& tracer, Workers& workers, const RayPlan& plan);

/// Sizes of the field: 10^3 and on, by half decades.
std::vector<std::size_t> growthSizes(int steps);
GrowthPoint measureGrowth(std::size_t triangles, WedgeTracer& tracer, Workers& workers, const RayPlan& plan);

} // namespace wedge::benchmark
