#pragma once

#include <glm/glm.hpp>

namespace wedge::scene {

/// What single precision makes of a number. By way of memory: g++ 12 leaves the rounding out where it works on two
/// numbers at once (double to float and back, by SSE).
inline double inSingle(double value)
{
    const volatile float single = static_cast<float>(value);
    return double { single };
}

inline glm::dvec2 inSingle(const glm::dvec2& v) { return { inSingle(v.x), inSingle(v.y) }; }

inline glm::dvec3 inSingle(const glm::dvec3& v) { return { inSingle(v.x), inSingle(v.y), inSingle(v.z) }; }

} // namespace wedge::scene
