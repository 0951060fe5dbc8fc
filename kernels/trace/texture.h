// Texture look-ups: bilinear, repeated, linear after the sRGB curve.
#ifndef WEDGE_TEXTURE_H
#define WEDGE_TEXTURE_H

#include "shared/material.h"
#include "trace/bilinear.h"

WEDGE_FN Vec3 texelRgb(__global const uint* texels, __global const float* srgbToLinear, uint index)
{
    const uint t = texels[index];
    return vec3(srgbToLinear[t & 255u], srgbToLinear[(t >> 8) & 255u], srgbToLinear[(t >> 16) & 255u]);
}

/// Linear RGB of texture `texture` at (u, v), v up, repeated outside [0, 1).
WEDGE_FN Vec3 sampleTexture(__global const TextureData* textures, __global const uint* texels,
    __global const float* srgbToLinear, uint texture, float u, float v)
{
    const TextureData info = textures[texture];
    Bilinear b;
    if (!bilinearAt(info.width, info.height, u, v, &b)) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    const uint row0 = info.offset + b.y0 * info.width;
    const uint row1 = info.offset + b.y1 * info.width;
    const Vec3 c00 = texelRgb(texels, srgbToLinear, row0 + b.x0);
    const Vec3 c10 = texelRgb(texels, srgbToLinear, row0 + b.x1);
    const Vec3 c01 = texelRgb(texels, srgbToLinear, row1 + b.x0);
    const Vec3 c11 = texelRgb(texels, srgbToLinear, row1 + b.x1);
    const Vec3 lower = vecMad(c00, vecSub(c10, c00), b.fx);
    const Vec3 upper = vecMad(c01, vecSub(c11, c01), b.fx);
    return vecMad(lower, vecSub(upper, lower), b.fy);
}

#endif
