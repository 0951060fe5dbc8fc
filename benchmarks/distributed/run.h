#pragma once

#include "benchmarks/common/setting_result.h"
#include "benchmarks/distributed/maps.h"
#include "benchmarks/distributed/plan.h"
#include "benchmarks/distributed/scenes.h"
#include "benchmarks/distributed/variant_curves.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Everything measured of one scene.
struct DistributedResult {
    DistributedScene source;
    std::string program; ///< the benchmark's name
    std::size_t triangles = 0;
    int bounces = 0;
    std::vector<SettingResult> settings; ///< the default, then the published one; without what was not asked for
    std::vector<double> raysPerPixel; ///< of each of these: of timed frames where there are any
    std::uint64_t memoryBytes = 0; ///< of a frame of 1024x1024 without its scene
    std::vector<int> budgets; ///< samples of the curves
    int usualSpp = 0; ///< that of the default setting
    std::vector<VariantCurve> curves; ///< empty with times alone
    std::vector<Map> maps;
    std::map<std::string, Reference> references; ///< without their pixels
    double seconds = 0; ///< all of it took

    /// Of the reference; 0 where there is none.
    double noise() const;
    /// Throws std::out_of_range for what was not measured.
    const VariantCurve& curve(const std::string& name) const;
};

/// Measures a scene as the plan says, for the benchmark of that name. Throws Error.
DistributedResult measureScene(const std::string& program, const DistributedScene& source, const device::Device& device,
    const DistributedPlan& plan);

} // namespace wedge::benchmark
