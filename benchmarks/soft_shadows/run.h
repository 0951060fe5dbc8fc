#pragma once

#include "benchmarks/soft_shadows/ablation.h"
#include "benchmarks/soft_shadows/savings.h"
#include "benchmarks/soft_shadows/scenes.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Everything measured in one setting.
struct ShadowSetting : SettingResult {
    std::vector<Measured> convergence; ///< by mu
};

/// Everything measured of one scene.
struct SceneResult {
    ShadowScene source;
    std::size_t triangles = 0;
    std::vector<ShadowSetting> settings;
    std::optional<FixedBlur> fixedBlur;
    std::vector<Series> series;
    std::map<std::string, Reference> references; ///< by integrandName(), without their pixels
    double seconds = 0; ///< all of it took

    const ShadowSetting& setting(const std::string& name) const;
    /// Of the reference that a setting is measured against; 0 where there is none.
    double noiseOf(const std::string& setting) const;
};

/// Measures a scene as the plan says. Throws Error.
SceneResult measureScene(const ShadowScene& source, const device::Device& device, const Plan& plan);

} // namespace wedge::benchmark
