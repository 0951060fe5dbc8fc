// Quadrature over a light, for sixteen receivers at once, where nothing is in the way: the rules among which
// unshadowed.h chooses.
#ifndef WEDGE_LIGHT_RULES_H
#define WEDGE_LIGHT_RULES_H

#include "light/receivers16.h"
#include "light/scene_light.h"

/// Fitted coordinates are no flatter than this: as good as plain ones, and rounding stays small.
#define WEDGE_FLATTEST 4.0f
#define WEDGE_STEEPEST 1e-4f

/// The integrand at points of the light.
WEDGE_FN float16 arrivesFrom(AreaLight light, Receivers16 r, Vec3x16 point, bool lobes)
{
    const Vec3x16 d = sub16(point, r.position);
    const float16 g = geometryTerm16(r.normal, d, light.normal, light.twoSided);
    return lobes ? g * lobePower16(r, d) : g;
}

/// By a tensor product. nodes: coordinate and weight of each of `count` nodes of one axis, the weights summing to 1.
WEDGE_FN float16 meanOverNodes(AreaLight light, Receivers16 r, __global const float* nodes, uint count, bool lobes)
{
    float16 sum = (float16)(0.0f);
    for (uint a = 0u; a < count; ++a) {
        for (uint b = 0u; b < count; ++b) {
            const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, nodes[2u * a], nodes[2u * b]);
            sum += nodes[2u * a + 1u] * nodes[2u * b + 1u] * arrivesFrom(light, r, splat3(point), lobes);
        }
    }
    return sum;
}

WEDGE_FN Vec3x16 choose16(int16 first, Vec3 a, Vec3 b)
{
    Vec3x16 v;
    v.x = first ? (float16)(a.x) : (float16)(b.x);
    v.y = first ? (float16)(a.y) : (float16)(b.y);
    v.z = first ? (float16)(a.z) : (float16)(b.z);
    return v;
}

/// An interval of one axis of the light, and coordinates t on it: x = at + flat sinh t, which are dense around the
/// point `at` that is nearest to the receiver, as the integrand is steep there (Johnston and Elliott, A sinh
/// transformation for evaluating nearly singular boundary element integrals, 2005).
typedef struct {
    float16 at, flat, middle, extent;
} FittedAxis;

WEDGE_FN float16 arcSinh16(float16 x)
{
    const float16 a = fabs(x);
    return copysign(0.693147181f * accurateLog2(a + sqrt(a * a + 1.0f)), x);
}

WEDGE_FN FittedAxis fittedAxis(float16 lo, float16 hi, float16 at, float16 flat)
{
    FittedAxis axis;
    axis.at = at;
    axis.flat = min16(max16(flat, (float16)(WEDGE_STEEPEST)), (float16)(WEDGE_FLATTEST));
    const float16 first = arcSinh16((lo - at) / axis.flat), last = arcSinh16((hi - at) / axis.flat);
    axis.middle = 0.5f * (first + last);
    axis.extent = max16(0.5f * (last - first), (float16)(0.0f));
    return axis;
}

/// The point of a node in [-1, 1] on the axis; *weight: of the node's weight, what the point counts.
WEDGE_FN float16 fittedPoint(FittedAxis axis, float node, float16* weight)
{
    const float16 up = exp2Block(1.44269504f * (axis.middle + axis.extent * node)), down = 1.0f / up;
    *weight = axis.extent * axis.flat * 0.5f * (up + down);
    return axis.at + axis.flat * 0.5f * (up - down);
}

/// Where points of an axis in [-1, 1] begin and end to be above a horizon: height + slope x > 0.
WEDGE_FN float16 lowestAbove(float16 height, float16 slope)
{
    const float16 edge = -height / (slope != 0.0f ? slope : (float16)(1.0f));
    return slope > 0.0f ? min16(max16(edge, (float16)(-1.0f)), (float16)(1.0f)) : (float16)(-1.0f);
}

WEDGE_FN float16 highestAbove(float16 height, float16 slope) { return -lowestAbove(height, -slope); }

/// The axes of a light for rules over the part of it above a horizon: the horizon is to cross the inner one rather than
/// to run along the outer one. The point x inner + y outer is height + innerSlope x + outerSlope y above it.
typedef struct {
    Vec3x16 inner, outer;
    float16 height, innerSlope, outerSlope;
    float16 highest; ///< along a line of the inner axis, without outerSlope y
} HorizonAxes;

WEDGE_FN HorizonAxes horizonAxes(AreaLight light, Vec3x16 toLight, Vec3x16 normal)
{
    const float16 u = dot16(normal, splat3(light.halfU)), v = dot16(normal, splat3(light.halfV));
    const int16 turned = fabs(v) > fabs(u);
    HorizonAxes axes;
    axes.inner = choose16(turned, light.halfV, light.halfU);
    axes.outer = choose16(turned, light.halfU, light.halfV);
    axes.innerSlope = turned ? v : u;
    axes.outerSlope = turned ? u : v;
    axes.height = dot16(normal, toLight);
    axes.highest = axes.height + fabs(axes.innerSlope);
    return axes;
}

/// Means of `sum`, over lines of both axes, of points of the light: 0 where none is above the horizon.
WEDGE_FN float16 meanOverLight(AreaLight light, HorizonAxes axes, float16 sum)
{
    const int16 some = axes.highest + fabs(axes.outerSlope) > 0.0f;
    return some ? sum * (vecLength(vecCross(light.halfU, light.halfV)) / light.profileArea) : (float16)(0.0f);
}

/// Exponent to the base 2 of the profile at a coordinate, over its square.
WEDGE_FN float falloffOf(AreaLight light)
{
    return light.profile == WEDGE_PROFILE_GAUSSIAN ? -0.721347520f * light.cut * light.cut : 0.0f;
}

/// By nodes on the part of the light above each receiver's horizon. nodes: the Gauss-Legendre rule.
WEDGE_FN float16 meanClipped(AreaLight light, Receivers16 r, __global const float* nodes, bool lobes)
{
    const HorizonAxes axes = horizonAxes(light, sub16(splat3(light.centre), r.position), r.normal);
    const float16 from = lowestAbove(axes.highest, axes.outerSlope), to = highestAbove(axes.highest, axes.outerSlope);
    const float16 extent = 0.5f * max16(to - from, (float16)(0.0f)), middle = 0.5f * (from + to);
    const float falloff = falloffOf(light);
    float16 sum = (float16)(0.0f);
    for (uint i = 0u; i < WEDGE_CLIPPED_NODES; ++i) {
        const float16 y = middle + extent * nodes[2u * i];
        const float16 there = axes.height + axes.outerSlope * y;
        const float16 first = lowestAbove(there, axes.innerSlope), last = highestAbove(there, axes.innerSlope);
        const float16 reach = 0.5f * max16(last - first, (float16)(0.0f)), halfway = 0.5f * (first + last);
        const Vec3x16 line = mad16(splat3(light.centre), axes.outer, y);
        float16 along = (float16)(0.0f);
        for (uint k = 0u; k < WEDGE_CLIPPED_NODES; ++k) {
            const float16 x = halfway + reach * nodes[2u * k];
            along += nodes[2u * k + 1u] * exp2Block(falloff * x * x)
                * arrivesFrom(light, r, mad16(line, axes.inner, x), lobes);
        }
        sum += nodes[2u * i + 1u] * reach * exp2Block(falloff * y * y) * along;
    }
    return meanOverLight(light, axes, sum * extent);
}

/// By nodes fitted to each receiver: over the part of the light above its horizon alone, and dense where the light is
/// near. nodes: the Gauss-Legendre rule.
WEDGE_FN float16 meanFitted(AreaLight light, Receivers16 r, __global const float* nodes, bool lobes)
{
    const Vec3x16 toLight = sub16(splat3(light.centre), r.position);
    const HorizonAxes axes = horizonAxes(light, toLight, r.normal);
    const float16 innerSquared = dot16(axes.inner, axes.inner), outerSquared = dot16(axes.outer, axes.outer);
    const float16 above = toLight.x * light.normal.x + toLight.y * light.normal.y + toLight.z * light.normal.z;
    const float16 innerFoot = -dot16(toLight, axes.inner) / innerSquared;
    const FittedAxis b =
        fittedAxis(lowestAbove(axes.highest, axes.outerSlope), highestAbove(axes.highest, axes.outerSlope),
            -dot16(toLight, axes.outer) / outerSquared, fabs(above) * rsqrt(outerSquared));
    const float falloff = falloffOf(light);
    float16 sum = (float16)(0.0f);
    for (uint i = 0u; i < WEDGE_FITTED_NODES; ++i) {
        float16 outerWeight;
        const float16 y = fittedPoint(b, nodes[2u * i], &outerWeight);
        const float16 there = axes.height + axes.outerSlope * y, away = y - b.at;
        const float16 distance = sqrt(above * above + away * away * outerSquared);
        const FittedAxis a = fittedAxis(lowestAbove(there, axes.innerSlope), highestAbove(there, axes.innerSlope),
            innerFoot, distance * rsqrt(innerSquared));
        float16 line = (float16)(0.0f);
        for (uint k = 0u; k < WEDGE_FITTED_NODES; ++k) {
            float16 weight;
            const float16 x = fittedPoint(a, nodes[2u * k], &weight);
            const Vec3x16 point = mad16(mad16(splat3(light.centre), axes.inner, x), axes.outer, y);
            line += nodes[2u * k + 1u] * weight * exp2Block(falloff * x * x) * arrivesFrom(light, r, point, lobes);
        }
        sum += nodes[2u * i + 1u] * outerWeight * exp2Block(falloff * y * y) * line;
    }
    return meanOverLight(light, axes, sum);
}

#endif
