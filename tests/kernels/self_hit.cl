// Rays that leave a surface in all directions above it: does any come back to the triangle that it started from?
#include "trace/surface.h"
#include "trace/traverse.h"

/// rays: 8 floats each, as in trace_test.cl; directions: 3 floats each, unit.
/// out: triangle hit first and how many of the rays from there hit it again; points: position and origin (6 floats).
__kernel void selfHit(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_SURFACE_PARAMETERS, __global const float* restrict rays, uint count,
    __global const float* restrict directions, uint directionCount, float length, __global uint* restrict triangle,
    __global uint* restrict returns, __global float* restrict points)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const float8 ray = vload8(i, rays);
    const Vec3 toward = vec3(ray.s4, ray.s5, ray.s6);
    const Hit hit = closestHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), toward, ray.s3, ray.s7, 0.0f);
    triangle[i] = hit.triangle;
    returns[i] = 0u;
    if (hit.triangle == WEDGE_NO_TRIANGLE) {
        return;
    }
    const Surface s = surfaceAt(WEDGE_SURFACE_ARGUMENTS, hit, toward, 0.0f);
    points[6u * i] = s.position.x;
    points[6u * i + 1u] = s.position.y;
    points[6u * i + 2u] = s.position.z;
    points[6u * i + 3u] = s.origin.x;
    points[6u * i + 4u] = s.origin.y;
    points[6u * i + 5u] = s.origin.z;
    for (uint k = 0u; k < directionCount; ++k) {
        Vec3 d = vec3(directions[3u * k], directions[3u * k + 1u], directions[3u * k + 2u]);
        const float side = vecDot(d, s.geometric);
        if (fabs(side) < 1e-4f) {
            continue;
        }
        d = vecScale(d, side < 0.0f ? -length : length);
        returns[i] += closestHit(nodes, blocks, s.origin, d, 0.0f, 0.9999f, 0.0f).triangle == hit.triangle ? 1u : 0u;
    }
}
