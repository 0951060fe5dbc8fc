// All of a map's light, direction by direction: for sums over it by brute force.
#pragma once

#include "effects/shadow_lights/map_lights.h"
#include "tests/environment_support.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace wedge::test {

/// Directions of a map with their light, as many in each texel as `times` squared.
inline std::vector<render::MapLight> directionsOf(const render::EnvironmentPicture& p, int times)
{
    const int columns = p.width * times, rows = p.height * times;
    std::vector<render::MapLight> out;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const double pi = std::numbers::pi, angle = 2 * pi * ((x + 0.5) / columns - 0.5),
                         down = pi * (y + 0.5) / rows;
            const double solidAngle = 2 * pi / columns * (std::cos(pi * y / rows) - std::cos(pi * (y + 1) / rows));
            const glm::dvec3 towards = std::cos(down) * glm::dvec3(p.up)
                + std::sin(down) * (std::sin(angle) * glm::dvec3(p.right) - std::cos(angle) * glm::dvec3(p.back));
            const std::size_t texel = 3
                * (static_cast<std::size_t>(y / times) * static_cast<std::size_t>(p.width)
                    + static_cast<std::size_t>(x / times));
            const glm::vec3 radiance(p.radiance[texel], p.radiance[texel + 1], p.radiance[texel + 2]);
            out.push_back({ glm::vec3(towards), static_cast<float>(solidAngle) * radiance });
        }
    return out;
}

} // namespace wedge::test
