// Elementary functions as straight-line code, unlike the library's: loops over samples become vectors, and the host
// computes the same bits.
#ifndef WEDGE_SHARED_MATHS_H
#define WEDGE_SHARED_MATHS_H

#include "compat.h"

WEDGE_SHARED_BEGIN

/// log(1 + z) = z - z^2/2 + z^3 P(z) for 1 + z in [1/sqrt 2, sqrt 2]; P is a least-squares fit.
WEDGE_INLINE float logNearOne(float z)
{
    float p = -0.0766083002f;
    p = 0.127863303f + p * z;
    p = -0.131616011f + p * z;
    p = 0.141978756f + p * z;
    p = -0.166227534f + p * z;
    p = 0.200014129f + p * z;
    p = -0.250008464f + p * z;
    p = 0.333333284f + p * z;
    return z - 0.5f * z * z + z * z * z * p;
}

/// The power of two that leaves x / 2^it in [1/sqrt 2, sqrt 2), and in *z that quotient less 1.
WEDGE_INLINE float splitPositive(float x, float* z)
{
    const uint shifted = as_uint(x) + (0x3f800000u - 0x3f3504f3u);
    *z = as_float((shifted & 0x007fffffu) + 0x3f3504f3u) - 1.0f;
    return (float)((int)(shifted >> 23) - 127);
}

/// Natural logarithm of a normal x > 0, to 4e-8 of max(1, |log x|).
WEDGE_INLINE float logPositive(float x)
{
    float z;
    const float exponent = splitPositive(x, &z);
    return exponent * 0.693147181f + logNearOne(z);
}

/// 2^x for x up to 126, relative error below 3e-7; below -126 it is 2^-126. Adding 1.5 * 2^23 leaves the nearest whole
/// number in the low bits of the sum; a Taylor polynomial does the rest in [-1/2, 1/2].
WEDGE_INLINE float exp2Bounded(float x)
{
    const float bounded = x > -126.0f ? x : -126.0f;
    const float shifted = bounded + 12582912.0f;
    const float f = bounded - (shifted - 12582912.0f);
    float p = 0.000154035304f;
    p = 0.00133335581f + p * f;
    p = 0.00961812911f + p * f;
    p = 0.0555041087f + p * f;
    p = 0.240226507f + p * f;
    p = 0.693147181f + p * f;
    p = 1.0f + p * f;
    return as_float(as_uint(p) + (as_uint(shifted) << 23));
}

/// x^y for a normal x > 0 and y log2 x up to 126; relative error 5e-7 of max(1, |y log2 x|). Below 2^-126 it is 2^-126.
WEDGE_INLINE float powPositive(float x, float y)
{
    float z;
    const float exponent = splitPositive(x, &z);
    return exp2Bounded(y * (exponent + 1.44269504f * logNearOne(z)));
}

/// Sine and cosine of 2 pi turn, turn in [0, 1], to 3e-7: in eighths of a turn by their series.
WEDGE_INLINE void sinCosTurn(float turn, float* sine, float* cosine)
{
    const int quarter = (int)(4.0f * turn + 0.5f);
    const float x = 6.28318531f * (turn - 0.25f * (float)quarter);
    const float q = x * x;
    const float s = x * (1.0f - q * (0.166666667f - q * (0.00833333333f - q * 0.000198412698f)));
    const float c = 1.0f - q * (0.5f - q * (0.0416666667f - q * (0.00138888889f - q * 0.0000248015873f)));
    const float a = (quarter & 1) != 0 ? c : s;
    const float b = (quarter & 1) != 0 ? s : c;
    *sine = (quarter & 2) != 0 ? -a : a;
    *cosine = ((quarter + 1) & 2) != 0 ? -b : b;
}

/// The angle of (x, y) in turns, atan2(y, x) / (2 pi), from -1/2 to 1/2, to 1e-7; 0 of (0, 0). Up to an eighth it is
/// the lesser over the greater times a polynomial of its square, whose largest error is least.
WEDGE_INLINE float turnOf(float y, float x)
{
    const float ax = fabs(x), ay = fabs(y);
    const float greater = fmax(ax, ay);
    const float t = greater > 1e-30f ? fmin(ax, ay) / greater : 0.0f; // no quotient of what devices take for 0
    const float q = t * t;
    float p = 0.00108413f;
    p = -0.00534827f + p * q;
    p = 0.01267249f + p * q;
    p = -0.02106151f + p * q;
    p = 0.03152512f + p * q;
    p = -0.05302624f + p * q;
    p = 0.15915432f + p * q;
    const float toEighth = t * p;
    const float toQuarter = ay > ax ? 0.25f - toEighth : toEighth;
    const float toHalf = x < 0.0f ? 0.5f - toQuarter : toQuarter;
    return y < 0.0f ? -toHalf : toHalf;
}

WEDGE_SHARED_END

#endif
