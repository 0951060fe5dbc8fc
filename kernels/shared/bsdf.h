// Reflection of the materials: Lambert plus a Phong or Blinn-Phong lobe.
#ifndef WEDGE_SHARED_BSDF_H
#define WEDGE_SHARED_BSDF_H

#include "material.h"
#include "maths.h"
#include "rng.h"
#include "vec.h"

#define WEDGE_INV_PI 0.318309886f

WEDGE_SHARED_BEGIN

/// What multiplies the power of the cosine so that the lobe reflects at most what arrives, 1/sr. Phong:
/// (m + 2) / 2 pi (Lafortune and Willems 1994); Blinn-Phong: (m + 2)(m + 4) / 8 pi (2^(-m/2) + m), the exact
/// albedo at normal incidence.
WEDGE_INLINE float specularNormalization(float exponent, uint kind)
{
    const float phong = (exponent + 2.0f) * (0.5f * WEDGE_INV_PI);
    const float blinn =
        (exponent + 2.0f) * (exponent + 4.0f) * (0.125f * WEDGE_INV_PI) / (exp2Bounded(-0.5f * exponent) + exponent);
    return kind == WEDGE_PHONG ? phong : blinn;
}

/// A specular lobe with what does not depend on directions worked out once.
typedef struct {
    float exponent;
    uint kind; ///< WEDGE_PHONG and so on; of WEDGE_LAMBERT nobody asks
    float normalization;
    float leastCosine; ///< below it the lobe is under 1e-7 of its peak and counts as 0: most of a scene's directions
} Lobe;

WEDGE_INLINE Lobe makeLobe(float exponent, uint kind)
{
    Lobe lobe;
    lobe.exponent = exponent;
    lobe.kind = kind;
    lobe.normalization = specularNormalization(exponent, kind);
    lobe.leastCosine = exp2Bounded(-23.2534966f / fmax(exponent, 1e-3f));
    return lobe;
}

/// What a lobe is in one direction, 1/sr.
typedef struct {
    float value; ///< the reflection
    float pdf; ///< density at which sampleLobe() gives the direction
} LobeAt;

/// For unit vectors: n normal, v to the viewer, l to the light, both above n's horizon.
WEDGE_INLINE LobeAt lobeAt(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const bool phong = lobe.kind == WEDGE_PHONG;
    const Vec3 sum = vecAdd(v, l);
    const float inverse = 1.0f / fmax(vecLength(sum), 1e-20f);
    const float across = vecDot(v, sum) * inverse; // of the half vector to the view
    const float mirrored = 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l);
    const float c = phong ? mirrored : vecDot(n, sum) * inverse;
    const float power = powPositive(fmax(c, 1e-30f), lobe.exponent);
    const float density = (lobe.exponent + 1.0f) * (0.5f * WEDGE_INV_PI) * power;
    const float mirroredHalf = across > 1e-6f ? density / (4.0f * fmax(across, 1e-6f)) : 0.0f;
    const bool inside = c > lobe.leastCosine;
    LobeAt at;
    at.value = inside ? lobe.normalization * power : 0.0f;
    at.pdf = inside ? (phong ? density : mirroredHalf) : 0.0f;
    return at;
}

/// The lobe's reflection alone, see lobeAt().
WEDGE_INLINE float lobeValue(Lobe lobe, Vec3 n, Vec3 v, Vec3 l) { return lobeAt(lobe, n, v, l).value; }

/// Luminance of linear Rec.709.
WEDGE_INLINE float luminance(Vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// Two unit vectors that make a right-handed orthonormal frame with the unit vector n (Duff et al., Building an
/// Orthonormal Basis, Revisited, JCGT 2017).
WEDGE_INLINE void tangentFrame(Vec3 n, Vec3* s, Vec3* t)
{
    const float sign = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    *s = vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *t = vec3(b, sign + n.y * n.y * a, -n.y);
}

/// Direction about the unit vector n of density cos / pi for u in [0,1)^2: the concentric map of Shirley and Chiu
/// (1997) raised onto the hemisphere. Sine and cosine of at most pi / 4 by their series, so that loops over lanes
/// become vectors. Length 1 to 1e-6.
WEDGE_INLINE Vec3 cosineDirection(Vec3 n, Vec2 u)
{
    const float a = 2.0f * u.x - 1.0f;
    const float b = 2.0f * u.y - 1.0f;
    const bool wide = fabs(a) > fabs(b);
    const float r = wide ? a : b;
    const float ratio = (wide ? b : a) / (r != 0.0f ? r : 1.0f);
    const float x = 0.785398163f * ratio;
    const float q = x * x;
    const float sine = x * (1.0f - q * (0.166666667f - q * (0.00833333333f - q * 0.000198412698f)));
    const float cosine = 1.0f - q * (0.5f - q * (0.0416666667f - q * (0.00138888889f - q * 0.0000248015873f)));
    const float p = r * (wide ? cosine : sine);
    const float o = r * (wide ? sine : cosine);
    Vec3 s, t;
    tangentFrame(n, &s, &t);
    return vecMad(vecMad(vecScale(s, p), t, o), n, sqrt(fmax(0.0f, 1.0f - r * r)));
}

/// Direction about the unit vector n whose cosine c to it has the density (m + 1) / 2 pi c^m.
WEDGE_INLINE Vec3 powerCosineDirection(Vec3 n, float exponent, Vec2 u)
{
    const float c = powPositive(fmax(1.0f - u.x, 1e-30f), 1.0f / (exponent + 1.0f));
    const float r = sqrt(fmax(0.0f, 1.0f - c * c));
    float sine, cosine;
    sinCosTurn(u.y, &sine, &cosine);
    Vec3 s, t;
    tangentFrame(n, &s, &t);
    return vecMad(vecMad(vecScale(s, r * cosine), t, r * sine), n, c);
}

/// A direction distributed as the lobe is, see lobePdf(); it may lie below n's horizon, where the lobe reflects
/// nothing. Phong: about the mirrored view; Blinn-Phong: the view mirrored by a half vector about n.
WEDGE_INLINE Vec3 sampleLobe(Lobe lobe, Vec3 n, Vec3 v, Vec2 u)
{
    const bool phong = lobe.kind == WEDGE_PHONG;
    const Vec3 mirrored = vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v));
    const Vec3 axis = vec3(phong ? mirrored.x : n.x, phong ? mirrored.y : n.y, phong ? mirrored.z : n.z);
    const Vec3 h = powerCosineDirection(axis, lobe.exponent, u);
    const Vec3 l = vecMad(vecScale(v, -1.0f), h, 2.0f * vecDot(v, h));
    return vec3(phong ? h.x : l.x, phong ? h.y : l.y, phong ? h.z : l.z);
}

/// Density in 1/sr of sampleLobe() at the unit vector l.
WEDGE_INLINE float lobePdf(Lobe lobe, Vec3 n, Vec3 v, Vec3 l) { return lobeAt(lobe, n, v, l).pdf; }

/// lobeValue() over lobePdf() at a direction that sampleLobe() gave; 0 where the lobe is cut off.
WEDGE_INLINE float lobeOverPdf(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const bool phong = lobe.kind == WEDGE_PHONG;
    const float scale = 6.28318531f * lobe.normalization / (lobe.exponent + 1.0f);
    const Vec3 h = vecNormalize(vecAdd(v, l));
    const float mirrored = 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l);
    const float c = phong ? mirrored : vecDot(n, h);
    // Where l is next to -v, rounding may put the half vector on the wrong side of v.
    const float jacobian = phong ? 1.0f : 4.0f * fmax(vecDot(v, h), 0.0f);
    return c > lobe.leastCosine ? jacobian * scale : 0.0f;
}

/// The same for a lobe that is used once.
WEDGE_FN float specularLobe(Vec3 n, Vec3 v, Vec3 l, float exponent, uint kind)
{
    return lobeValue(makeLobe(exponent, kind), n, v, l);
}

WEDGE_SHARED_END

#endif
