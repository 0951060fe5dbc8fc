// Rays in packets: WEDGE_PACKET_SIZE neighbours that run through much the same nodes, such as those of a block of
// pixels to the eye or to one light. Any set of rays is traced right; distant ones only gain nothing.
//
// Callers fill a RayPacket in a loop over its lanes, and read the hits in another. Where the device has no use for
// packets (the scalar family), a packet is one ray and the same kernels run with loops of one.
#ifndef WEDGE_PACKET_H
#define WEDGE_PACKET_H

#include "core/packet_size.h"
#include "trace/traverse.h"

/// The rays origin + t direction, tMin < t < tMax, at their times; the conditions of closestHit. A lane without a ray
/// has tMax = 0.
typedef struct {
    float originX[WEDGE_PACKET_SIZE], originY[WEDGE_PACKET_SIZE], originZ[WEDGE_PACKET_SIZE], tMin[WEDGE_PACKET_SIZE];
    float directionX[WEDGE_PACKET_SIZE], directionY[WEDGE_PACKET_SIZE], directionZ[WEDGE_PACKET_SIZE];
    float tMax[WEDGE_PACKET_SIZE];
#ifdef WEDGE_TOUCHING_GLASS
    uint after[WEDGE_PACKET_SIZE]; ///< closestHitAfter()'s
#endif
#ifdef WEDGE_MOTION
    float time[WEDGE_PACKET_SIZE];
#endif
} RayPacket;

/// As Hit, lane by lane.
typedef struct {
    float t[WEDGE_PACKET_SIZE], u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    uint triangle[WEDGE_PACKET_SIZE];
} PacketHits;

WEDGE_INLINE void setRay(RayPacket* packet, uint lane, Vec3 origin, Vec3 direction, float tMin, float tMax)
{
    packet->originX[lane] = origin.x;
    packet->originY[lane] = origin.y;
    packet->originZ[lane] = origin.z;
    packet->directionX[lane] = direction.x;
    packet->directionY[lane] = direction.y;
    packet->directionZ[lane] = direction.z;
    packet->tMin[lane] = tMin;
    packet->tMax[lane] = tMax;
#ifdef WEDGE_TOUCHING_GLASS
    packet->after[lane] = WEDGE_NO_TRIANGLE;
#endif
}

#ifdef WEDGE_TOUCHING_GLASS
/// Lets a lane's ray begin behind a hit: at its t other triangles count if they come after it in the order in which
/// closestHits() finds them.
WEDGE_INLINE void beginBehind(RayPacket* packet, uint lane, float t, uint triangle)
{
    packet->tMin[lane] = t;
    packet->after[lane] = triangle;
}
#endif

/// Sets the time of a lane's ray, from 0, where the shutter opens, to 1, where it closes. Each lane of a packet needs
/// one before it is traced, with a ray or without. Where nothing moves there is nothing to do.
WEDGE_INLINE void setTime(RayPacket* packet, uint lane, float time)
{
#ifdef WEDGE_MOTION
    packet->time[lane] = time;
#else
    (void)packet;
    (void)lane;
    (void)time;
#endif
}

/// The time of a lane's ray; 0 where nothing moves.
WEDGE_INLINE float timeOf(const RayPacket* packet, uint lane)
{
#ifdef WEDGE_MOTION
    return packet->time[lane];
#else
    (void)packet;
    (void)lane;
    return 0.0f;
#endif
}

WEDGE_INLINE Vec3 rayStart(const RayPacket* packet, uint lane)
{
    return vec3(packet->originX[lane], packet->originY[lane], packet->originZ[lane]);
}

WEDGE_INLINE Vec3 rayDirection(const RayPacket* packet, uint lane)
{
    return vec3(packet->directionX[lane], packet->directionY[lane], packet->directionZ[lane]);
}

WEDGE_INLINE Hit packetHit(const PacketHits* hits, uint lane)
{
    Hit hit;
    hit.t = hits->t[lane];
    hit.u = hits->u[lane];
    hit.v = hits->v[lane];
    hit.triangle = hits->triangle[lane];
    return hit;
}

#ifdef WEDGE_TRAVERSAL_SCALAR

/// closestHit() of each lane. A lane without a ray hits nothing.
WEDGE_FN void closestHits(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const RayPacket* packet, PacketHits* hits)
{
#ifdef WEDGE_TOUCHING_GLASS
    const uint after = packet->after[0];
#else
    const uint after = WEDGE_NO_TRIANGLE;
#endif
    const Hit hit = closestHitAfter(nodes, blocks, vec3(packet->originX[0], packet->originY[0], packet->originZ[0]),
        vec3(packet->directionX[0], packet->directionY[0], packet->directionZ[0]), packet->tMin[0], after,
        packet->tMax[0], timeOf(packet, 0));
    hits->t[0] = hit.t;
    hits->u[0] = hit.u;
    hits->v[0] = hit.v;
    hits->triangle[0] = hit.triangle;
}

/// anyHit() of each lane: 1 or 0.
WEDGE_FN void anyHits(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const RayPacket* packet, uint* occluded)
{
    occluded[0] = anyHit(nodes, blocks, vec3(packet->originX[0], packet->originY[0], packet->originZ[0]),
        vec3(packet->directionX[0], packet->directionY[0], packet->directionZ[0]), packet->tMin[0], packet->tMax[0],
        timeOf(packet, 0));
}

#else
#include "trace/packet_wide.h"
#endif

#endif
