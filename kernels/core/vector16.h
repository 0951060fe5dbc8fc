// Sixteen neighbouring pixels of a row at once. PoCL does not vectorize a loop over taps across work-items, so the
// filter and analysis passes spell the vector out.
#ifndef WEDGE_VECTOR16_H
#define WEDGE_VECTOR16_H

#include "shared/frame.h"

typedef struct {
    float16 x, y, z;
} Vec3x16;

WEDGE_FN float16 loadBlock(__global const float* plane, int i) { return vload16(0, plane + i); }

WEDGE_FN uint16 loadIdBlock(__global const uint* plane, int i) { return vload16(0, plane + i); }

WEDGE_FN Vec3x16 loadVecBlock(__global const float* planes, uint planeSize, int i)
{
    Vec3x16 v;
    v.x = vload16(0, planes + i);
    v.y = vload16(0, planes + planeSize + i);
    v.z = vload16(0, planes + 2u * planeSize + i);
    return v;
}

WEDGE_FN Vec3x16 splat3(Vec3 a)
{
    Vec3x16 v;
    v.x = (float16)(a.x);
    v.y = (float16)(a.y);
    v.z = (float16)(a.z);
    return v;
}

WEDGE_FN Vec3x16 sub16(Vec3x16 a, Vec3x16 b)
{
    Vec3x16 v;
    v.x = a.x - b.x;
    v.y = a.y - b.y;
    v.z = a.z - b.z;
    return v;
}

WEDGE_FN Vec3x16 mul16(Vec3x16 a, Vec3x16 b)
{
    Vec3x16 v;
    v.x = a.x * b.x;
    v.y = a.y * b.y;
    v.z = a.z * b.z;
    return v;
}

/// a + s b
WEDGE_FN Vec3x16 mad16(Vec3x16 a, Vec3x16 b, float16 s)
{
    Vec3x16 v;
    v.x = a.x + b.x * s;
    v.y = a.y + b.y * s;
    v.z = a.z + b.z * s;
    return v;
}

WEDGE_FN float16 dot16(Vec3x16 a, Vec3x16 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

WEDGE_FN float16 luminance16(Vec3x16 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

WEDGE_FN float16 min16(float16 a, float16 b) { return a < b ? a : b; }
WEDGE_FN float16 max16(float16 a, float16 b) { return a > b ? a : b; }

WEDGE_FN float largestOf(float16 v)
{
    const float8 a = v.lo > v.hi ? v.lo : v.hi;
    const float4 b = a.lo > a.hi ? a.lo : a.hi;
    const float2 c = b.lo > b.hi ? b.lo : b.hi;
    return c.x > c.y ? c.x : c.y;
}

/// 2^x for x up to 126, relative error below 3e-6; below -126 it is 2^-126. Adding 1.5 * 2^23 leaves the nearest
/// whole number in the low bits of the sum; a minimax polynomial of degree 4 does the rest in [-1/2, 1/2].
WEDGE_FN float16 exp2Block(float16 x)
{
    const float16 bounded = max16(x, (float16)(-126.0f));
    const float16 shifted = bounded + 12582912.0f;
    const float16 f = bounded - (shifted - 12582912.0f);
    float16 p = (float16)(9.57010132e-03f);
    p = p * f + 5.59178603e-02f;
    p = p * f + 2.40247448e-01f;
    p = p * f + 6.93121815e-01f;
    p = p * f + 9.99999261e-01f;
    return as_float16(as_int16(p) + (as_int16(shifted) << 23));
}

/// log2 x for normal x > 0, absolute error below 1e-4: the exponent plus (m - 1) times the minimax polynomial of
/// degree 5 of log2(m) / (m - 1) on the mantissa m in [1, 2).
WEDGE_FN float16 log2Block(float16 x)
{
    const int16 bits = as_int16(x);
    const float16 exponent = convert_float16((bits >> 23) - 127);
    const float16 m = as_float16((bits & 0x007fffff) | 0x3f800000);
    float16 p = (float16)(-3.44357996e-2f);
    p = p * m + 3.18211618e-1f;
    p = p * m - 1.23152444f;
    p = p * m + 2.59883559f;
    p = p * m - 3.32419149f;
    p = p * m + 3.11578744f;
    return exponent + p * (m - 1.0f);
}

#endif
