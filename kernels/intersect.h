// One ray against the 8 boxes of a node and against a block of triangles, each as one wide vector.
#ifndef WEDGE_INTERSECT_H
#define WEDGE_INTERSECT_H

#include "shared/bvh_types.h"
#include "shared/compat.h"
#include "shared/hit.h"
#include "shared/vec.h"

#if WEDGE_BVH_WIDTH != 8 || WEDGE_BLOCK_SIZE != 8
#error "These tests are written for vectors of 8"
#endif

/// A set of lanes of a vector of 8: the top bit of byte i stands for lane i.
typedef ulong LaneMask;

/// The lanes whose comparison holds (all bits set).
WEDGE_FN LaneMask laneMask(int8 comparison) { return as_ulong(convert_char8(comparison)) & 0x8080808080808080ul; }
/// The lowest lane of a set that is not empty. OpenCL C 1.2 has no count of trailing zeros; compilers know this one.
WEDGE_FN uint firstLane(LaneMask lanes) { return (uint)popcount(~lanes & (lanes - 1)) >> 3; }
/// The set without its lowest lane.
WEDGE_FN LaneMask dropFirstLane(LaneMask lanes) { return lanes & (lanes - 1); }

/// Box tests widen by these so that no ray slips between boxes through rounding: t by a part of itself (the
/// reciprocal of 2.5 ulp, twice, the multiply-add, and room for the rounding of a triangle's t), planes by a
/// part of the origin's coordinate (it is multiplied and subtracted rounded), and by an absolute distance, in
/// scenes of unit size, that keeps rays within the plane of a face through 0.
#define WEDGE_WIDEN_T 1.000001f
#define WEDGE_WIDEN_ORIGIN 2.4e-7f
#define WEDGE_WIDEN_PLANE 1e-12f

// Written as a choice, not as min and max: where one operand is NaN (infinity minus infinity, from origins far beyond
// the scene) it takes the other, which errs towards entering a box; and it is one instruction.
#define WEDGE_MIN(a, b) ((a) < (b) ? (a) : (b))
#define WEDGE_MAX(a, b) ((a) > (b) ? (a) : (b))

/// A ray as the tests want it, in the units of the hierarchy. t is the caller's.
typedef struct {
    Vec3 origin, direction;
    float tMin, tMax; ///< hits have tMin < t <= tMax
    Vec3 nearScale, nearOffset; ///< t of a near plane p = p scale + offset, rounded towards earlier
    Vec3 farScale, farOffset; ///< the same of the far planes, towards later
    uint nearX, nearY, nearZ, farX, farY, farZ; ///< where these planes start in a node, in floats
} TraversalRay;

WEDGE_FN float boundedReciprocal(float x) { return 1.0f / (fabs(x) < 1e-30f ? copysign(1e-30f, x) : x); }

/// Prepares the ray origin + t direction, tMin < t < tMax; a negative tMin counts as 0. unit: that of the root node.
/// Returns false where it can hit nothing: a component is not finite or the interval is empty.
WEDGE_FN bool prepareRay(TraversalRay* ray, float unit, Vec3 origin, Vec3 direction, float tMin, float tMax)
{
#pragma OPENCL FP_CONTRACT ON
    origin = vecScale(origin, unit);
    direction = vecScale(direction, unit);
    ray->origin = origin;
    ray->direction = direction;
    ray->tMin = WEDGE_MAX(tMin, 0.0f);
    // The float before tMax, or before infinity.
    ray->tMax = as_float(as_uint(tMax) - 1u);
    const Vec3 r = vec3(boundedReciprocal(direction.x), boundedReciprocal(direction.y), boundedReciprocal(direction.z));
    const Vec3 offset = vec3(-origin.x * r.x, -origin.y * r.y, -origin.z * r.z);
    const Vec3 slack = vec3(fabs(offset.x) * WEDGE_WIDEN_ORIGIN + fabs(r.x) * WEDGE_WIDEN_PLANE,
        fabs(offset.y) * WEDGE_WIDEN_ORIGIN + fabs(r.y) * WEDGE_WIDEN_PLANE,
        fabs(offset.z) * WEDGE_WIDEN_ORIGIN + fabs(r.z) * WEDGE_WIDEN_PLANE);
    ray->nearScale = r;
    ray->nearOffset = vecSub(offset, slack);
    ray->farScale = vecScale(r, WEDGE_WIDEN_T);
    ray->farOffset = vecMad(slack, offset, WEDGE_WIDEN_T);
    // loX hiX loY hiY loZ hiZ lie WEDGE_BVH_WIDTH floats apart; rays against an axis enter through hi.
    ray->nearX = r.x < 0.0f ? WEDGE_BVH_WIDTH : 0;
    ray->nearY = (r.y < 0.0f ? 3 : 2) * WEDGE_BVH_WIDTH;
    ray->nearZ = (r.z < 0.0f ? 5 : 4) * WEDGE_BVH_WIDTH;
    ray->farX = WEDGE_BVH_WIDTH - ray->nearX;
    ray->farY = 5 * WEDGE_BVH_WIDTH - ray->nearY;
    ray->farZ = 9 * WEDGE_BVH_WIDTH - ray->nearZ;
    // 0 times a finite number is 0, and times anything else NaN. Last, since it is not what the tests wait for.
    const float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
    return sum * 0.0f == 0.0f && ray->tMin < tMax;
}

/// The children of a node that the ray enters by t = tCull, and where it enters each. Boxes are widened by more than
/// their roundings, so fusing multiply-adds, or not, loses no hit.
WEDGE_FN LaneMask intersectBoxes(__global const BvhNode* node, const TraversalRay* ray, float tCull, float8* tEnter)
{
#pragma OPENCL FP_CONTRACT ON
    __global const float* planes = node->loX;
    const float8 nearX = vload8(0, planes + ray->nearX) * ray->nearScale.x + ray->nearOffset.x;
    const float8 nearY = vload8(0, planes + ray->nearY) * ray->nearScale.y + ray->nearOffset.y;
    const float8 nearZ = vload8(0, planes + ray->nearZ) * ray->nearScale.z + ray->nearOffset.z;
    const float8 farX = vload8(0, planes + ray->farX) * ray->farScale.x + ray->farOffset.x;
    const float8 farY = vload8(0, planes + ray->farY) * ray->farScale.y + ray->farOffset.y;
    const float8 farZ = vload8(0, planes + ray->farZ) * ray->farScale.z + ray->farOffset.z;
    const float8 nearXY = WEDGE_MAX(nearX, nearY), nearZ0 = WEDGE_MAX(nearZ, (float8)(ray->tMin));
    const float8 farXY = WEDGE_MIN(farX, farY), farZ0 = WEDGE_MIN(farZ, (float8)(tCull));
    const float8 enter = WEDGE_MAX(nearXY, nearZ0);
    const float8 leave = WEDGE_MIN(farXY, farZ0);
    *tEnter = enter;
    return laneMask(enter <= leave);
}

WEDGE_FN float smallestLane(float8 x)
{
    const float4 four = WEDGE_MIN(x.lo, x.hi);
    const float2 two = WEDGE_MIN(four.lo, four.hi);
    return WEDGE_MIN(two.x, two.y);
}

/// Intersects a block and replaces hit where one of its triangles is hit at tMin < t <= hit->t; of equal t the smaller
/// index wins, so that the order of blocks does not show. Returns whether anything was hit.
/// The triangle test is that of Möller and Trumbore in the form that tests the signed volumes before it divides.
/// Multiply-adds are not fused here (compat.h): fused, three times as many rays slip through shared edges.
WEDGE_FN bool intersectBlock(__global const TriangleBlock* block, const TraversalRay* ray, Hit* hit)
{
    const Vec3 o = ray->origin, d = ray->direction;
    const float8 cx = vload8(0, block->v0x) - o.x, cy = vload8(0, block->v0y) - o.y, cz = vload8(0, block->v0z) - o.z;
    const float8 e1x = vload8(0, block->e1x), e1y = vload8(0, block->e1y), e1z = vload8(0, block->e1z);
    const float8 e2x = vload8(0, block->e2x), e2y = vload8(0, block->e2y), e2z = vload8(0, block->e2z);
    const float8 rx = cy * d.z - cz * d.y, ry = cz * d.x - cx * d.z, rz = cx * d.y - cy * d.x;
    const float8 nx = e1y * e2z - e1z * e2y, ny = e1z * e2x - e1x * e2z, nz = e1x * e2y - e1y * e2x;
    const float8 volume = nx * d.x + ny * d.y + nz * d.z;
    const int8 sign = as_int8(volume) & (int)0x80000000;
    const int8 opposite = sign ^ (int)0x80000000;
    const float8 size = as_float8(as_int8(volume) ^ sign);
    const float8 u = as_float8(as_int8(rx * e2x + ry * e2y + rz * e2z) ^ sign);
    const float8 v = as_float8(as_int8(rx * e1x + ry * e1y + rz * e1z) ^ opposite);
    const float8 w = as_float8(as_int8(nx * cx + ny * cy + nz * cz) ^ sign);
    // Widened, for ties: the decision is that of the rounded t below, the one that is returned and compared.
    const float tFar = hit->t * WEDGE_WIDEN_T;
    const int8 inside = (u >= 0.0f) & (v >= 0.0f) & (u + v <= size) & (w > size * ray->tMin) & (w <= size * tFar);
    if (laneMask(inside) == 0)
        return false;
    const float8 inverse = 1.0f / size;
    const float8 t = w * inverse;
    const int8 in = inside & (t > ray->tMin) & (t <= hit->t);
    if (laneMask(in) == 0)
        return false;
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
}

#endif
