// Surface descriptions as they lie in device memory.
#ifndef WEDGE_SHARED_MATERIAL_H
#define WEDGE_SHARED_MATERIAL_H

#include "vec.h"

// Programs of scenes that have no such lobe are built without it; C++ has it always.
#if defined(__cplusplus) && !defined(WEDGE_GGX)
#define WEDGE_GGX 1
#endif
#if defined(__cplusplus) && !defined(WEDGE_MIRRORS)
#define WEDGE_MIRRORS 1
#endif

#define WEDGE_NO_TEXTURE 0xffffffffu

/// What a material reflects besides its diffuse part; bsdf.h evaluates it.
#define WEDGE_LAMBERT 0u ///< nothing
#define WEDGE_PHONG 1u ///< a power of the cosine to the mirrored view
#define WEDGE_BLINN_PHONG 2u ///< a power of the half vector's cosine to the normal
#define WEDGE_MICROFACETS 3u ///< GGX microfacets, whose reflection rises towards grazing directions
#define WEDGE_MIRROR 4u ///< the mirrored view alone
#define WEDGE_GLASS 5u ///< the mirrored and the refracted view
/// Bits that a kind takes in planes.
#define WEDGE_KIND_BITS 3u

/// Of a gloss plane's value, or a surface's kind: whether it is a mirror or glass. Such a kind has the number of the
/// material, shifted by WEDGE_MIRROR_BITS, and this bit where the surface is seen from behind.
#define WEDGE_IS_MIRROR(kind) (((kind)&7u) >= WEDGE_MIRROR)
#define WEDGE_MIRROR_BEHIND 8u
#define WEDGE_MIRROR_BITS 4u

/// Bodies of glass in one another that paths follow.
#define WEDGE_MOST_MEDIA 24u
#define WEDGE_MEDIUM_PRIORITY_SHIFT 24u
#define WEDGE_MEDIUM_MATERIAL 0xffffffu

WEDGE_SHARED_BEGIN

typedef struct {
    Vec3 diffuse; ///< of WEDGE_GLASS what is transmitted
    float exponent; ///< of WEDGE_MICROFACETS the roughness, of WEDGE_GLASS the refractive index
    Vec3 specular;
    uint kind; ///< WEDGE_LAMBERT and so on
    Vec3 emission;
    uint diffuseTexture;
    uint specularTexture;
    uint exponentTexture;
    uint emissionTexture;
    uint normalTexture; ///< directions in the tangent space, or heights; see normal_maps.h
    uint normalIsHeight; ///< 1: heights
    float normalStrength; ///< that its slopes are multiplied by
    uint
        medium; ///< of WEDGE_GLASS: its number, and above WEDGE_MEDIUM_PRIORITY_SHIFT its priority where bodies overlap
    uint nesting; ///< of WEDGE_GLASS: of two bodies in one another the one with the larger number is the inner one
} MaterialData;

/// The least alpha of microfacets: sharper lobes are as those, 4 / alpha^2 being 4e6.
#define WEDGE_LEAST_ALPHA 1e-3f

/// What the shape of a surface's reflection depends on.
typedef struct {
    float exponent; ///< at least 0; of microfacets 4 / alpha^2, that of the Blinn-Phong lobe of as sharp a peak
    uint kind; ///< WEDGE_LAMBERT and so on; see WEDGE_IS_MIRROR
    float rise; ///< of microfacets: by how much of itself the specular colour is more at grazing directions; else 0
} Gloss;

WEDGE_INLINE Gloss makeGloss(float exponent, uint kind)
{
    Gloss g;
    g.exponent = exponent;
    g.kind = kind;
    g.rise = 0.0f;
    return g;
}

/// F90 / F0 - 1 of Schlick's Fresnel factor for the largest channel F0 of the specular colour. F90 is what the largest
/// channel of the diffuse one leaves, so that no direction reflects more than arrives.
WEDGE_INLINE float fresnelRise(Vec3 diffuse, Vec3 specular)
{
    const float f0 = fmax(specular.x, fmax(specular.y, specular.z));
    const float f90 = fmax(f0, 1.0f - fmax(diffuse.x, fmax(diffuse.y, diffuse.z)));
    // Not more than planes keep, and nothing infinite where there is next to no colour.
    return f0 > 0.0f ? fmin(f90 / f0, 65535.0f) - 1.0f : 0.0f;
}

/// Microfacets of a roughness in [0, 1], alpha = roughness^2 (Burley 2012).
WEDGE_INLINE Gloss microfacetGloss(float roughness, Vec3 diffuse, Vec3 specular)
{
    const float alpha = clamp(roughness * roughness, WEDGE_LEAST_ALPHA, 1.0f);
    Gloss g = makeGloss(4.0f / (alpha * alpha), WEDGE_MICROFACETS);
    g.rise = fresnelRise(diffuse, specular);
    return g;
}

/// Of microfacets, in one word besides the kind: 15 bits of the exponent, to 0.05 % between 2^-10 and 2^22, and 14 of
/// 1 + rise, to 0.1 % up to 2^16 and never more than it is.
WEDGE_INLINE uint packMicrofacets(Gloss g)
{
    const uint sharpness = (as_uint(fmax(g.exponent, 0x1p-10f)) - (117u << 23) + (1u << 12)) >> 13;
    const uint ratio = (as_uint(fmax(g.rise, 0.0f) + 1.0f) - (127u << 23)) >> 13;
    return min(ratio, (1u << 14) - 1u) << 18 | min(sharpness, (1u << 15) - 1u) << WEDGE_KIND_BITS | WEDGE_MICROFACETS;
}

WEDGE_INLINE Gloss unpackMicrofacets(uint packed)
{
    const uint sharpness = packed >> WEDGE_KIND_BITS & ((1u << 15) - 1u);
    Gloss g = makeGloss(as_float((sharpness << 13) + (117u << 23)), WEDGE_MICROFACETS);
    g.rise = as_float((packed >> 18 << 13) + (127u << 23)) - 1.0f;
    return g;
}

/// In one word: the exponent to 1e-6; microfacets see packMicrofacets(), mirrors and glass WEDGE_IS_MIRROR.
WEDGE_INLINE uint packGloss(Gloss g)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
#ifdef WEDGE_MIRRORS
    if (WEDGE_IS_MIRROR(g.kind)) {
        return g.kind;
    }
#endif
#ifdef WEDGE_GGX
    const uint microfacets = packMicrofacets(g);
    return g.kind == WEDGE_MICROFACETS ? microfacets : (as_uint(g.exponent) & ~kinds) | g.kind;
#else
    return (as_uint(g.exponent) & ~kinds) | g.kind;
#endif
}

/// Mirrors and glass have no lobe: they are as black as their reflectances in planes.
WEDGE_INLINE Gloss unpackGloss(uint packed)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
#ifdef WEDGE_MIRRORS
    if (WEDGE_IS_MIRROR(packed)) {
        return makeGloss(1.0f, WEDGE_LAMBERT);
    }
#endif
#ifdef WEDGE_GGX
    if ((packed & kinds) == WEDGE_MICROFACETS) {
        return unpackMicrofacets(packed);
    }
#endif
    return makeGloss(as_float(packed & ~kinds), packed & kinds);
}

/// In 16 bits: the exponent to 0.2 % between 2^-10 and 2^22, what is below or above as these; no rise.
WEDGE_INLINE uint packGlossShort(Gloss g)
{
    const uint least = 117u << 23, last = (1u << 13) - 1u;
    const uint bits = as_uint(fmax(g.exponent, 0x1p-10f)) - least;
    return min((bits + (1u << 14)) >> 15, last) << WEDGE_KIND_BITS | g.kind;
}

WEDGE_INLINE Gloss unpackGlossShort(uint packed)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
    return makeGloss(as_float((packed >> WEDGE_KIND_BITS << 15) + (117u << 23)), packed & kinds);
}

/// The exponent that a lobe of that kind has if it is as wide as this: the half vector turns half as far as the
/// direction does, so that Blinn-Phong's is four times Phong's. Microfacets have Blinn-Phong's.
WEDGE_INLINE float exponentAs(Gloss g, uint kind)
{
    const float turned = g.kind == WEDGE_PHONG ? 4.0f : 0.25f;
    const bool same =
        (g.kind == WEDGE_PHONG) == (kind == WEDGE_PHONG) || g.kind == WEDGE_LAMBERT || kind == WEDGE_LAMBERT;
    return same ? g.exponent : turned * g.exponent;
}

/// Where a texture's texels start in the texel buffer. Row 0 is v = 0; texels are 8-bit sRGB, red in the low byte.
typedef struct {
    uint offset, width, height, padding;
} TextureData;

WEDGE_SHARED_END

#endif
