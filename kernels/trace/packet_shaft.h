// One shaft around the rays of a packet against 8 boxes, and the rays against each of them.
#ifndef WEDGE_PACKET_SHAFT_H
#define WEDGE_PACKET_SHAFT_H

#include "trace/packet_rays.h"

/// One axis of the shaft: points of all rays at t lie between lowOrigin + t lowDirection and highOrigin + t
/// highDirection, and each of the two ends bounds t by a plane of a box: from below or from above.
typedef struct {
    float nearScale, nearOffset; ///< t >= plane scale + offset
    float farScale, farOffset; ///< t <= plane scale + offset; infinite where directions differ in sign
    float turnedScale, turnedOffset; ///< a second t >=, of the high plane, where directions differ in sign
    uint nearPlane, farPlane; ///< in floats from the node's start
} ShaftAxis;

typedef struct {
    ShaftAxis x, y, z;
    float tMin;
    bool turned; ///< the directions of an axis differ in sign
} Shaft;

/// What the live rays of a packet span: 16 reductions at once cost a third of one after the other.
typedef struct {
    float lowOrigin[3], highOrigin[3], lowScale[3], highScale[3]; ///< x, y, z; of origin and nearScale
    float tMin;
} PacketExtent;

WEDGE_FN PacketExtent packetExtent(const TraversalPacket* p, int16 live)
{
    const float16 none = (float16)(3e38f);
    const float16 low = mergeEighths(mergeQuarters(mergeHalves(live ? p->x.origin : none, live ? p->y.origin : none),
                                         mergeHalves(live ? p->z.origin : none, live ? p->x.nearScale : none)),
        mergeQuarters(mergeHalves(live ? p->y.nearScale : none, live ? p->z.nearScale : none),
            mergeHalves(live ? p->tMin : none, none)));
    const float16 high = mergeEighths(mergeQuarters(mergeHalves(live ? -p->x.origin : none, live ? -p->y.origin : none),
                                          mergeHalves(live ? -p->z.origin : none, live ? -p->x.nearScale : none)),
        mergeQuarters(mergeHalves(live ? -p->y.nearScale : none, live ? -p->z.nearScale : none), none));
    float least[16];
    vstore16(mergeSixteenths(low, high), 0, least);
    PacketExtent e;
    for (int axis = 0; axis < 3; axis++) {
        e.lowOrigin[axis] = least[axis];
        e.lowScale[axis] = least[3 + axis];
        e.highOrigin[axis] = -least[8 + axis];
        e.highScale[axis] = -least[11 + axis];
    }
    e.tMin = least[6];
    return e;
}

/// One axis of the shaft around the live rays. start: that of the axis' low planes in a node, in floats. turned: set
/// where directions differ in sign.
WEDGE_FN ShaftAxis shaftAxis(const PacketExtent* extent, int axis, const PacketAxis* a, int16 live, bool* turned)
{
#pragma OPENCL FP_CONTRACT ON
    const uint start = 2 * WEDGE_BVH_WIDTH * axis;
    const float lowOrigin = extent->lowOrigin[axis], highOrigin = extent->highOrigin[axis];
    const float lowScale = extent->lowScale[axis], highScale = extent->highScale[axis];
    ShaftAxis s;
    s.turnedScale = 0.0f;
    s.turnedOffset = 0.0f;
    if (lowScale > 0.0f || highScale < 0.0f) {
        const bool up = lowScale > 0.0f;
        // The fastest ray that starts farthest ahead bounds where the shaft enters; negative values do not matter.
        const float nearScale = up ? lowScale : highScale, nearOrigin = up ? highOrigin : lowOrigin;
        const float farScale = up ? highScale : lowScale, farOrigin = up ? lowOrigin : highOrigin;
        const float nearOffset = -nearOrigin * nearScale, farOffset = -farOrigin * farScale;
        s.nearScale = nearScale;
        s.nearOffset = nearOffset - (fabs(nearOffset) * WEDGE_WIDEN_ORIGIN + fabs(nearScale) * WEDGE_WIDEN_PLANE);
        s.farScale = farScale * WEDGE_WIDEN_T;
        s.farOffset =
            farOffset * WEDGE_WIDEN_T + fabs(farOffset) * WEDGE_WIDEN_ORIGIN + fabs(farScale) * WEDGE_WIDEN_PLANE;
        s.nearPlane = start + (up ? 0 : WEDGE_BVH_WIDTH);
        s.farPlane = start + (up ? WEDGE_BVH_WIDTH : 0);
        return s;
    }
    *turned = true;
    // The reciprocals say nothing about the fastest rays either way, which spread the shaft.
    const float down = smallestOf16(live ? a->direction : (float16)(0.0f));
    const float up = largestOf16(live ? a->direction : (float16)(0.0f));
    const float highScale2 = boundedReciprocal(WEDGE_MAX(up, 1e-30f)),
                lowScale2 = boundedReciprocal(WEDGE_MIN(down, -1e-30f));
    const float nearOffset = -highOrigin * highScale2, turnedOffset = -lowOrigin * lowScale2;
    s.nearScale = highScale2;
    s.nearOffset = nearOffset - (fabs(nearOffset) * WEDGE_WIDEN_ORIGIN + fabs(highScale2) * WEDGE_WIDEN_PLANE);
    s.nearPlane = start;
    s.turnedScale = lowScale2;
    s.turnedOffset = turnedOffset - (fabs(turnedOffset) * WEDGE_WIDEN_ORIGIN + fabs(lowScale2) * WEDGE_WIDEN_PLANE);
    s.farScale = 0.0f;
    s.farOffset = INFINITY;
    s.farPlane = start + WEDGE_BVH_WIDTH;
    return s;
}
#pragma OPENCL FP_CONTRACT OFF

/// Where a shaft meets the slabs of 8 boxes along one axis.
typedef struct {
    float8 near, far, turned;
} ShaftSlab;

/// Where the shaft enters the slab between the low and the high planes of 8 boxes at the earliest and leaves it at the
/// latest, from planes chosen by the shaft's direction.
WEDGE_FN ShaftSlab intersectSlab(const ShaftAxis* a, float8 nearPlane, float8 farPlane)
{
#pragma OPENCL FP_CONTRACT ON
    ShaftSlab slab;
    slab.near = nearPlane * a->nearScale + a->nearOffset;
    slab.far = farPlane * a->farScale + a->farOffset;
    slab.turned = farPlane * a->turnedScale + a->turnedOffset;
    return slab;
}
#pragma OPENCL FP_CONTRACT OFF

WEDGE_FN LaneMask intersectSlabs(const Shaft* shaft, ShaftSlab x, ShaftSlab y, ShaftSlab z, float tCull, float8* tEnter)
{
    const float8 nearXY = WEDGE_MAX(x.near, y.near), nearZ0 = WEDGE_MAX(z.near, (float8)(shaft->tMin));
    const float8 farXY = WEDGE_MIN(x.far, y.far), farZ0 = WEDGE_MIN(z.far, (float8)(tCull));
    float8 enter = WEDGE_MAX(nearXY, nearZ0);
    if (shaft->turned) {
        // The one order of operands that lets a NaN pass.
        enter = WEDGE_MAX(x.turned, enter);
        enter = WEDGE_MAX(y.turned, enter);
        enter = WEDGE_MAX(z.turned, enter);
    }
    *tEnter = enter;
    return laneMask(enter <= WEDGE_MIN(farXY, farZ0));
}

/// 8 planes of a node as the shaft meets them. Its rays may have any times: of planes that move it meets the one that
/// bounds them all, low planes (the even ones) at their lowest, high planes at their highest.
WEDGE_FN float8 shaftPlanes(__global const float* planes, uint start)
{
#ifdef WEDGE_MOTION
    return (start / WEDGE_BVH_WIDTH) % 2 == 0 ? WEDGE_LOWEST8(planes + start) : WEDGE_HIGHEST8(planes + start);
#else
    return vload8(0, planes + start);
#endif
}

/// The children of a node that the shaft enters by t = tCull, and where it enters each at the earliest.
WEDGE_FN LaneMask shaftBoxes(__global const TraversalNode* node, const Shaft* shaft, float tCull, float8* tEnter)
{
    __global const float* planes = node->loX;
    const ShaftSlab x =
        intersectSlab(&shaft->x, shaftPlanes(planes, shaft->x.nearPlane), shaftPlanes(planes, shaft->x.farPlane));
    const ShaftSlab y =
        intersectSlab(&shaft->y, shaftPlanes(planes, shaft->y.nearPlane), shaftPlanes(planes, shaft->y.farPlane));
    const ShaftSlab z =
        intersectSlab(&shaft->z, shaftPlanes(planes, shaft->z.nearPlane), shaftPlanes(planes, shaft->z.farPlane));
    return intersectSlabs(shaft, x, y, z, tCull, tEnter);
}

/// The slab of the shaft and the bounds of 8 triangles along one axis.
WEDGE_FN ShaftSlab triangleSlab(
    const ShaftAxis* a, bool nearIsLow, __global const float* v0, __global const float* v1, __global const float* v2)
{
    const float8 p = vload8(0, v0), q = vload8(0, v1), r = vload8(0, v2);
#ifdef WEDGE_MOTION
    // At their opening and at their closing: all between is between.
    const float8 p1 = WEDGE_CORNERS8(v0, 1.0f), q1 = WEDGE_CORNERS8(v1, 1.0f), r1 = WEDGE_CORNERS8(v2, 1.0f);
    const float8 low = WEDGE_MIN(WEDGE_MIN(WEDGE_MIN(p, q), r), WEDGE_MIN(WEDGE_MIN(p1, q1), r1));
    const float8 high = WEDGE_MAX(WEDGE_MAX(WEDGE_MAX(p, q), r), WEDGE_MAX(WEDGE_MAX(p1, q1), r1));
#else
    const float8 low = WEDGE_MIN(WEDGE_MIN(p, q), r), high = WEDGE_MAX(WEDGE_MAX(p, q), r);
#endif
    return intersectSlab(a, nearIsLow ? low : high, nearIsLow ? high : low);
}

/// The triangles of a block whose boxes the shaft enters by t = tCull.
WEDGE_FN LaneMask shaftTriangles(__global const TriangleBlock* block, const Shaft* shaft, float tCull)
{
    const ShaftSlab x = triangleSlab(&shaft->x, shaft->x.nearPlane == 0, block->v0x, block->v1x, block->v2x);
    const ShaftSlab y =
        triangleSlab(&shaft->y, shaft->y.nearPlane == 2 * WEDGE_BVH_WIDTH, block->v0y, block->v1y, block->v2y);
    const ShaftSlab z =
        triangleSlab(&shaft->z, shaft->z.nearPlane == 4 * WEDGE_BVH_WIDTH, block->v0z, block->v1z, block->v2z);
    float8 tEnter;
    return intersectSlabs(shaft, x, y, z, tCull, &tEnter);
}

/// The rays that enter the box of a node's child by their tFar. FP_CONTRACT as in intersectBoxes.
WEDGE_FN LaneMask16 raysMeetBox(
    __global const TraversalNode* node, uint child, const TraversalPacket* p, const Shaft* shaft)
{
#pragma OPENCL FP_CONTRACT ON
    __global const float* planes = node->loX + child;
    float16 nearX = WEDGE_PLANE(planes, shaft->x.nearPlane, WEDGE_TIME_OF(p));
    float16 farX = WEDGE_PLANE(planes, shaft->x.farPlane, WEDGE_TIME_OF(p));
    float16 nearY = WEDGE_PLANE(planes, shaft->y.nearPlane, WEDGE_TIME_OF(p));
    float16 farY = WEDGE_PLANE(planes, shaft->y.farPlane, WEDGE_TIME_OF(p));
    float16 nearZ = WEDGE_PLANE(planes, shaft->z.nearPlane, WEDGE_TIME_OF(p));
    float16 farZ = WEDGE_PLANE(planes, shaft->z.farPlane, WEDGE_TIME_OF(p));
    if (shaft->turned) {
        // Planes by the sign of each ray; nearPlane is the low one on an axis with both.
        const float16 lowX = WEDGE_PLANE(node->loX, child, WEDGE_TIME_OF(p));
        const float16 highX = WEDGE_PLANE(node->hiX, child, WEDGE_TIME_OF(p));
        const float16 lowY = WEDGE_PLANE(node->loY, child, WEDGE_TIME_OF(p));
        const float16 highY = WEDGE_PLANE(node->hiY, child, WEDGE_TIME_OF(p));
        const float16 lowZ = WEDGE_PLANE(node->loZ, child, WEDGE_TIME_OF(p));
        const float16 highZ = WEDGE_PLANE(node->hiZ, child, WEDGE_TIME_OF(p));
        nearX = p->x.nearScale < 0.0f ? highX : lowX;
        farX = p->x.nearScale < 0.0f ? lowX : highX;
        nearY = p->y.nearScale < 0.0f ? highY : lowY;
        farY = p->y.nearScale < 0.0f ? lowY : highY;
        nearZ = p->z.nearScale < 0.0f ? highZ : lowZ;
        farZ = p->z.nearScale < 0.0f ? lowZ : highZ;
    }
    const float16 ax = nearX * p->x.nearScale + p->x.nearOffset, bx = farX * p->x.farScale + p->x.farOffset;
    const float16 ay = nearY * p->y.nearScale + p->y.nearOffset, by = farY * p->y.farScale + p->y.farOffset;
    const float16 az = nearZ * p->z.nearScale + p->z.nearOffset, bz = farZ * p->z.farScale + p->z.farOffset;
    const float16 nearXY = WEDGE_MAX(ax, ay), nearZ0 = WEDGE_MAX(az, p->tMin);
    const float16 farXY = WEDGE_MIN(bx, by), farZ0 = WEDGE_MIN(bz, p->tFar * WEDGE_WIDEN_T);
    return laneMask16(WEDGE_MAX(nearXY, nearZ0) <= WEDGE_MIN(farXY, farZ0));
}
#pragma OPENCL FP_CONTRACT OFF

#endif
