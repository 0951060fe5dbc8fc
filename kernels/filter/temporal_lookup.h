// Where a surface point is seen in an earlier frame, and how kept light lies around there.
#ifndef WEDGE_TEMPORAL_LOOKUP_H
#define WEDGE_TEMPORAL_LOOKUP_H

#include "core/packed_planes.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/temporal.h"

/// Weights of the four pixels around a point add up to more where all of them see its surface.
#define WEDGE_ALL_TAPS 0.999f
/// Weights of those that see it, at least, for the surface to be seen: the mean of a few beside an edge is off by
/// light's gradient.
#define WEDGE_LEAST_TAPS 0.5f

/// A surface point as the earlier frame's camera looks for it.
typedef struct {
    Vec3 position, normal;
    uint object;
} SoughtPoint;

/// Where a point of the object was: false where that is not known.
WEDGE_FN bool movedBack(TemporalParams p, __global const float* motions, SoughtPoint* point, bool* still)
{
    *still = p.cameraStill != 0u && p.objectsStill != 0u;
    if (*still) {
        return true;
    }
    if (point->object == 0u || point->object > p.objects) {
        return false; // it sees nothing, or several objects
    }
    if (p.objectsStill != 0u) {
        return true;
    }
    __global const float* m = motions + (point->object - 1u) * WEDGE_TEMPORAL_MOTION;
    const float kind = m[12];
    *still = kind == WEDGE_TEMPORAL_STILL && p.cameraStill != 0u;
    if (kind != WEDGE_TEMPORAL_MOVED) {
        return kind == WEDGE_TEMPORAL_STILL;
    }
    const Vec3 a = vec3(m[0], m[1], m[2]), b = vec3(m[4], m[5], m[6]), c = vec3(m[8], m[9], m[10]);
    const Vec3 at = point->position;
    point->position = vec3(vecDot(a, at) + m[3], vecDot(b, at) + m[7], vecDot(c, at) + m[11]);
    // Normals as what is across both of two tangents.
    const Vec3 n = point->normal;
    const Vec3 axis = fabs(n.x) < 0.6f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
    const Vec3 u = vecCross(n, axis), v = vecCross(n, u);
    const Vec3 mu = vec3(vecDot(a, u), vecDot(b, u), vecDot(c, u)), mv = vec3(vecDot(a, v), vecDot(b, v), vecDot(c, v));
    const Vec3 across = vecCross(mu, mv);
    const float length = vecLength(across);
    point->normal = length > 0.0f ? vecScale(across, 1.0f / length) : n;
    return true;
}

/// A sought point's plane as pixels of the earlier frame are held against it.
typedef struct {
    float forward, right, down; ///< parts of the camera's vectors along the normal
    float offset; ///< of the eye
    float tolerance; ///< how far off the plane a surface may be, of its depth
} SoughtPlane;

WEDGE_FN SoughtPlane planeOf(TemporalParams p, SoughtPoint point)
{
    SoughtPlane plane;
    plane.right = vecDot(p.right, point.normal);
    plane.down = vecDot(p.down, point.normal);
    // Through the image's corner.
    plane.forward = vecDot(p.forward, point.normal) + (0.5f - 0.5f * (float)p.width) * plane.right
        + (0.5f - 0.5f * (float)p.height) * plane.down;
    plane.offset = vecDot(vecSub(p.eye, point.position), point.normal);
    plane.tolerance = vecLength(p.right);
    return plane;
}

/// Whether the earlier frame's pixel sees the point's surface, no farther from its plane than a pixel is large.
WEDGE_FN bool seesSurface(TemporalParams p, SoughtPoint point, SoughtPlane plane, int x, int y,
    __global const float* depth, __global const uint* facing, __global const uint* object)
{
    if (x < 0 || y < 0 || x >= (int)p.width || y >= (int)p.height) {
        return false;
    }
    const uint i = pixelIndex((uint)x, (uint)y, p.stride);
    const float along = plane.forward + (float)x * plane.right + (float)y * plane.down;
    if (object[i] != point.object || !(fabs(plane.offset + depth[i] * along) <= plane.tolerance * depth[i])) {
        return false;
    }
    const Vec3 normal = unpackNormal(facing[i]);
    const float cosine = vecDot(normal, point.normal);
    return cosine > 0.0f && cosine * cosine >= p.normalCosine * p.normalCosine * vecDot(normal, normal);
}

/// What an earlier frame keeps of surfaces.
typedef struct {
    __global const float* depth;
    __global const uint* facing;
    __global const uint* object;
} KeptSurfaces;

/// A pixel of an earlier frame and those beside it that see the same surface.
typedef struct {
    uint at, stride; ///< elements: the pixel's, and how many farther on the one below it is
    bool across, along; ///< whether both pixels see it: left and right, above and below
} AroundTap;

WEDGE_FN AroundTap aroundTap(TemporalParams p, SoughtPoint point, SoughtPlane plane, int x, int y, KeptSurfaces kept)
{
    AroundTap out;
    out.at = pixelIndex((uint)x, (uint)y, p.stride);
    out.stride = p.stride;
    out.across = seesSurface(p, point, plane, x - 1, y, kept.depth, kept.facing, kept.object)
        && seesSurface(p, point, plane, x + 1, y, kept.depth, kept.facing, kept.object);
    out.along = seesSurface(p, point, plane, x, y - 1, kept.depth, kept.facing, kept.object)
        && seesSurface(p, point, plane, x, y + 1, kept.depth, kept.facing, kept.object);
    return out;
}

/// Takes out of light that was interpolated between four pixels what lines add to curves, as light bends around the
/// nearest one. By half of it at most: it stays positive beside a pixel that is far brighter. light: kept colours, n
/// pixels a plane; away: from the point to the nearest pixel; curve: f (1 - f) / 2 of both axes, f the way between
/// pixels. Returns what the nearest pixel's luminance has more than the point's.
WEDGE_FN float straighten(
    uint n, AroundTap around, __global const float* light, Vec2 away, Vec2 curve, Vec3* interpolated)
{
    const Vec3 own = loadColour(light, n, around.at);
    Vec3 bend = vec3(0.0f, 0.0f, 0.0f);
    float shift = 0.0f;
    if (around.across) {
        const Vec3 before = loadColour(light, n, around.at - 1u);
        const Vec3 after = loadColour(light, n, around.at + 1u);
        bend = vecMad(bend, vecMad(vecAdd(before, after), own, -2.0f), curve.x);
        shift += 0.5f * away.x * (luminance(after) - luminance(before));
    }
    if (around.along) {
        const Vec3 before = loadColour(light, n, around.at - around.stride);
        const Vec3 after = loadColour(light, n, around.at + around.stride);
        bend = vecMad(bend, vecMad(vecAdd(before, after), own, -2.0f), curve.y);
        shift += 0.5f * away.y * (luminance(after) - luminance(before));
    }
    const Vec3 most = vecScale(*interpolated, 0.5f);
    *interpolated = vecSub(*interpolated,
        vec3(clamp(bend.x, -most.x, most.x), clamp(bend.y, -most.y, most.y), clamp(bend.z, -most.z, most.z)));
    return shift;
}

#endif
