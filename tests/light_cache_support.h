// Where normals lie in tables of a map's light, by angles and in double.
#pragma once

#include "kernels/shared/shadow_lights.h"
#include "tests/pass_bench.h"

#include <cmath>

namespace wedge::test::shadows {

inline constexpr int side = WEDGE_CACHE_SIDE;

struct NormalDisc {
    explicit NormalDisc(const shared::FrameParams& frame)
        : towards(-glm::normalize(toGlm(frame.forward)))
        , across(glm::normalize(toGlm(frame.right)))
        , down(glm::normalize(toGlm(frame.down)))
    {
        const glm::dvec3 corner =
            toGlm(frame.forward) + 0.5 * frame.width * toGlm(frame.right) + 0.5 * frame.height * toGlm(frame.down);
        const double off = std::acos(glm::dot(glm::normalize(corner), glm::normalize(toGlm(frame.forward))));
        widest = std::acos(-1.0) / 2 + off;
        texels = (0.5 * side - 2) / std::sin(0.5 * widest);
    }
    /// Of a place in texels from the middle of the first one.
    glm::dvec3 normalAt(double x, double y) const
    {
        const double a = x + 0.5 - 0.5 * side, b = y + 0.5 - 0.5 * side;
        const double off = 2 * std::asin(std::min(std::hypot(a, b) / texels, 1.0)), turn = std::atan2(b, a);
        return std::cos(off) * towards + std::sin(off) * (std::cos(turn) * across + std::sin(turn) * down);
    }
    glm::dvec2 placeOf(const glm::dvec3& n) const
    {
        const double off = std::min(std::acos(std::clamp(glm::dot(n, towards), -1.0, 1.0)), widest);
        const double turn = std::atan2(glm::dot(n, down), glm::dot(n, across)), radius = texels * std::sin(0.5 * off);
        return glm::dvec2(radius * std::cos(turn), radius * std::sin(turn)) + glm::dvec2(0.5 * side - 0.5);
    }
    /// Whether pixels may look there.
    static bool inside(int x, int y) { return std::hypot(x + 0.5 - 0.5 * side, y + 0.5 - 0.5 * side) <= 0.5 * side; }

    glm::dvec3 towards, across, down;
    double widest, texels; ///< the largest angle, and of the radius of an angle whose half has the sine 1
};

} // namespace wedge::test::shadows
