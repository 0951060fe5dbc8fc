// Three-component vectors as a struct of scalars: PoCL vectorizes these across work-items and does not
// vectorize float3, and the layout is the same on the host.
#ifndef WEDGE_SHARED_VEC_H
#define WEDGE_SHARED_VEC_H

#include "compat.h"

WEDGE_SHARED_BEGIN

typedef struct {
    float x, y, z;
} Vec3;

WEDGE_INLINE Vec3 vec3(float x, float y, float z)
{
    Vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
WEDGE_INLINE Vec3 vecAdd(Vec3 a, Vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
WEDGE_INLINE Vec3 vecSub(Vec3 a, Vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
WEDGE_INLINE Vec3 vecMul(Vec3 a, Vec3 b) { return vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
WEDGE_INLINE Vec3 vecScale(Vec3 a, float s) { return vec3(a.x * s, a.y * s, a.z * s); }
/// a + s b
WEDGE_INLINE Vec3 vecMad(Vec3 a, Vec3 b, float s) { return vec3(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s); }
WEDGE_INLINE float vecDot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WEDGE_INLINE Vec3 vecCross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
WEDGE_INLINE float vecLength(Vec3 a) { return sqrt(vecDot(a, a)); }
/// a or b, number by number: a choice of whole vectors keeps compilers from turning a loop over lanes into vectors (a
/// Vec3 that is returned is a pair of floats and a float to them, and stays so).
WEDGE_INLINE Vec3 vecChoose(bool first, Vec3 a, Vec3 b)
{
    return vec3(first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z);
}
/// a / |a|, or the zero vector where |a| is 0.
WEDGE_INLINE Vec3 vecNormalize(Vec3 a)
{
    const float length = vecLength(a);
    return vecChoose(length > 0.0f, vecScale(a, 1.0f / length), vec3(0.0f, 0.0f, 0.0f));
}

WEDGE_SHARED_END

#endif
