// Frames with filters of samples (host/render/filter_chain.h), and what they show.
#pragma once

#include "tests/render_support.h"

#include <string>
#include <vector>

namespace wedge::test {

inline render::Settings with(render::Settings settings, const render::ChosenFilter& filter)
{
    settings.filters = { filter };
    return settings;
}

/// A plane of the frame that these settings make, as far as it is shown. layers: whether it is made with all of them.
inline std::vector<float> rendered(render::Renderer& renderer, const render::Settings& settings,
    const std::string& plane = "beauty", bool layers = false)
{
    renderer.render(settings, {}, layers);
    return pixels(renderer, plane, render::outputWindow(settings));
}

inline double sumOf(const std::vector<float>& values)
{
    double sum = 0;
    for (const float v : values)
        sum += v;
    return sum;
}

} // namespace wedge::test
