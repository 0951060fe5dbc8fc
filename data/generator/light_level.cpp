#include "data/generator/light_level.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wedge::generator {

scene::AreaLight gaussianLight(const glm::vec3& centre, const glm::vec3& target, float half)
{
    const glm::vec3 forward = glm::normalize(target - centre);
    scene::AreaLight light;
    light.centre = centre;
    light.halfU = half * glm::normalize(glm::cross(forward, glm::vec3(0.0f, 1.0f, 0.0f)));
    light.halfV = half * glm::normalize(glm::cross(forward, light.halfU)); // cross(halfU, halfV) = forward
    return light;
}

double irradianceOfUnit(const scene::AreaLight& light, const glm::dvec3& point, const glm::dvec3& normal)
{
    constexpr int cells = 64;
    const glm::dvec3 u(light.halfU), v(light.halfV);
    const glm::dvec3 cross = glm::cross(u, v);
    const double cellArea = 4.0 * glm::length(cross) / (cells * cells);
    const glm::dvec3 facing = glm::normalize(cross);
    double sum = 0.0;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const double a = 2.0 * (i + 0.5) / cells - 1.0, b = 2.0 * (j + 0.5) / cells - 1.0;
            const glm::dvec3 to = glm::dvec3(light.centre) + a * u + b * v - point;
            const double distance = glm::length(to);
            const double cosines = std::max(glm::dot(normal, to), 0.0) * std::max(-glm::dot(facing, to), 0.0);
            const bool gaussian = light.profile == scene::LightProfile::Gaussian;
            const double cut = light.cut;
            const double profile = gaussian ? std::exp(-0.5 * cut * cut * (a * a + b * b)) : 1.0;
            sum += profile * cosines / std::pow(distance, 4.0);
        }
    }
    return sum * cellArea;
}

float radianceFor(
    const scene::AreaLight& light, const glm::dvec3& point, const glm::dvec3& normal, double albedo, double level)
{
    return static_cast<float>(level * std::numbers::pi / (albedo * irradianceOfUnit(light, point, normal)));
}

} // namespace wedge::generator
