#pragma once

#include "host/scene/scene.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Lights of one size and power over a floor with a glossy and a matt box before a wall.
struct LampScene {
    std::string name;
    scene::Scene scene;
};

/// quad: one square of [[light]], 0.5 m, emitting to both sides; lamp: the same as a mesh; thousand: a mesh each of a
/// thousandth of its area, spread over 4 x 4 x 1 m; quads64: 64 quads of a 64th.
std::vector<LampScene> lampScenes();

} // namespace wedge::benchmark
