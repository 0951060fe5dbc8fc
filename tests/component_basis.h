// The functions that stand in the place of a light's profile.
#pragma once

#include <cmath>

namespace wedge::test {

/// B_i of kernels/light/components.h.
inline double basis(int count, double bandwidth, int i, double y)
{
    const int pair = (i + 1) / 2;
    const double extent = bandwidth / count, angle = 2 * pair * extent * y;
    return std::exp(-0.5 * extent * extent * y * y) * (i == 0 ? 1.0 : i % 2 == 1 ? std::cos(angle) : std::sin(angle));
}

} // namespace wedge::test
