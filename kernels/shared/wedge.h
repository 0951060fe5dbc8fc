// The frequency analysis of soft shadows (thesis chapter 3): slopes of the occlusion's double wedge, from them
// the spatial bandlimit, the width of the image filter and the number of samples.
#ifndef WEDGE_SHARED_WEDGE_H
#define WEDGE_SHARED_WEDGE_H

#include "compat.h"

/// Explicit bounds of measured slopes: contacts (an occluder at the receiver), of suns that are far behind a large
/// floor (effects/environment/suns.cpp), too; and occluders at the light.
#define WEDGE_SLOPE_MIN 1e-6f
#define WEDGE_SLOPE_MAX 1e3f
/// Rays of the first pass, 3 x 3 strata (section 3.6).
#define WEDGE_FIRST_PASS_RAYS 9u

WEDGE_SHARED_BEGIN

/// Samples in the first of two parts of n samples, from whose difference their noise is known (fallback.cl): a half, or
/// where that would end within the first pass, of so many rays, half of that pass. Parts are runs of indices: the even
/// and the odd points of a Sobol sequence lie in different halves of the light.
WEDGE_FN uint firstPart(uint n, uint firstPass) { return n >= 2u * firstPass ? n / 2u : firstPass / 2u; }

/// Slope s = d1/d2 - 1 of an occluder at parameter t of a shadow ray that runs from the receiver (0) to the light
/// (1): d1 = 1 and d2 = 1 - t up to the ray's length (section 3.3). Clamped to [WEDGE_SLOPE_MIN, WEDGE_SLOPE_MAX].
WEDGE_FN float slopeOfHit(float t) { return clamp(t / fmax(1.0f - t, 1e-6f), WEDGE_SLOPE_MIN, WEDGE_SLOPE_MAX); }

/// Standard deviation of the world-space image filter, metres, equation (3.13):
/// beta = 1/(k mu) max(sigma s_min, 1/Omega_x_max), Omega_x_max = alpha / ((1 + s_min) d), (3.6).
/// sigma: light's standard deviation in metres; pixelSize: d, metres.
WEDGE_FN float filterWidth(float sMin, float sigma, float pixelSize, float k, float mu, float alpha)
{
    return fmax(sigma * sMin, (1.0f + sMin) * pixelSize / alpha) / (k * mu);
}

/// Samples a pixel needs, equation (3.21), as a real number. pixelSize = sqrt(A_p) and lightSize = sqrt(A_l), metres.
WEDGE_FN float sampleCount(float sMin, float sMax, float pixelSize, float lightSize, float mu, float alpha)
{
    const float angular = 1.0f + mu * sMax / sMin;
    const float spatial = mu * (2.0f / sMin) * (pixelSize / lightSize) + alpha / (1.0f + sMin);
    return 4.0f * angular * angular * spatial * spatial;
}

WEDGE_SHARED_END

#endif
