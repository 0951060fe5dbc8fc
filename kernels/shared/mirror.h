// Mirrors and glass: surfaces that light leaves in one direction, or in two.
#ifndef WEDGE_SHARED_MIRROR_H
#define WEDGE_SHARED_MIRROR_H

#include "material.h"

/// The part of the camera's paths that Russian roulette lets go on where a mirror or glass reflects them, from that of
/// the number PathParams::mostMirrored on: most rays that stay in glass for so long stay for some more.
#define WEDGE_MIRRORED_SURVIVAL 0.9f

WEDGE_SHARED_BEGIN

/// Share of unpolarized light that a smooth dielectric reflects (Fresnel), for the cosine `c` in [0, 1] between
/// direction and normal. index: refractive index behind the surface over that before it. *behind: the cosine of the
/// refracted direction, 0 where all light is reflected.
WEDGE_INLINE float dielectricFresnel(float c, float index, float* behind)
{
    const float sine = (1.0f - c * c) / (index * index); // squared, of the refracted direction
    const float d = sqrt(fmax(1.0f - sine, 0.0f));
    const float across = (c - index * d) / fmax(c + index * d, 1e-20f);
    const float along = (index * c - d) / fmax(index * c + d, 1e-20f);
    *behind = d;
    return sine < 1.0f ? 0.5f * (across * across + along * along) : 1.0f;
}

/// Where a path goes on from a mirror or glass.
typedef struct {
    Vec3 direction; ///< unit
    Vec3 weight; ///< what its radiance counts
    uint through; ///< 1: behind the surface
} Deflection;

/// A mirrored direction, by a unit normal on v's side.
WEDGE_INLINE Vec3 mirroredBy(Vec3 n, Vec3 v) { return vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v)); }

/// A refracted one, for the index and the cosine behind that dielectricFresnel() has.
WEDGE_INLINE Vec3 refractedBy(Vec3 n, Vec3 v, float index, float behind)
{
    return vecNormalize(vecMad(vecScale(v, -1.0f / index), n, vecDot(n, v) / index - behind));
}

/// Follows the unit view v, on the side of the geometric normal. normal: that of shading; where directions by it would
/// be on the wrong side of the surface, the geometric one makes them, so that nothing is lost. index: of glass, as of
/// dielectricFresnel(), which chooses between reflection and refraction by `choice` in [0, 1); 0: a mirror. Radiance
/// is that over the squared index of where it is, so that what is refracted counts 1 / index^2 times (Veach 1997, 5.2).
WEDGE_INLINE Deflection deflect(
    Vec3 normal, Vec3 geometric, Vec3 v, float index, Vec3 reflects, Vec3 transmits, float choice)
{
    const bool glass = index > 0.0f;
    const float used = glass ? index : 1.0f;
    const bool facing = vecDot(normal, v) > 0.0f;
    const Vec3 n = vecChoose(facing, normal, geometric);
    float behind, steep;
    const float share = dielectricFresnel(fmin(vecDot(n, v), 1.0f), used, &behind);
    // By the geometric normal it may be that all is reflected.
    const float plain = dielectricFresnel(clamp(vecDot(geometric, v), 0.0f, 1.0f), used, &steep);
    const Vec3 bent = refractedBy(n, v, used, behind), bentPlain = refractedBy(geometric, v, used, steep);
    const bool under = vecDot(bent, geometric) < 0.0f;
    const bool through = glass && choice >= share && (under || plain < 1.0f);
    const Vec3 mirrored = mirroredBy(n, v), mirroredPlain = mirroredBy(geometric, v);
    const Vec3 back = vecChoose(vecDot(mirrored, geometric) > 0.0f, mirrored, mirroredPlain);
    const Vec3 forth = vecChoose(under, bent, bentPlain);
    Deflection d;
    d.through = through ? 1u : 0u;
    d.direction = vecNormalize(vecChoose(through, forth, back));
    d.weight = vecChoose(through, vecScale(transmits, 1.0f / (used * used)), reflects);
    return d;
}

WEDGE_SHARED_END

#endif
