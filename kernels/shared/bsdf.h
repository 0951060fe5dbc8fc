// Reflection of the materials: Lambert plus a Phong or Blinn-Phong lobe.
#ifndef WEDGE_SHARED_BSDF_H
#define WEDGE_SHARED_BSDF_H

#include "rng.h"
#include "vec.h"

#define WEDGE_SPECULAR_BLINN_PHONG 0u
#define WEDGE_SPECULAR_PHONG 1u
#define WEDGE_INV_PI 0.318309886f

WEDGE_SHARED_BEGIN

/// What multiplies the power of the cosine so that the lobe reflects at most what arrives, 1/sr. Phong:
/// (m + 2) / 2 pi (Lafortune and Willems 1994); Blinn-Phong: (m + 2)(m + 4) / 8 pi (2^(-m/2) + m), the exact
/// albedo at normal incidence.
WEDGE_FN float specularNormalization(float exponent, uint model)
{
    if (model == WEDGE_SPECULAR_PHONG) {
        return (exponent + 2.0f) * (0.5f * WEDGE_INV_PI);
    }
    return (exponent + 2.0f) * (exponent + 4.0f) * (0.125f * WEDGE_INV_PI) / (pow(2.0f, -0.5f * exponent) + exponent);
}

/// A specular lobe with what does not depend on directions worked out once.
typedef struct {
    float exponent;
    uint model; ///< WEDGE_SPECULAR_*
    float normalization;
    float leastCosine; ///< below it the lobe is under 1e-7 of its peak and counts as 0: most of a scene's directions
} Lobe;

WEDGE_FN Lobe makeLobe(float exponent, uint model)
{
    Lobe lobe;
    lobe.exponent = exponent;
    lobe.model = model;
    lobe.normalization = specularNormalization(exponent, model);
    lobe.leastCosine = exp(-16.118096f / fmax(exponent, 1e-3f));
    return lobe;
}

/// The lobe in 1/sr for unit vectors: n normal, v to the viewer, l to the light, both above n's horizon.
WEDGE_FN float lobeValue(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    float c;
    if (lobe.model == WEDGE_SPECULAR_PHONG) {
        c = 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l);
    } else {
        c = vecDot(n, vecNormalize(vecAdd(v, l)));
    }
    return c > lobe.leastCosine ? lobe.normalization * pow(c, lobe.exponent) : 0.0f;
}

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

/// Direction about the unit vector n of density cos / pi for u in [0,1)^2: the concentric map of Shirley and Chiu (1997)
/// raised onto the hemisphere. Sine and cosine of at most pi / 4 by their series, so that loops over lanes become
/// vectors. Length 1 to 1e-6.
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
WEDGE_FN Vec3 powerCosineDirection(Vec3 n, float exponent, Vec2 u)
{
    const float c = pow(1.0f - u.x, 1.0f / (exponent + 1.0f));
    const float r = sqrt(fmax(0.0f, 1.0f - c * c));
    const float phi = 6.28318531f * u.y;
    Vec3 s, t;
    tangentFrame(n, &s, &t);
    return vecMad(vecMad(vecScale(s, r * cos(phi)), t, r * sin(phi)), n, c);
}

/// A direction distributed as the lobe is, see lobePdf(); it may lie below n's horizon, where the lobe reflects nothing.
/// Phong: about the mirrored view; Blinn-Phong: the view mirrored by a half vector about n.
WEDGE_FN Vec3 sampleLobe(Lobe lobe, Vec3 n, Vec3 v, Vec2 u)
{
    if (lobe.model == WEDGE_SPECULAR_PHONG) {
        return powerCosineDirection(vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v)), lobe.exponent, u);
    }
    const Vec3 h = powerCosineDirection(n, lobe.exponent, u);
    return vecMad(vecScale(v, -1.0f), h, 2.0f * vecDot(v, h));
}

/// Density in 1/sr of sampleLobe() at the unit vector l.
WEDGE_FN float lobePdf(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const float scale = (lobe.exponent + 1.0f) * (0.5f * WEDGE_INV_PI);
    if (lobe.model == WEDGE_SPECULAR_PHONG) {
        const float c = 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l);
        return c > lobe.leastCosine ? scale * pow(c, lobe.exponent) : 0.0f;
    }
    const Vec3 h = vecNormalize(vecAdd(v, l));
    const float c = vecDot(n, h);
    const float across = vecDot(v, h);
    return c > lobe.leastCosine && across > 1e-6f ? scale * pow(c, lobe.exponent) / (4.0f * across) : 0.0f;
}

/// lobeValue() over lobePdf() at a direction that sampleLobe() gave; 0 where the lobe is cut off.
WEDGE_FN float lobeOverPdf(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const float scale = 6.28318531f * lobe.normalization / (lobe.exponent + 1.0f);
    if (lobe.model == WEDGE_SPECULAR_PHONG) {
        return 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l) > lobe.leastCosine ? scale : 0.0f;
    }
    const Vec3 h = vecNormalize(vecAdd(v, l));
    // Where l is next to -v, rounding may put the half vector on the wrong side of v.
    return vecDot(n, h) > lobe.leastCosine ? 4.0f * fmax(vecDot(v, h), 0.0f) * scale : 0.0f;
}

/// The same for a lobe that is used once.
WEDGE_FN float specularLobe(Vec3 n, Vec3 v, Vec3 l, float exponent, uint model)
{
    return lobeValue(makeLobe(exponent, model), n, v, l);
}

WEDGE_SHARED_END

#endif
