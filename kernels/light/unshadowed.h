// What a light would send to receivers if nothing were between: by quadrature, sixteen receivers at once. The one place
// for it: frames of pixels (composite.cl) and of waves (wave_light.cl) take the same rules.
//
// Means over the light of the geometry term, or of it times a lobe, by the rule that is exact enough for each receiver:
//   few     3 x 3 nodes of the profile's own Gauss rule: far from the light
//   coarse  5 x 5 nodes
//   medium  8 x 8: near the light, or for lobes narrower than it
//   fine    12 x 12: for lobes narrower still
//   clipped 8 x 8 over the part of the light above the receiver's horizon: where that crosses the light
//   fitted  16 x 16 in coordinates fitted to the receiver: at the light, and across horizons that the clipped rule does
//   not serve sampled directions of the lobe: where it is far narrower than the light, or narrower at all where the
//   fitted rule would do
#ifndef WEDGE_UNSHADOWED_H
#define WEDGE_UNSHADOWED_H

#include "core/vector16.h"
#include "light/light_sample.h"
#include "light/scene_light.h"

/// The medium rule serves receivers nearer to the light's centre than this many of its largest half extents.
#define WEDGE_NEAR_LIGHT 3.0f
/// That of few nodes serves receivers farther than this many of them.
#define WEDGE_FAR_LIGHT 4.0f
/// The fitted rule serves receivers nearer to a point of the light than this many of them.
#define WEDGE_AT_LIGHT 1.0f

/// The clipped rule serves receivers farther from the light's centre than this many of its largest half extents, and
/// profiles cut at this many standard deviations at most.
#define WEDGE_CLIPPED_LIGHT 2.0f
#define WEDGE_CLIPPED_CUT 3.0f
/// And Blinn-Phong lobes whose view makes a cosine of at least this with the light's direction.
#define WEDGE_CLIPPED_TURN -0.875f

/// The coarse one serves lobes whose squared width is at least the light's squared angular half extent over this.
#define WEDGE_COARSE_LOBE 4.0f
/// Those of few nodes, far from the light, at least over this.
#define WEDGE_FEW_LOBE 1.5f
/// The medium one at least over this. Of a lobe like exp(-across x^2 / 2) on [-1, 1] it errs by 2e-4 of its peak there,
/// by the fine one 4e-7, and 3e-4 where lobes are sharp. The clipped one has the profile among what it integrates: of a
/// Gaussian cut at c standard deviations as much as c^2 across.
#define WEDGE_MEDIUM_LOBE 14.0f
/// Lobes sharper than this, in the same measure, fall between the fine rule's nodes.
#define WEDGE_SHARP_LOBE 40.0f
/// The same of the fitted rule's, which are dense where the light is near and not where the lobe is.
#define WEDGE_SHARP_FITTED_LOBE 10.0f

/// Fitted coordinates are no flatter than this: as good as plain ones, and rounding stays small.
#define WEDGE_FLATTEST 4.0f
#define WEDGE_STEEPEST 1e-4f

/// Square of the light's larger half extent, m^2.
WEDGE_FN float squaredExtent(AreaLight light)
{
    return fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV));
}

/// log2 x for normal x > 0, to 6e-8 of max(1, |log2 x|): logPositive() of sixteen.
WEDGE_FN float16 accurateLog2(float16 x)
{
    const int16 shifted = as_int16(x) + (0x3f800000 - 0x3f3504f3);
    const float16 exponent = convert_float16((shifted >> 23) - 127);
    const float16 z = as_float16((shifted & 0x007fffff) + 0x3f3504f3) - 1.0f;
    float16 p = (float16)(-0.0766083002f);
    p = 0.127863303f + p * z;
    p = -0.131616011f + p * z;
    p = 0.141978756f + p * z;
    p = -0.166227534f + p * z;
    p = 0.200014129f + p * z;
    p = -0.250008464f + p * z;
    p = 0.333333284f + p * z;
    return exponent + 1.44269504f * (z - 0.5f * z * z + z * z * z * p);
}

WEDGE_FN Vec3x16 unit16(Vec3x16 a)
{
    const float16 scale = rsqrt(max16(dot16(a, a), (float16)(1e-30f)));
    a.x *= scale;
    a.y *= scale;
    a.z *= scale;
    return a;
}

/// What sixteen receivers reflect into their views. Without a lobe the first two count alone.
typedef struct {
    Vec3x16 position, normal;
    Vec3x16 view; ///< unit, to the eye
    float16 cosine; ///< of the view
    float16 exponent;
    int16 phong; ///< else Blinn-Phong
#ifdef WEDGE_GGX
    int16 microfacets; ///< else one of these; its view faces the surface
    float16 rise;
#endif
} Receivers16;

WEDGE_FN Receivers16 mattReceivers(Vec3x16 position, Vec3x16 normal)
{
    Receivers16 r;
    r.position = position;
    r.normal = normal;
    r.view = normal;
    r.cosine = r.exponent = (float16)(1.0f);
    r.phong = (int16)(0);
#ifdef WEDGE_GGX
    r.microfacets = (int16)(0);
    r.rise = (float16)(0.0f);
#endif
    return r;
}

#ifdef WEDGE_GGX
/// unpackMicrofacets() and facingView() of those that have them.
WEDGE_FN void addMicrofacets(Receivers16* r, uint16 gloss)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
    r->microfacets = (gloss & kinds) == WEDGE_MICROFACETS;
    const uint16 sharpness = gloss >> WEDGE_KIND_BITS & ((1u << 15) - 1u);
    r->exponent = r->microfacets ? as_float16((sharpness << 13) + (117u << 23)) : r->exponent;
    r->rise = as_float16((gloss >> 18 << 13) + (127u << 23)) - 1.0f;
    const float16 below = WEDGE_LEAST_FACING - r->cosine;
    const int16 lifted = r->microfacets & (below > 0.0f);
    const Vec3x16 view = unit16(mad16(r->view, r->normal, max16(below, (float16)(0.0f))));
    r->view.x = lifted ? view.x : r->view.x;
    r->view.y = lifted ? view.y : r->view.y;
    r->view.z = lifted ? view.z : r->view.z;
    r->cosine = lifted ? max16(dot16(r->normal, r->view), (float16)(0.5f * WEDGE_LEAST_FACING)) : r->cosine;
}
#endif

/// gloss: packGloss() of each.
WEDGE_FN Receivers16 glossyReceivers(Vec3x16 position, Vec3x16 normal, Vec3x16 view, uint16 gloss)
{
    Receivers16 r = mattReceivers(position, normal);
    r.view = view;
    r.cosine = dot16(normal, view);
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
    r.exponent = as_float16(gloss & ~kinds);
    r.phong = (gloss & kinds) == WEDGE_PHONG;
#ifdef WEDGE_GGX
    addMicrofacets(&r, gloss);
#endif
    return r;
}

/// Geometry terms of 16 receivers and points of the light d away, 1/m^2; see geometryTerm().
WEDGE_FN float16 geometryTerm16(Vec3x16 normal, Vec3x16 d, Vec3 lightNormal, uint twoSided)
{
    const float16 receiver = dot16(normal, d);
    const float16 emitter = -(d.x * lightNormal.x + d.y * lightNormal.y + d.z * lightNormal.z);
    const float16 facing = twoSided != 0u ? fabs(emitter) : emitter;
    const float16 squared = dot16(d, d);
    const int16 lit = (receiver > 0.0f) & (facing > 0.0f);
    return lit ? receiver * facing / (squared * squared) : (float16)(0.0f);
}

#ifdef WEDGE_GGX
/// microfacetLobeAt() of sixteen, in the unit directions l.
WEDGE_FN float16 microfacetValue16(Receivers16 r, Vec3x16 l)
{
    const float16 one = (float16)(1.0f), zero = (float16)(0.0f);
    const float16 a = 4.0f / max16(r.exponent, 4.0f * one);
    Vec3x16 h;
    h.x = r.view.x + l.x;
    h.y = r.view.y + l.y;
    h.z = r.view.z + l.z;
    h = unit16(h);
    const float16 nl = max16(dot16(r.normal, l), zero), nh = dot16(r.normal, h);
    const Vec3x16 aside = mad16(h, r.normal, -nh);
    const float16 spread = dot16(aside, aside) + a * nh * nh;
    const float16 d = a * WEDGE_INV_PI / max16(spread * spread, 1e-30f * one);
    const float16 nv = r.cosine;
    const float16 crossed = nl * sqrt(a + (1.0f - a) * nv * nv) + nv * sqrt(a + (1.0f - a) * nl * nl);
    const float16 away = max16(1.0f - dot16(r.view, h), zero), squared = away * away;
    const float16 value = 0.5f * d * (1.0f + r.rise * squared * squared * away) / crossed;
    return nh > 0.0f ? value : zero;
}
#endif

/// lobeValue() without the lobe's normalization, in the direction of d.
WEDGE_FN float16 lobePower16(Receivers16 r, Vec3x16 d)
{
    const float16 inverse = rsqrt(max16(dot16(d, d), (float16)(1e-30f)));
    const float16 cosine = dot16(r.normal, d) * inverse, inView = dot16(r.view, d) * inverse;
    // The cosine of Blinn-Phong is that of the half vector l + v, which is as long as sqrt(2 + 2 l.v).
    const float16 c = r.phong ? 2.0f * r.cosine * cosine - inView : cosine + r.cosine;
    const float16 length = r.phong ? (float16)(1.0f) : max16(2.0f + 2.0f * inView, (float16)(1e-6f));
    const float16 squaredLobe = min16(c * c / length, (float16)(1.0f));
    const float16 lobe = exp2Block(0.5f * r.exponent * accurateLog2(max16(squaredLobe, (float16)(1e-30f))));
    const float16 power = c > 0.0f ? lobe : (float16)(0.0f);
#ifdef WEDGE_GGX
    if (any(r.microfacets)) {
        return r.microfacets ? microfacetValue16(r, unit16(d)) : power;
    }
#endif
    return power;
}

/// specularNormalization() of sixteen; 1 of microfacets.
WEDGE_FN float16 normalization16(Receivers16 r)
{
    const float16 m = r.exponent;
    const float16 phong = (m + 2.0f) * (0.5f * WEDGE_INV_PI);
    const float16 blinn = (m + 2.0f) * (m + 4.0f) * (0.125f * WEDGE_INV_PI) / (exp2Block(-0.5f * m) + m);
    const float16 power = r.phong ? phong : blinn;
#ifdef WEDGE_GGX
    return r.microfacets ? (float16)(1.0f) : power;
#else
    return power;
#endif
}

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

/// Squared angular half extent of the light over the squared width of the lobe, which at exponent m is about 1/sqrt(m):
/// of the half vector, and so of Blinn-Phong |l + v| times as much of l, far less where both graze.
WEDGE_FN float16 lobesAcross16(AreaLight light, Vec3x16 toLight, Receivers16 r)
{
    const float16 squared = dot16(toLight, toLight);
    const float16 widening = max16(2.0f + 2.0f * dot16(r.view, toLight) * rsqrt(squared), (float16)(1e-6f));
    const float16 across = squaredExtent(light) * max16(r.exponent, (float16)(1.0f)) / squared;
#ifdef WEDGE_GGX
    if (any(r.microfacets)) {
        // Aside of its peak the lobe falls off far slower: as one of alpha^2 + tan^2, at the place of the light where
        // the half vector is nearest to the normal.
        const Vec3x16 l = unit16(toLight);
        Vec3x16 h;
        h.x = r.view.x + l.x;
        h.y = r.view.y + l.y;
        h.z = r.view.z + l.z;
        h = unit16(h);
        const float16 nh = dot16(r.normal, h);
        const Vec3x16 off = mad16(h, r.normal, -nh);
        const float16 reach = sqrt(2.0f * squaredExtent(light) / (squared * widening));
        const float16 aside = max16(sqrt(dot16(off, off)) - reach, (float16)(0.0f));
        const float16 slower = 1.0f / (1.0f + 0.25f * max16(r.exponent, (float16)(4.0f)) * aside * aside);
        return (r.phong ? across : across / widening) * (r.microfacets ? slower : (float16)(1.0f));
    }
#endif
    return r.phong ? across : across / widening;
}

/// Lanes whose horizon goes through the light.
WEDGE_FN int16 horizonAcross(AreaLight light, Vec3x16 toLight, Vec3x16 normal)
{
    const float16 reach = fabs(dot16(normal, splat3(light.halfU))) + fabs(dot16(normal, splat3(light.halfV)));
    return fabs(dot16(normal, toLight)) <= reach;
}

/// Squared distance to the light's nearest point; of a parallelogram about that.
WEDGE_FN float16 squaredDistanceTo(AreaLight light, Vec3x16 toLight)
{
    const Vec3x16 u = splat3(light.halfU), v = splat3(light.halfV);
    const float16 one = (float16)(1.0f);
    const float16 a = min16(max16(-dot16(toLight, u) / dot16(u, u), -one), one);
    const float16 b = min16(max16(-dot16(toLight, v) / dot16(v, v), -one), one);
    const Vec3x16 d = mad16(mad16(toLight, u, a), v, b);
    return dot16(d, d);
}

/// Profile-weighted mean over the light of the geometry term, 1/m^2, of lanes `wanted`; lobes: of lobe times geometry
/// term, 1/(sr m^2), without the lobe's normalization, and nothing in lanes of *sampled, whose lobes are too sharp for
/// a rule.
WEDGE_FN float16 unshadowedMean(
    AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted, bool lobes, int16* sampled)
{
    const Vec3x16 toLight = sub16(splat3(light.centre), r.position);
    const float16 squared = dot16(toLight, toLight);
    const float extent = squaredExtent(light);
    const float16 across = lobes ? lobesAcross16(light, toLight, r) : (float16)(0.0f);
    const int16 horizon = horizonAcross(light, toLight, r.normal);
    const int16 at = squaredDistanceTo(light, toLight) < extent * WEDGE_AT_LIGHT * WEDGE_AT_LIGHT;
    const float profile = light.profile == WEDGE_PROFILE_GAUSSIAN ? light.cut * light.cut : 0.0f;
    const bool smooth = profile <= WEDGE_CLIPPED_CUT * WEDGE_CLIPPED_CUT;
    // Towards the mirrored view a half vector turns far faster in some places of the light than at its centre.
    const int16 steady = lobes ? r.phong | (dot16(r.view, toLight) > WEDGE_CLIPPED_TURN * sqrt(squared)) : (int16)(-1);
    const int16 clipped = horizon & !at & steady & (across + profile < WEDGE_MEDIUM_LOBE)
        & (squared >= (smooth ? extent * WEDGE_CLIPPED_LIGHT * WEDGE_CLIPPED_LIGHT : INFINITY));
    const int16 fitted = (horizon & !clipped) | at;
    const int16 few =
        !(horizon | at) & (across < WEDGE_FEW_LOBE) & (squared >= extent * WEDGE_FAR_LIGHT * WEDGE_FAR_LIGHT);
    const int16 fine = !(horizon | at) & (across >= WEDGE_MEDIUM_LOBE);
    const int16 medium = !(horizon | at | fine)
        & ((across >= WEDGE_COARSE_LOBE) | (squared < extent * WEDGE_NEAR_LIGHT * WEDGE_NEAR_LIGHT));
    *sampled = (across > WEDGE_SHARP_LOBE) | (fitted & (across > WEDGE_SHARP_FITTED_LOBE));
    // The surface that the light is in does not light itself: isInLight().
    const int16 apart = fabs(dot16(toLight, splat3(light.normal))) >= light.lift;
    *sampled &= apart;
    const int16 ruled = wanted & apart & !*sampled;
    float16 mean = (float16)(0.0f);
    if (any(ruled & few)) {
        mean = meanOverNodes(light, r, nodes + WEDGE_FEW_OFFSET, WEDGE_FEW_NODES, lobes);
    }
    if (any(ruled & !few & !medium & !fine & !clipped & !fitted)) {
        const float16 coarse = meanOverNodes(light, r, nodes, WEDGE_COARSE_NODES, lobes);
        mean = few ? mean : coarse;
    }
    if (any(ruled & medium)) {
        const float16 other = meanOverNodes(light, r, nodes + WEDGE_MEDIUM_OFFSET, WEDGE_MEDIUM_NODES, lobes);
        mean = medium ? other : mean;
    }
    if (any(ruled & fine)) {
        const float16 other = meanOverNodes(light, r, nodes + WEDGE_FINE_OFFSET, WEDGE_FINE_NODES, lobes);
        mean = fine ? other : mean;
    }
    if (any(ruled & clipped)) {
        const float16 other = meanClipped(light, r, nodes + WEDGE_CLIPPED_OFFSET, lobes);
        mean = clipped ? other : mean;
    }
    if (any(ruled & fitted)) {
        const float16 other = meanFitted(light, r, nodes + WEDGE_FITTED_OFFSET, lobes);
        mean = fitted ? other : mean;
    }
    return ruled ? mean : (float16)(0.0f);
}

WEDGE_FN float16 unshadowedDiffuse(AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted)
{
    int16 none;
    return unshadowedMean(light, r, nodes, wanted, false, &none);
}

/// Sixteen receivers as arrays, for loops over lanes.
typedef struct {
    float positionX[WEDGE_BLOCK_PIXELS], positionY[WEDGE_BLOCK_PIXELS], positionZ[WEDGE_BLOCK_PIXELS];
    float normalX[WEDGE_BLOCK_PIXELS], normalY[WEDGE_BLOCK_PIXELS], normalZ[WEDGE_BLOCK_PIXELS];
    float viewX[WEDGE_BLOCK_PIXELS], viewY[WEDGE_BLOCK_PIXELS], viewZ[WEDGE_BLOCK_PIXELS];
    float exponent[WEDGE_BLOCK_PIXELS], normalization[WEDGE_BLOCK_PIXELS];
    uint kind[WEDGE_BLOCK_PIXELS];
} ReceiverLanes;

WEDGE_FN ReceiverLanes lanesOf(Receivers16 r)
{
    ReceiverLanes lanes;
    vstore16(r.position.x, 0, lanes.positionX);
    vstore16(r.position.y, 0, lanes.positionY);
    vstore16(r.position.z, 0, lanes.positionZ);
    vstore16(r.normal.x, 0, lanes.normalX);
    vstore16(r.normal.y, 0, lanes.normalY);
    vstore16(r.normal.z, 0, lanes.normalZ);
    vstore16(r.view.x, 0, lanes.viewX);
    vstore16(r.view.y, 0, lanes.viewY);
    vstore16(r.view.z, 0, lanes.viewZ);
    vstore16(r.exponent, 0, lanes.exponent);
    vstore16(normalization16(r), 0, lanes.normalization);
    const uint16 kind = r.phong ? (uint16)(WEDGE_PHONG) : (uint16)(WEDGE_BLINN_PHONG);
#ifdef WEDGE_GGX
    vstore16(r.microfacets ? r.rise : normalization16(r), 0, lanes.normalization);
    vstore16(r.microfacets ? (uint16)(WEDGE_MICROFACETS) : kind, 0, lanes.kind);
#else
    vstore16(kind, 0, lanes.kind);
#endif
    return lanes;
}

/// What one direction of a lane's lobe brings, for the numbers u.
WEDGE_INLINE float broughtByLobe(AreaLight light, const ReceiverLanes* r, uint lane, Vec2 u)
{
    const Vec3 p = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const Vec3 v = vec3(r->viewX[lane], r->viewY[lane], r->viewZ[lane]);
    Lobe lobe;
    lobe.exponent = r->exponent[lane];
    lobe.kind = r->kind[lane];
    lobe.normalization = r->normalization[lane];
    lobe.leastCosine = 0.0f;
    const Vec3 l = sampleLobe(lobe, n, v, u);
    const LightMeeting m = meetLight(light, p, l);
    const float cosine = vecDot(n, l);
    const float value = lobeOverPdf(lobe, n, v, l) * cosine * metProfile(light, m);
    return m.t < INFINITY && cosine > 0.0f ? value : 0.0f;
}

/// Which directions of their lobes receivers take: of a pixel's sequence `count` from `first` on.
typedef struct {
    uint16 pixel; ///< x in the lower 16 bits, y in the upper
    uint16 first;
    uint count;
    uint seed; ///< of the frame
} LobeDirections;

/// Roberts' additive sequence R2, in units of 2^-32.
#define WEDGE_R2_FIRST 3242174889u
#define WEDGE_R2_SECOND 2447445414u

/// The mean of lobe times geometry term by directions of the lobe: nothing is in the way, so that they need no rays.
/// Each pixel has a sequence of its own, which its receivers share out: however many see the same point, their mean
/// becomes the integral.
WEDGE_FN float16 unshadowedByLobe(AreaLight light, Receivers16 receivers, LobeDirections directions)
{
    const ReceiverLanes r = lanesOf(receivers);
    float sum[WEDGE_BLOCK_PIXELS];
    uint u[WEDGE_BLOCK_PIXELS], v[WEDGE_BLOCK_PIXELS], first[WEDGE_BLOCK_PIXELS];
    vstore16(directions.pixel, 0, u);
    vstore16(directions.first, 0, first);
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const uint shift = hashCombine(directions.seed, u[lane]);
        u[lane] = shift + first[lane] * WEDGE_R2_FIRST;
        v[lane] = hashUint(shift) + first[lane] * WEDGE_R2_SECOND;
        sum[lane] = 0.0f;
    }
    for (uint k = 0u; k < directions.count; ++k) {
        for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
            sum[lane] += broughtByLobe(light, &r, lane, vec2(toUnitFloat(u[lane]), toUnitFloat(v[lane])));
            u[lane] += WEDGE_R2_FIRST;
            v[lane] += WEDGE_R2_SECOND;
        }
    }
    return vload16(0, sum) / ((float)directions.count * light.profileArea);
}

/// Mean of lobe times geometry term over the light, 1/(sr m^2), of lanes `wanted`, 0 elsewhere. directions: of each
/// lobe that is too sharp for a rule.
WEDGE_FN float16 unshadowedSpecular(
    AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted, LobeDirections directions)
{
    int16 sharp;
    float16 mean = unshadowedMean(light, r, nodes, wanted, true, &sharp) * normalization16(r);
    if (any(wanted & sharp)) {
        mean = (wanted & sharp) ? unshadowedByLobe(light, r, directions) : mean;
    }
    return wanted ? mean : (float16)(0.0f);
}

#endif
