// Packets of 16 rays through the 8-wide hierarchy: one shaft around all rays is tested against the 8 boxes of a node,
// then the 16 rays against each box that the shaft meets, and against each triangle.
#ifndef WEDGE_PACKET_WIDE_H
#define WEDGE_PACKET_WIDE_H

#include "trace/packet_shaft.h"
#include "trace/packet_triangle.h"
#include "trace/traverse_wide.h"

/// Below this many rays a subtree is walked by each alone.
#ifndef WEDGE_MIN_PACKET_RAYS
#define WEDGE_MIN_PACKET_RAYS 5
#endif

WEDGE_FN TraversalRay rayOfLane(const TraversalPacket* p, uint lane)
{
    TraversalRay r;
    r.tMin = WEDGE_LANE(p->tMin, lane);
    r.tMax = WEDGE_LANE(p->tFar, lane);
#ifdef WEDGE_TOUCHING_GLASS
    r.after = ((const uint*)&p->after)[lane];
#endif
    r.nearScale =
        vec3(WEDGE_LANE(p->x.nearScale, lane), WEDGE_LANE(p->y.nearScale, lane), WEDGE_LANE(p->z.nearScale, lane));
    r.nearOffset =
        vec3(WEDGE_LANE(p->x.nearOffset, lane), WEDGE_LANE(p->y.nearOffset, lane), WEDGE_LANE(p->z.nearOffset, lane));
    r.farScale =
        vec3(WEDGE_LANE(p->x.farScale, lane), WEDGE_LANE(p->y.farScale, lane), WEDGE_LANE(p->z.farScale, lane));
    r.farOffset =
        vec3(WEDGE_LANE(p->x.farOffset, lane), WEDGE_LANE(p->y.farOffset, lane), WEDGE_LANE(p->z.farOffset, lane));
    choosePlanes(&r);
    r.testOrigin =
        vec3(WEDGE_LANE(p->testOriginX, lane), WEDGE_LANE(p->testOriginY, lane), WEDGE_LANE(p->testOriginZ, lane));
    r.testDirection = vec3(
        WEDGE_LANE(p->testDirectionX, lane), WEDGE_LANE(p->testDirectionY, lane), WEDGE_LANE(p->testDirectionZ, lane));
    r.shearX = WEDGE_LANE(p->shearX, lane);
    r.shearY = WEDGE_LANE(p->shearY, lane);
    chooseAxes(&r, ((const int*)&p->axis)[lane]);
#ifdef WEDGE_MOTION
    r.time = WEDGE_LANE(p->time, lane);
#endif
#ifdef WEDGE_CUTOUTS
    r.cutouts = p->cutouts;
#endif
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
WEDGE_FN void traversePacket(__global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, const Shaft* shaft, const TestAxes* axes, TraversalPacket* p,
    const bool any)
{
    // One more than single rays need: all children of a node go onto it before the nearest comes off again.
    uint stack[WEDGE_BVH_STACK + 1];
    float enters[WEDGE_BVH_STACK + 1];
    LaneMask16 rays[WEDGE_BVH_STACK + 1];
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
            __global const TraversalNode* node = nodes + current;
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

/// Sends the rays through the hierarchy.
WEDGE_FN void tracePacket(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    TraversalPacket* p, const bool any)
{
    const int16 live = p->tFar >= 0.0f;
    if (!anyLane(live))
        return;
#ifdef WEDGE_CUTOUTS
    p->cutouts = WEDGE_CUTOUT_TABLE(nodes, blocks);
#endif
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
