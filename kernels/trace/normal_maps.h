// What normal maps and height maps make of a shading normal, in programs with WEDGE_NORMAL_MAPS.
//
// Both are slopes in a tangent space: x along the texture's u, y along its v, z off the surface's outside. Of a normal
// map a texel is the direction 2c - 1; of a height map the slopes are differences between texels next to each other, 1
// being as high as a texel is wide.
#ifndef WEDGE_NORMAL_MAPS_H
#define WEDGE_NORMAL_MAPS_H

#include "shared/bsdf.h"
#include "trace/texture.h"

/// Least cosine between a mapped normal and the triangle's.
#define WEDGE_LEAST_MAPPED_COSINE 0.01f
/// Triangles whose texture coordinates lie on a line up to this, relative, have no tangents.
#define WEDGE_LEAST_TEXTURE_AREA 1e-6f

/// Height at (u, v), 0 to 1. plain: 256 numbers, what bytes mean.
WEDGE_FN float heightAt(__global const TextureData* textures, __global const uint* texels, __global const float* plain,
    uint texture, float u, float v)
{
    return luminance(sampleTexture(textures, texels, plain, texture, u, v));
}

/// The direction in the tangent space, of any length, that a material's map has at (u, v).
WEDGE_FN Vec3 mappedDirection(__global const TextureData* textures, __global const uint* texels,
    __global const float* plain, MaterialData material, Vec2 at)
{
    const uint texture = material.normalTexture;
    Vec3 n;
    if (material.normalIsHeight != 0u) {
        const float u = at.x - floor(at.x), v = at.y - floor(at.y);
        const float du = 1.0f / (float)textures[texture].width, dv = 1.0f / (float)textures[texture].height;
        n.x = 0.5f
            * (heightAt(textures, texels, plain, texture, u - du, v)
                - heightAt(textures, texels, plain, texture, u + du, v));
        n.y = 0.5f
            * (heightAt(textures, texels, plain, texture, u, v - dv)
                - heightAt(textures, texels, plain, texture, u, v + dv));
        n.z = 1.0f;
    } else {
        const Vec3 c = sampleTexture(textures, texels, plain, texture, at.x, at.y);
        n = vec3(2.0f * c.x - 1.0f, 2.0f * c.y - 1.0f, 2.0f * c.z - 1.0f);
    }
    n.x *= material.normalStrength;
    n.y *= material.normalStrength;
    return n;
}

/// A direction of the tangent space in the world, a unit normal.
///
/// normal, geometric: the unit normals without the map, on the viewer's side. side: 1 where that is the outside, else
/// -1. ab, ac: the triangle's edges; uvB, uvC: how far the texture coordinates go along them. Without tangents, and
/// where there is no direction, it is `normal`. A normal that the triangle is not seen under is lifted over its plane.
WEDGE_FN Vec3 fromTangentSpace(
    Vec3 direction, Vec3 normal, Vec3 geometric, float side, Vec3 ab, Vec3 ac, Vec2 uvB, Vec2 uvC)
{
    const float area = uvB.x * uvC.y - uvC.x * uvB.y, sign = area < 0.0f ? -1.0f : 1.0f;
    if (!(fabs(area) > WEDGE_LEAST_TEXTURE_AREA * (fabs(uvB.x * uvC.y) + fabs(uvC.x * uvB.y)))) {
        return normal;
    }
    const Vec3 alongU = vecScale(vecSub(vecScale(ab, uvC.y), vecScale(ac, uvB.y)), sign);
    const Vec3 alongV = vecScale(vecSub(vecScale(ac, uvB.x), vecScale(ab, uvC.x)), sign);
    const Vec3 across = vecMad(alongU, normal, -vecDot(alongU, normal));
    const float length = vecLength(across);
    if (!(length > 1e-18f && length < INFINITY)) {
        return normal;
    }
    const Vec3 tangent = vecScale(across, 1.0f / length);
    const Vec3 left = vecCross(normal, tangent);
    // Textures may be mirrored.
    const Vec3 bitangent = vecScale(left, vecDot(left, alongV) < 0.0f ? -1.0f : 1.0f);
    Vec3 n = vecScale(normal, direction.z);
    n = vecMad(n, tangent, side * direction.x);
    n = vecMad(n, bitangent, side * direction.y);
    const float whole = vecLength(n);
    if (!(whole > 1e-6f && whole < INFINITY)) {
        return normal;
    }
    const float below = WEDGE_LEAST_MAPPED_COSINE * whole - vecDot(n, geometric);
    return vecNormalize(vecMad(n, geometric, fmax(below, 0.0f)));
}

#endif
