// The other technique of direct light: reflected directions of a packet's pixels that happen to meet the light. Where a
// lobe is sharp or the light near, they find it better than points on it do. Both are seen from the point that is
// shaded: where shadow rays start is lifted off it, which a light that is near does look different from.
#ifndef WEDGE_MET_LIGHT_H
#define WEDGE_MET_LIGHT_H

#include "core/vec_lanes.h"
#include "light/light_packet.h"
#include "light/light_sampling.h"
#include "light/scene_light.h"

/// Seeds of the directions, apart from that of the light's points.
#define WEDGE_DIFFUSE_DIRECTION_SEED 0x64696666u
#define WEDGE_SPECULAR_DIRECTION_SEED 0x73706563u

/// What the samples at local coordinates (a, b) of the light's part that a lane samples weigh.
WEDGE_INLINE float laneMass(AreaLight light, const ReceiverPacket* r, uint lane, float a, float b)
{
    const float mass = r->anyCut ? partMass(light, lanePart(r, lane), a, b) : 1.0f;
    return r->cut[lane] != 0u ? mass : 1.0f;
}

/// Density in 1/sr of a lane's point on the light, in direction l.
WEDGE_INLINE float pointPdf(AreaLight light, const ReceiverPacket* r, const LightSamples* s, uint lane, Vec3 l)
{
    const LightMeeting m = meetLight(light, lanePosition(r, lane), l);
    const float a = clamp(m.a, -1.0f, 1.0f), b = clamp(m.b, -1.0f, 1.0f);
    const float distance = vecLength(sampleVector(r, s, lane));
    return lightPdf(light, a, b, distance, vecDot(l, light.normal)) / laneMass(light, r, lane, a, b);
}

/// Where reflected directions are followed besides points on the light: where they may be as dense as those. Decided
/// by the receiver alone, so that each sample's expectation is the same with them and without.
typedef struct {
    uint lane[WEDGE_VALUES][WEDGE_PACKET_SIZE]; ///< 1: a lane's diffuse, its specular part is sampled by both
    bool any[WEDGE_VALUES]; ///< of the lanes
} Directions;

/// What a light could bring at most, over a diffuse reflection's largest, from which on its diffuse part is sampled by
/// directions, too. Below it points on the light, which follow its profile, do as well alone.
#define WEDGE_DIFFUSE_DIRECTED 1.0f
/// Squared angular half extent of the light over the squared width of a lobe from which on both are sampled: points on
/// the light find too little of it, in plain Monte Carlo and in ratios (lobesAcross16() in unshadowed.h).
#define WEDGE_LOBE_DIRECTED 4.0f

/// The light as if all of it shone from its nearest point, overhead and face on, over what the whole hemisphere could
/// bring: profileArea / (pi r^2). It is also the most that the density of cosine-distributed directions can be over
/// that of points on a uniform light.
WEDGE_INLINE float diffuseShare(AreaLight light, Vec3 position)
{
    const float u = vecDot(light.halfU, light.halfU), v = vecDot(light.halfV, light.halfV);
    const float corner = sqrt(u + v + 2.0f * fabs(vecDot(light.halfU, light.halfV)));
    const float nearest = fmax(vecLength(vecSub(light.centre, position)) - corner, 0.0f);
    return WEDGE_INV_PI * light.profileArea / fmax(nearest * nearest, 1e-30f);
}

WEDGE_FN void chooseDirections(SampleParams params, AreaLight light, const ReceiverPacket* r, Directions* out)
{
    const bool plain = params.shading == WEDGE_SHADING_INSIDE && params.lightSampling != WEDGE_LIGHTS_SAMPLED;
    const bool all = plain && params.lightSampling == WEDGE_LIGHTS_MET;
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool near = diffuseShare(light, lanePosition(r, lane)) > WEDGE_DIFFUSE_DIRECTED;
        const bool chosen = plain && (all || near) && r->pixel[lane] != WEDGE_NO_PIXEL;
        out->lane[0][lane] = chosen ? 1u : 0u;
        any |= out->lane[0][lane];
    }
    out->any[0] = any != 0u;
#ifdef WEDGE_SPECULAR
    const float extent = fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV));
    any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 d = vecSub(light.centre, lanePosition(r, lane));
        const float squared = fmax(vecDot(d, d), 1e-30f);
        const float widening = fmax(2.0f + 2.0f * vecDot(laneView(r, lane), d) * rsqrt(squared), 1e-6f);
        const float across = extent * r->exponent[lane] / squared;
        const bool phong = r->kind[lane] == WEDGE_PHONG;
        const bool narrow = (phong ? across : across / widening) > WEDGE_LOBE_DIRECTED;
        const bool lobe = r->pixel[lane] != WEDGE_NO_PIXEL && r->kind[lane] != WEDGE_LAMBERT;
        const bool chosen = all || (narrow && (plain || params.shading == WEDGE_SHADING_RATIO));
        out->lane[1][lane] = chosen && lobe ? 1u : 0u;
        any |= out->lane[1][lane];
    }
    out->any[1] = any != 0u;
#endif
}

/// Weights of the lanes' points on the light against reflected directions, multiplied into s.
WEDGE_FN void weighPoints(
    SampleParams params, AreaLight light, const ReceiverPacket* r, const Directions* directions, LightSamples* s)
{
    light.pick = 1.0f;
    const float used = params.lightSampling == WEDGE_LIGHTS_MET ? 0.0f : 1.0f;
    if (directions->any[0]) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec3 l = vecNormalize(sampleVector(r, s, lane));
            const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
            const float p = pointPdf(light, r, s, lane, l);
            const float weight = used * powerHeuristic(p, fmax(0.0f, vecDot(n, l)) * WEDGE_INV_PI);
            s->diffuse[lane] *= directions->lane[0][lane] != 0u && s->diffuse[lane] > 0.0f ? weight : 1.0f;
        }
    }
#ifdef WEDGE_SPECULAR
    if (directions->any[1]) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec3 l = vecNormalize(sampleVector(r, s, lane));
            const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
            const float p = pointPdf(light, r, s, lane, l);
            const float weight = used * powerHeuristic(p, lobePdf(laneLobe(r, lane), n, laneView(r, lane), l));
            s->specular[lane] *= directions->lane[1][lane] != 0u && s->specular[lane] > 0.0f ? weight : 1.0f;
        }
    }
#endif
}

/// A reflected direction of a lane.
typedef struct {
    Vec3 direction; ///< unit
    float pdf; ///< 1/sr
    float reflected; ///< over that density, without the diffuse part's 1 / pi, which the light's points leave out too
} Reflection;

WEDGE_INLINE Reflection diffuseReflection(const ReceiverPacket* r, uint lane, Vec2 u)
{
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    Reflection out;
    out.direction = cosineDirection(n, u);
    out.pdf = fmax(0.0f, vecDot(n, out.direction)) * WEDGE_INV_PI;
    out.reflected = 1.0f / WEDGE_INV_PI;
    return out;
}

#ifdef WEDGE_SPECULAR
WEDGE_INLINE Reflection specularReflection(const ReceiverPacket* r, uint lane, Vec2 u)
{
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const Lobe lobe = laneLobe(r, lane);
    Reflection out;
    out.direction = sampleLobe(lobe, n, laneView(r, lane), u);
    const LobeAt at = lobeAt(lobe, n, laneView(r, lane), out.direction);
    out.pdf = at.pdf;
    out.reflected = at.value * vecDot(n, out.direction) / fmax(at.pdf, 1e-30f);
    return out;
}
#endif

/// Reflected directions of all lanes for the numbers (u, v), number by number.
typedef struct {
    VecLanes direction;
    float pdf[WEDGE_PACKET_SIZE], reflected[WEDGE_PACKET_SIZE];
} Reflections;

WEDGE_INLINE void keepReflection(Reflections* out, uint lane, Reflection r)
{
    setLaneVec(&out->direction, lane, r.direction);
    out->pdf[lane] = r.pdf;
    out->reflected[lane] = r.reflected;
}

WEDGE_FN void reflect(const ReceiverPacket* r, bool specular, const float* u, const float* v, Reflections* out)
{
#ifdef WEDGE_SPECULAR
    if (specular) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            keepReflection(out, lane, specularReflection(r, lane, vec2(u[lane], v[lane])));
        }
        return;
    }
#else
    (void)specular;
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        keepReflection(out, lane, diffuseReflection(r, lane, vec2(u[lane], v[lane])));
    }
}

/// One reflected direction of each lane that follows them: the ray to where it meets the light into `packet`, and in
/// weight what it counts in its term if nothing is in the way; 0 where it meets nothing.
WEDGE_FN void meetDirections(SampleParams params, AreaLight light, const ReceiverPacket* r, bool specular,
    const uint* follow, const uint* index, const uint* last, const uint* count, RayPacket* packet, float* weight)
{
    light.pick = 1.0f;
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    uint seed[WEDGE_PACKET_SIZE];
    const uint kind = specular ? WEDGE_SPECULAR_DIRECTION_SEED : WEDGE_DIFFUSE_DIRECTION_SEED;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        seed[lane] = hashCombine(r->seed[lane], kind);
    }
    samplePositions(params, kind, seed, index, count, u, v);
    Reflections reflections;
    reflect(r, specular, u, v, &reflections);
    float x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE], z[WEDGE_PACKET_SIZE], end[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 l = laneVec(&reflections.direction, lane);
        const float pdf = reflections.pdf[lane];
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const LightMeeting m = meetLight(light, lanePosition(r, lane), l);
        const bool wanted = follow[lane] != 0u && index[lane] < last[lane];
        const bool meets =
            wanted && m.t < INFINITY && vecDot(n, l) > 0.0f && pdf > 0.0f && !isInLight(light, lanePosition(r, lane));
        const float w = params.lightSampling == WEDGE_LIGHTS_MET
            ? 1.0f
            : powerHeuristic(pdf, lightPdf(light, m.a, m.b, m.t, m.facing) / laneMass(light, r, lane, m.a, m.b));
        weight[lane] = meets ? w * reflections.reflected[lane] * metProfile(light, m) / light.profileArea : 0.0f;
        end[lane] = weight[lane] > 0.0f ? shadowRayEnd(light) : 0.0f;
        const Vec3 ray = liftedRay(light, vecSub(vecScale(l, meets ? m.t : 1.0f), laneLift(r, lane)));
        x[lane] = ray.x;
        y[lane] = ray.y;
        z[lane] = ray.z;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        // Lanes without a receiver have no samples to take either: see the callers.
        setRay(packet, lane, vec3(r->originX[lane], r->originY[lane], r->originZ[lane]),
            vec3(x[lane], y[lane], z[lane]), 0.0f, end[lane]);
        setTime(packet, lane, receiverTime(r, lane));
    }
}

#endif
