// What kernels trace rays with: closestHit and anyHit over nodes of type TraversalNode. Two families of traversals
// stand behind them; the host chooses one by what the device is (Options::traversal) and uploads the nodes that it
// walks.
#ifndef WEDGE_TRAVERSE_H
#define WEDGE_TRAVERSE_H

// What both include comes first: a file is put into the program once, where it is first included, and that must not be
// within the branch of one family.
#include "shared/hit.h"
#include "trace/ray.h"

#ifdef WEDGE_TRAVERSAL_SCALAR
#include "trace/traverse_scalar.h"
#else
#include "trace/traverse_wide.h"
#endif

/// The nearest hit of origin + t direction, tMin < t < tMax, on either face of the triangles; of hits at equal t the
/// one of the smallest index. after: in programs with WEDGE_TOUCHING_GLASS triangles above this index count at tMin
/// itself, too, so that (t, triangle) of a hit leads to the next one; WEDGE_NO_TRIANGLE: none does. The direction may
/// have any length. A negative tMin counts as 0; a ray with a NaN or infinity (but in tMax) or a zero direction hits
/// nothing. On a miss triangle is WEDGE_NO_TRIANGLE and t = tMax. time: at which the ray is sent, from 0, where the
/// shutter opens, to 1, where it closes. What does not move (programs without WEDGE_MOTION) has none.
WEDGE_FN Hit closestHitAfter(__global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, Vec3 origin, Vec3 direction, float tMin, uint after, float tMax,
    float time)
{
    Hit hit;
    hit.t = tMax;
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.triangle = WEDGE_NO_TRIANGLE;
    TraversalRay ray;
    if (!prepareRay(&ray, nodes->unit, origin, direction, tMin, tMax, time))
        return hit;
    hit.t = ray.tMax;
#ifdef WEDGE_TOUCHING_GLASS
    ray.after = after;
#else
    (void)after;
#endif
#ifdef WEDGE_CUTOUTS
    ray.cutouts = WEDGE_CUTOUT_TABLE(nodes, blocks);
#endif
    traverse(nodes, blocks, 0, &ray, false, &hit);
    if (hit.triangle == WEDGE_NO_TRIANGLE)
        hit.t = tMax;
    return hit;
}

/// The same of all hits behind tMin.
WEDGE_FN Hit closestHit(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    Vec3 origin, Vec3 direction, float tMin, float tMax, float time)
{
    return closestHitAfter(nodes, blocks, origin, direction, tMin, WEDGE_NO_TRIANGLE, tMax, time);
}

/// Whether any triangle lies at tMin < t < tMax; the conditions of closestHit.
WEDGE_FN bool anyHit(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    Vec3 origin, Vec3 direction, float tMin, float tMax, float time)
{
    TraversalRay ray;
    if (!prepareRay(&ray, nodes->unit, origin, direction, tMin, tMax, time))
        return false;
#ifdef WEDGE_CUTOUTS
    ray.cutouts = WEDGE_CUTOUT_TABLE(nodes, blocks);
#endif
    Hit hit;
    hit.t = ray.tMax;
    hit.triangle = WEDGE_NO_TRIANGLE;
    traverse(nodes, blocks, 0, &ray, true, &hit);
    return hit.triangle != WEDGE_NO_TRIANGLE;
}

#endif
