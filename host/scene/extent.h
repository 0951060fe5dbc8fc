#pragma once

#include <algorithm>
#include <limits>

#include <glm/glm.hpp>

namespace wedge::scene {

/// The box around points.
struct Extent {
    glm::dvec3 lo { std::numeric_limits<double>::max() }, hi { std::numeric_limits<double>::lowest() };

    void add(const glm::dvec3& p)
    {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    double size() const { return largestOf(hi - lo); } ///< its longest side
    double distance() const { return largestOf(glm::max(glm::abs(lo), glm::abs(hi))); } ///< the largest coordinate

private:
    static double largestOf(const glm::dvec3& v) { return std::max({ v.x, v.y, v.z }); }
};

} // namespace wedge::scene
