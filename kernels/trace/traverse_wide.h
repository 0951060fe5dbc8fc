// One ray through the 8-wide hierarchy: the nearest hit, or whether there is any. For devices whose work-items run
// vectors of 8: CPUs.
#ifndef WEDGE_TRAVERSE_WIDE_H
#define WEDGE_TRAVERSE_WIDE_H

#include "trace/intersect.h"

/// Walks the subtree of a reference (0: all) front to back, and writes the nearest hit, or, with any, the first one it
/// comes across.
/// Nodes and leaves take turns in one flat loop, which is faster here than a loop over nodes that ends in a loop
/// over leaves. The builder guarantees that the stack suffices.
WEDGE_FN void traverse(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    uint reference, const TraversalRay* ray, const bool any, Hit* hit)
{
    uint stack[WEDGE_BVH_STACK];
    float enters[WEDGE_BVH_STACK]; // where the ray enters each
    float tCull = hit->t * WEDGE_WIDEN_T; // beyond this nothing matters any more
    int depth = 0;
    uint current = reference;
    for (;;) {
        if (current & WEDGE_BVH_LEAF) {
            __global const TriangleBlock* block = blocks + ((current & ~WEDGE_BVH_LEAF) >> 3);
            for (uint left = current & 7u; left != 0; left--, block++)
                if (intersectBlock(block, ray, hit) && any)
                    return;
            tCull = hit->t * WEDGE_WIDEN_T;
        } else {
            __global const TraversalNode* node = nodes + current;
            float8 tEnter;
            LaneMask lanes = intersectBoxes(node, ray, tCull, &tEnter);
            if (lanes) {
                uint lane = firstLane(lanes);
                lanes = dropFirstLane(lanes);
                current = node->child[lane];
                if (lanes == 0)
                    continue;
                if (any) {
                    do {
                        lane = firstLane(lanes);
                        lanes = dropFirstLane(lanes);
                        stack[depth++] = node->child[lane];
                    } while (lanes);
                    continue;
                }
                // The nearest child is next; the others go onto the stack, farthest first.
                float t[WEDGE_BVH_WIDTH];
                vstore8(tEnter, 0, t);
                float nearest = t[lane];
                const int base = depth;
                do {
                    lane = firstLane(lanes);
                    lanes = dropFirstLane(lanes);
                    uint child = node->child[lane];
                    float enter = t[lane];
                    if (enter < nearest) {
                        const uint c = child;
                        child = current;
                        current = c;
                        const float e = enter;
                        enter = nearest;
                        nearest = e;
                    }
                    int place = depth++;
                    for (; place > base && enters[place - 1] < enter; place--) {
                        stack[place] = stack[place - 1];
                        enters[place] = enters[place - 1];
                    }
                    stack[place] = child;
                    enters[place] = enter;
                } while (lanes);
                continue;
            }
        }
        do {
            if (depth == 0)
                return;
            depth--;
        } while (!any && enters[depth] > tCull);
        current = stack[depth];
    }
}

#endif
