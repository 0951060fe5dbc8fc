// What is shown of filtered numbers f that fall back to u (analysis/fallback.cl, which finds own and ratio). Where
// nothing is shared u may hold anything.
#ifndef WEDGE_FALLEN_BACK_H
#define WEDGE_FALLEN_BACK_H

#include "core/vector16.h"
#include "shared/vec.h"

#define WEDGE_FALLEN_BACK(V, name)                                                                                     \
    WEDGE_INLINE V name(V f, V u, V own, V ratio)                                                                      \
    {                                                                                                                  \
        const V scaled = ratio != 0.0f ? f + ratio * f : f;                                                            \
        return own > 0.0f ? scaled + own * (u - scaled) : scaled;                                                      \
    }
WEDGE_FALLEN_BACK(float, fallenBack)
WEDGE_FALLEN_BACK(float16, fallenBack16)

/// share: own, ratio
WEDGE_INLINE Vec3 fallenBackVec(Vec3 f, Vec3 u, float2 share)
{
    return vec3(fallenBack(f.x, u.x, share.x, share.y), fallenBack(f.y, u.y, share.x, share.y),
        fallenBack(f.z, u.z, share.x, share.y));
}

#endif
