// What is no number, by its bits: fast maths lets compilers take any number for finite.
#ifndef WEDGE_FINITE_H
#define WEDGE_FINITE_H

#include "core/vector16.h"
#include "shared/vec.h"

#define WEDGE_NO_NUMBER 0x7fc00000u

WEDGE_INLINE bool finiteNumber(float v) { return (as_uint(v) & 0x7f800000u) != 0x7f800000u; }

WEDGE_INLINE bool finiteVec(Vec3 v) { return finiteNumber(v.x) && finiteNumber(v.y) && finiteNumber(v.z); }

/// v where there is some, else no number, which filters of images leave out.
WEDGE_INLINE float numberIf(bool there, float v) { return as_float(there ? as_uint(v) : WEDGE_NO_NUMBER); }

WEDGE_INLINE Vec3 vecIf(bool there, Vec3 v)
{
    return vec3(numberIf(there, v.x), numberIf(there, v.y), numberIf(there, v.z));
}

WEDGE_INLINE float16 numberIf16(int16 there, float16 v)
{
    return as_float16(there ? as_uint16(v) : (uint16)(WEDGE_NO_NUMBER));
}

#endif
