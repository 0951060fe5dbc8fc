// Traces rays from a buffer, for tests and benchmarks of the traversal.
#include "packet.h"

/// rays: 8 floats a ray, ox oy oz tMin dx dy dz tMax. hits: one a ray. One work-item a ray; more do nothing.
__kernel void traceClosest(__global const float* restrict rays, __global Hit* restrict hits,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const float8 ray = vload8(i, rays);
    hits[i] = closestHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), vec3(ray.s4, ray.s5, ray.s6), ray.s3, ray.s7);
}

/// As traceClosest; occluded: 1 for each ray that hits anything, 0 for the others.
__kernel void traceAny(__global const float* restrict rays, __global uint* restrict occluded,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count)
        return;
    const float8 ray = vload8(i, rays);
    occluded[i] = anyHit(nodes, blocks, vec3(ray.s0, ray.s1, ray.s2), vec3(ray.s4, ray.s5, ray.s6), ray.s3, ray.s7);
}

/// Fills a packet with rays first to first + WEDGE_PACKET_SIZE - 1, as far as there are any.
WEDGE_FN void loadRays(__global const float* restrict rays, uint first, uint count, RayPacket* packet)
{
    for (uint lane = 0; lane < WEDGE_PACKET_SIZE; lane++) {
        const float8 ray = vload8(min(first + lane, count - 1), rays);
        const float tMax = first + lane < count ? ray.s7 : 0.0f;
        setRay(packet, lane, vec3(ray.s0, ray.s1, ray.s2), vec3(ray.s4, ray.s5, ray.s6), ray.s3, tMax);
    }
}

/// As traceClosest, WEDGE_PACKET_SIZE consecutive rays a work-item.
__kernel void traceClosestPackets(__global const float* restrict rays, __global Hit* restrict hits,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint first = (uint)get_global_id(0) * WEDGE_PACKET_SIZE;
    if (first >= count)
        return;
    RayPacket packet;
    loadRays(rays, first, count, &packet);
    PacketHits found;
    closestHits(nodes, blocks, &packet, &found);
    for (uint lane = 0; lane < WEDGE_PACKET_SIZE && first + lane < count; lane++)
        hits[first + lane] = packetHit(&found, lane);
}

/// As traceAny, WEDGE_PACKET_SIZE consecutive rays a work-item.
__kernel void traceAnyPackets(__global const float* restrict rays, __global uint* restrict occluded,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks, uint count)
{
    const uint first = (uint)get_global_id(0) * WEDGE_PACKET_SIZE;
    if (first >= count)
        return;
    RayPacket packet;
    loadRays(rays, first, count, &packet);
    uint found[WEDGE_PACKET_SIZE];
    anyHits(nodes, blocks, &packet, found);
    for (uint lane = 0; lane < WEDGE_PACKET_SIZE && first + lane < count; lane++)
        occluded[first + lane] = found[lane];
}
