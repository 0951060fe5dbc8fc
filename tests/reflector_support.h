// What the tests of reflectors.cl share.
#pragma once

#include "kernels/shared/path.h"
#include "tests/pass_bench.h"

#include <cmath>

namespace wedge::test {

/// Parameters over a whole image.
inline shared::ReflectorParams paramsFor(const render::PlaneLayout& layout)
{
    shared::ReflectorParams p = paramsOf<shared::ReflectorParams>(layout);
    p.mu = 0.9f;
    p.alpha = 0.3f;
    p.widthScale = 0.5f;
    p.leastReflector = 0.005f;
    p.countCap = 256;
    return p;
}

/// Within a fraction of b, however small that is.
inline bool close(double a, double b, double relative) { return std::fabs(a - b) <= relative * std::fabs(b); }

} // namespace wedge::test
