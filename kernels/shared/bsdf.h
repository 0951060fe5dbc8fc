// Reflection of the materials: Lambert plus a Phong, Blinn-Phong or GGX lobe.
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
    float normalization; ///< of microfacets Gloss::rise
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

WEDGE_INLINE Lobe lobeOf(Gloss g)
{
    Lobe lobe = makeLobe(g.exponent, g.kind);
#ifdef WEDGE_GGX
    lobe.normalization = g.kind == WEDGE_MICROFACETS ? g.rise : lobe.normalization;
#endif
    return lobe;
}

/// What a lobe is in one direction, 1/sr.
typedef struct {
    float value; ///< the reflection
    float pdf; ///< density at which sampleLobe() gives the direction
} LobeAt;

#ifdef WEDGE_GGX
/// Views nearer to the horizon of microfacets than this cosine count as at it: where interpolated normals face away,
/// surfaces go on reflecting.
#define WEDGE_LEAST_FACING 1e-3f

/// The view, lifted above the horizon.
WEDGE_INLINE Vec3 facingView(Vec3 n, Vec3 v)
{
    const float below = WEDGE_LEAST_FACING - vecDot(n, v);
    const Vec3 lifted = vecNormalize(vecMad(v, n, fmax(below, 0.0f)));
    return vecChoose(below > 0.0f, lifted, v);
}

/// The mirrored view is at least this many alphas above the triangle, as a cosine, or as far as the view itself.
#define WEDGE_RIM_ALPHAS 4.0f

/// The shading normal n of microfacets on a triangle of the normal g, which v sees: bent towards g as far as it takes
/// for the lobe to lie above the triangle. Beyond, at the rim of coarse meshes, what it reflects would be lost.
WEDGE_INLINE Vec3 reflectingNormal(Vec3 n, Vec3 g, Vec3 v, float exponent)
{
    const float alpha = 2.0f / sqrt(fmax(exponent, 4.0f));
    const float least = fmin(vecDot(v, g), WEDGE_RIM_ALPHAS * alpha);
    const Vec3 facing = vecNormalize(vecMad(n, v, fmax(WEDGE_LEAST_FACING - vecDot(n, v), 0.0f)));
    const Vec3 mirrored = vecMad(vecScale(v, -1.0f), facing, 2.0f * vecDot(facing, v));
    const float below = least - vecDot(mirrored, g);
    const Vec3 raised = vecNormalize(vecMad(mirrored, g, fmax(below, 0.0f)));
    // Half of the way from the view to it. Rounding alone bends nothing.
    return vecChoose(below > 1e-5f, vecNormalize(vecAdd(v, raised)), n);
}

/// sqrt(alpha^2 + (1 - alpha^2) c^2) of a direction's cosine c: Smith's masking is G1 = 2 c / (c + this).
WEDGE_INLINE float smithRoot(float squaredAlpha, float c) { return sqrt(squaredAlpha + (1.0f - squaredAlpha) * c * c); }

/// Schlick's Fresnel factor over F0 for the cosine between half vector and view.
WEDGE_INLINE float fresnelOver(float rise, float c)
{
    const float away = fmax(1.0f - c, 0.0f), squared = away * away;
    return 1.0f + rise * squared * squared * away;
}

/// What of the microfacets' reflection there is beside their distribution.
typedef struct {
    float nh; ///< cosine of the half vector
    float d; ///< their distribution (Trowbridge and Reitz; Walter et al. 2007)
    float nv, rootV, crossed; ///< crossed: nl rootV + nv rootL
    float fresnel; ///< over F0
} Microfacets;

WEDGE_INLINE Microfacets microfacetsAt(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const float squaredAlpha = 4.0f / fmax(lobe.exponent, 4.0f);
    const Vec3 view = facingView(n, v);
    const Vec3 sum = vecAdd(view, l);
    const Vec3 h = vecScale(sum, 1.0f / fmax(vecLength(sum), 1e-20f));
    const float nl = fmax(vecDot(n, l), 0.0f);
    Microfacets m;
    m.nv = fmax(vecDot(n, view), 0.5f * WEDGE_LEAST_FACING);
    m.nh = vecDot(n, h);
    // 1 - nh^2 would leave nothing of sharp lobes.
    const Vec3 aside = vecMad(h, n, -m.nh);
    const float spread = vecDot(aside, aside) + squaredAlpha * m.nh * m.nh;
    m.d = squaredAlpha * WEDGE_INV_PI / fmax(spread * spread, 1e-30f);
    m.rootV = smithRoot(squaredAlpha, m.nv);
    m.crossed = nl * m.rootV + m.nv * smithRoot(squaredAlpha, nl);
    m.fresnel = fresnelOver(lobe.normalization, vecDot(view, h));
    return m;
}

/// lobeAt() of microfacets: D G2 F / (4 nv nl) over F0, with the height-correlated masking and shadowing of Smith
/// (Heitz 2014), and the density of visible normals over 4 v.h, G1 D / (4 nv).
WEDGE_INLINE LobeAt microfacetLobeAt(Lobe lobe, Vec3 n, Vec3 v, Vec3 l)
{
    const Microfacets m = microfacetsAt(lobe, n, v, l);
    LobeAt at;
    at.value = m.nh > 0.0f ? 0.5f * m.d * m.fresnel / m.crossed : 0.0f;
    at.pdf = m.nh > 0.0f ? 0.5f * m.d / (m.nv + m.rootV) : 0.0f;
    return at;
}
#endif

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
#ifdef WEDGE_GGX
    const bool microfacets = lobe.kind == WEDGE_MICROFACETS;
    const LobeAt other = microfacetLobeAt(lobe, n, v, l);
    at.value = microfacets ? other.value : at.value;
    at.pdf = microfacets ? other.pdf : at.pdf;
#endif
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

#ifdef WEDGE_GGX
/// The view mirrored by a visible normal of the microfacets: in the space in which they are a hemisphere, the cap of
/// directions about the view, each halved with it (Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical
/// Caps, 2023).
WEDGE_INLINE Vec3 sampleMicrofacets(Lobe lobe, Vec3 n, Vec3 v, Vec2 u)
{
    const float alpha = 2.0f / sqrt(fmax(lobe.exponent, 4.0f));
    const Vec3 view = facingView(n, v);
    Vec3 s, t;
    tangentFrame(n, &s, &t);
    const Vec3 w = vecNormalize(vec3(alpha * vecDot(s, view), alpha * vecDot(t, view), vecDot(n, view)));
    const float z = (1.0f - u.x) * (1.0f + w.z) - w.z;
    const float r = sqrt(fmax(0.0f, 1.0f - z * z));
    float sine, cosine;
    sinCosTurn(u.y, &sine, &cosine);
    const Vec3 m = vecNormalize(vec3(alpha * (r * cosine + w.x), alpha * (r * sine + w.y), fmax(z + w.z, 1e-20f)));
    const Vec3 h = vecMad(vecMad(vecScale(s, m.x), t, m.y), n, m.z);
    return vecMad(vecScale(view, -1.0f), h, 2.0f * vecDot(view, h));
}
#endif

/// A direction distributed as the lobe is, see lobePdf(); it may lie below n's horizon, where the lobe reflects
/// nothing. Phong: about the mirrored view; Blinn-Phong: the view mirrored by a half vector about n; microfacets: by
/// one of their visible normals.
WEDGE_INLINE Vec3 sampleLobe(Lobe lobe, Vec3 n, Vec3 v, Vec2 u)
{
    const bool phong = lobe.kind == WEDGE_PHONG;
    const Vec3 mirrored = vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v));
    const Vec3 axis = vec3(phong ? mirrored.x : n.x, phong ? mirrored.y : n.y, phong ? mirrored.z : n.z);
    const Vec3 h = powerCosineDirection(axis, lobe.exponent, u);
    const Vec3 l = vecMad(vecScale(v, -1.0f), h, 2.0f * vecDot(v, h));
    const Vec3 sampled = vec3(phong ? h.x : l.x, phong ? h.y : l.y, phong ? h.z : l.z);
#ifdef WEDGE_GGX
    return vecChoose(lobe.kind == WEDGE_MICROFACETS, sampleMicrofacets(lobe, n, v, u), sampled);
#else
    return sampled;
#endif
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
    const float weight = c > lobe.leastCosine ? jacobian * scale : 0.0f;
#ifdef WEDGE_GGX
    const Microfacets m = microfacetsAt(lobe, n, v, l);
    const float other = m.nh > 0.0f ? m.fresnel * (m.nv + m.rootV) / m.crossed : 0.0f;
    return lobe.kind == WEDGE_MICROFACETS ? other : weight;
#else
    return weight;
#endif
}

/// The same for a lobe that is used once.
WEDGE_FN float specularLobe(Vec3 n, Vec3 v, Vec3 l, float exponent, uint kind)
{
    return lobeValue(makeLobe(exponent, kind), n, v, l);
}

WEDGE_SHARED_END

#endif
