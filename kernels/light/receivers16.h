// Sixteen receivers of light, and what each reflects of it into its view.
#ifndef WEDGE_RECEIVERS16_H
#define WEDGE_RECEIVERS16_H

#include "core/vector16.h"
#include "light/light_sample.h"

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

#endif
