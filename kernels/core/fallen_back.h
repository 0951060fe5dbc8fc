// What is shown of filtered numbers f that fall back to u (analysis/fallback.cl, which finds own and ratio). Where
// nothing is shared u may hold anything.
#ifndef WEDGE_FALLEN_BACK_H
#define WEDGE_FALLEN_BACK_H

#include "core/vector16.h"

#define WEDGE_FALLEN_BACK(V, name)                                                                                     \
    WEDGE_INLINE V name(V f, V u, V own, V ratio)                                                                      \
    {                                                                                                                  \
        const V scaled = ratio != 0.0f ? f + ratio * f : f;                                                            \
        return own > 0.0f ? scaled + own * (u - scaled) : scaled;                                                      \
    }
WEDGE_FALLEN_BACK(float, fallenBack)
WEDGE_FALLEN_BACK(float16, fallenBack16)

#endif
