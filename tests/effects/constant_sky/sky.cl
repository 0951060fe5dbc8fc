// Direct light of what is beyond the scene: directions of a receiver's hemisphere, all alike, and directions that its
// surface reflects, combined by the power heuristic.
//
// in      frame, BVH, receivers; sampling: WEDGE_LIGHTS_*; samples of each technique a receiver; sampleOf: of a wave
// in out  lit (3 planes, radiance), rays
#include "light/light_packet.h"
#include "light/scene_light.h"
#include "trace/environment.h"
#include "trace/packet.h"

#define SKY_SEED 0x736b7921u

/// What a receiver reflects, and how its directions are chosen.
typedef struct {
    Receiver at;
    Vec3 geometric;
    Vec3 diffuse, specular;
    float diffuseShare; ///< probability of the diffuse part's directions
} Reflecting;

WEDGE_FN Vec3 hemisphereDirection(Vec3 n, Vec2 u)
{
    Vec3 s, t;
    tangentFrame(n, &s, &t);
    const float sine = sqrt(fmax(0.0f, 1.0f - u.x * u.x)), phi = 6.28318531f * u.y;
    return vecMad(vecMad(vecScale(n, u.x), s, sine * cos(phi)), t, sine * sin(phi));
}

WEDGE_FN Vec3 reflectedDirection(const Reflecting* r, float choice, Vec2 u)
{
    return choice < r->diffuseShare ? cosineDirection(r->at.normal, u)
                                    : sampleLobe(r->at.lobe, r->at.normal, r->at.view, u);
}

/// Radiance reflected from direction l over the density of the one technique, weighted by both; 0 below a horizon.
WEDGE_FN Vec3 weighed(const Reflecting* r, uint sampling, bool reflected, Vec3 l)
{
    const float cosine = vecDot(r->at.normal, l);
    if (!(cosine > 0.0f) || !(vecDot(r->geometric, l) > 0.0f)) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    Vec3 value = vecScale(r->diffuse, WEDGE_INV_PI);
    const float even = 0.5f * WEDGE_INV_PI;
    float pdf = r->diffuseShare * cosine * WEDGE_INV_PI;
    if (r->diffuseShare < 1.0f) {
        const LobeAt at = lobeAt(r->at.lobe, r->at.normal, r->at.view, l);
        value = vecMad(value, r->specular, at.value);
        pdf += (1.0f - r->diffuseShare) * at.pdf;
    }
    const float own = reflected ? pdf : even, other = reflected ? even : pdf;
    const float weight = sampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(own, other) : 1.0f;
    return own > 0.0f ? vecScale(vecMul(value, environmentRadiance(l)), weight * cosine / own) : vec3(0.0f, 0.0f, 0.0f);
}

WEDGE_FN void addTo(__global float* planes, uint size, uint i, Vec3 radiance)
{
    storeVec(planes, size, i, vecAdd(loadVec(planes, size, i), radiance));
}

#include "pass/skyLight.h"
#ifdef PASS_skyLight
__kernel void skyLight(PARAMETERS)
{
    const uint size = frame.planeSize;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    ReceiverPacket receivers;
    loadReceivers(frame, SKY_SEED, firstGroup, data, &receivers);
    Reflecting at[WEDGE_PACKET_SIZE];
    Vec3 sum[WEDGE_PACKET_SIZE];
    uint traced[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        sum[lane] = vec3(0.0f, 0.0f, 0.0f);
        traced[lane] = 0u;
        if (i != WEDGE_NO_PIXEL) {
            at[lane].at = loadReceiver(frame, data, i);
            at[lane].geometric = unpackDirection(geometric[i]);
            at[lane].diffuse = loadVec(diffuse, size, i);
            at[lane].specular = loadVec(specular, size, i);
            const float d = luminance(at[lane].diffuse), s = luminance(at[lane].specular);
            at[lane].diffuseShare = s > 0.0f ? d / (d + s) : 1.0f;
        }
    }
    for (uint step = 0u; step < 2u * samples; ++step) {
        const bool reflected = step % 2u != 0u;
        if (sampling == (reflected ? WEDGE_LIGHTS_SAMPLED : WEDGE_LIGHTS_MET)) {
            continue;
        }
        RayPacket packet;
        Vec3 arrives[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const uint i = receivers.pixel[lane];
            Vec3 l = vec3(0.0f, 0.0f, 1.0f);
            arrives[lane] = vec3(0.0f, 0.0f, 0.0f);
            if (i != WEDGE_NO_PIXEL) {
                const uint index = step / 2u + LOAD_sampleOf(size, i);
                const uint seed = hashCombine(receivers.seed[lane], reflected ? 1u : 0u);
                const Vec2 u = sobolOwen(index, seed);
                const float choice = sobolOwen(index, hashCombine(seed, 2u)).x;
                l = reflected ? reflectedDirection(&at[lane], choice, u) : hemisphereDirection(at[lane].at.normal, u);
                arrives[lane] = weighed(&at[lane], sampling, reflected, l);
            }
            const bool wanted = luminance(arrives[lane]) > 0.0f;
            setRay(&packet, lane, vec3(receivers.originX[lane], receivers.originY[lane], receivers.originZ[lane]), l,
                0.0f, wanted ? INFINITY : 0.0f);
            setTime(&packet, lane, receiverTime(&receivers, lane));
            traced[lane] += wanted ? 1u : 0u;
        }
        uint occluded[WEDGE_PACKET_SIZE];
        anyHits(nodes, blocks, &packet, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            sum[lane] = occluded[lane] == 0u ? vecAdd(sum[lane], arrives[lane]) : sum[lane];
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i == WEDGE_NO_PIXEL) {
            continue;
        }
        const Vec3 radiance = vecScale(sum[lane], 1.0f / (float)samples);
        addTo(lit, size, i, radiance);
        rays[i] += traced[lane];
    }
}
#endif
