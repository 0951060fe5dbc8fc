#pragma once

#include "benchmarks/indirect/bias.h"
#include "benchmarks/indirect/curves.h"
#include "benchmarks/indirect/scenes.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Everything measured in one setting with so many bounces.
struct IndirectSetting : SettingResult {
    int bounces = 1; ///< 0: ambient occlusion
    std::optional<FixedBlur> fixedBlur; ///< of the default setting, with one bounce and of ambient occlusion
};

/// Everything measured of one scene.
struct SceneResult {
    IndirectScene source;
    std::size_t triangles = 0;
    std::vector<IndirectSetting> settings; ///< by bounces, the default before the published one
    std::vector<Series> series;
    std::vector<Bias> biases;
    std::map<std::string, Reference> references; ///< by integrandName(), without their pixels
    double seconds = 0; ///< all of it took

    /// Throws std::out_of_range for what was not measured.
    const IndirectSetting& setting(const std::string& name, int bounces) const;
    /// Of the reference with so many bounces; 0 where there is none.
    double noiseOf(int bounces) const;
};

/// Measures a scene as the plan says. Throws Error.
SceneResult measureScene(const IndirectScene& source, const device::Device& device, const Plan& plan);

} // namespace wedge::benchmark
