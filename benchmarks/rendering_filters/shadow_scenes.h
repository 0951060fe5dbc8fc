#pragma once

#include "benchmarks/common/scene_source.h"

#include <vector>

namespace wedge::benchmark {

/// Four spheres on a plane, all of one material, under one map; docs/shadow-lights.md.
struct ShadowScene : SceneSource {
    bool plainReference = false; ///< its reference is by method mc, since filters blur what it mirrors
    bool hasGoals = false; ///< it is one of those that goals are stated for
};

/// Every material under every map, one map after the other. Maps are below WEDGE_DATA, but for the one of data/scenes.
std::vector<ShadowScene> shadowScenes();

} // namespace wedge::benchmark
