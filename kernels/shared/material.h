// Surface descriptions as they lie in device memory.
#ifndef WEDGE_SHARED_MATERIAL_H
#define WEDGE_SHARED_MATERIAL_H

#include "vec.h"

#define WEDGE_NO_TEXTURE 0xffffffffu

/// What a material reflects besides its diffuse part; bsdf.h evaluates it.
#define WEDGE_LAMBERT 0u ///< nothing
#define WEDGE_PHONG 1u ///< a power of the cosine to the mirrored view
#define WEDGE_BLINN_PHONG 2u ///< a power of the half vector's cosine to the normal
/// Bits that a kind takes in planes.
#define WEDGE_KIND_BITS 3u

WEDGE_SHARED_BEGIN

typedef struct {
    Vec3 diffuse;
    float exponent;
    Vec3 specular;
    uint kind; ///< WEDGE_LAMBERT and so on
    Vec3 emission;
    uint diffuseTexture;
    uint specularTexture;
    uint exponentTexture;
    uint emissionTexture;
    uint padding;
} MaterialData;

/// A surface's kind and exponent: what its reflection's shape depends on.
typedef struct {
    float exponent; ///< at least 0
    uint kind; ///< WEDGE_LAMBERT and so on
} Gloss;

WEDGE_INLINE Gloss makeGloss(float exponent, uint kind)
{
    Gloss g;
    g.exponent = exponent;
    g.kind = kind;
    return g;
}

/// In one word: the exponent to 1e-6.
WEDGE_INLINE uint packGloss(Gloss g)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
    return (as_uint(g.exponent) & ~kinds) | g.kind;
}

WEDGE_INLINE Gloss unpackGloss(uint packed)
{
    const uint kinds = (1u << WEDGE_KIND_BITS) - 1u;
    return makeGloss(as_float(packed & ~kinds), packed & kinds);
}

/// In 16 bits: the exponent to 0.2 % between 2^-10 and 2^22, what is below or above as these.
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
/// direction does, so that Blinn-Phong's is four times Phong's.
WEDGE_INLINE float exponentAs(Gloss g, uint kind)
{
    const float turned = g.kind == WEDGE_PHONG ? 4.0f : 0.25f;
    const bool same = g.kind == kind || g.kind == WEDGE_LAMBERT || kind == WEDGE_LAMBERT;
    return same ? g.exponent : turned * g.exponent;
}

/// Where a texture's texels start in the texel buffer. Row 0 is v = 0; texels are 8-bit sRGB, red in the low byte.
typedef struct {
    uint offset, width, height, padding;
} TextureData;

WEDGE_SHARED_END

#endif
