// Passes of the tests of host/graph, whose parameters come from their declarations.
typedef struct {
    uint x0, y0, x1, y1;
    uint width;
} Rectangle;

// A format of the tests' own: 11 bits of precision.
static inline float load_half1(__global const half* plane, size_t size, size_t at)
{
    (void)size;
    return vload_half(at, plane);
}
static inline void store_half1(__global half* plane, size_t size, size_t at, float value)
{
    (void)size;
    vstore_half(value, at, plane);
}

#include "pass/numbered.h"
#ifdef PASS_numbered
__kernel void numbered(PARAMETERS)
{
    const uint x = p.x0 + (uint)get_global_id(0), y = p.y0 + (uint)get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        STORE_out(size, y * p.width + x, vec3((float)x, (float)y, scale));
    }
}
#endif

// Mean of a pixel and its neighbours to both sides.
#include "pass/smoothed.h"
#ifdef PASS_smoothed
__kernel void smoothed(PARAMETERS)
{
    const uint x = p.x0 + (uint)get_global_id(0), y = p.y0 + (uint)get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    Vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    const uint from = x < reach ? 0u : x - reach, to = min(x + reach, p.width - 1u);
    for (uint i = from; i <= to; ++i) {
        sum = vecAdd(sum, LOAD_in(size, y * p.width + i));
    }
    STORE_out(size, y * p.width + x, vecScale(sum, 1.0f / (float)(to - from + 1u)));
}
#endif

#include "pass/added.h"
#ifdef PASS_added
__kernel void added(PARAMETERS)
{
    const uint i = (uint)get_global_id(0);
    if (i < count) {
        STORE_sum(size, i, LOAD_sum(size, i) + (float)(1u + iteration) * LOAD_in(size, i).x);
    }
}
#endif

// As often as each item of each tile is visited, in 16 bits.
#include "pass/visited.h"
#ifdef PASS_visited
__kernel void visited(PARAMETERS)
{
    const uint i = (firstGroup + (uint)get_group_id(0)) * (uint)get_local_size(0) + (uint)get_local_id(0);
    if (i < count) {
        STORE_visits(size, i, LOAD_visits(size, i) + 1.0f);
    }
}
#endif

#include "pass/weighted.h"
#ifdef PASS_weighted
__kernel void weighted(PARAMETERS)
{
    const uint i = (uint)get_global_id(0);
    if (i < count) {
        STORE_sum(size, i, LOAD_sum(size, i) + weight * LOAD_in(size, i).z);
    }
}
#endif
