// What a point light or a directional one brings to a receiver where nothing hides it.
#ifndef WEDGE_DELTA_LIGHT_H
#define WEDGE_DELTA_LIGHT_H

#include "light/light_sample.h"

/// Radiance that a receiver reflects to where it is seen from. toLight: vectorToLight(); cosine: between it and the
/// receiver's normal, above 0.
WEDGE_FN Vec3 deltaLightAt(DeltaLight light, Receiver r, Vec3 toLight, float cosine, Vec3 diffuse, Vec3 specular)
{
    const float falloff = light.directional != 0u ? cosine : cosine / vecDot(toLight, toLight);
    const Vec3 lobe = vecScale(specular, lobeValue(r.lobe, r.normal, r.view, vecNormalize(toLight)));
    const Vec3 reflected = vecMad(lobe, diffuse, WEDGE_INV_PI);
    return vecScale(vecMul(reflected, light.colour), falloff);
}

#endif
