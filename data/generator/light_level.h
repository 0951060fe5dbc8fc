#pragma once

#include "host/scene/scene.h"

namespace wedge::generator {

/// A square Gaussian light (cut at 2 standard deviations) of half side `half` around `centre` that faces `target`.
scene::AreaLight gaussianLight(const glm::vec3& centre, const glm::vec3& target, float half);

/// Irradiance at an unoccluded point per unit of the light's radiance: the integral over the light of
/// profile cos cos' / r^2, by the midpoint rule.
double irradianceOfUnit(const scene::AreaLight& light, const glm::dvec3& point, const glm::dvec3& normal);

/// The radiance at which a diffuse surface of this albedo at that point, alone, sends out `level`.
float radianceFor(
    const scene::AreaLight& light, const glm::dvec3& point, const glm::dvec3& normal, double albedo, double level);

} // namespace wedge::generator
