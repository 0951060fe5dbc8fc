// Means of images against closed forms.
#pragma once

#include "tests/render_support.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>
#include <glm/glm.hpp>

namespace wedge::test {

/// Of the pixels' numbers of one channel, as if they were independent.
struct Mean {
    double value = 0, deviation = 0;
};

inline Mean meanOf(const std::vector<float>& pixels, std::size_t channel)
{
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = channel; i < pixels.size(); i += 3) {
        sum += pixels[i];
        squares += static_cast<double>(pixels[i]) * pixels[i];
        ++count;
    }
    const double mean = sum / count;
    return { mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count) };
}

/// Of the second channel over frames of seeds from 0 on.
inline double meanOverSeeds(render::Renderer& renderer, render::Settings settings, std::uint32_t seeds)
{
    double sum = 0;
    for (settings.seed = 0; settings.seed < seeds; ++settings.seed)
        sum += meanOf(renderPixels(renderer, settings), 1).value;
    return sum / seeds;
}

/// Every channel is `expected` within 3 standard deviations of the image's mean and rounding.
inline void checkMean(const std::vector<float>& pixels, glm::vec3 expected, double slack = 1e-4)
{
    REQUIRE(notFinite(pixels) == 0);
    for (int channel = 0; channel < 3; ++channel) {
        const Mean mean = meanOf(pixels, static_cast<std::size_t>(channel));
        CAPTURE(channel);
        CAPTURE(mean.value);
        CAPTURE(mean.deviation);
        CAPTURE(expected[channel]);
        CHECK(std::abs(mean.value - expected[channel]) <= 3 * mean.deviation + slack * expected[channel]);
    }
}

} // namespace wedge::test
