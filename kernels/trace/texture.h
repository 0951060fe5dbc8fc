// Texture look-ups: bilinear, repeated, linear after the sRGB curve.
#ifndef WEDGE_TEXTURE_H
#define WEDGE_TEXTURE_H

#include "shared/material.h"

WEDGE_FN Vec3 texelRgb(__global const uint* texels, __global const float* srgbToLinear, uint index)
{
    const uint t = texels[index];
    return vec3(srgbToLinear[t & 255u], srgbToLinear[(t >> 8) & 255u], srgbToLinear[(t >> 16) & 255u]);
}

/// i modulo n for -1 <= i <= n, n >= 1.
WEDGE_FN uint wrapIndex(int i, uint n) { return i < 0 ? n - 1u : (uint)i < n ? (uint)i : 0u; }

/// Linear RGB of texture `texture` at (u, v), v up, repeated outside [0, 1).
WEDGE_FN Vec3 sampleTexture(__global const TextureData* textures, __global const uint* texels,
    __global const float* srgbToLinear, uint texture, float u, float v)
{
    const TextureData info = textures[texture];
    // Reduced to one period first: an integer conversion of a huge coordinate is undefined.
    const float x = (u - floor(u)) * (float)info.width - 0.5f;
    const float y = (v - floor(v)) * (float)info.height - 0.5f;
    if (!(fabs(x) < 1e9f) || !(fabs(y) < 1e9f)) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    const float fx = x - floor(x);
    const float fy = y - floor(y);
    const uint x0 = wrapIndex((int)floor(x), info.width);
    const uint y0 = wrapIndex((int)floor(y), info.height);
    const uint x1 = wrapIndex((int)x0 + 1, info.width);
    const uint y1 = wrapIndex((int)y0 + 1, info.height);
    const uint row0 = info.offset + y0 * info.width;
    const uint row1 = info.offset + y1 * info.width;
    const Vec3 c00 = texelRgb(texels, srgbToLinear, row0 + x0);
    const Vec3 c10 = texelRgb(texels, srgbToLinear, row0 + x1);
    const Vec3 c01 = texelRgb(texels, srgbToLinear, row1 + x0);
    const Vec3 c11 = texelRgb(texels, srgbToLinear, row1 + x1);
    const Vec3 lower = vecMad(c00, vecSub(c10, c00), fx);
    const Vec3 upper = vecMad(c01, vecSub(c11, c01), fx);
    return vecMad(lower, vecSub(upper, lower), fy);
}

#endif
