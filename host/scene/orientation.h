#pragma once

#include <glm/glm.hpp>

namespace wedge::scene {

/// Which way a, b, c turn: 1 counter-clockwise, -1 clockwise, 0 on one line. Exact where the coordinates are those of
/// single precision.
int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// Twice the signed area of a, b, c, rounded.
inline double doubleArea(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether three points of single precision lie on one line, exactly.
bool onOneLine(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

} // namespace wedge::scene
