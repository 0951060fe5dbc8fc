#pragma once

#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/setting_result.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// What a scene is to reach, and what the thesis reports of samples saved.
struct Goals {
    std::optional<double> samplesSaved, samplesSavedPublished, overhead, paperSamplesSaved;
};

/// A scene with soft shadows.
struct ShadowScene : SceneSource {
    const PaperRow* paper = nullptr; ///< of Table 3.1
    Goals goals;
    bool curves = true; ///< with all the curves of Fig. 3.6c
};

/// All scenes with a name: ours, then those of the thesis' authors.
const std::vector<ShadowScene>& shadowScenes();

} // namespace wedge::benchmark
