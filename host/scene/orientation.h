#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace wedge::scene {

/// orientation() where rounding leaves it open.
int exactOrientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// Which way a, b, c turn: 1 counter-clockwise, -1 clockwise, 0 on one line. Exact, as long as products of coordinates
/// neither overflow nor underflow.
inline int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    const double error = 1e-15 * (std::abs(left) + std::abs(right)); // more than three roundings
    return left - right > error ? 1 : right - left > error ? -1 : exactOrientation(a, b, c);
}

/// Twice the signed area of a, b, c, rounded.
inline double doubleArea(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether three points lie on one line; exact as orientation() is.
bool onOneLine(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

} // namespace wedge::scene
