// Closed forms of what lens, shutter and pixels' squares make of edges, and motion of whole scenes.
#pragma once

#include "host/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::test {

/// All vertices move by as much while the shutter is open.
inline void displace(scene::Scene& scene, glm::vec3 by)
{
    scene::Geometry& g = scene.geometry;
    g.positionsAtClose = g.positions;
    g.normalsAtClose = g.normals;
    for (std::size_t i = 0; i < g.positions.size(); ++i)
        g.positionsAtClose[i] += by[static_cast<int>(i % 3)];
}

/// Share of a disc of unit radius to the left of x, weighted by a uniform profile or a Gaussian of which the radius is
/// two standard deviations.
inline double discShare(scene::ApertureProfile profile, double x)
{
    x = std::clamp(x, -1.0, 1.0);
    if (profile == scene::ApertureProfile::Uniform)
        return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / std::numbers::pi;
    // Chords: the integral over each is an error function.
    constexpr int steps = 400;
    const auto left = [&](double to) {
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double u = -1 + (to + 1) * (i + 0.5) / steps;
            sum += std::exp(-2 * u * u) * std::erf(std::numbers::sqrt2 * std::sqrt(1 - u * u)) * (to + 1) / steps;
        }
        return sum;
    };
    static const double all = left(1);
    return left(x) / all;
}

/// Share of the lens through which a pixel sees what lies to the left of `reach` pixels from its middle, with a circle
/// of confusion of that signed radius.
inline double lensShare(scene::ApertureProfile profile, double circle, double reach)
{
    if (std::fabs(circle) < 1e-9)
        return reach > 0 ? 1 : 0;
    // The profile is symmetric: the sign does not matter.
    return discShare(profile, reach / std::fabs(circle));
}

/// Area of the unit square at (x, y) inside a triangle of counter-clockwise or clockwise corners (Sutherland and
/// Hodgman).
inline double coverage(const glm::dvec2 (&corners)[3], double x, double y)
{
    const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
    const double turn = cross(corners[1] - corners[0], corners[2] - corners[0]) > 0 ? 1 : -1;
    std::vector<glm::dvec2> polygon { { x, y }, { x + 1, y }, { x + 1, y + 1 }, { x, y + 1 } };
    for (int side = 0; side < 3 && !polygon.empty(); ++side) {
        const glm::dvec2 a = corners[side], along = corners[(side + 1) % 3] - a;
        std::vector<glm::dvec2> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
            const double dp = turn * cross(along, p - a), dq = turn * cross(along, q - a);
            if (dp >= 0)
                kept.push_back(p);
            if ((dp >= 0) != (dq >= 0))
                kept.push_back(p + (q - p) * (dp / (dp - dq)));
        }
        polygon = kept;
    }
    double doubled = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        doubled += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return 0.5 * std::fabs(doubled);
}

} // namespace wedge::test
