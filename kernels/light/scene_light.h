// The scene's lights as a path's vertices see them: samples of one of them, and the ones that a ray meets.
#ifndef WEDGE_SCENE_LIGHT_H
#define WEDGE_SCENE_LIGHT_H

#include "light/emitters.h"
#include "light/environment_map.h"
#include "shared/bsdf.h"
#include "shared/light.h"
#include "shared/path.h"

typedef struct {
    __global const AreaLight* area;
    __global const DeltaLight* delta;
    EmitterData emitters;
    BeyondData beyond;
    uint areaCount, deltaCount;
    float sceneDiameter;
    uint sampling; ///< WEDGE_LIGHTS_*
    float touching; ///< of PathParams
} LightData;

/// One sample of one light.
typedef struct {
    Vec3 ray; ///< from the shadow ray's origin to the light's point
    Vec3 direction; ///< unit, of the ray
    Vec3 irradiance; ///< on the shaded point, over the probability of the sample; 0: no need to trace
    float pdf; ///< density of the direction, 1/sr; 0 for point and directional lights
    float end; ///< of the ray, in its lengths
} LightChoice;

/// Density in 1/sr at which a vertex samples an area light's point, local coordinates (a, b), in a direction in which
/// the light is `distance` metres away and whose cosine to the light's normal is `facing`.
WEDGE_INLINE float lightPdf(AreaLight light, float a, float b, float distance, float facing)
{
    return light.pick * lightProfile(a, b, light.profile, light.cut) * distance * distance
        / (light.profileArea * fmax(fabs(facing), 1e-12f));
}

/// Whether a point is in the surface that the light is in, which does not light itself: by rounding it may be on either
/// side of it.
WEDGE_INLINE bool isInLight(AreaLight light, Vec3 position)
{
    return fabs(vecDot(light.normal, vecSub(light.centre, position))) < light.lift;
}

/// As seen from where rays start, as directions that meet a light see it: the two are combined.
WEDGE_INLINE LightChoice sampleAreaLight(AreaLight light, Vec3 origin, Vec3 normal, Vec2 u)
{
    LightChoice choice;
    choice.end = shadowRayEnd(light);
    const float a = lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
    const float b = lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
    choice.ray = vecSub(lightPoint(light.centre, light.halfU, light.halfV, a, b), origin);
    choice.direction = vecNormalize(choice.ray);
    const float geometry =
        isInLight(light, origin) ? 0.0f : geometryTerm(normal, choice.ray, light.normal, light.twoSided);
    choice.irradiance = vecScale(light.power, geometry / light.pick);
    const float facing = vecDot(choice.direction, light.normal);
    choice.pdf = geometry > 0.0f ? lightPdf(light, a, b, vecLength(choice.ray), facing) : 0.0f;
    choice.ray = liftedRay(light, choice.ray);
    return choice;
}

WEDGE_FN LightChoice sampleDeltaLight(__global const DeltaLight* light, float sceneDiameter, Vec3 origin, Vec3 normal)
{
    LightChoice choice;
    choice.end = WEDGE_SHADOW_RAY_END;
    choice.ray = vectorToLight(*light, sceneDiameter, origin);
    choice.direction = vecNormalize(choice.ray);
    const float cosine = fmax(0.0f, vecDot(normal, choice.direction));
    const float falloff = light->directional != 0u ? cosine : cosine / fmax(vecDot(choice.ray, choice.ray), 1e-30f);
    choice.irradiance = vecScale(light->colour, falloff / light->pick);
    choice.pdf = 0.0f;
    return choice;
}

WEDGE_FN LightChoice sampleEmitterLight(EmitterData emitters, Vec3 origin, Vec3 normal, Vec2 u, float time)
{
    const EmitterPoint p = sampleEmitter(emitters, u, time);
    LightChoice choice;
    choice.ray = vecSub(p.point, origin);
    const float distance = vecLength(choice.ray);
    choice.direction = vecScale(choice.ray, 1.0f / fmax(distance, 1e-30f));
    const float cosine = vecDot(normal, choice.direction);
    const float pdf = emitters.share * densityOfDirection(p.density, p.normal, choice.direction, distance);
    const bool found = cosine > 0.0f && pdf > 0.0f && emitsAgainst(&p, choice.direction);
    choice.pdf = found ? pdf : 0.0f;
    choice.irradiance = vecScale(p.radiance, found ? cosine / pdf : 0.0f);
    choice.ray = emitterShadowRay(&p, origin);
    choice.end = p.end;
    return choice;
}

/// A direction to what is beyond the scene.
WEDGE_FN LightChoice sampleBeyond(BeyondData beyond, Vec3 normal, Vec2 u)
{
    const BeyondSample sample = chooseBeyond(beyond, u);
    const float cosine = vecDot(normal, sample.direction), pdf = beyond.share * sample.pdf;
    const bool found = cosine > 0.0f && pdf > 0.0f;
    LightChoice choice;
    choice.ray = choice.direction = sample.direction;
    choice.irradiance = vecScale(sample.radiance, found ? cosine / pdf : 0.0f);
    choice.pdf = found ? pdf : 0.0f;
    choice.end = INFINITY;
    return choice;
}

/// No light: see pickLight().
#define WEDGE_NO_LIGHT 0xffffffffu

/// Chooses a light by `pick` in [0, 1): a number of the area lights, then of the others, then one for all emitters, and
/// one for what is beyond the scene.
WEDGE_FN uint pickLight(LightData lights, float pick)
{
    float below = 0.0f;
    for (uint i = 0u; i < lights.areaCount; ++i) {
        below += lights.area[i].pick;
        if (pick < below) {
            return i;
        }
    }
    for (uint i = 0u; i < lights.deltaCount; ++i) {
        below += lights.delta[i].pick;
        if (pick < below) {
            return lights.areaCount + i;
        }
    }
    const uint others = lights.areaCount + lights.deltaCount;
    if (WEDGE_ENVIRONMENT_MAP != 0 && pick >= below + (lights.emitters.count > 0u ? lights.emitters.share : 0.0f)) {
        return others + 1u;
    }
    return lights.emitters.count > 0u ? others : WEDGE_NO_LIGHT;
}

/// Of a distance along a ray: what its meetings with a light and a surface in one place may be off by.
#define WEDGE_MEETING_ROUNDING 1e-6f

/// Where a ray meets a light's quad.
typedef struct {
    float t; ///< along the direction; +inf where it does not
    float a, b;
    float facing; ///< the direction times the light's normal; negative on the emitting side
} LightMeeting;

/// Without branches, so that loops over lanes become vectors.
WEDGE_INLINE LightMeeting meetLight(AreaLight light, Vec3 origin, Vec3 direction)
{
    LightMeeting m;
    m.facing = vecDot(light.normal, direction);
    const float t = vecDot(light.normal, vecSub(light.centre, origin)) / m.facing;
    const bool before = m.facing != 0.0f && t > 0.0f && t < INFINITY;
    // Local coordinates from the two edges' cross products, so that the quad may be a parallelogram.
    const Vec3 d = vecSub(vecMad(origin, direction, before ? t : 0.0f), light.centre);
    const Vec3 n = vecCross(light.halfU, light.halfV);
    const float scale = before ? 1.0f / vecDot(n, n) : 0.0f;
    m.a = vecDot(vecCross(d, light.halfV), n) * scale;
    m.b = vecDot(vecCross(light.halfU, d), n) * scale;
    m.t = before && fabs(m.a) <= 1.0f && fabs(m.b) <= 1.0f ? t : INFINITY;
    return m;
}

/// How far along its direction a ray has met a light that lies in a surface: before that surface on the sides that
/// emit, behind it on the other. Elsewhere where it meets the quad.
WEDGE_INLINE float meetingEnd(AreaLight light, LightMeeting m)
{
    const float off = light.lift / fmax(fabs(m.facing), 1e-12f) + WEDGE_MEETING_ROUNDING * m.t;
    const float within = light.lift > 0.0f ? fmin(off, 0.5f * m.t) : 0.0f;
    return m.t < INFINITY ? m.t + (m.facing < 0.0f || light.twoSided != 0u ? -within : within) : m.t;
}

/// Whether a path's ray from `origin` meets a light before what it hits at a distance. As for shadow rays, what lies
/// just before the light is its housing.
WEDGE_INLINE bool isMetBefore(AreaLight light, LightMeeting m, Vec3 origin, float hit)
{
    const bool before = m.t * WEDGE_SHADOW_RAY_END < hit || meetingEnd(light, m) < hit;
    return m.t < INFINITY && before && !isInLight(light, origin);
}

/// The light's profile where a ray met it, 0 on the side that does not emit.
WEDGE_INLINE float metProfile(AreaLight light, LightMeeting m)
{
    const bool emits = m.facing < 0.0f || light.twoSided != 0u;
    return emits ? lightProfile(m.a, m.b, light.profile, light.cut) : 0.0f;
}

/// Weight of a sample of density p where another technique has density q (power heuristic, Veach 1997).
WEDGE_INLINE float powerHeuristic(float p, float q)
{
    // By the ratio, so that no square overflows.
    const float ratio = q / fmax(p, 1e-30f);
    return 1.0f / (1.0f + ratio * ratio);
}

#endif
