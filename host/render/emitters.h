#pragma once

#include "host/scene/scene.h"
#include "kernels/shared/emitter.h"

#include <vector>

namespace wedge::render {

/// Whether any triangle emits, when the shutter opens: one that has an area then.
bool hasEmitters(const scene::Scene& scene);

/// The scene's triangles that emit, as kernels choose among them (kernels/light/emitters.h): in proportion to their
/// power, area times the mean luminance of what they emit.
struct EmitterList {
    std::vector<shared::Emitter> list; ///< in the order of the scene's triangles; empty where nothing emits
    std::vector<float> picks; ///< of each triangle of the scene: the probability that a number chooses it
    double power = 0; ///< W/sr, of both sides, as lights' are counted
};

EmitterList emitterList(const scene::Scene& scene);

} // namespace wedge::render
