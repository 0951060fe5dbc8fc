// Surfaces that rays find on geometry that moves: where they are at the ray's time, and where they go.
#include "trace/surface.h"
#include "trace/traverse.h"

/// rays: 8 floats each, as in trace_test.cl; times: one each. triangle: what each hit; out: 15 floats each, of that hit
/// u v, then position, shading normal, geometric normal and motion, and the distance to the ray's origin.
__kernel void motionSurface(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_SURFACE_PARAMETERS, __global const float* restrict rays, __global const float* restrict times, uint count,
    __global uint* restrict triangle, __global float* restrict out)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SurfaceData data = WEDGE_SURFACE_ARGUMENTS;
    const float8 ray = vload8(i, rays);
    const Vec3 direction = vec3(ray.s4, ray.s5, ray.s6);
    const Hit hit = closestHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), direction, ray.s3, ray.s7, times[i]);
    triangle[i] = hit.triangle;
    if (hit.triangle == WEDGE_NO_TRIANGLE) {
        return;
    }
    const Surface s = surfaceAt(data, hit, direction, times[i]);
    const Vec3 motion = hitMotion(data, hit);
    const Vec3 vectors[4] = { s.position, s.normal, s.geometric, motion };
    __global float* o = out + 15u * i;
    o[0] = hit.u;
    o[1] = hit.v;
    for (uint k = 0u; k < 4u; ++k) {
        o[2u + 3u * k] = vectors[k].x;
        o[3u + 3u * k] = vectors[k].y;
        o[4u + 3u * k] = vectors[k].z;
    }
    o[14] = hit.t;
}
