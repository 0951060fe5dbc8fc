// How much of a pixel a quad covers, in closed form but for the wide filters' steps.
#ifndef WEDGE_SHARED_COVERAGE_H
#define WEDGE_SHARED_COVERAGE_H

#include "bsdf.h"
#include "camera.h"

/// Steps of the integrals along a part of an edge, of wide filters and of the lens, and of cells that are a fraction of
/// those. The box filter's is exact with one.
#define WEDGE_EDGE_STEPS 24u
#define WEDGE_CELL_STEPS 3u

WEDGE_SHARED_BEGIN

/// A convex quad in the image, corners around it, pixels from a pixel's centre.
typedef struct {
    Vec2 corners[4];
} ImageQuad;

/// From 0 to 1 as s goes, slowly at both ends: where those are a filter's ends its offsets change most.
WEDGE_FN float easedStep(float s) { return s * s * (3.0f - 2.0f * s); }

/// The part of coverage() that one edge makes: the integral of the filter's weight before the edge's x over its
/// weights of y.
WEDGE_FN float edgeCoverage(uint filter, uint mostSteps, Vec2 from, Vec2 to)
{
    const float first = pixelNumber(filter, from.y), last = pixelNumber(filter, to.y);
    if (first == last) {
        return 0.0f;
    }
    const float slope = (to.x - from.x) / (to.y - from.y);
    // Where the edge enters the filter's reach in x and where it leaves there is a kink.
    float kinks[2] = { first, first };
    for (uint k = 0u; k < 2u; ++k) {
        const float x = k == 0u ? -pixelReach(filter) : pixelReach(filter);
        if (slope != 0.0f) {
            kinks[k] = clamp(pixelNumber(filter, from.y + (x - from.x) / slope), fmin(first, last), fmax(first, last));
        }
    }
    const bool inOrder = fabs(kinks[0] - first) <= fabs(kinks[1] - first);
    const float ends[4] = { first, inOrder ? kinks[0] : kinks[1], inOrder ? kinks[1] : kinks[0], last };
    const uint steps = filter == WEDGE_PIXEL_BOX ? 1u : mostSteps;
    float sum = 0.0f;
    for (uint part = 0u; part < 3u; ++part) {
        const float range = ends[part + 1u] - ends[part];
        for (uint k = 0u; range != 0.0f && k < steps; ++k) {
            const float start = easedStep((float)k / (float)steps), end = easedStep(((float)k + 1.0f) / (float)steps);
            const float y = pixelOffset(filter, ends[part] + easedStep(((float)k + 0.5f) / (float)steps) * range);
            sum += pixelNumber(filter, from.x + slope * (y - from.y)) * (end - start) * range;
        }
    }
    return sum;
}

/// Whether all of the quad lies beyond one side of a square around the origin.
WEDGE_FN bool beyondSquare(ImageQuad quad, float reach)
{
    const Vec2* c = quad.corners;
    const float left = fmin(fmin(c[0].x, c[1].x), fmin(c[2].x, c[3].x));
    const float right = fmax(fmax(c[0].x, c[1].x), fmax(c[2].x, c[3].x));
    const float top = fmin(fmin(c[0].y, c[1].y), fmin(c[2].y, c[3].y));
    const float bottom = fmax(fmax(c[0].y, c[1].y), fmax(c[2].y, c[3].y));
    return left >= reach || right <= -reach || top >= reach || bottom <= -reach;
}

/// The share of a pixel, as its filter weighs it, that a quad covers. Green's theorem: each edge by itself. steps:
/// WEDGE_EDGE_STEPS, or WEDGE_CELL_STEPS.
WEDGE_FN float coverage(uint filter, uint steps, ImageQuad quad)
{
    if (beyondSquare(quad, pixelReach(filter))) {
        return 0.0f;
    }
    float sum = 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        sum += edgeCoverage(filter, steps, quad.corners[k], quad.corners[(k + 1u) % 4u]);
    }
    return fmin(fabs(sum), 1.0f);
}

/// The integral of the unit disc's part before an edge's x, over y, along the edge.
WEDGE_FN float edgeInDisc(uint steps, Vec2 from, Vec2 to)
{
    if (from.y == to.y) {
        return 0.0f;
    }
    const float slope = (to.x - from.x) / (to.y - from.y);
    // By the angle of y on the circle, which makes its ends smooth. Kinks: where the line x = offset + slope y meets
    // the circle.
    const float first = asin(clamp(from.y, -1.0f, 1.0f)), last = asin(clamp(to.y, -1.0f, 1.0f));
    const float offset = from.x - slope * from.y, a = 1.0f + slope * slope;
    const float root = sqrt(fmax(a - offset * offset, 0.0f));
    const float low = fmin(first, last), high = fmax(first, last);
    const float one = clamp(asin(clamp((-offset * slope - root) / a, -1.0f, 1.0f)), low, high);
    const float other = clamp(asin(clamp((-offset * slope + root) / a, -1.0f, 1.0f)), low, high);
    const float ends[4] = { first, first < last ? one : other, first < last ? other : one, last };
    float sum = 0.0f;
    for (uint part = 0u; part < 3u; ++part) {
        const float step = (ends[part + 1u] - ends[part]) / (float)steps;
        for (uint k = 0u; step != 0.0f && k < steps; ++k) {
            const float angle = ends[part] + ((float)k + 0.5f) * step;
            const float y = sin(angle), width = cos(angle);
            sum += (clamp(offset + slope * y, -width, width) + width) * width * step;
        }
    }
    return sum;
}

/// The share of the unit disc that a quad covers, 1e-3 exact. steps: WEDGE_EDGE_STEPS, or WEDGE_CELL_STEPS.
WEDGE_FN float discCoverage(uint steps, ImageQuad quad)
{
    if (beyondSquare(quad, 1.0f)) {
        return 0.0f;
    }
    bool inside = true;
    float area = 0.0f, sum = 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        const Vec2 from = quad.corners[k], to = quad.corners[(k + 1u) % 4u];
        inside = inside && from.x * from.x + from.y * from.y <= 1.0f;
        area += 0.5f * (from.x * to.y - to.x * from.y);
    }
    if (inside) {
        return fabs(area) * WEDGE_INV_PI;
    }
    for (uint k = 0u; k < 4u; ++k) {
        sum += edgeInDisc(steps, quad.corners[k], quad.corners[(k + 1u) % 4u]);
    }
    return fmin(fabs(sum) * WEDGE_INV_PI, 1.0f);
}

/// Twice the area of the triangle of an edge and a point, positive on one side.
WEDGE_FN float sideOf(Vec2 from, Vec2 to, float x, float y)
{
    return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
}

/// Where the square around the pixel's centre with edges at that distance lies: -1 beyond an edge of the quad, 1 in the
/// quad, 0 in part, or perhaps.
WEDGE_FN int squareInQuad(ImageQuad quad, float reach)
{
    const Vec2* c = quad.corners;
    const float turn = sideOf(c[0], c[1], c[2].x, c[2].y) < 0.0f ? -1.0f : 1.0f;
    bool inside = true;
    for (uint k = 0u; k < 4u; ++k) {
        const Vec2 from = c[k], to = c[(k + 1u) % 4u];
        const float middle = turn * sideOf(from, to, 0.0f, 0.0f);
        const float spread = reach * (fabs(to.x - from.x) + fabs(to.y - from.y));
        if (middle + spread < 0.0f) {
            return -1;
        }
        inside = inside && middle - spread > 0.0f;
    }
    return inside ? 1 : 0;
}

WEDGE_SHARED_END

#endif
