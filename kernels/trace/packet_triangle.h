// 16 rays against one triangle: the test of intersect.h with the roles exchanged.
#ifndef WEDGE_PACKET_TRIANGLE_H
#define WEDGE_PACKET_TRIANGLE_H

#include "trace/packet_rays.h"

/// A point in the axes of each ray's test.
typedef struct {
    float16 x, y, z;
} TurnedPoints;

/// turnAxes() of one point by the axis of each ray.
WEDGE_FN TurnedPoints turnPoint(
    WEDGE_PACKET_COORDINATE x, WEDGE_PACKET_COORDINATE y, WEDGE_PACKET_COORDINATE z, int16 axis)
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
WEDGE_FN TurnedPoints loadTurned(__global const float* vertex, const TestAxes* axes, const TraversalPacket* rays)
{
    if (axes->mixed)
        return turnPoint(WEDGE_CORNER(vertex, 0, WEDGE_TIME_OF(rays)),
            WEDGE_CORNER(vertex, WEDGE_BLOCK_SIZE, WEDGE_TIME_OF(rays)),
            WEDGE_CORNER(vertex, 2 * WEDGE_BLOCK_SIZE, WEDGE_TIME_OF(rays)), rays->axis);
    TurnedPoints p;
    p.x = WEDGE_CORNER(vertex, axes->x, WEDGE_TIME_OF(rays));
    p.y = WEDGE_CORNER(vertex, axes->y, WEDGE_TIME_OF(rays));
    p.z = WEDGE_CORNER(vertex, axes->z, WEDGE_TIME_OF(rays));
    return p;
}

/// One coordinate of the edge between two vertices.
WEDGE_FN WEDGE_PACKET_COORDINATE packetEdge(
    __global const float* from, __global const float* to, uint i, const TraversalPacket* rays)
{
    (void)rays; // where nothing moves
    return WEDGE_CORNER(to, i, WEDGE_TIME_OF(rays)) - WEDGE_CORNER(from, i, WEDGE_TIME_OF(rays));
}

/// The normal of a triangle as the rays' tests see it: turning axes in a circle turns a cross product with them.
WEDGE_FN TurnedPoints turnedNormal(__global const float* v0, __global const float* v1, __global const float* v2,
    const TestAxes* axes, const TraversalPacket* rays)
{
    const uint x = axes->mixed ? 0 : axes->x;
    const uint y = axes->mixed ? WEDGE_BLOCK_SIZE : axes->y;
    const uint z = axes->mixed ? 2 * WEDGE_BLOCK_SIZE : axes->z;
    const WEDGE_PACKET_COORDINATE e1x = packetEdge(v0, v1, x, rays), e2x = packetEdge(v0, v2, x, rays);
    const WEDGE_PACKET_COORDINATE e1y = packetEdge(v0, v1, y, rays), e2y = packetEdge(v0, v2, y, rays);
    const WEDGE_PACKET_COORDINATE e1z = packetEdge(v0, v1, z, rays), e2z = packetEdge(v0, v2, z, rays);
    const WEDGE_PACKET_COORDINATE nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    if (axes->mixed)
        return turnPoint(nx, ny, nz, rays->axis);
    TurnedPoints n;
    n.x = nx;
    n.y = ny;
    n.z = nz;
    return n;
}

#ifdef WEDGE_MOTION
/// WEDGE_SPANS_AREA of a triangle with that normal; which axis is which does not matter to it.
WEDGE_FN int16 packetArea(__global const float* v0, __global const float* v1, __global const float* v2,
    const TurnedPoints* n, const TraversalPacket* rays)
{
    const uint y = WEDGE_BLOCK_SIZE, z = 2 * WEDGE_BLOCK_SIZE;
    const float16 e1x = packetEdge(v0, v1, 0, rays), e1y = packetEdge(v0, v1, y, rays),
                  e1z = packetEdge(v0, v1, z, rays);
    const float16 e2x = packetEdge(v0, v2, 0, rays), e2y = packetEdge(v0, v2, y, rays),
                  e2z = packetEdge(v0, v2, z, rays);
    return WEDGE_SPANS_AREA(n->x, n->y, n->z, e1x, e1y, e1z, e2x, e2y, e2z);
}
#endif

#ifdef WEDGE_CUTOUTS
/// Those of the rays `hit`, which meet a triangle at the barycentrics (u, v), that do not pass through it.
WEDGE_FN int16 solidLanes(uint triangle, int16 hit, float16 u, float16 v, const TraversalPacket* p)
{
    int solid[16];
    vstore16((int16)(0), 0, solid);
    for (LaneMask16 lanes = laneMask16(hit); lanes; lanes &= lanes - 1) {
        const uint lane = firstLane16(lanes);
        const Vec3 origin =
            vec3(WEDGE_LANE(p->testOriginX, lane), WEDGE_LANE(p->testOriginY, lane), WEDGE_LANE(p->testOriginZ, lane));
        const Vec3 direction = vec3(WEDGE_LANE(p->testDirectionX, lane), WEDGE_LANE(p->testDirectionY, lane),
            WEDGE_LANE(p->testDirectionZ, lane));
#ifdef WEDGE_MOTION
        const float time = WEDGE_LANE(p->time, lane);
#else
        const float time = 0.0f;
#endif
        const bool hole =
            isHole(p->cutouts, triangle, WEDGE_LANE(u, lane), WEDGE_LANE(v, lane), origin, direction, time);
        solid[lane] = hole ? 0 : -1;
    }
    return vload16(0, solid);
}
#endif

/// Intersects the triangle in one lane of a block with 16 rays: intersectBlock with the roles exchanged, operation by
/// operation, so that both find the same hits to the last bit. entering: the rays that count. Returns whether any ray
/// hit it.
WEDGE_FN bool intersectTriangle(__global const TriangleBlock* block, uint lane, const TestAxes* axes, int16 entering,
    TraversalPacket* p, const bool any)
{
    __global const float *v0 = block->v0x + lane, *v1 = block->v1x + lane, *v2 = block->v2x + lane;
    const TurnedPoints va = loadTurned(v0, axes, p);
    const TurnedPoints vb = loadTurned(v1, axes, p);
    const TurnedPoints vc = loadTurned(v2, axes, p);
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
    const TurnedPoints n = turnedNormal(v0, v1, v2, axes, p);
    const float16 t = (n.x * ax + n.y * ay + n.z * az)
        / (n.x * p->testDirectionX + n.y * p->testDirectionY + n.z * p->testDirectionZ);
    const uint triangle = block->triangle[lane];
    const int16 nearer = (t < p->tFar) | ((t == p->tFar) & (triangle < p->triangle));
    const int16 beyond = WEDGE_BEYOND_START(p, t, (uint16)(triangle));
#ifdef WEDGE_MOTION
    int16 hit = inside & beyond & nearer & packetArea(v0, v1, v2, &n, p);
#else
    int16 hit = inside & beyond & nearer;
#endif
    if (!anyLane(hit))
        return false;
#ifdef WEDGE_CUTOUTS
    if (p->cutouts[triangle] != WEDGE_NO_CUTOUT) {
        const float16 reciprocal = 1.0f / sum;
        hit = solidLanes(triangle, hit, u * reciprocal, v * reciprocal, p);
        if (!anyLane(hit))
            return false;
    }
#endif
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

#endif
