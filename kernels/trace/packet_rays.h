// 16 rays as the tests of packets want them.
#ifndef WEDGE_PACKET_RAYS_H
#define WEDGE_PACKET_RAYS_H

#include "trace/packet_lanes.h"

// Lanes by a variable index: compilers of OpenCL C let scalars alias the vectors they make up.
#define WEDGE_LANE(vector, lane) (((const float*)&(vector))[lane])

/// A coordinate of 16 rays, and what the box and triangle tests need of it. All in the units of the hierarchy.
typedef struct {
    float16 origin, direction;
    float16 nearScale, nearOffset, farScale, farOffset; ///< as in TraversalRay
} PacketAxis;

/// 16 rays with their state. Lanes without a ray have tFar < 0.
typedef struct {
    PacketAxis x, y, z;
    float16 tMin, tFar, u, v;
    uint16 triangle;
#ifdef WEDGE_TOUCHING_GLASS
    uint16 after; ///< as in TraversalRay
#endif
    float16 shearX, shearY; ///< as in TraversalRay
    int16 axis; ///< of the largest component of the direction: 0, 1, 2
    float16 testOriginX, testOriginY, testOriginZ; ///< as in TraversalRay
    float16 testDirectionX, testDirectionY, testDirectionZ;
#ifdef WEDGE_MOTION
    float16 time; ///< 0 to 1
#endif
#ifdef WEDGE_CUTOUTS
    __global const uint* cutouts; ///< as in TraversalRay; tracePacket sets it
#endif
} TraversalPacket;

WEDGE_FN PacketAxis packetAxis(float16 origin, float16 direction)
{
#pragma OPENCL FP_CONTRACT ON
    PacketAxis a;
    a.origin = origin;
    a.direction = direction;
    const float16 bounded = fabs(direction) < 1e-30f ? copysign((float16)(1e-30f), direction) : direction;
    const float16 r = 1.0f / bounded;
    const float16 offset = -origin * r;
    const float16 slack = fabs(offset) * WEDGE_WIDEN_ORIGIN + fabs(r) * WEDGE_WIDEN_PLANE;
    a.nearScale = r;
    a.nearOffset = offset - slack;
    a.farScale = r * WEDGE_WIDEN_T;
    a.farOffset = offset * WEDGE_WIDEN_T + slack;
    return a;
}
#pragma OPENCL FP_CONTRACT OFF

WEDGE_FN void loadPacket(const RayPacket* packet, float unit, TraversalPacket* p)
{
    p->x = packetAxis(vload16(0, packet->originX) * unit, vload16(0, packet->directionX) * unit);
    p->y = packetAxis(vload16(0, packet->originY) * unit, vload16(0, packet->directionY) * unit);
    p->z = packetAxis(vload16(0, packet->originZ) * unit, vload16(0, packet->directionZ) * unit);
    const float16 tMin = vload16(0, packet->tMin), tMax = vload16(0, packet->tMax);
    p->tMin = WEDGE_MAX(tMin, (float16)(0.0f));
#ifdef WEDGE_TOUCHING_GLASS
    p->after = vload16(0, packet->after);
#endif
#ifdef WEDGE_MOTION
    const float16 time = vload16(0, packet->time);
    p->time = time > 0.0f ? WEDGE_MIN(time, (float16)(1.0f)) : (float16)(0.0f); // as boundedTime
#endif
    // As in prepareRay.
    const float16 sum = p->x.origin + p->y.origin + p->z.origin + p->x.direction + p->y.direction + p->z.direction;
    const int16 valid = (fabs(sum) < INFINITY) & (p->tMin < tMax);
    // The float before tMax, or before infinity.
    p->tFar = valid ? as_float16(as_uint16(tMax) - 1u) : (float16)(-1.0f);
    p->u = (float16)(0.0f);
    p->v = (float16)(0.0f);
    p->triangle = (uint16)(WEDGE_NO_TRIANGLE);
    const float16 dx = fabs(p->x.direction), dy = fabs(p->y.direction), dz = fabs(p->z.direction);
    const int16 largestX = (dx >= dy) & (dx >= dz);
    const int16 largestY = ~largestX & (dy >= dz);
    p->axis = largestX ? (int16)(0) : largestY ? (int16)(1) : (int16)(2);
    p->testOriginX = largestX ? p->y.origin : largestY ? p->z.origin : p->x.origin;
    p->testOriginY = largestX ? p->z.origin : largestY ? p->x.origin : p->y.origin;
    p->testOriginZ = largestX ? p->x.origin : largestY ? p->y.origin : p->z.origin;
    p->testDirectionX = largestX ? p->y.direction : largestY ? p->z.direction : p->x.direction;
    p->testDirectionY = largestX ? p->z.direction : largestY ? p->x.direction : p->y.direction;
    p->testDirectionZ = largestX ? p->x.direction : largestY ? p->y.direction : p->z.direction;
    p->shearX = p->testDirectionX / p->testDirectionZ;
    p->shearY = p->testDirectionY / p->testDirectionZ;
}

/// The axes of the triangle test.
typedef struct {
    uint x, y,
        z; ///< where their coordinates start in a vertex of a block, in floats; for rays that have them in common
    bool mixed; ///< the rays do not
} TestAxes;

/// The axes of the live rays' tests.
WEDGE_FN TestAxes testAxes(const TraversalPacket* p, int16 live)
{
    const int first = ((const int*)&p->axis)[firstLane16(laneMask16(live))];
    TestAxes axes;
    axes.x = (first == 0 ? 1 : first == 1 ? 2 : 0) * WEDGE_BLOCK_SIZE;
    axes.y = (first == 0 ? 2 : first == 1 ? 0 : 1) * WEDGE_BLOCK_SIZE;
    axes.z = first * WEDGE_BLOCK_SIZE;
    axes.mixed = anyLane(live & (p->axis != first));
    return axes;
}

#endif
