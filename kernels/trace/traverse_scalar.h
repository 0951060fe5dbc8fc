// One ray through the narrow tree: the nearest hit, or whether there is any. For devices whose work-items run one lane
// of a vector each: GPUs. Four boxes are tested at once for the sake of their loads, triangles one at a time; what
// lives through the loop is a ray, a hit and a few words, so that many work-items fit on a processor.
// The hits are those of traverse_wide.h, to the last bit where multiply-adds are not fused.
#ifndef WEDGE_TRAVERSE_SCALAR_H
#define WEDGE_TRAVERSE_SCALAR_H

#include "shared/hit.h"
#include "trace/ray.h"

/// The node that this family of traversals walks.
#ifdef WEDGE_MOTION
typedef MovingNode4 TraversalNode;
#else
typedef BvhNode4 TraversalNode;
#endif

/// References of the children that the ray enters by t = tCull, nearest first, and where it enters each; the others
/// are empty leaves and come last.
WEDGE_FN uint4 enterChildren(__global const TraversalNode* node, const TraversalRay* ray, float tCull, float4* tEnter)
{
#pragma OPENCL FP_CONTRACT ON
    __global const float* planes = node->loX;
    const float4 nearX = WEDGE_PLANES4(planes + ray->nearX, WEDGE_TIME_OF(ray)) * ray->nearScale.x + ray->nearOffset.x;
    const float4 nearY = WEDGE_PLANES4(planes + ray->nearY, WEDGE_TIME_OF(ray)) * ray->nearScale.y + ray->nearOffset.y;
    const float4 nearZ = WEDGE_PLANES4(planes + ray->nearZ, WEDGE_TIME_OF(ray)) * ray->nearScale.z + ray->nearOffset.z;
    const float4 farX = WEDGE_PLANES4(planes + ray->farX, WEDGE_TIME_OF(ray)) * ray->farScale.x + ray->farOffset.x;
    const float4 farY = WEDGE_PLANES4(planes + ray->farY, WEDGE_TIME_OF(ray)) * ray->farScale.y + ray->farOffset.y;
    const float4 farZ = WEDGE_PLANES4(planes + ray->farZ, WEDGE_TIME_OF(ray)) * ray->farScale.z + ray->farOffset.z;
    const float4 nearXY = WEDGE_MAX(nearX, nearY), nearZ0 = WEDGE_MAX(nearZ, (float4)(ray->tMin));
    const float4 farXY = WEDGE_MIN(farX, farY), farZ0 = WEDGE_MIN(farZ, (float4)(tCull));
    const float4 enter = WEDGE_MAX(nearXY, nearZ0);
    const float4 leave = WEDGE_MIN(farXY, farZ0);
    const int4 entered = enter <= leave;
    float4 t = entered ? enter : (float4)(INFINITY);
    uint4 child = entered ? vload4(0, node->child) : (uint4)(WEDGE_BVH_LEAF);
    // A network of five exchanges, without a branch that neighbours might not share.
    const int2 swapA = t.xy > t.zw;
    t = (float4)(swapA ? t.zw : t.xy, swapA ? t.xy : t.zw);
    child = (uint4)(swapA ? child.zw : child.xy, swapA ? child.xy : child.zw);
    const int2 swapB = t.xz > t.yw;
    t = (float4)(swapB ? t.yw : t.xz, swapB ? t.xz : t.yw).xzyw;
    child = (uint4)(swapB ? child.yw : child.xz, swapB ? child.xz : child.yw).xzyw;
    const bool swapC = t.y > t.z;
    *tEnter = swapC ? t.xzyw : t;
    return swapC ? child.xzyw : child;
}
#pragma OPENCL FP_CONTRACT OFF

/// One triangle of a block as intersectBlock of intersect.h tests it, operation by operation. Returns whether it
/// replaced hit.
WEDGE_FN bool intersectTriangle(__global const TriangleBlock* block, uint lane, const TraversalRay* ray, Hit* hit)
{
    __global const float* v0 = block->v0x + lane;
    __global const float* v1 = block->v1x + lane;
    __global const float* v2 = block->v2x + lane;
    const Vec3 p0 = vec3(WEDGE_CORNER(v0, ray->axisX, WEDGE_TIME_OF(ray)),
        WEDGE_CORNER(v0, ray->axisY, WEDGE_TIME_OF(ray)), WEDGE_CORNER(v0, ray->axisZ, WEDGE_TIME_OF(ray)));
    const Vec3 p1 = vec3(WEDGE_CORNER(v1, ray->axisX, WEDGE_TIME_OF(ray)),
        WEDGE_CORNER(v1, ray->axisY, WEDGE_TIME_OF(ray)), WEDGE_CORNER(v1, ray->axisZ, WEDGE_TIME_OF(ray)));
    const Vec3 p2 = vec3(WEDGE_CORNER(v2, ray->axisX, WEDGE_TIME_OF(ray)),
        WEDGE_CORNER(v2, ray->axisY, WEDGE_TIME_OF(ray)), WEDGE_CORNER(v2, ray->axisZ, WEDGE_TIME_OF(ray)));
    const Vec3 a = vecSub(p0, ray->testOrigin), b = vecSub(p1, ray->testOrigin), c = vecSub(p2, ray->testOrigin);
    const float ax = a.x - ray->shearX * a.z, ay = a.y - ray->shearY * a.z;
    const float bx = b.x - ray->shearX * b.z, by = b.y - ray->shearY * b.z;
    const float cx = c.x - ray->shearX * c.z, cy = c.y - ray->shearY * c.z;
    const float u = ax * cy - ay * cx;
    const float v = bx * ay - by * ax;
    const float w = cx * by - cy * bx;
    const float least = WEDGE_MIN(WEDGE_MIN(u, v), w), most = WEDGE_MAX(WEDGE_MAX(u, v), w);
    const float sum = u + v + w;
    if (!((least >= 0.0f || most <= 0.0f) && sum != 0.0f))
        return false;
    const Vec3 e1 = vecSub(p1, p0), e2 = vecSub(p2, p0), n = vecCross(e1, e2);
#ifdef WEDGE_MOTION
    if (!WEDGE_SPANS_AREA(n.x, n.y, n.z, e1.x, e1.y, e1.z, e2.x, e2.y, e2.z))
        return false;
#endif
    const float t = vecDot(n, a) / vecDot(n, ray->testDirection);
    const uint triangle = block->triangle[lane];
    if (!(WEDGE_BEYOND_START(ray, t, triangle) && t <= hit->t))
        return false;
    if (t == hit->t && triangle > hit->triangle)
        return false;
    const float inverse = 1.0f / sum;
#ifdef WEDGE_CUTOUTS
    if (isHole(
            ray->cutouts, triangle, u * inverse, v * inverse, ray->testOrigin, ray->testDirection, WEDGE_TIME_OF(ray)))
        return false;
#endif
    hit->t = t;
    hit->u = u * inverse;
    hit->v = v * inverse;
    hit->triangle = triangle;
    return true;
}

/// Tests the triangles of a leaf. Returns whether any was hit; with any, after the first.
WEDGE_FN bool intersectLeaf(
    __global const TriangleBlock* block, uint blockCount, const TraversalRay* ray, const bool any, Hit* hit)
{
    bool found = false;
    for (uint i = 0; i < blockCount * WEDGE_BLOCK_SIZE; i++) {
        found |= intersectTriangle(block + i / WEDGE_BLOCK_SIZE, i % WEDGE_BLOCK_SIZE, ray, hit);
        if (any && found)
            break;
    }
    return found;
}

/// Walks the subtree of a reference (0: all) front to back, and writes the nearest hit, or, with any, the first one it
/// comes across. The narrow tree needs no more of the stack than the wide one (bvh/narrow_tree.h).
WEDGE_FN void traverse(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    uint reference, const TraversalRay* ray, const bool any, Hit* hit)
{
    uint stack[WEDGE_BVH_STACK];
    float enters[WEDGE_BVH_STACK]; // where the ray enters each
    float tCull = hit->t * WEDGE_WIDEN_T; // beyond this nothing matters any more
    int depth = 0;
    uint current = reference;
    for (;;) {
        if (!(current & WEDGE_BVH_LEAF)) {
            float4 t;
            const uint4 child = enterChildren(nodes + current, ray, tCull, &t);
            // The nearest child is next; the others go onto the stack, farthest first.
            if (child.w != WEDGE_BVH_LEAF) {
                stack[depth] = child.w;
                enters[depth++] = t.w;
            }
            if (child.z != WEDGE_BVH_LEAF) {
                stack[depth] = child.z;
                enters[depth++] = t.z;
            }
            if (child.y != WEDGE_BVH_LEAF) {
                stack[depth] = child.y;
                enters[depth++] = t.y;
            }
            current = child.x;
            if (current != WEDGE_BVH_LEAF)
                continue;
        } else {
            const uint first = (current & ~WEDGE_BVH_LEAF) >> 3;
            if (intersectLeaf(blocks + first, current & 7u, ray, any, hit) && any)
                return;
            tCull = hit->t * WEDGE_WIDEN_T;
        }
        do {
            if (depth == 0)
                return;
            depth--;
        } while (enters[depth] > tCull);
        current = stack[depth];
    }
}

#endif
