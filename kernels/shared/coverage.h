// How much of a pixel, or of the lens, a quad covers, in closed form.
#ifndef WEDGE_SHARED_COVERAGE_H
#define WEDGE_SHARED_COVERAGE_H

#include "bsdf.h"
#include "vec.h"

WEDGE_SHARED_BEGIN

/// A convex quad, corners around it: in the image, pixels from a pixel's centre, or on the lens, in its radii.
typedef struct {
    Vec2 corners[4];
} ImageQuad;

WEDGE_FN float crossOf(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/// The part of pixelCoverage() that one edge makes: the square's part before the edge's x, along the edge's y.
WEDGE_FN float edgeCoverage(Vec2 from, Vec2 to)
{
    const float first = clamp(from.y, -0.5f, 0.5f), last = clamp(to.y, -0.5f, 0.5f);
    if (first == last) {
        return 0.0f;
    }
    const float slope = (to.x - from.x) / (to.y - from.y);
    // Where the edge enters the square's range of x and where it leaves there is a kink; between them all is linear.
    const float low = fmin(first, last), high = fmax(first, last);
    const float left = slope != 0.0f ? clamp(from.y + (-0.5f - from.x) / slope, low, high) : first;
    const float right = slope != 0.0f ? clamp(from.y + (0.5f - from.x) / slope, low, high) : first;
    const bool inOrder = fabs(left - first) <= fabs(right - first);
    const float ends[4] = { first, inOrder ? left : right, inOrder ? right : left, last };
    float sum = 0.0f;
    for (uint part = 0u; part < 3u; ++part) {
        const float middle = 0.5f * (ends[part] + ends[part + 1u]);
        sum += (clamp(from.x + slope * (middle - from.y), -0.5f, 0.5f) + 0.5f) * (ends[part + 1u] - ends[part]);
    }
    return sum;
}

/// The share of a pixel's square that a quad covers. Green's theorem: each edge by itself.
WEDGE_FN float pixelCoverage(ImageQuad quad)
{
    float sum = 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        sum += edgeCoverage(quad.corners[k], quad.corners[(k + 1u) % 4u]);
    }
    return fmin(fabs(sum), 1.0f);
}

/// The angle at the origin from a to b, radians.
WEDGE_FN float angleOf(Vec2 a, Vec2 b) { return atan2(crossOf(a, b), a.x * b.x + a.y * b.y); }

/// Twice the area that the unit disc and the triangle of its centre and an edge share, negative clockwise.
WEDGE_FN float edgeInDisc(Vec2 from, Vec2 to)
{
    const Vec2 d = vec2(to.x - from.x, to.y - from.y);
    const float a = d.x * d.x + d.y * d.y, b = from.x * d.x + from.y * d.y;
    // Not b^2 - a (from^2 - 1), whose digits cancel where corners are far from the disc.
    const float c = crossOf(from, d), root = a - c * c;
    if (!(a > 0.0f)) {
        return 0.0f;
    }
    // Where the edge is within the disc, from 0 to 1 along it.
    const float reach = sqrt(fmax(root, 0.0f));
    const float enters = fmax((-b - reach) / a, 0.0f), leaves = fmin((-b + reach) / a, 1.0f);
    if (root <= 0.0f || enters >= leaves) {
        return angleOf(from, to);
    }
    const Vec2 in = vec2(from.x + enters * d.x, from.y + enters * d.y);
    const Vec2 out = vec2(from.x + leaves * d.x, from.y + leaves * d.y);
    return (enters > 0.0f ? angleOf(from, in) : 0.0f) + crossOf(in, out) + (leaves < 1.0f ? angleOf(out, to) : 0.0f);
}

/// The share of the unit disc that a quad covers.
WEDGE_FN float discCoverage(ImageQuad quad)
{
    float sum = 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        sum += edgeInDisc(quad.corners[k], quad.corners[(k + 1u) % 4u]);
    }
    return fmin(fabs(sum) * (0.5f * WEDGE_INV_PI), 1.0f);
}

/// Where the square around the origin with edges at that distance lies: -1 beyond an edge of the quad, 1 in the quad, 0
/// in part, or perhaps.
WEDGE_FN int squareInQuad(ImageQuad quad, float reach)
{
    const Vec2* c = quad.corners;
    const float turn =
        crossOf(vec2(c[1].x - c[0].x, c[1].y - c[0].y), vec2(c[2].x - c[1].x, c[2].y - c[1].y)) < 0.0f ? -1.0f : 1.0f;
    bool inside = true;
    for (uint k = 0u; k < 4u; ++k) {
        const Vec2 from = c[k], to = c[(k + 1u) % 4u], along = vec2(to.x - from.x, to.y - from.y);
        const float middle = turn * crossOf(along, vec2(-from.x, -from.y));
        const float spread = reach * (fabs(along.x) + fabs(along.y));
        if (middle + spread < 0.0f) {
            return -1;
        }
        inside = inside && middle - spread > 0.0f;
    }
    return inside ? 1 : 0;
}

WEDGE_SHARED_END

#endif
