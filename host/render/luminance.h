#pragma once

#include <glm/glm.hpp>

namespace wedge::render {

/// What red, green and blue count for, of linear radiance by the primaries of sRGB. They add up to 1.
inline glm::dvec3 luminanceWeights() { return { 0.2126, 0.7152, 0.0722 }; }

/// Of linear RGB, in its unit.
template <typename Number>
Number luminanceOf(const glm::vec<3, Number, glm::defaultp>& c)
{
    const glm::vec<3, Number, glm::defaultp> weights(luminanceWeights());
    return weights.r * c.r + weights.g * c.g + weights.b * c.b;
}

} // namespace wedge::render
