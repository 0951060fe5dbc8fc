// What would light a surface from beyond the scene if nothing hid it, by the surface's direction.
#ifndef WEDGE_UNSHADOWED_ENVIRONMENT_H
#define WEDGE_UNSHADOWED_ENVIRONMENT_H

#include "core/vector16.h"
#include "light/environment_map.h"

/// Least of what unshadowedLight() returns: harmonics of a small sun go below 0.
#define WEDGE_LEAST_UNSHADOWED 0.0625f

WEDGE_INLINE float16 ofHarmonics(__global const float* c, Vec3x16 n)
{
    const float16 value = c[0] + c[1] * n.x + c[2] * n.y + c[3] * n.z + c[4] * n.x * n.y + c[5] * n.y * n.z
        + c[6] * n.z * n.x + c[7] * (3.0f * n.z * n.z - 1.0f) + c[8] * (n.x * n.x - n.y * n.y);
    return min16(max16(value, (float16)(WEDGE_LEAST_UNSHADOWED)), (float16)(1.0f));
}

/// Irradiance of surfaces of unit normals n over the largest that any normal has, red, green and blue: from
/// WEDGE_LEAST_UNSHADOWED to 1, smooth, by spherical harmonics of up to the second order (Ramamoorthi and Hanrahan, An
/// Efficient Representation for Irradiance Environment Maps, 2001).
WEDGE_INLINE Vec3x16 unshadowedLight(__global const EnvironmentMap* environment, __global const float* table, Vec3x16 n)
{
    __global const float* c = table + environmentHarmonics(environment[0].width, environment[0].height);
    Vec3x16 light;
    light.x = ofHarmonics(c, n);
    light.y = ofHarmonics(c + WEDGE_HARMONICS, n);
    light.z = ofHarmonics(c + 2u * WEDGE_HARMONICS, n);
    return light;
}

#endif
