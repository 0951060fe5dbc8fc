// Reflection of the materials: Lambert plus a Phong or Blinn-Phong lobe.
#ifndef WEDGE_SHARED_BSDF_H
#define WEDGE_SHARED_BSDF_H

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

/// The same for a lobe that is used once.
WEDGE_FN float specularLobe(Vec3 n, Vec3 v, Vec3 l, float exponent, uint model)
{
    return lobeValue(makeLobe(exponent, model), n, v, l);
}

WEDGE_SHARED_END

#endif
