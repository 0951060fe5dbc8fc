// Meshes that emit as lights, and area lights that share a term: points on them, chosen by power, and the density of
// those where a ray meets them. Both sides of a triangle emit.
#ifndef WEDGE_EMITTERS_H
#define WEDGE_EMITTERS_H

#include "shared/emitter.h"
#include "shared/light.h"
#include "trace/cutouts.h"
#include "trace/surface.h"

typedef struct {
    SurfaceData surfaces;
    __global const AreaLight* quads; ///< which WEDGE_PAIR_QUAD numbers
    __global const Emitter* list;
    __global const float* picks; ///< of each triangle of the scene: the probability that it is chosen, or
                                 ///< WEDGE_PICK_ELSEWHERE: it is part of another term
    uint count; ///< of the list
    float share; ///< probability that a path's vertex samples them and not other lights
#ifdef WEDGE_CUTOUTS
    __global const uint* cutouts; ///< as in TraversalRay
#endif
} EmitterData;

/// The scene's emitters among a kernel's parameters.
#define WEDGE_EMITTER_PARAMETERS __global const Emitter *restrict emitters, __global const float *restrict emitterPicks

/// A point on one of them.
typedef struct {
    Vec3 point; ///< metres
    Vec3 normal; ///< unit, of the triangle, on either side; of a quad on the side that emits
    Vec3 radiance;
    float density; ///< of the point, 1/m^2
    float extent; ///< metres, of the emitter
    float error; ///< metres: rounding of the point and of tests of rays that end at it
    float end; ///< of such rays, in their lengths
    bool oneSided;
} EmitterPoint;

/// Twice the area of a triangle times its unit normal, at a time.
WEDGE_FN Vec3 triangleNormal(SurfaceData data, uint triangle, float time)
{
    const Vec3 a = positionAt(data, data.indices[3u * triangle], time);
    const Vec3 ab = vecSub(positionAt(data, data.indices[3u * triangle + 1u], time), a);
    return vecCross(ab, vecSub(positionAt(data, data.indices[3u * triangle + 2u], time), a));
}

/// The first of the list whose numbers reach beyond `number`: between where its stripe of numbers begins and the next.
WEDGE_FN uint findEmitter(EmitterData e, float number)
{
    const uint last = e.count - 1u, stripe = min((uint)(number * (float)e.count), last);
    uint low = e.list[stripe].guide, high = stripe < last ? e.list[stripe + 1u].guide : last;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        const bool below = e.list[middle].upTo <= number;
        low = below ? middle + 1u : low;
        high = below ? high : middle;
    }
    return low;
}

WEDGE_FN Vec3 emittedAt(SurfaceData data, uint triangle, Vec2 weights)
{
    const MaterialData material = data.materials[data.materialIds[triangle]];
    if (material.emissionTexture == WEDGE_NO_TEXTURE) {
        return material.emission;
    }
    __global const uint* corner = data.indices + 3u * triangle;
    const float first = 1.0f - weights.x - weights.y;
    const float u = data.texcoords[2u * corner[0]] * first + data.texcoords[2u * corner[1]] * weights.x
        + data.texcoords[2u * corner[2]] * weights.y;
    const float v = data.texcoords[2u * corner[0] + 1u] * first + data.texcoords[2u * corner[1] + 1u] * weights.x
        + data.texcoords[2u * corner[2] + 1u] * weights.y;
    return vecMul(material.emission,
        sampleTexture(data.textures, data.texels, data.srgbToLinear, material.emissionTexture, u, v));
}

/// The point of the numbers u of an area light that is chosen with the probability `pick`.
WEDGE_FN EmitterPoint sampleQuad(AreaLight light, Vec2 u, float pick)
{
    const float a = lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
    const float b = lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
    const float profile = lightProfile(a, b, light.profile, light.cut);
    EmitterPoint p;
    p.point = lightPoint(light.centre, light.halfU, light.halfV, a, b);
    p.normal = light.normal;
    p.radiance = vecScale(light.radiance, profile);
    p.density = pick * profile / light.profileArea;
    p.error = 0.0f;
    p.end = WEDGE_SHADOW_RAY_END;
    p.oneSided = light.twoSided == 0u;
    return p;
}

/// The point of the numbers u at a time. The first number chooses the triangle and goes on within it: what is
/// stratified over the square is so over the list, too.
WEDGE_FN EmitterPoint sampleEmitter(EmitterData e, Vec2 u, float time)
{
    const uint i = findEmitter(e, u.x);
    const Emitter emitter = e.list[i];
    const float from = i > 0u ? e.list[i - 1u].upTo : 0.0f;
    const float within = clamp((u.x - from) / fmax(emitter.upTo - from, 1e-30f), 0.0f, 1.0f);
    uint second = 0u;
    const Vec2 at = vec2(within, u.y);
    if (emitter.pair == WEDGE_PAIR_QUAD) {
        EmitterPoint p = sampleQuad(e.quads[emitter.triangle], at, emitter.upTo - from);
        p.extent = emitter.extent;
        return p;
    }
    const Vec2 weights =
        emitter.pair != WEDGE_PAIR_NONE ? squareToPair(emitter.pair, at, &second) : squareToTriangle(at);
    const uint triangle = emitter.triangle + second;
    const SurfaceData data = e.surfaces;
    const Vec3 a = positionAt(data, data.indices[3u * triangle], time);
    const Vec3 ab = vecSub(positionAt(data, data.indices[3u * triangle + 1u], time), a);
    const Vec3 ac = vecSub(positionAt(data, data.indices[3u * triangle + 2u], time), a);
    const Vec3 normal = vecCross(ab, ac);
    const float twice = vecLength(normal);
    EmitterPoint p;
    p.point = vecMad(vecMad(a, ab, weights.x), ac, weights.y);
    p.normal = vecScale(normal, 1.0f / fmax(twice, 1e-30f));
    p.radiance = emittedAt(data, triangle, weights);
#ifdef WEDGE_CUTOUTS
    // Rays end before the emitter; as many as would pass through it find no light.
    p.radiance = vecScale(p.radiance, opacityAt(e.cutouts, triangle, weights.x, weights.y) * (1.0f / 255.0f));
#endif
    p.density = 2.0f * e.picks[triangle] / fmax(twice, 1e-30f);
    p.extent = emitter.extent;
    const Vec3 far = vec3(
        fabs(a.x) + fabs(ab.x) + fabs(ac.x), fabs(a.y) + fabs(ab.y) + fabs(ac.y), fabs(a.z) + fabs(ab.z) + fabs(ac.z));
    p.error = WEDGE_ORIGIN_ULPS * WEDGE_ULP * (far.x + far.y + far.z);
    p.end = 1.0f;
    p.oneSided = false;
    return p;
}

/// Whether the point sends light against the direction l.
WEDGE_INLINE bool emitsAgainst(const EmitterPoint* p, Vec3 l) { return !p->oneSided || vecDot(p->normal, l) < 0.0f; }

/// From there to the point, lifted off the emitter: the ray meets what is before it, be it ever so near, but not the
/// emitter itself.
WEDGE_FN Vec3 emitterShadowRay(const EmitterPoint* p, Vec3 origin)
{
    const Vec3 ray = vecSub(p->point, origin);
    return vecMad(ray, p->normal, vecDot(p->normal, ray) > 0.0f ? -p->error : p->error);
}

/// Density in 1/sr of a point of that density on a surface of that unit normal, `distance` metres away in direction l.
WEDGE_INLINE float densityOfDirection(float density, Vec3 normal, Vec3 l, float distance)
{
    return density * distance * distance / fmax(fabs(vecDot(normal, l)), 1e-12f);
}

/// Density in 1/sr at which sampleEmitter() finds what a ray of unit direction l met.
WEDGE_FN float emitterPdf(EmitterData e, Hit hit, Vec3 l, float time)
{
    const float pick = e.picks[hit.triangle];
    if (!(pick > 0.0f)) {
        return 0.0f;
    }
    const Vec3 normal = triangleNormal(e.surfaces, hit.triangle, time);
    const float twice = fmax(vecLength(normal), 1e-30f);
    return densityOfDirection(2.0f * pick / twice, vecScale(normal, 1.0f / twice), l, hit.t);
}

/// What a ray meets that emits; 0 of all else.
WEDGE_FN Vec3 emittedOf(EmitterData e, Hit hit)
{
    return hit.triangle != WEDGE_NO_TRIANGLE && e.count > 0u ? emittedAt(e.surfaces, hit.triangle, vec2(hit.u, hit.v))
                                                             : vec3(0.0f, 0.0f, 0.0f);
}

#endif
