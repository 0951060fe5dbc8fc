// One ray against the 8 boxes of a node and against a block of triangles, each as one wide vector.
#ifndef WEDGE_INTERSECT_H
#define WEDGE_INTERSECT_H

#include "shared/hit.h"
#include "trace/ray.h"

#if WEDGE_BVH_WIDTH != 8 || WEDGE_BLOCK_SIZE != 8
#error "These tests are written for vectors of 8"
#endif

/// The node that the wide family of traversals walks.
#ifdef WEDGE_MOTION
typedef MovingNode TraversalNode;
#else
typedef BvhNode TraversalNode;
#endif

/// A set of lanes of a vector of 8: the top bit of byte i stands for lane i.
typedef ulong LaneMask;

/// The lanes whose comparison holds (all bits set).
WEDGE_FN LaneMask laneMask(int8 comparison) { return as_ulong(convert_char8(comparison)) & 0x8080808080808080ul; }
/// The lowest lane of a set that is not empty. OpenCL C 1.2 has no count of trailing zeros; compilers know this one.
WEDGE_FN uint firstLane(LaneMask lanes) { return (uint)popcount(~lanes & (lanes - 1)) >> 3; }
/// The set without its lowest lane.
WEDGE_FN LaneMask dropFirstLane(LaneMask lanes) { return lanes & (lanes - 1); }

/// The children of a node that the ray enters by t = tCull, and where it enters each. Boxes are widened by more than
/// their roundings, so fusing multiply-adds, or not, loses no hit.
WEDGE_FN LaneMask intersectBoxes(
    __global const TraversalNode* node, const TraversalRay* ray, float tCull, float8* tEnter)
{
#pragma OPENCL FP_CONTRACT ON
    __global const float* planes = node->loX;
    const float8 nearX = WEDGE_PLANES8(planes + ray->nearX, WEDGE_TIME_OF(ray)) * ray->nearScale.x + ray->nearOffset.x;
    const float8 nearY = WEDGE_PLANES8(planes + ray->nearY, WEDGE_TIME_OF(ray)) * ray->nearScale.y + ray->nearOffset.y;
    const float8 nearZ = WEDGE_PLANES8(planes + ray->nearZ, WEDGE_TIME_OF(ray)) * ray->nearScale.z + ray->nearOffset.z;
    const float8 farX = WEDGE_PLANES8(planes + ray->farX, WEDGE_TIME_OF(ray)) * ray->farScale.x + ray->farOffset.x;
    const float8 farY = WEDGE_PLANES8(planes + ray->farY, WEDGE_TIME_OF(ray)) * ray->farScale.y + ray->farOffset.y;
    const float8 farZ = WEDGE_PLANES8(planes + ray->farZ, WEDGE_TIME_OF(ray)) * ray->farScale.z + ray->farOffset.z;
    const float8 nearXY = WEDGE_MAX(nearX, nearY), nearZ0 = WEDGE_MAX(nearZ, (float8)(ray->tMin));
    const float8 farXY = WEDGE_MIN(farX, farY), farZ0 = WEDGE_MIN(farZ, (float8)(tCull));
    const float8 enter = WEDGE_MAX(nearXY, nearZ0);
    const float8 leave = WEDGE_MIN(farXY, farZ0);
    *tEnter = enter;
    return laneMask(enter <= leave);
}
#pragma OPENCL FP_CONTRACT OFF

WEDGE_FN float smallestLane(float8 x)
{
    const float4 four = WEDGE_MIN(x.lo, x.hi);
    const float2 two = WEDGE_MIN(four.lo, four.hi);
    return WEDGE_MIN(two.x, two.y);
}

/// Vertices relative to the ray's origin, in the axes of the test, then sheared along z so that the ray is the z axis.
typedef struct {
    float8 x, y;
} ShearedVertices;

WEDGE_FN ShearedVertices shear(
    const TraversalRay* ray, __global const float* vertex, float8* px, float8* py, float8* pz)
{
    *px = WEDGE_CORNERS8(vertex + ray->axisX, WEDGE_TIME_OF(ray)) - ray->testOrigin.x;
    *py = WEDGE_CORNERS8(vertex + ray->axisY, WEDGE_TIME_OF(ray)) - ray->testOrigin.y;
    *pz = WEDGE_CORNERS8(vertex + ray->axisZ, WEDGE_TIME_OF(ray)) - ray->testOrigin.z;
    ShearedVertices v;
    v.x = *px - ray->shearX * *pz;
    v.y = *py - ray->shearY * *pz;
    return v;
}

/// One coordinate of the edges between two vertices at the time.
WEDGE_FN float8 edge(uint axis, __global const float* from, __global const float* to, float time)
{
    (void)time; // where nothing moves
    return WEDGE_CORNERS8(to + axis, time) - WEDGE_CORNERS8(from + axis, time);
}

#ifdef WEDGE_CUTOUTS
/// Replaces hit by the nearest of the triangles `in` that the ray does not pass through; they have t <= hit->t. Returns
/// whether there was one. Each turn drops a lane, so that it ends after 8.
WEDGE_FN bool nearestSolid(
    __global const TriangleBlock* block, const TraversalRay* ray, int8 in, float8 t, float8 u, float8 v, Hit* hit)
{
    const int8 lanes = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    float us[WEDGE_BLOCK_SIZE], vs[WEDGE_BLOCK_SIZE];
    vstore8(u, 0, us);
    vstore8(v, 0, vs);
    do {
        const float8 candidate = in ? t : (float8)(INFINITY);
        const float nearest = smallestLane(candidate);
        const uint lane = firstLane(laneMask(in & (candidate == nearest)));
        const uint triangle = block->triangle[lane];
        // Those that are left lie no nearer, and at this distance have larger indices.
        if (nearest == hit->t && triangle > hit->triangle)
            return false;
        if (!isHole(
                ray->cutouts, triangle, us[lane], vs[lane], ray->testOrigin, ray->testDirection, WEDGE_TIME_OF(ray))) {
            hit->t = nearest;
            hit->u = us[lane];
            hit->v = vs[lane];
            hit->triangle = triangle;
            return true;
        }
        in &= lanes != (int8)((int)lane);
    } while (laneMask(in) != 0);
    return false;
}
#endif

/// Intersects a block and replaces hit where one of its triangles is hit at tMin < t <= hit->t; of equal t the smaller
/// index wins, so that the order of blocks does not show. Returns whether anything was hit.
/// The test is watertight (Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2013): the side on which
/// the ray passes an edge is the sign of a difference of two products of vertices that all triangles share. Rounding
/// may make that difference 0, and then both sides count, but it never turns the sign; fused, it could.
WEDGE_FN bool intersectBlock(__global const TriangleBlock* block, const TraversalRay* ray, Hit* hit)
{
    float8 ax, ay, az, bx, by, bz, cx, cy, cz;
    const ShearedVertices a = shear(ray, block->v0x, &ax, &ay, &az);
    const ShearedVertices b = shear(ray, block->v1x, &bx, &by, &bz);
    const ShearedVertices c = shear(ray, block->v2x, &cx, &cy, &cz);
    const float8 u = a.x * c.y - a.y * c.x;
    const float8 v = b.x * a.y - b.y * a.x;
    const float8 w = c.x * b.y - c.y * b.x;
    const float8 least = WEDGE_MIN(WEDGE_MIN(u, v), w), most = WEDGE_MAX(WEDGE_MAX(u, v), w);
    const float8 sum = u + v + w;
    const int8 inside = ((least >= 0.0f) | (most <= 0.0f)) & (sum != 0.0f);
    if (laneMask(inside) == 0)
        return false;
    // t is that of the plane: next to a triangle it is surer of its sign than what the three sides interpolate. The
    // normal is the triangle's own, not that of the rounded differences to the origin.
    const float time = WEDGE_TIME_OF(ray);
    const float8 e1x = edge(ray->axisX, block->v0x, block->v1x, time),
                 e2x = edge(ray->axisX, block->v0x, block->v2x, time);
    const float8 e1y = edge(ray->axisY, block->v0x, block->v1x, time),
                 e2y = edge(ray->axisY, block->v0x, block->v2x, time);
    const float8 e1z = edge(ray->axisZ, block->v0x, block->v1x, time),
                 e2z = edge(ray->axisZ, block->v0x, block->v2x, time);
    const float8 nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    const Vec3 d = ray->testDirection;
    const float8 t = (nx * ax + ny * ay + nz * az) / (nx * d.x + ny * d.y + nz * d.z);
    const int8 beyond = WEDGE_BEYOND_START(ray, t, vload8(0, block->triangle));
#ifdef WEDGE_MOTION
    const int8 in = inside & beyond & (t <= hit->t) & WEDGE_SPANS_AREA(nx, ny, nz, e1x, e1y, e1z, e2x, e2y, e2z);
#else
    const int8 in = inside & beyond & (t <= hit->t);
#endif
    if (laneMask(in) == 0)
        return false;
    const float8 inverse = 1.0f / sum;
#ifdef WEDGE_CUTOUTS
    return nearestSolid(block, ray, in, t, u * inverse, v * inverse, hit);
#else
    const float8 candidate = in ? t : (float8)(INFINITY);
    const float nearest = smallestLane(candidate);
    const uint lane = firstLane(laneMask(candidate == nearest));
    const uint triangle = block->triangle[lane];
    if (nearest == hit->t && triangle > hit->triangle)
        return false;
    float us[WEDGE_BLOCK_SIZE], vs[WEDGE_BLOCK_SIZE];
    vstore8(u * inverse, 0, us);
    vstore8(v * inverse, 0, vs);
    hit->t = nearest;
    hit->u = us[lane];
    hit->v = vs[lane];
    hit->triangle = triangle;
    return true;
#endif
}

#endif
