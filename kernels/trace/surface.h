// From a ray's hit to the surface that is shaded: position, normals, ray origin, material.
#ifndef WEDGE_SURFACE_H
#define WEDGE_SURFACE_H

#include "shared/bsdf.h"
#include "shared/hit.h"
#include "trace/normal_maps.h"
#include "trace/texture.h"

/// Rounding errors of a hit point and of the next ray's triangle test, in units of the last place of the largest
/// coordinate involved.
#define WEDGE_ORIGIN_ULPS 32.0f
#define WEDGE_ULP 5.96046448e-8f

/// The scene's geometry and materials.
typedef struct {
    __global const float* positions; ///< 3 a vertex
    __global const float* normals; ///< 3 a vertex, zero: use the geometric normal
    __global const float* texcoords; ///< 2 a vertex
    __global const uint* indices; ///< 3 a triangle
    __global const uint* materialIds; ///< 1 a triangle
    __global const MaterialData* materials;
    __global const TextureData* textures;
    __global const uint* texels;
    __global const float* srgbToLinear; ///< 256 entries of colours, then 256 of plain numbers
    /// When the shutter closes; positions and normals are those when it opens. Nobody reads them without WEDGE_MOTION.
    __global const float *positionsAtClose, *normalsAtClose;
} SurfaceData;

/// The scene's geometry and materials among a kernel's parameters, and the SurfaceData made of them.
#define WEDGE_SURFACE_PARAMETERS                                                                                       \
    __global const float *restrict positions, __global const float *restrict normals,                                  \
        __global const float *restrict texcoords, __global const uint *restrict indices,                               \
        __global const uint *restrict materialIds, __global const MaterialData *restrict materials,                    \
        __global const TextureData *restrict textures, __global const uint *restrict texels,                           \
        __global const float *restrict srgbToLinear, __global const float *restrict positionsAtClose,                  \
        __global const float *restrict normalsAtClose
#define WEDGE_SURFACE_ARGUMENTS                                                                                        \
    surfaceData(positions, normals, texcoords, indices, materialIds, materials, textures, texels, srgbToLinear,        \
        positionsAtClose, normalsAtClose)

WEDGE_FN SurfaceData surfaceData(WEDGE_SURFACE_PARAMETERS)
{
    SurfaceData data;
    data.positions = positions;
    data.normals = normals;
    data.texcoords = texcoords;
    data.indices = indices;
    data.materialIds = materialIds;
    data.materials = materials;
    data.textures = textures;
    data.texels = texels;
    data.srgbToLinear = srgbToLinear;
    data.positionsAtClose = positionsAtClose;
    data.normalsAtClose = normalsAtClose;
    return data;
}

typedef struct {
    Vec3 position; ///< metres, on the triangle
    Vec3 origin; ///< where rays start: position lifted off the surface on the viewer's side
    Vec3 normal; ///< unit shading normal on the viewer's side
    Vec3 geometric; ///< unit geometric normal on the viewer's side
    Vec3 diffuse, specular, emission;
    Gloss gloss;
} Surface;

WEDGE_FN Vec3 loadVertex(__global const float* data, uint vertex)
{
    return vec3(data[3u * vertex], data[3u * vertex + 1u], data[3u * vertex + 2u]);
}

/// A vertex at a time, the same floats as traversals compute in the hierarchy's units.
WEDGE_FN Vec3 positionAt(SurfaceData data, uint vertex, float time)
{
    const Vec3 open = loadVertex(data.positions, vertex);
#ifdef WEDGE_MOTION
    return vecMad(open, vecSub(loadVertex(data.positionsAtClose, vertex), open), time);
#else
    (void)time;
    return open;
#endif
}

/// A vertex' unit normal at a time; the zero vector where it has none, or turns round and has none halfway.
WEDGE_FN Vec3 normalAt(SurfaceData data, uint vertex, float time)
{
    const Vec3 open = loadVertex(data.normals, vertex);
#ifdef WEDGE_MOTION
    const Vec3 n = vecMad(open, vecSub(loadVertex(data.normalsAtClose, vertex), open), time);
    return vecDot(n, n) > 1e-12f ? vecNormalize(n) : vec3(0.0f, 0.0f, 0.0f);
#else
    (void)time;
    return open;
#endif
}

/// How far the point of a hit moves from the shutter's opening to its closing, in metres; 0 where nothing moves.
WEDGE_FN Vec3 hitMotion(SurfaceData data, Hit hit)
{
#ifdef WEDGE_MOTION
    Vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    const float weights[3] = { 1.0f - hit.u - hit.v, hit.u, hit.v };
    for (uint corner = 0u; corner < 3u; ++corner) {
        const uint vertex = data.indices[3u * hit.triangle + corner];
        const Vec3 displacement = vecSub(loadVertex(data.positionsAtClose, vertex), loadVertex(data.positions, vertex));
        sum = vecMad(sum, displacement, weights[corner]);
    }
    return sum;
#else
    (void)data;
    (void)hit;
    return vec3(0.0f, 0.0f, 0.0f);
#endif
}

/// How far p lies below the tangent plane of a vertex, along that plane's normal; 0 where it lies above.
WEDGE_INLINE Vec3 liftToTangentPlane(Vec3 p, Vec3 vertex, Vec3 normal)
{
    return vecScale(normal, -fmin(0.0f, vecDot(vecSub(p, vertex), normal)));
}

/// Ray origin of point p = (a, b, c weighted by barycentrics): lifted onto the curved surface that the vertex
/// normals suggest, so that a coarse mesh does not shadow itself at the terminator (Hanika, Hacking the Shadow
/// Terminator, Ray Tracing Gems II, 2021), then off the plane by the rounding error of everything that made p:
/// a bound from the coordinates themselves instead of one global distance.
WEDGE_INLINE Vec3 rayOrigin(
    Vec3 p, Vec3 geometric, Vec3 a, Vec3 b, Vec3 c, Vec3 na, Vec3 nb, Vec3 nc, bool smooth, float u, float v)
{
    Vec3 curved = vecMad(p, liftToTangentPlane(p, a, na), 1.0f - u - v);
    curved = vecMad(curved, liftToTangentPlane(p, b, nb), u);
    curved = vecMad(curved, liftToTangentPlane(p, c, nc), v);
    Vec3 lifted = vecChoose(smooth, curved, p);
    const float x = fmax(fmax(fabs(a.x), fabs(b.x)), fabs(c.x));
    const float y = fmax(fmax(fabs(a.y), fabs(b.y)), fabs(c.y));
    const float z = fmax(fmax(fabs(a.z), fabs(b.z)), fabs(c.z));
    const float error = WEDGE_ORIGIN_ULPS * WEDGE_ULP
        * (fabs(geometric.x) * x + fabs(geometric.y) * y + fabs(geometric.z) * z + 0.125f * fmax(fmax(x, y), z));
    // And by as much towards the middle of the triangle: a point on its edge lies in the neighbour's plane, too, and a
    // ray from there would pass the neighbour by.
    const Vec3 inwards = vecSub(vecScale(vecAdd(vecAdd(a, b), c), 1.0f / 3.0f), p);
    lifted = vecMad(lifted, inwards, fmin(error / fmax(vecLength(inwards), 1e-30f), 1.0f));
    return vecMad(lifted, geometric, error);
}

/// A triangle's corners and its vertex normals at a time, see positionAt() and normalAt().
typedef struct {
    Vec3 a, b, c;
    Vec3 normalA, normalB, normalC;
} Corners;

WEDGE_FN Corners cornersOf(SurfaceData data, uint triangle, float time)
{
    const uint a = data.indices[3u * triangle];
    const uint b = data.indices[3u * triangle + 1u];
    const uint c = data.indices[3u * triangle + 2u];
    Corners k;
    k.a = positionAt(data, a, time);
    k.b = positionAt(data, b, time);
    k.c = positionAt(data, c, time);
    k.normalA = normalAt(data, a, time);
    k.normalB = normalAt(data, b, time);
    k.normalC = normalAt(data, c, time);
    return k;
}

/// Where and how a surface lies.
typedef struct {
    Vec3 position, origin, normal, geometric; ///< as of Surface
} Facet;

/// The triangle's at barycentrics (u, v), seen along a direction. Without branches, for loops over lanes.
WEDGE_INLINE Facet facetOf(Corners k, float u, float v, Vec3 direction)
{
    const Vec3 ab = vecSub(k.b, k.a), ac = vecSub(k.c, k.a);
    Facet f;
    f.position = vecMad(vecMad(k.a, ab, u), ac, v);
    const Vec3 winding = vecNormalize(vecCross(ab, ac));
    f.geometric = vecScale(winding, vecDot(winding, direction) > 0.0f ? -1.0f : 1.0f);

    // Vertex normals follow the winding in well-made files and do not in others: each is turned to the viewer's side.
    const Vec3 na = vecScale(k.normalA, vecDot(k.normalA, f.geometric) < 0.0f ? -1.0f : 1.0f);
    const Vec3 nb = vecScale(k.normalB, vecDot(k.normalB, f.geometric) < 0.0f ? -1.0f : 1.0f);
    const Vec3 nc = vecScale(k.normalC, vecDot(k.normalC, f.geometric) < 0.0f ? -1.0f : 1.0f);
    const Vec3 interpolated = vecMad(vecMad(vecScale(na, 1.0f - u - v), nb, u), nc, v);
    const bool smooth = vecDot(interpolated, interpolated) > 1e-12f;
    f.normal = vecChoose(smooth, vecNormalize(interpolated), f.geometric);
    f.origin = rayOrigin(f.position, f.geometric, k.a, k.b, k.c, na, nb, nc, smooth, u, v);
    return f;
}

/// Texture coordinates of a hit.
WEDGE_FN Vec2 texcoordsAt(SurfaceData data, Hit hit)
{
    const uint a = data.indices[3u * hit.triangle];
    const uint b = data.indices[3u * hit.triangle + 1u];
    const uint c = data.indices[3u * hit.triangle + 2u];
    const float w = 1.0f - hit.u - hit.v;
    return vec2(data.texcoords[2u * a] * w + data.texcoords[2u * b] * hit.u + data.texcoords[2u * c] * hit.v,
        data.texcoords[2u * a + 1u] * w + data.texcoords[2u * b + 1u] * hit.u + data.texcoords[2u * c + 1u] * hit.v);
}
#ifdef WEDGE_MIRRORS
/// A mirror's or glass' facet: no light is sampled there, and rays start next to the triangle itself. *kind: of the
/// surface.
WEDGE_INLINE void mirrorFacet(Corners k, float u, float v, Vec3 direction, Facet* f, uint* kind)
{
    const bool mirror = WEDGE_IS_MIRROR(*kind);
    const Vec3 plain =
        rayOrigin(f->position, f->geometric, k.a, k.b, k.c, f->normal, f->normal, f->normal, false, u, v);
    f->origin = vecChoose(mirror, plain, f->origin);
    const bool behind = vecDot(vecCross(vecSub(k.b, k.a), vecSub(k.c, k.a)), direction) > 0.0f;
    *kind |= mirror && behind ? WEDGE_MIRROR_BEHIND : 0u;
}
#endif

#ifdef WEDGE_GGX
/// A facet of microfacets is shaded by reflectingNormal(); v: unit, to the viewer.
WEDGE_INLINE void microfacetFacet(Gloss gloss, Vec3 v, Facet* f)
{
    const bool microfacets = gloss.kind == WEDGE_MICROFACETS;
    f->normal = vecChoose(microfacets, reflectingNormal(f->normal, f->geometric, v, gloss.exponent), f->normal);
}
#endif

/// What a surface is made of.
typedef struct {
    Vec3 diffuse, specular, emission;
    Gloss gloss;
} Finish;

/// With the material's own number in the place of the exponent.
WEDGE_FN Finish paintOf(SurfaceData data, Hit hit)
{
    Finish s;
    const MaterialData material = data.materials[data.materialIds[hit.triangle]];
    s.diffuse = material.diffuse;
    s.specular = material.specular;
    s.emission = material.emission;
    s.gloss = makeGloss(material.exponent, material.kind);
    const bool textured = material.diffuseTexture != WEDGE_NO_TEXTURE || material.specularTexture != WEDGE_NO_TEXTURE
        || material.emissionTexture != WEDGE_NO_TEXTURE || material.exponentTexture != WEDGE_NO_TEXTURE;
    if (!textured) {
        return s;
    }
    const Vec2 at = texcoordsAt(data, hit);
    const float tu = at.x, tv = at.y;
    if (material.diffuseTexture != WEDGE_NO_TEXTURE) {
        s.diffuse = vecMul(
            s.diffuse, sampleTexture(data.textures, data.texels, data.srgbToLinear, material.diffuseTexture, tu, tv));
    }
    if (material.specularTexture != WEDGE_NO_TEXTURE) {
        s.specular = vecMul(
            s.specular, sampleTexture(data.textures, data.texels, data.srgbToLinear, material.specularTexture, tu, tv));
    }
    if (material.emissionTexture != WEDGE_NO_TEXTURE) {
        s.emission = vecMul(
            s.emission, sampleTexture(data.textures, data.texels, data.srgbToLinear, material.emissionTexture, tu, tv));
    }
    if (material.exponentTexture != WEDGE_NO_TEXTURE) {
        // An exponent is a number and no colour: nothing has encoded it.
        s.gloss.exponent *=
            sampleTexture(data.textures, data.texels, data.srgbToLinear + 256, material.exponentTexture, tu, tv).x;
    }
    return s;
}

WEDGE_FN Finish finishOf(SurfaceData data, Hit hit)
{
    Finish s = paintOf(data, hit);
#ifdef WEDGE_GGX
    if (s.gloss.kind == WEDGE_MICROFACETS) {
        s.gloss = microfacetGloss(s.gloss.exponent, s.diffuse, s.specular);
    }
#endif
#ifdef WEDGE_MIRRORS
    if (WEDGE_IS_MIRROR(s.gloss.kind)) {
        s.gloss.kind |= data.materialIds[hit.triangle] << WEDGE_MIRROR_BITS;
        s.diffuse = s.specular = vec3(0.0f, 0.0f, 0.0f);
    }
#endif
    return s;
}

#ifdef WEDGE_NORMAL_MAPS
/// How far the texture coordinates go from one vertex to another.
WEDGE_FN Vec2 texcoordStep(SurfaceData data, uint from, uint to)
{
    return vec2(data.texcoords[2u * to] - data.texcoords[2u * from],
        data.texcoords[2u * to + 1u] - data.texcoords[2u * from + 1u]);
}

/// The shading normal of a hit with the map of its material, if it has one. normal, geometric: as facetOf() has them of
/// the triangle's corners. Files' normals say where the outside is, and where there are none the winding.
WEDGE_FN Vec3 mappedNormal(SurfaceData data, Hit hit, Corners k, Vec3 normal, Vec3 geometric)
{
    const MaterialData material = data.materials[data.materialIds[hit.triangle]];
    if (material.normalTexture == WEDGE_NO_TEXTURE) {
        return normal;
    }
    const Vec3 direction =
        mappedDirection(data.textures, data.texels, data.srgbToLinear + 256, material, texcoordsAt(data, hit));
    const Vec3 ab = vecSub(k.b, k.a), ac = vecSub(k.c, k.a);
    const Vec3 own = vecMad(vecMad(vecScale(k.normalA, 1.0f - hit.u - hit.v), k.normalB, hit.u), k.normalC, hit.v);
    const float byNormals = vecDot(own, geometric), byWinding = vecDot(vecCross(ab, ac), geometric);
    const float side = (byNormals != 0.0f ? byNormals : byWinding) < 0.0f ? -1.0f : 1.0f;
    const uint a = data.indices[3u * hit.triangle];
    const Vec2 uvB = texcoordStep(data, a, data.indices[3u * hit.triangle + 1u]);
    const Vec2 uvC = texcoordStep(data, a, data.indices[3u * hit.triangle + 2u]);
    return fromTangentSpace(direction, normal, geometric, side, ab, ac, uvB, uvC);
}
#endif

/// Surface hit by a ray of the given direction (any length) and time (0 where the shutter opens, 1 where it closes).
WEDGE_FN Surface surfaceAt(SurfaceData data, Hit hit, Vec3 direction, float time)
{
    const Corners corners = cornersOf(data, hit.triangle, time);
    Facet f = facetOf(corners, hit.u, hit.v, direction);
    Finish finish = finishOf(data, hit);
#ifdef WEDGE_MIRRORS
    mirrorFacet(corners, hit.u, hit.v, direction, &f, &finish.gloss.kind);
#endif
#ifdef WEDGE_GGX
    microfacetFacet(finish.gloss, vecScale(vecNormalize(direction), -1.0f), &f);
#endif
    Surface s;
    s.position = f.position;
    s.origin = f.origin;
#ifdef WEDGE_NORMAL_MAPS
    s.normal = mappedNormal(data, hit, corners, f.normal, f.geometric);
#else
    s.normal = f.normal;
#endif
    s.geometric = f.geometric;
    s.diffuse = finish.diffuse;
    s.specular = finish.specular;
    s.emission = finish.emission;
    s.gloss = finish.gloss;
    return s;
}

#endif
