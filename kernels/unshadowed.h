// What a light would send to receivers if nothing were between: by quadrature, sixteen receivers at once.
#ifndef WEDGE_UNSHADOWED_H
#define WEDGE_UNSHADOWED_H

#include "light_sample.h"
#include "vector16.h"

/// The fine quadrature serves receivers nearer to the light's centre than this many of its largest half extents.
#define WEDGE_NEAR_LIGHT 3.0f

/// The coarse one serves lobes whose squared width is at least the light's squared angular half extent over this.
#define WEDGE_COARSE_LOBE 2.0f
/// Lobes sharper than this, in the same measure, fall between the fine rule's nodes.
#define WEDGE_SHARP_LOBE 40.0f

/// Squared angular half extent of the light over the squared width of a lobe: exponent m is about 1/sqrt(m) wide, and the
/// coarse rule does for a light that is small beside it. squared: distance to the light's centre.
WEDGE_FN float lobesAcross(AreaLight light, float squared, float exponent)
{
    const float extent = fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV));
    return extent * fmax(exponent, 1.0f) / squared;
}

/// Geometry terms of 16 receivers and one point of the light, 1/m^2; see geometryTerm().
WEDGE_FN float16 geometryTerm16(Vec3x16 normal, Vec3x16 d, Vec3 lightNormal, uint twoSided)
{
    const float16 receiver = dot16(normal, d);
    const float16 emitter = -(d.x * lightNormal.x + d.y * lightNormal.y + d.z * lightNormal.z);
    const float16 facing = twoSided != 0u ? fabs(emitter) : emitter;
    const float16 squared = dot16(d, d);
    const int16 lit = (receiver > 0.0f) & (facing > 0.0f);
    return lit ? receiver * facing / (squared * squared) : (float16)(0.0f);
}

/// Profile-weighted mean of the geometry term over the light by tensor-product Gauss quadrature. nodes: coordinate
/// and weight of each of `count` nodes of one axis, the weights summing to 1. *edge: lanes where the light is partly
/// below a horizon, so that the integrand has a kink.
WEDGE_FN float16 unshadowedDiffuse(AreaLight light, Vec3x16 position, Vec3x16 normal, __global const float* nodes,
                                   uint count, int16* edge)
{
    float16 sum = (float16)(0.0f);
    int16 someZero = (int16)(0);
    int16 someLit = (int16)(0);
    for (uint a = 0u; a < count; ++a) {
        for (uint b = 0u; b < count; ++b) {
            const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, nodes[2u * a], nodes[2u * b]);
            const float16 g = geometryTerm16(normal, sub16(splat3(point), position), light.normal, light.twoSided);
            someZero |= g == 0.0f;
            someLit |= g > 0.0f;
            sum += nodes[2u * a + 1u] * nodes[2u * b + 1u] * g;
        }
    }
    *edge = someZero & someLit;
    return sum;
}

/// The same mean by the coarse quadrature, and by the fine one in lanes of `wanted` that are near the light, or see a part of
/// it below a horizon. nodes: the coarse quadrature's (coordinate, weight) pairs, then the fine one's.
WEDGE_FN float16 unshadowedWhere(AreaLight light, Vec3x16 position, Vec3x16 normal, __global const float* nodes, int16 wanted)
{
    int16 hard;
    const float16 coarse = unshadowedDiffuse(light, position, normal, nodes, WEDGE_COARSE_NODES, &hard);
    const Vec3x16 toLight = sub16(splat3(light.centre), position);
    const float extent = fmax(vecLength(light.halfU), vecLength(light.halfV)) * WEDGE_NEAR_LIGHT;
    hard |= dot16(toLight, toLight) < extent * extent;
    hard &= wanted;
    if (!any(hard)) {
        return coarse;
    }
    int16 unused;
    const float16 fine = unshadowedDiffuse(light, position, normal, nodes + 2u * WEDGE_COARSE_NODES, WEDGE_FINE_NODES, &unused);
    return hard ? fine : coarse;
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

/// What sixteen receivers reflect into their views.
typedef struct {
    Vec3x16 position, normal, view; ///< view: unit, to the eye
    float16 exponent;
    int16 phong;                    ///< else Blinn-Phong
} Receivers16;

/// Lobe times geometry term of one point of the light, without the lobe's normalization; lobeValue().
WEDGE_FN float16 reflectedFrom(AreaLight light, Receivers16 r, Vec3 point)
{
    const Vec3x16 d = sub16(splat3(point), r.position);
    const float16 g = geometryTerm16(r.normal, d, light.normal, light.twoSided);
    const Vec3x16 l = unit16(d);
    Vec3x16 h;
    h.x = l.x + r.view.x;
    h.y = l.y + r.view.y;
    h.z = l.z + r.view.z;
    const float16 mirrored = 2.0f * dot16(r.normal, r.view) * dot16(r.normal, l) - dot16(r.view, l);
    const float16 c = r.phong ? mirrored : dot16(r.normal, unit16(h));
    const float16 lobe = exp2Block(r.exponent * accurateLog2(max16(c, (float16)(1e-30f))));
    return ((c > 0.0f) & (g > 0.0f)) ? g * lobe : (float16)(0.0f);
}

/// unshadowedSpecular() of sixteen receivers, without the lobe's normalization.
WEDGE_FN float16 unshadowedLobes(AreaLight light, Receivers16 r, __global const float* nodes, uint count)
{
    float16 sum = (float16)(0.0f);
    for (uint a = 0u; a < count; ++a) {
        for (uint b = 0u; b < count; ++b) {
            const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, nodes[2u * a], nodes[2u * b]);
            sum += nodes[2u * a + 1u] * nodes[2u * b + 1u] * reflectedFrom(light, r, point);
        }
    }
    return sum;
}

#endif
