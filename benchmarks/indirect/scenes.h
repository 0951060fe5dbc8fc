#pragma once

#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/setting_result.h"

#include <optional>
#include <vector>

namespace wedge::benchmark {

/// What is measured of a scene with paths of so many bounces, or of its ambient occlusion.
struct BounceCase {
    int bounces = 1; ///< 0: ambient occlusion
    const PaperRow* paper = nullptr; ///< of Table 4.1
    std::optional<double> overheadGoal;
    bool errors = true; ///< else times alone
    float ambientDistance = 0; ///< metres within which surfaces occlude; 0: any
};

/// A scene with indirect light.
struct IndirectScene : SceneSource {
    std::vector<BounceCase> cases { {} };
    std::optional<double> samplesSavedGoal, paperSamplesSaved; ///< with one bounce, or of ambient occlusion
    bool curves = false; ///< with those of Fig. 4.10
    bool bias = false; ///< with those of Fig. 4.9
};

/// All scenes with a name: ours, then those that need meshes of others.
const std::vector<IndirectScene>& indirectScenes();

} // namespace wedge::benchmark
