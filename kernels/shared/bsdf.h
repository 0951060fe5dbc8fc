// Reflection of the materials: Lambert plus a Phong or Blinn-Phong lobe.
#ifndef WEDGE_SHARED_BSDF_H
#define WEDGE_SHARED_BSDF_H

#include "vec.h"

#define WEDGE_SPECULAR_BLINN_PHONG 0u
#define WEDGE_SPECULAR_PHONG 1u
#define WEDGE_PI 3.14159265f
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

/// The specular lobe in 1/sr for unit vectors: n normal, v to the viewer, l to the light, both above n's horizon.
WEDGE_FN float specularLobe(Vec3 n, Vec3 v, Vec3 l, float exponent, uint model)
{
    float c;
    if (model == WEDGE_SPECULAR_PHONG) {
        c = 2.0f * vecDot(n, v) * vecDot(n, l) - vecDot(v, l);
    } else {
        c = vecDot(n, vecNormalize(vecAdd(v, l)));
    }
    return c > 0.0f ? specularNormalization(exponent, model) * pow(c, exponent) : 0.0f;
}

WEDGE_SHARED_END

#endif
