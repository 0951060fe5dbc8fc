// Traces rays from a buffer, for tests and benchmarks of the traversal.
#include "trace/packet.h"

/// The time of ray i of `count`: in programs with WEDGE_MOTION the times follow all the rays.
WEDGE_FN float rayTime(__global const float* rays, uint count, uint i)
{
#ifdef WEDGE_MOTION
    return rays[8 * count + i];
#else
    (void)rays;
    (void)count;
    (void)i;
    return 0.0f;
#endif
}

/// rays: 8 floats a ray, ox oy oz tMin dx dy dz tMax; rayTime() says where times are. hits: one a ray. One work-item a
/// ray; more do nothing.
__kernel void traceClosest(__global const float* restrict rays, __global Hit* restrict hits,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const float8 ray = vload8(i, rays);
    hits[i] = closestHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), vec3(ray.s4, ray.s5, ray.s6), ray.s3, ray.s7,
        rayTime(rays, count, i));
}

/// As traceClosest; occluded: 1 for each ray that hits anything, 0 for the others.
__kernel void traceAny(__global const float* restrict rays, __global uint* restrict occluded,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const float8 ray = vload8(i, rays);
    occluded[i] = anyHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), vec3(ray.s4, ray.s5, ray.s6), ray.s3, ray.s7,
        rayTime(rays, count, i));
}

/// As traceClosest, but a packet a work-item: packets and their hits are structures of arrays, as packet.h has them.
__kernel void traceClosestPackets(__global const RayPacket* restrict packets, __global PacketHits* restrict hits,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const RayPacket packet = packets[i];
    PacketHits found;
    closestHits(nodes, blocks, &packet, &found);
    hits[i] = found;
}

/// As traceAny, but a packet a work-item. occluded: one a ray.
__kernel void traceAnyPackets(__global const RayPacket* restrict packets, __global uint* restrict occluded,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const RayPacket packet = packets[i];
    uint found[WEDGE_PACKET_SIZE];
    anyHits(nodes, blocks, &packet, found);
    for (uint lane = 0; lane < WEDGE_PACKET_SIZE; lane++)
        occluded[i * WEDGE_PACKET_SIZE + lane] = found[lane];
}
