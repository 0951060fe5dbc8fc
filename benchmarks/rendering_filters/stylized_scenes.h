#pragma once

#include "benchmarks/common/scene_source.h"

#include <vector>

namespace wedge::benchmark {

/// A scene with a light whose shadows have a style.
struct StylizedScene : SceneSource {
    bool hasGoals = false; ///< it is one of those that goals are stated for
};

std::vector<StylizedScene> stylizedScenes();

} // namespace wedge::benchmark
