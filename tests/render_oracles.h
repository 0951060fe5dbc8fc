// Direct light in double, straight from its definitions: what rendering tests measure by.
#pragma once

#include "host/scene/scene.h"

#include <cmath>

#include <glm/glm.hpp>

namespace wedge::test {

inline glm::dvec3 lightNormal(const scene::AreaLight& light)
{
    return glm::normalize(glm::cross(glm::dvec3(light.halfU), glm::dvec3(light.halfV)));
}

inline double lightArea(const scene::AreaLight& light)
{
    return 4 * glm::length(glm::cross(glm::dvec3(light.halfU), glm::dvec3(light.halfV)));
}

/// 1 at the centre; a, b in [-1, 1].
inline double profileAt(const scene::AreaLight& light, double a, double b)
{
    const bool gaussian = light.profile == scene::LightProfile::Gaussian;
    return gaussian ? std::exp(-0.5 * light.cut * light.cut * (a * a + b * b)) : 1.0;
}

inline glm::dvec3 pointOf(const scene::AreaLight& light, double a, double b)
{
    return glm::dvec3(light.centre) + a * glm::dvec3(light.halfU) + b * glm::dvec3(light.halfV);
}

/// cos cos / d^2 of receiver normal n, vector d to the light and light normal m.
inline double geometry(glm::dvec3 n, glm::dvec3 d, glm::dvec3 m, bool twoSided)
{
    const double receiver = glm::dot(n, d);
    const double emitter = twoSided ? std::fabs(glm::dot(m, d)) : -glm::dot(m, d);
    const double squared = glm::dot(d, d);
    return receiver > 0 && emitter > 0 ? receiver * emitter / (squared * squared) : 0.0;
}

/// Irradiance of a uniform quad of radiance 1 wholly above the receiver's horizon: Lambert's sum over edges.
inline double lambertIrradiance(const scene::AreaLight& light, glm::dvec3 position, glm::dvec3 normal)
{
    const double corners[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 from = glm::normalize(pointOf(light, corners[i][0], corners[i][1]) - position);
        const int next = (i + 1) % 4;
        const glm::dvec3 to = glm::normalize(pointOf(light, corners[next][0], corners[next][1]) - position);
        const glm::dvec3 across = glm::cross(from, to);
        const double angle = std::atan2(glm::length(across), glm::dot(from, to));
        sum += angle * glm::dot(normal, glm::normalize(across));
    }
    return 0.5 * std::fabs(sum);
}

} // namespace wedge::test
