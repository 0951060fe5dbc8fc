// A scene of soft shadows, and errors of its images.
#pragma once

#include "tests/render_support.h"

#include <cmath>

namespace wedge::test {

/// A ground in the penumbrae of three slats at different heights.
inline scene::Scene slats(scene::LightProfile profile)
{
    SceneBuilder b;
    b.newObject();
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    for (int i = 0; i < 3; ++i) {
        b.newObject();
        b.quad({ -0.6f + 0.6f * static_cast<float>(i), 0.5f + 0.3f * static_cast<float>(i), 0 }, { 0.1f, 0, 0.02f },
            { 0, 0, 0.8f });
    }
    b.light({ 0, 3, 0 }, { 0.4f, 0, 0 }, { 0.1f, 0, 0.3f }, profile, 2).radiance = { 20, 18, 15 };
    b.camera({ 0, 1.6f, 2.8f }, { 0, 0.1f, 0.4f });
    return b.scene;
}

/// RMS over seeds.
inline double errorOf(render::Renderer& renderer, render::Settings s, const std::vector<float>& reference)
{
    double squares = 0;
    constexpr int seeds = 3;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        s.seed = seed;
        const double e = rmse(renderPixels(renderer, s), reference);
        squares += e * e;
    }
    return std::sqrt(squares / seeds);
}

} // namespace wedge::test
