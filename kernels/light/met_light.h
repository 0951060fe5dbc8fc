// The other technique of direct light: reflected directions of a packet's pixels that happen to meet the light. Where a
// lobe is sharp or the light near, they find it better than points on it do. Both are seen from the point that is
// shaded: where shadow rays start is lifted off it, which a light that is near does look different from.
#ifndef WEDGE_MET_LIGHT_H
#define WEDGE_MET_LIGHT_H

#include "light/light_packet.h"
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

/// Weights of the lanes' points on the light against reflected directions, multiplied into s.
WEDGE_FN void weighPoints(SampleParams params, AreaLight light, const ReceiverPacket* r, LightSamples* s)
{
    light.pick = 1.0f;
    const float used = params.lightSampling == WEDGE_LIGHTS_MET ? 0.0f : 1.0f;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 l = vecNormalize(sampleVector(r, s, lane));
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const float p = pointPdf(light, r, s, lane, l);
        const float diffuse = used * powerHeuristic(p, fmax(0.0f, vecDot(n, l)) * WEDGE_INV_PI);
        s->diffuse[lane] *= s->diffuse[lane] > 0.0f ? diffuse : 1.0f;
#ifdef WEDGE_SPECULAR
        const float specular = used * powerHeuristic(p, lobePdf(laneLobe(r, lane), n, laneView(r, lane), l));
        s->specular[lane] *= s->specular[lane] > 0.0f ? specular : 1.0f;
#endif
    }
}

#ifdef WEDGE_SPECULAR
/// Squared angular half extent of the light over the squared width of a lobe, from which on points on the light find
/// too little of it (lobesAcross16() in unshadowed.h).
#define WEDGE_LOBE_SAMPLED 4.0f

/// 1 for lanes whose lobe is so much narrower than the light that their specular term is sampled by directions, too.
/// Returns whether there are any.
WEDGE_FN bool narrowLobes(SampleParams params, AreaLight light, const ReceiverPacket* r, uint* narrow)
{
    const float extent = fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV));
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 d = vecSub(light.centre, vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]));
        const float squared = fmax(vecDot(d, d), 1e-30f);
        const float widening = fmax(2.0f + 2.0f * vecDot(laneView(r, lane), d) * rsqrt(squared), 1e-6f);
        const float across = extent * r->exponent[lane] / squared;
        const bool phong = r->kind[lane] == WEDGE_PHONG;
        const bool found = (phong ? across : across / widening) > WEDGE_LOBE_SAMPLED;
        narrow[lane] = found && params.shading == WEDGE_SHADING_RATIO && r->pixel[lane] != WEDGE_NO_PIXEL ? 1u : 0u;
        any |= narrow[lane];
    }
    return any != 0u;
}

/// Weights of the points of lanes with narrow lobes in the specular term alone, multiplied into s.
WEDGE_FN void weighLobePoints(AreaLight light, const ReceiverPacket* r, const uint* narrow, LightSamples* s)
{
    light.pick = 1.0f;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 l = vecNormalize(sampleVector(r, s, lane));
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const float weight =
            powerHeuristic(pointPdf(light, r, s, lane, l), lobePdf(laneLobe(r, lane), n, laneView(r, lane), l));
        s->specular[lane] *= narrow[lane] != 0u && s->specular[lane] > 0.0f ? weight : 1.0f;
    }
}
#endif

/// A reflected direction of the diffuse or the specular part for the numbers u; in *pdf its density, 1/sr, and in
/// *reflected what the part reflects over that density, without the diffuse part's 1 / pi, which the light's points
/// leave out too.
WEDGE_INLINE Vec3 reflectedDirection(
    const ReceiverPacket* r, uint lane, bool specular, Vec2 u, float* pdf, float* reflected)
{
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
#ifdef WEDGE_SPECULAR
    if (specular) {
        const Lobe lobe = laneLobe(r, lane);
        const Vec3 l = sampleLobe(lobe, n, laneView(r, lane), u);
        const LobeAt at = lobeAt(lobe, n, laneView(r, lane), l);
        *pdf = at.pdf;
        *reflected = at.value * vecDot(n, l) / fmax(at.pdf, 1e-30f);
        return l;
    }
#else
    (void)specular;
#endif
    const Vec3 l = cosineDirection(n, u);
    *pdf = fmax(0.0f, vecDot(n, l)) * WEDGE_INV_PI;
    *reflected = 1.0f / WEDGE_INV_PI;
    return l;
}

/// One reflected direction a lane: the ray to where it meets the light into `packet`, and in weight what it counts in
/// its term if nothing is in the way; 0 where it meets nothing.
WEDGE_FN void meetDirections(SampleParams params, AreaLight light, const ReceiverPacket* r, bool specular,
    const uint* index, const uint* last, const uint* count, RayPacket* packet, float* weight)
{
    light.pick = 1.0f;
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    uint seed[WEDGE_PACKET_SIZE];
    const uint kind = specular ? WEDGE_SPECULAR_DIRECTION_SEED : WEDGE_DIFFUSE_DIRECTION_SEED;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        seed[lane] = hashCombine(r->seed[lane], kind);
    }
    samplePositions(params, kind, seed, index, count, u, v);
    float x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE], z[WEDGE_PACKET_SIZE], end[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        float pdf, reflected;
        const Vec3 l = reflectedDirection(r, lane, specular, vec2(u[lane], v[lane]), &pdf, &reflected);
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const LightMeeting m = meetLight(light, lanePosition(r, lane), l);
        const bool meets = m.t < INFINITY && vecDot(n, l) > 0.0f && pdf > 0.0f && index[lane] < last[lane];
        const float w = params.lightSampling == WEDGE_LIGHTS_MET
            ? 1.0f
            : powerHeuristic(pdf, lightPdf(light, m.a, m.b, m.t, m.facing) / laneMass(light, r, lane, m.a, m.b));
        weight[lane] = meets ? w * reflected * metProfile(light, m) / light.profileArea : 0.0f;
        end[lane] = weight[lane] > 0.0f ? WEDGE_SHADOW_RAY_END : 0.0f;
        const Vec3 ray = vecSub(vecScale(l, meets ? m.t : 1.0f), laneLift(r, lane));
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
