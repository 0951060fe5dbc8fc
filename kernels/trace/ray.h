// A ray as traversals and intersection tests want it, prepared once.
#ifndef WEDGE_RAY_H
#define WEDGE_RAY_H

#include "shared/bvh_types.h"
#include "shared/compat.h"
#include "shared/vec.h"
#include "trace/cutouts.h"
#include "trace/motion.h"

/// Children of a node of the family of traversals that the program is built for.
#ifdef WEDGE_TRAVERSAL_SCALAR
#define WEDGE_NODE_WIDTH WEDGE_BVH_NARROW_WIDTH
#else
#define WEDGE_NODE_WIDTH WEDGE_BVH_WIDTH
#endif

/// Box tests widen by these so that no ray slips between boxes through rounding: t by a part of itself (the
/// reciprocal of 2.5 ulp, twice, the multiply-add, and room for the rounding of a triangle's t), planes by a
/// part of the origin's coordinate (it is multiplied and subtracted rounded), and by an absolute distance, in
/// scenes of unit size, that keeps rays within the plane of a face through 0.
#define WEDGE_WIDEN_T 1.000001f
#define WEDGE_WIDEN_ORIGIN 2.4e-7f
#define WEDGE_WIDEN_PLANE 1e-12f

// Written as a choice, not as min and max: where one operand is NaN (infinity minus infinity, from origins far beyond
// the scene) it takes the second, which errs towards entering a box; and it is one instruction.
#define WEDGE_MIN(a, b) ((a) < (b) ? (a) : (b))
#define WEDGE_MAX(a, b) ((a) > (b) ? (a) : (b))

/// Whether a triangle at t lies on a ray or a packet's rays, before their ends. Where bodies of glass touch, rays go on
/// behind one of several faces at the same t.
#ifdef WEDGE_TOUCHING_GLASS
#define WEDGE_BEYOND_START(ray, t, triangle)                                                                           \
    (((t) > (ray)->tMin) | (((t) == (ray)->tMin) & ((triangle) > (ray)->after)))
#else
#define WEDGE_BEYOND_START(ray, t, triangle) ((t) > (ray)->tMin)
#endif

/// A ray as the tests want it, in the units of the hierarchy. t is the caller's.
typedef struct {
    float tMin, tMax; ///< hits have tMin < t <= tMax
#ifdef WEDGE_TOUCHING_GLASS
    uint after; ///< and at tMin itself triangles above this one count as well; WEDGE_NO_TRIANGLE: none
#endif
    Vec3 nearScale, nearOffset; ///< t of a near plane p = p scale + offset, rounded towards earlier
    Vec3 farScale, farOffset; ///< the same of the far planes, towards later
    uint nearX, nearY, nearZ, farX, farY, farZ; ///< where these planes start in a node, in floats
    Vec3 testOrigin, testDirection; ///< in the axes of the triangle test, whose z is the direction's largest
    float shearX, shearY; ///< x and y of the direction over its z
    uint axisX, axisY, axisZ; ///< where these coordinates start in a vertex of a block, in floats
#ifdef WEDGE_MOTION
    float time; ///< 0 to 1
#endif
#ifdef WEDGE_CUTOUTS
    __global const uint* cutouts; ///< the table; prepareRay leaves it to its caller
#endif
} TraversalRay;

WEDGE_FN float boundedReciprocal(float x) { return 1.0f / (fabs(x) < 1e-30f ? copysign(1e-30f, x) : x); }

/// v with its axes turned so that the largest of the direction comes last.
WEDGE_FN Vec3 turnAxes(Vec3 v, bool largestX, bool largestY)
{
    return largestX ? vec3(v.y, v.z, v.x) : largestY ? vec3(v.z, v.x, v.y) : v;
}

/// Finds the near and far planes of nodes from the signs of nearScale.
WEDGE_FN void choosePlanes(TraversalRay* ray)
{
    // loX hiX loY hiY loZ hiZ lie WEDGE_NODE_WIDTH floats apart; rays against an axis enter through hi.
    ray->nearX = ray->nearScale.x < 0.0f ? WEDGE_NODE_WIDTH : 0;
    ray->nearY = (ray->nearScale.y < 0.0f ? 3 : 2) * WEDGE_NODE_WIDTH;
    ray->nearZ = (ray->nearScale.z < 0.0f ? 5 : 4) * WEDGE_NODE_WIDTH;
    ray->farX = WEDGE_NODE_WIDTH - ray->nearX;
    ray->farY = 5 * WEDGE_NODE_WIDTH - ray->nearY;
    ray->farZ = 9 * WEDGE_NODE_WIDTH - ray->nearZ;
}

/// Finds the coordinates of vertices in the axes of the triangle test. largest: axis of the direction's largest
/// component.
WEDGE_FN void chooseAxes(TraversalRay* ray, int largest)
{
    ray->axisX = (largest == 0 ? 1 : largest == 1 ? 2 : 0) * WEDGE_BLOCK_SIZE;
    ray->axisY = (largest == 0 ? 2 : largest == 1 ? 0 : 1) * WEDGE_BLOCK_SIZE;
    ray->axisZ = largest * WEDGE_BLOCK_SIZE;
}

#ifdef WEDGE_MOTION
/// A time within the shutter: the nearest there is; NaN counts as 0.
WEDGE_FN float boundedTime(float time) { return time > 0.0f ? WEDGE_MIN(time, 1.0f) : 0.0f; }
#endif

/// Prepares the ray origin + t direction, tMin < t < tMax, at the time; a negative tMin counts as 0. unit: that of the
/// root node. Returns false where it can hit nothing: a component is not finite or the interval is empty.
WEDGE_FN bool prepareRay(TraversalRay* ray, float unit, Vec3 origin, Vec3 direction, float tMin, float tMax, float time)
{
#pragma OPENCL FP_CONTRACT ON
    origin = vecScale(origin, unit);
    direction = vecScale(direction, unit);
    ray->tMin = WEDGE_MAX(tMin, 0.0f);
#ifdef WEDGE_TOUCHING_GLASS
    ray->after = WEDGE_NO_TRIANGLE;
#endif
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
    const bool largestX = fabs(direction.x) >= fabs(direction.y) && fabs(direction.x) >= fabs(direction.z);
    const bool largestY = !largestX && fabs(direction.y) >= fabs(direction.z);
    chooseAxes(ray, largestX ? 0 : largestY ? 1 : 2);
    ray->testOrigin = turnAxes(origin, largestX, largestY);
    ray->testDirection = turnAxes(direction, largestX, largestY);
    ray->shearX = ray->testDirection.x / ray->testDirection.z;
    ray->shearY = ray->testDirection.y / ray->testDirection.z;
    choosePlanes(ray);
#ifdef WEDGE_MOTION
    ray->time = boundedTime(time);
#else
    (void)time;
#endif
    // Not finite if any of them is not; some compilers take x * 0 == 0 for true. Last, as the tests do not wait for it.
    const float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
    return fabs(sum) < INFINITY && ray->tMin < tMax;
}
#pragma OPENCL FP_CONTRACT OFF

#endif
