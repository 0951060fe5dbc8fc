// The other technique of direct light: reflected directions of a packet's pixels that happen to meet the light. Where a lobe
// is sharp or the light near, they find it better than points on it do.
#ifndef WEDGE_MET_LIGHT_H
#define WEDGE_MET_LIGHT_H

#include "light_packet.h"
#include "scene_light.h"

/// Seeds of the directions, apart from that of the light's points.
#define WEDGE_DIFFUSE_DIRECTION_SEED 0x64696666u
#define WEDGE_SPECULAR_DIRECTION_SEED 0x73706563u

/// Density in 1/sr of reflected directions of the diffuse or the specular part.
WEDGE_FN float directionPdf(const ReceiverPacket* r, uint lane, bool specular, Vec3 l)
{
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
#ifdef WEDGE_SPECULAR
    if (specular) {
        return lobePdf(r->lobe[lane], n, r->view[lane], l);
    }
#else
    (void)specular;
#endif
    return fmax(0.0f, vecDot(n, l)) * WEDGE_INV_PI;
}

/// Weights of the lanes' points on the light against reflected directions, multiplied into s.
WEDGE_FN void weighPoints(SampleParams params, AreaLight light, const ReceiverPacket* r, LightSamples* s)
{
    light.pick = 1.0f;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!(s->diffuse[lane] > 0.0f)) {
            continue;
        }
        if (params.lightSampling == WEDGE_LIGHTS_MET) {
            s->diffuse[lane] = s->specular[lane] = 0.0f;
            continue;
        }
        const Vec3 ray = vec3(s->rayX[lane], s->rayY[lane], s->rayZ[lane]);
        const Vec3 l = vecNormalize(ray);
        const Vec3 origin = vec3(r->originX[lane], r->originY[lane], r->originZ[lane]);
        const LightMeeting m = meetLight(light, origin, l);
        const float p = lightPdf(light, clamp(m.a, -1.0f, 1.0f), clamp(m.b, -1.0f, 1.0f), vecLength(ray), vecDot(l, light.normal));
        s->diffuse[lane] *= powerHeuristic(p, directionPdf(r, lane, false, l));
        s->specular[lane] *= s->specular[lane] > 0.0f ? powerHeuristic(p, directionPdf(r, lane, true, l)) : 1.0f;
    }
}

/// One reflected direction a lane: the ray to where it meets the light into `packet`, and in weight what it counts in its
/// term if nothing is in the way; 0 where it meets nothing.
WEDGE_FN void meetDirections(SampleParams params, AreaLight light, const ReceiverPacket* r, bool specular, const uint* index,
                             const uint* last, const uint* count, RayPacket* packet, float* weight)
{
    light.pick = 1.0f;
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    uint seed[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        seed[lane] = hashCombine(r->seed[lane], specular ? WEDGE_SPECULAR_DIRECTION_SEED : WEDGE_DIFFUSE_DIRECTION_SEED);
    }
    samplePositions(params, specular ? WEDGE_SPECULAR_DIRECTION_SEED : WEDGE_DIFFUSE_DIRECTION_SEED, seed, index, count, u, v);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const Vec3 origin = vec3(r->originX[lane], r->originY[lane], r->originZ[lane]);
        Vec3 l = cosineDirection(n, vec2(u[lane], v[lane]));
        float value = WEDGE_INV_PI; // only a lobe's is used
#ifdef WEDGE_SPECULAR
        if (specular) {
            l = sampleLobe(r->lobe[lane], n, r->view[lane], vec2(u[lane], v[lane]));
            value = lobeValue(r->lobe[lane], n, r->view[lane], l);
        }
#endif
        const LightMeeting m = meetLight(light, origin, l);
        const float cosine = vecDot(n, l);
        const float pdf = directionPdf(r, lane, specular, l);
        weight[lane] = 0.0f;
        if (r->pixel[lane] != WEDGE_NO_PIXEL && index[lane] < last[lane] && m.t < INFINITY && cosine > 0.0f && pdf > 0.0f) {
            const float w = params.lightSampling == WEDGE_LIGHTS_MET
                ? 1.0f
                : powerHeuristic(pdf, lightPdf(light, m.a, m.b, m.t, m.facing));
            // The diffuse term leaves out 1 / pi, as the light's points do.
            const float reflected = specular ? value * cosine / pdf : 1.0f / WEDGE_INV_PI;
            weight[lane] = w * reflected * metProfile(light, m) / light.profileArea;
        }
        setRay(packet, lane, origin, l, 0.0f, weight[lane] > 0.0f ? m.t * WEDGE_SHADOW_RAY_END : 0.0f);
        setTime(packet, lane, receiverTime(r, lane));
    }
}

#endif
