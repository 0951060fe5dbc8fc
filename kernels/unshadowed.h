// What a light would send to receivers if nothing were between: by quadrature, sixteen receivers at once.
#ifndef WEDGE_UNSHADOWED_H
#define WEDGE_UNSHADOWED_H

#include "light_sample.h"
#include "vector16.h"

/// The fine quadrature serves receivers nearer to the light's centre than this many of its largest half extents.
#define WEDGE_NEAR_LIGHT 3.0f
/// That of few nodes serves receivers farther than this many of them that see none of the light below their horizon.
#define WEDGE_FAR_LIGHT 4.0f

/// The coarse one serves lobes whose squared width is at least the light's squared angular half extent over this.
#define WEDGE_COARSE_LOBE 2.0f
/// Those of few nodes, far from the light, at least over this.
#define WEDGE_FEW_LOBE 1.5f
/// Lobes sharper than this, in the same measure, fall between the fine rule's nodes.
#define WEDGE_SHARP_LOBE 40.0f

/// Square of the light's larger half extent, m^2.
WEDGE_FN float squaredExtent(AreaLight light) { return fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV)); }

/// Squared angular half extent of the light over the squared width of a lobe, which at exponent m is about 1/sqrt(m): of the
/// half vector, and so of Blinn-Phong |l + v| times as much of l, far less where both graze. toLight: from the receiver to the
/// light's centre, metres; view: unit, to the eye.
WEDGE_FN float lobesAcross(AreaLight light, Vec3 toLight, Vec3 view, float exponent, bool phong)
{
    const float squared = vecDot(toLight, toLight);
    const float widening = phong ? 1.0f : fmax(2.0f + 2.0f * vecDot(view, toLight) * rsqrt(squared), 1e-6f);
    return squaredExtent(light) * fmax(exponent, 1.0f) / (squared * widening);
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
/// it below a horizon.
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
    const float16 fine = unshadowedDiffuse(light, position, normal, nodes + WEDGE_FINE_OFFSET, WEDGE_FINE_NODES, &unused);
    return hard ? fine : coarse;
}

/// Lanes whose horizon goes through the light.
WEDGE_FN int16 horizonAcross(AreaLight light, Vec3x16 toLight, Vec3x16 normal)
{
    const float16 reach = fabs(dot16(normal, splat3(light.halfU))) + fabs(dot16(normal, splat3(light.halfV)));
    return fabs(dot16(normal, toLight)) <= reach;
}

/// unshadowedWhere(), in lanes that are far from the light with few nodes.
WEDGE_FN float16 unshadowedOfFew(AreaLight light, Vec3x16 position, Vec3x16 normal, __global const float* nodes, int16 wanted)
{
    const Vec3x16 toLight = sub16(splat3(light.centre), position);
    const int16 far = dot16(toLight, toLight) >= squaredExtent(light) * WEDGE_FAR_LIGHT * WEDGE_FAR_LIGHT;
    const int16 few = far & !horizonAcross(light, toLight, normal);
    float16 shading = (float16)(0.0f);
    if (any(wanted & few)) {
        int16 unused;
        shading = unshadowedDiffuse(light, position, normal, nodes + WEDGE_FEW_OFFSET, WEDGE_FEW_NODES, &unused);
    }
    if (any(wanted & !few)) {
        const float16 other = unshadowedWhere(light, position, normal, nodes, wanted & !few);
        shading = few ? shading : other;
    }
    return shading;
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
    float16 cosine;                 ///< of the view
    float16 exponent;
    int16 phong;                    ///< else Blinn-Phong
} Receivers16;

/// lobesAcross() of sixteen.
WEDGE_FN float16 lobesAcross16(AreaLight light, Vec3x16 toLight, Receivers16 r)
{
    const float16 squared = dot16(toLight, toLight);
    const float16 widening = max16(2.0f + 2.0f * dot16(r.view, toLight) * rsqrt(squared), (float16)(1e-6f));
    const float16 across = squaredExtent(light) * max16(r.exponent, (float16)(1.0f)) / squared;
    return r.phong ? across : across / widening;
}

/// Lobe times geometry term of one point of the light, without the lobe's normalization; lobeValue().
WEDGE_FN float16 reflectedFrom(AreaLight light, Receivers16 r, Vec3 point)
{
    const Vec3x16 d = sub16(splat3(point), r.position);
    const float16 inverse = rsqrt(max16(dot16(d, d), (float16)(1e-30f))), squared = inverse * inverse;
    const float16 cosine = dot16(r.normal, d) * inverse, inView = dot16(r.view, d) * inverse;
    const float16 emitter = -(d.x * light.normal.x + d.y * light.normal.y + d.z * light.normal.z) * inverse;
    const float16 facing = light.twoSided != 0u ? fabs(emitter) : emitter;
    // The cosine of Blinn-Phong is that of the half vector l + v, which is as long as sqrt(2 + 2 l.v).
    const float16 c = r.phong ? 2.0f * r.cosine * cosine - inView : cosine + r.cosine;
    const float16 length = r.phong ? (float16)(1.0f) : max16(2.0f + 2.0f * inView, (float16)(1e-6f));
    const float16 squaredLobe = min16(c * c / length, (float16)(1.0f));
    const float16 lobe = exp2Block(0.5f * r.exponent * accurateLog2(max16(squaredLobe, (float16)(1e-30f))));
    return ((c > 0.0f) & (cosine > 0.0f) & (facing > 0.0f)) ? cosine * facing * squared * lobe : (float16)(0.0f);
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
