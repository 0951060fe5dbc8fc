#pragma once

#include <cmath>
#include <cstdint>

#include "data/generator/shapes.h"

/// How the lottery draws. Frozen: what a seed draws is the same for good.
namespace wedge::generator {

/// Each subject draws from numbers of its own, so that one that draws more does not shift the others.
enum class Stream : std::uint32_t { Traits, Stage, Materials, Camera, Things, Lights, Emitters, Motion, Lamps, Sky };

inline Random stream(std::uint32_t seed, Stream subject)
{
    return Random(seed * 2654435761u + static_cast<std::uint32_t>(subject) * 40503u + 17u);
}

inline bool chance(Random& random, double probability) { return random.uniform(0, 1) < probability; }

/// From lo to hi, both included.
inline int whole(Random& random, int lo, int hi) { return lo + static_cast<int>(random.uniform(0, 1) * (hi - lo + 1)); }

/// Even over the logarithm.
inline double logarithmic(Random& random, double lo, double hi)
{
    return lo * std::exp(random.uniform(0, 1) * std::log(hi / lo));
}

/// Components of their own in [lo, hi), drawn in order.
inline glm::dvec3 within(Random& random, const glm::dvec3& lo, const glm::dvec3& hi)
{
    const double x = random.uniform(lo.x, hi.x), y = random.uniform(lo.y, hi.y), z = random.uniform(lo.z, hi.z);
    return { x, y, z };
}

/// Of unit length, even over the sphere.
inline glm::dvec3 direction(Random& random)
{
    for (;;) {
        const glm::dvec3 p = random.inBall();
        if (glm::dot(p, p) > 1e-4)
            return glm::normalize(p);
    }
}

} // namespace wedge::generator
