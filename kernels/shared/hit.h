// What a ray found, as kernels store it and the host reads it.
#ifndef WEDGE_SHARED_HIT_H
#define WEDGE_SHARED_HIT_H

#include "bvh_types.h"
#include "compat.h"

WEDGE_SHARED_BEGIN

/// The point origin + t direction = v0 + u (v1 - v0) + v (v2 - v0) of a triangle; u and v are the barycentric
/// weights of its vertices 1 and 2. On a miss triangle is WEDGE_NO_TRIANGLE, t the ray's end, and u = v = 0.
typedef struct {
    float t, u, v;
    uint triangle;
} Hit;

WEDGE_SHARED_END

#if !defined(__OPENCL_VERSION__) && !defined(__OPENCL_C_VERSION__)
static_assert(sizeof(wedge::shared::Hit) == 16);
#endif

#endif
