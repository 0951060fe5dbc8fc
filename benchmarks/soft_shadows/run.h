#pragma once

#include "benchmarks/soft_shadows/ablation.h"
#include "benchmarks/soft_shadows/lab.h"
#include "benchmarks/soft_shadows/savings.h"
#include "benchmarks/soft_shadows/scenes.h"
#include "benchmarks/soft_shadows/timing.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wedge::benchmark {

/// Everything measured in one setting.
struct SettingResult {
    std::string name; ///< "default" or "published"
    Timing timing;
    /// The rest is empty where only times were measured.
    Method method;
    std::vector<std::pair<Baseline, Savings>> baselines;
    std::vector<Measured> convergence; ///< by mu
};

/// Everything measured of one scene.
struct SceneResult {
    SceneSource source;
    std::string path;
    std::size_t triangles = 0;
    std::vector<SettingResult> settings;
    std::optional<FixedBlur> fixedBlur;
    std::vector<Series> series;
    std::map<std::string, Reference> references; ///< "true integral" and "shading apart", without their pixels
    double seconds = 0; ///< all of it took

    const SettingResult& setting(const std::string& name) const;
};

/// Measures a scene as the plan says. Throws Error.
SceneResult measureScene(const SceneSource& source, const device::Device& device, const Plan& plan);

} // namespace wedge::benchmark
