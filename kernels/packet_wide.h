// Packets of 16 rays through the 8-wide hierarchy: one shaft around all rays is tested against the 8 boxes of a node,
// then the 16 rays against each box that the shaft meets, and against each triangle.
#ifndef WEDGE_PACKET_WIDE_H
#define WEDGE_PACKET_WIDE_H

#include "traverse_wide.h"

WEDGE_FN float smallestOf16(float16 x) { return smallestLane(WEDGE_MIN(x.lo, x.hi)); }
WEDGE_FN float largestOf16(float16 x)
{
    const float8 eight = WEDGE_MAX(x.lo, x.hi);
    const float4 four = WEDGE_MAX(eight.lo, eight.hi);
    const float2 two = WEDGE_MAX(four.lo, four.hi);
    return WEDGE_MAX(two.x, two.y);
}

/// A set of lanes of a vector of 16: byte i stands for lanes i (its top bit) and i + 8 (its lowest).
typedef ulong LaneMask16;

WEDGE_FN LaneMask16 laneMask16(int16 comparison)
{
    const ulong2 bytes = as_ulong2(convert_char16(comparison));
    return (bytes.x & 0x8080808080808080ul) | (bytes.y & 0x0101010101010101ul);
}
WEDGE_FN uint firstLane16(LaneMask16 lanes)
{
    const uint bit = (uint)popcount(~lanes & (lanes - 1));
    return (bit >> 3) + ((bit & 7) == 0 ? 8 : 0);
}

/// All bits set in the lanes of a set, none in the others.
WEDGE_FN int16 lanesOf(LaneMask16 lanes) { return convert_int16(as_char16((ulong2)(lanes, lanes << 7))) < 0; }

/// Whether the comparison holds in any lane.
WEDGE_FN bool anyLane(int16 comparison)
{
    const ulong2 bytes = as_ulong2(convert_char16(comparison));
    return (bytes.x | bytes.y) != 0;
}

/// A coordinate of 16 rays, and what the box and triangle tests need of it. All in the units of the hierarchy.
typedef struct {
    float16 origin, direction;
    float16 nearScale, nearOffset, farScale, farOffset; ///< as in TraversalRay
} PacketAxis;

/// One axis of the shaft: points of all rays at t lie between lowOrigin + t lowDirection and highOrigin + t
/// highDirection, and each of the two ends bounds t by a plane of a box: from below or from above.
typedef struct {
    float nearScale, nearOffset; ///< t >= plane scale + offset
    float farScale, farOffset;   ///< t <= plane scale + offset; infinite where directions differ in sign
    float turnedScale, turnedOffset; ///< a second t >=, of the high plane, where directions differ in sign
    uint nearPlane, farPlane; ///< in floats from the node's start
} ShaftAxis;

typedef struct {
    ShaftAxis x, y, z;
    float tMin;
    bool turned; ///< the directions of an axis differ in sign
} Shaft;

/// 16 rays with their state. Lanes without a ray have tFar < 0.
typedef struct {
    PacketAxis x, y, z;
    float16 tMin, tFar, u, v;
    uint16 triangle;
    float16 shearX, shearY; ///< as in TraversalRay
    int16 axis; ///< of the largest component of the direction: 0, 1, 2
    float16 testOriginX, testOriginY, testOriginZ; ///< as in TraversalRay
    float16 testDirectionX, testDirectionY, testDirectionZ;
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

// Each of these takes the smaller of neighbouring halves of the parts of x and y, and puts what is left side by side.
WEDGE_FN float16 mergeHalves(float16 x, float16 y)
{
    const float16 first = (float16)(x.lo, y.lo), second = (float16)(x.hi, y.hi);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeQuarters(float16 x, float16 y)
{
    const float16 first = (float16)(x.s0123, x.s89ab, y.s0123, y.s89ab);
    const float16 second = (float16)(x.s4567, x.scdef, y.s4567, y.scdef);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeEighths(float16 x, float16 y)
{
    const float16 first = (float16)(x.s01, x.s45, x.s89, x.scd, y.s01, y.s45, y.s89, y.scd);
    const float16 second = (float16)(x.s23, x.s67, x.sab, x.sef, y.s23, y.s67, y.sab, y.sef);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeSixteenths(float16 x, float16 y)
{
    const float16 first = (float16)(x.s02468ace, y.s02468ace), second = (float16)(x.s13579bdf, y.s13579bdf);
    return WEDGE_MIN(first, second);
}

/// What the live rays of a packet span: 16 reductions at once cost a third of one after the other.
typedef struct {
    float lowOrigin[3], highOrigin[3], lowScale[3], highScale[3]; ///< x, y, z; of origin and nearScale
    float tMin;
} PacketExtent;

WEDGE_FN PacketExtent packetExtent(const TraversalPacket* p, int16 live)
{
    const float16 none = (float16)(3e38f);
    const float16 low = mergeEighths(
        mergeQuarters(mergeHalves(live ? p->x.origin : none, live ? p->y.origin : none),
            mergeHalves(live ? p->z.origin : none, live ? p->x.nearScale : none)),
        mergeQuarters(mergeHalves(live ? p->y.nearScale : none, live ? p->z.nearScale : none),
            mergeHalves(live ? p->tMin : none, none)));
    const float16 high = mergeEighths(
        mergeQuarters(mergeHalves(live ? -p->x.origin : none, live ? -p->y.origin : none),
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
        // The slowest ray that starts farthest ahead bounds where the shaft enters; negative values do not matter.
        const float nearScale = up ? lowScale : highScale, nearOrigin = up ? highOrigin : lowOrigin;
        const float farScale = up ? highScale : lowScale, farOrigin = up ? lowOrigin : highOrigin;
        const float nearOffset = -nearOrigin * nearScale, farOffset = -farOrigin * farScale;
        s.nearScale = nearScale;
        s.nearOffset = nearOffset - (fabs(nearOffset) * WEDGE_WIDEN_ORIGIN + fabs(nearScale) * WEDGE_WIDEN_PLANE);
        s.farScale = farScale * WEDGE_WIDEN_T;
        s.farOffset = farOffset * WEDGE_WIDEN_T + fabs(farOffset) * WEDGE_WIDEN_ORIGIN + fabs(farScale) * WEDGE_WIDEN_PLANE;
        s.nearPlane = start + (up ? 0 : WEDGE_BVH_WIDTH);
        s.farPlane = start + (up ? WEDGE_BVH_WIDTH : 0);
        return s;
    }
    *turned = true;
    // The reciprocals say nothing about the fastest rays either way, which spread the shaft.
    const float down = smallestOf16(live ? a->direction : (float16)(0.0f));
    const float up = largestOf16(live ? a->direction : (float16)(0.0f));
    const float highScale2 = boundedReciprocal(WEDGE_MAX(up, 1e-30f)), lowScale2 = boundedReciprocal(WEDGE_MIN(down, -1e-30f));
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

/// The children of a node that the shaft enters by t = tCull, and where it enters each at the earliest.
WEDGE_FN LaneMask shaftBoxes(__global const BvhNode* node, const Shaft* shaft, float tCull, float8* tEnter)
{
    __global const float* planes = node->loX;
    const ShaftSlab x = intersectSlab(&shaft->x, vload8(0, planes + shaft->x.nearPlane), vload8(0, planes + shaft->x.farPlane));
    const ShaftSlab y = intersectSlab(&shaft->y, vload8(0, planes + shaft->y.nearPlane), vload8(0, planes + shaft->y.farPlane));
    const ShaftSlab z = intersectSlab(&shaft->z, vload8(0, planes + shaft->z.nearPlane), vload8(0, planes + shaft->z.farPlane));
    return intersectSlabs(shaft, x, y, z, tCull, tEnter);
}

/// The slab of the shaft and the bounds of 8 triangles along one axis.
WEDGE_FN ShaftSlab triangleSlab(const ShaftAxis* a, bool nearIsLow, __global const float* v0, __global const float* v1,
    __global const float* v2)
{
    const float8 p = vload8(0, v0), q = vload8(0, v1), r = vload8(0, v2);
    const float8 low = WEDGE_MIN(WEDGE_MIN(p, q), r), high = WEDGE_MAX(WEDGE_MAX(p, q), r);
    return intersectSlab(a, nearIsLow ? low : high, nearIsLow ? high : low);
}

/// The triangles of a block whose boxes the shaft enters by t = tCull.
WEDGE_FN LaneMask shaftTriangles(__global const TriangleBlock* block, const Shaft* shaft, float tCull)
{
    const ShaftSlab x = triangleSlab(&shaft->x, shaft->x.nearPlane == 0, block->v0x, block->v1x, block->v2x);
    const ShaftSlab y = triangleSlab(&shaft->y, shaft->y.nearPlane == 2 * WEDGE_BVH_WIDTH, block->v0y, block->v1y, block->v2y);
    const ShaftSlab z = triangleSlab(&shaft->z, shaft->z.nearPlane == 4 * WEDGE_BVH_WIDTH, block->v0z, block->v1z, block->v2z);
    float8 tEnter;
    return intersectSlabs(shaft, x, y, z, tCull, &tEnter);
}

/// The rays that enter the box of a node's child by their tFar. FP_CONTRACT as in intersectBoxes.
WEDGE_FN LaneMask16 raysMeetBox(__global const BvhNode* node, uint child, const TraversalPacket* p, const Shaft* shaft)
{
#pragma OPENCL FP_CONTRACT ON
    __global const float* planes = node->loX + child;
    float16 nearX = planes[shaft->x.nearPlane], farX = planes[shaft->x.farPlane];
    float16 nearY = planes[shaft->y.nearPlane], farY = planes[shaft->y.farPlane];
    float16 nearZ = planes[shaft->z.nearPlane], farZ = planes[shaft->z.farPlane];
    if (shaft->turned) {
        // Planes by the sign of each ray; nearPlane is the low one on an axis with both.
        const float16 lowX = node->loX[child], highX = node->hiX[child];
        const float16 lowY = node->loY[child], highY = node->hiY[child];
        const float16 lowZ = node->loZ[child], highZ = node->hiZ[child];
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

/// The axes of the triangle test.
typedef struct {
    uint x, y, z; ///< where their coordinates start in a vertex of a block, in floats; for rays that have them in common
    bool mixed;   ///< the rays do not
} TestAxes;

/// A point in the axes of each ray's test.
typedef struct {
    float16 x, y, z;
} TurnedPoints;

/// turnAxes() of one point by the axis of each ray.
WEDGE_FN TurnedPoints turnPoint(float x, float y, float z, int16 axis)
{
    const float16 vx = x, vy = y, vz = z;
    const int16 largestX = axis == 0, largestY = axis == 1;
    TurnedPoints p;
    p.x = largestX ? vy : largestY ? vz : vx;
    p.y = largestX ? vz : largestY ? vx : vy;
    p.z = largestX ? vx : largestY ? vy : vz;
    return p;
}

/// A vertex as the rays' tests see it.
WEDGE_FN TurnedPoints loadTurned(__global const float* vertex, const TestAxes* axes, int16 axis)
{
    if (axes->mixed)
        return turnPoint(vertex[0], vertex[WEDGE_BLOCK_SIZE], vertex[2 * WEDGE_BLOCK_SIZE], axis);
    TurnedPoints p;
    p.x = vertex[axes->x];
    p.y = vertex[axes->y];
    p.z = vertex[axes->z];
    return p;
}

/// The normal of a triangle as the rays' tests see it: turning axes in a circle turns a cross product with them.
WEDGE_FN TurnedPoints turnedNormal(__global const float* v0, __global const float* v1, __global const float* v2,
    const TestAxes* axes, int16 axis)
{
    const uint x = axes->mixed ? 0 : axes->x;
    const uint y = axes->mixed ? WEDGE_BLOCK_SIZE : axes->y;
    const uint z = axes->mixed ? 2 * WEDGE_BLOCK_SIZE : axes->z;
    const float e1x = v1[x] - v0[x], e2x = v2[x] - v0[x];
    const float e1y = v1[y] - v0[y], e2y = v2[y] - v0[y];
    const float e1z = v1[z] - v0[z], e2z = v2[z] - v0[z];
    const float nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    if (axes->mixed)
        return turnPoint(nx, ny, nz, axis);
    TurnedPoints n;
    n.x = nx;
    n.y = ny;
    n.z = nz;
    return n;
}

/// Intersects the triangle in one lane of a block with 16 rays: intersectBlock with the roles exchanged, operation by
/// operation, so that both find the same hits to the last bit. entering: the rays that count. Returns whether any ray
/// hit it.
WEDGE_FN bool intersectTriangle(__global const TriangleBlock* block, uint lane, const TestAxes* axes, int16 entering, TraversalPacket* p, const bool any)
{
    __global const float *v0 = block->v0x + lane, *v1 = block->v1x + lane, *v2 = block->v2x + lane;
    const TurnedPoints va = loadTurned(v0, axes, p->axis);
    const TurnedPoints vb = loadTurned(v1, axes, p->axis);
    const TurnedPoints vc = loadTurned(v2, axes, p->axis);
    const float16 ax = va.x - p->testOriginX, ay = va.y - p->testOriginY, az = va.z - p->testOriginZ;
    const float16 bx = vb.x - p->testOriginX, by = vb.y - p->testOriginY, bz = vb.z - p->testOriginZ;
    const float16 cx = vc.x - p->testOriginX, cy = vc.y - p->testOriginY, cz = vc.z - p->testOriginZ;
    const float16 sax = ax - p->shearX * az, say = ay - p->shearY * az;
    const float16 sbx = bx - p->shearX * bz, sby = by - p->shearY * bz;
    const float16 scx = cx - p->shearX * cz, scy = cy - p->shearY * cz;
    const float16 u = sax * scy - say * scx;
    const float16 v = sbx * say - sby * sax;
    const float16 w = scx * sby - scy * sbx;
    const float16 least = WEDGE_MIN(WEDGE_MIN(u, v), w), most = WEDGE_MAX(WEDGE_MAX(u, v), w);
    const float16 sum = u + v + w;
    const int16 inside = entering & ((least >= 0.0f) | (most <= 0.0f)) & (sum != 0.0f);
    if (!anyLane(inside))
        return false;
    const TurnedPoints n = turnedNormal(v0, v1, v2, axes, p->axis);
    const float16 t = (n.x * ax + n.y * ay + n.z * az)
        / (n.x * p->testDirectionX + n.y * p->testDirectionY + n.z * p->testDirectionZ);
    const uint triangle = block->triangle[lane];
    const int16 nearer = (t < p->tFar) | ((t == p->tFar) & (triangle < p->triangle));
    const int16 hit = inside & (t > p->tMin) & nearer;
    if (!anyLane(hit))
        return false;
    if (any) {
        p->tFar = hit ? (float16)(-1.0f) : p->tFar;
        return true;
    }
    const float16 inverse = 1.0f / sum;
    p->tFar = hit ? t : p->tFar;
    p->u = hit ? u * inverse : p->u;
    p->v = hit ? v * inverse : p->v;
    p->triangle = hit ? (uint16)(triangle) : p->triangle;
    return true;
}

/// Below this many rays a subtree is walked by each alone.
#ifndef WEDGE_MIN_PACKET_RAYS
#define WEDGE_MIN_PACKET_RAYS 5
#endif

#define WEDGE_LANE(vector, lane) (((const float*)&(vector))[lane])

WEDGE_FN TraversalRay rayOfLane(const TraversalPacket* p, uint lane)
{
    TraversalRay r;
    r.origin = vec3(WEDGE_LANE(p->x.origin, lane), WEDGE_LANE(p->y.origin, lane), WEDGE_LANE(p->z.origin, lane));
    r.direction = vec3(WEDGE_LANE(p->x.direction, lane), WEDGE_LANE(p->y.direction, lane), WEDGE_LANE(p->z.direction, lane));
    r.tMin = WEDGE_LANE(p->tMin, lane);
    r.tMax = WEDGE_LANE(p->tFar, lane);
    r.nearScale = vec3(WEDGE_LANE(p->x.nearScale, lane), WEDGE_LANE(p->y.nearScale, lane), WEDGE_LANE(p->z.nearScale, lane));
    r.nearOffset = vec3(WEDGE_LANE(p->x.nearOffset, lane), WEDGE_LANE(p->y.nearOffset, lane), WEDGE_LANE(p->z.nearOffset, lane));
    r.farScale = vec3(WEDGE_LANE(p->x.farScale, lane), WEDGE_LANE(p->y.farScale, lane), WEDGE_LANE(p->z.farScale, lane));
    r.farOffset = vec3(WEDGE_LANE(p->x.farOffset, lane), WEDGE_LANE(p->y.farOffset, lane), WEDGE_LANE(p->z.farOffset, lane));
    choosePlanes(&r);
    r.testOrigin = vec3(WEDGE_LANE(p->testOriginX, lane), WEDGE_LANE(p->testOriginY, lane), WEDGE_LANE(p->testOriginZ, lane));
    r.testDirection
        = vec3(WEDGE_LANE(p->testDirectionX, lane), WEDGE_LANE(p->testDirectionY, lane), WEDGE_LANE(p->testDirectionZ, lane));
    r.shearX = WEDGE_LANE(p->shearX, lane);
    r.shearY = WEDGE_LANE(p->shearY, lane);
    chooseAxes(&r, ((const int*)&p->axis)[lane]);
    return r;
}

/// Walks the subtree of a reference with each of some rays alone.
WEDGE_FN void traverseAlone(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    uint reference, LaneMask16 lanes, TraversalPacket* p, const bool any)
{
    for (; lanes; lanes &= lanes - 1) {
        const uint lane = firstLane16(lanes);
        Hit hit;
        hit.t = ((float*)&p->tFar)[lane];
        if (hit.t < 0.0f)
            continue;
        hit.u = ((float*)&p->u)[lane];
        hit.v = ((float*)&p->v)[lane];
        hit.triangle = ((uint*)&p->triangle)[lane];
        const TraversalRay ray = rayOfLane(p, lane);
        const uint before = hit.triangle;
        traverse(nodes, blocks, reference, &ray, any, &hit);
        if (any) {
            ((float*)&p->tFar)[lane] = hit.triangle != before ? -1.0f : hit.t;
            continue;
        }
        ((float*)&p->tFar)[lane] = hit.t;
        ((float*)&p->u)[lane] = hit.u;
        ((float*)&p->v)[lane] = hit.v;
        ((uint*)&p->triangle)[lane] = hit.triangle;
    }
}

/// Walks the hierarchy with the rays of a packet. With any, a ray that hit something has tFar < 0.
WEDGE_FN void traversePacket(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const Shaft* shaft, const TestAxes* axes, TraversalPacket* p, const bool any)
{
    uint stack[WEDGE_BVH_STACK];
    float enters[WEDGE_BVH_STACK];
    LaneMask16 rays[WEDGE_BVH_STACK];
    float tCull = largestOf16(p->tFar) * WEDGE_WIDEN_T;
    int depth = 0;
    uint current = 0;
    LaneMask16 live = ~0ul;
    for (;;) {
        if (popcount(live) < WEDGE_MIN_PACKET_RAYS) {
            traverseAlone(nodes, blocks, current, live, p, any);
            tCull = largestOf16(p->tFar) * WEDGE_WIDEN_T;
            if (any && tCull < 0.0f)
                return;
        } else if (current & WEDGE_BVH_LEAF) {
            __global const TriangleBlock* block = blocks + ((current & ~WEDGE_BVH_LEAF) >> 3);
            // A ray that misses the box may pass a triangle within rounding: alone it would not see it either.
            const int16 entering = lanesOf(live);
            bool found = false;
            for (uint left = current & 7u; left != 0; left--, block++) {
                LaneMask lanes = shaftTriangles(block, shaft, tCull);
                for (; lanes; lanes = dropFirstLane(lanes))
                    found |= intersectTriangle(block, firstLane(lanes), axes, entering, p, any);
            }
            if (found) {
                tCull = largestOf16(p->tFar) * WEDGE_WIDEN_T;
                if (any && tCull < 0.0f)
                    return;
            }
        } else {
            __global const BvhNode* node = nodes + current;
            float8 tEnter;
            LaneMask lanes = shaftBoxes(node, shaft, tCull, &tEnter);
            float t[WEDGE_BVH_WIDTH];
            vstore8(tEnter, 0, t);
            const int base = depth;
            for (; lanes; lanes = dropFirstLane(lanes)) {
                const uint lane = firstLane(lanes);
                const LaneMask16 meet = raysMeetBox(node, lane, p, shaft);
                if (meet == 0)
                    continue;
                // Farthest first, so that the nearest is on top.
                int place = depth++;
                for (; place > base && enters[place - 1] < t[lane]; place--) {
                    stack[place] = stack[place - 1];
                    enters[place] = enters[place - 1];
                    rays[place] = rays[place - 1];
                }
                stack[place] = node->child[lane];
                enters[place] = t[lane];
                rays[place] = meet;
            }
        }
        do {
            if (depth == 0)
                return;
            depth--;
        } while (enters[depth] > tCull);
        current = stack[depth];
        live = rays[depth];
    }
}

WEDGE_FN void loadPacket(const RayPacket* packet, float unit, TraversalPacket* p)
{
    p->x = packetAxis(vload16(0, packet->originX) * unit, vload16(0, packet->directionX) * unit);
    p->y = packetAxis(vload16(0, packet->originY) * unit, vload16(0, packet->directionY) * unit);
    p->z = packetAxis(vload16(0, packet->originZ) * unit, vload16(0, packet->directionZ) * unit);
    const float16 tMin = vload16(0, packet->tMin), tMax = vload16(0, packet->tMax);
    p->tMin = WEDGE_MAX(tMin, (float16)(0.0f));
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

/// Sends the rays through the hierarchy.
WEDGE_FN void tracePacket(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    TraversalPacket* p, const bool any)
{
    const int16 live = p->tFar >= 0.0f;
    if (!anyLane(live))
        return;
    const TestAxes axes = testAxes(p, live);
    const PacketExtent extent = packetExtent(p, live);
    Shaft shaft;
    shaft.turned = false;
    shaft.x = shaftAxis(&extent, 0, &p->x, live, &shaft.turned);
    shaft.y = shaftAxis(&extent, 1, &p->y, live, &shaft.turned);
    shaft.z = shaftAxis(&extent, 2, &p->z, live, &shaft.turned);
    shaft.tMin = extent.tMin;
    traversePacket(nodes, blocks, &shaft, &axes, p, any);
}

/// closestHit() of each lane. A lane without a ray hits nothing.
WEDGE_FN void closestHits(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const RayPacket* packet, PacketHits* hits)
{
    TraversalPacket p;
    loadPacket(packet, nodes->unit, &p);
    tracePacket(nodes, blocks, &p, false);
    const float16 tMax = vload16(0, packet->tMax);
    vstore16(p.triangle == WEDGE_NO_TRIANGLE ? tMax : p.tFar, 0, hits->t);
    vstore16(p.u, 0, hits->u);
    vstore16(p.v, 0, hits->v);
    vstore16(p.triangle, 0, hits->triangle);
}

/// anyHit() of each lane: 1 or 0.
WEDGE_FN void anyHits(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const RayPacket* packet, uint* occluded)
{
    TraversalPacket p;
    loadPacket(packet, nodes->unit, &p);
    const int16 valid = p.tFar >= 0.0f;
    tracePacket(nodes, blocks, &p, true);
    vstore16((valid & (p.tFar < 0.0f)) ? (uint16)(1u) : (uint16)(0u), 0, occluded);
}

#endif
