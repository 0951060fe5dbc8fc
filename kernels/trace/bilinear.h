// Which four texels a look-up lies between, repeated outside [0, 1).
#ifndef WEDGE_BILINEAR_H
#define WEDGE_BILINEAR_H

#include "shared/compat.h"

typedef struct {
    uint x0, x1, y0, y1; ///< columns and rows
    float fx, fy; ///< how far from the first to the second
} Bilinear;

/// i modulo n for -1 <= i <= n, n >= 1.
WEDGE_FN uint wrapIndex(int i, uint n) { return i < 0 ? n - 1u : (uint)i < n ? (uint)i : 0u; }

/// At (u, v), v up; false where these are no numbers.
WEDGE_FN bool bilinearAt(uint width, uint height, float u, float v, Bilinear* b)
{
    // Reduced to one period first: an integer conversion of a huge coordinate is undefined.
    const float x = (u - floor(u)) * (float)width - 0.5f;
    const float y = (v - floor(v)) * (float)height - 0.5f;
    if (!(fabs(x) < 1e9f) || !(fabs(y) < 1e9f)) {
        return false;
    }
    b->fx = x - floor(x);
    b->fy = y - floor(y);
    b->x0 = wrapIndex((int)floor(x), width);
    b->y0 = wrapIndex((int)floor(y), height);
    b->x1 = wrapIndex((int)b->x0 + 1, width);
    b->y1 = wrapIndex((int)b->y0 + 1, height);
    return true;
}

#endif
