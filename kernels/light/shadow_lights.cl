// Direct light from beyond the scene by directional lights that stand for its map: what they bring with shadows and
// without. Both are kept without reflectances, so that textures are none of their business.
#include "light/lit_lanes.h"
#include "shared/shadow_lights.h"
#include "trace/packet.h"

/// The receivers that have not taken the lights up to lastSample, and where the first of them goes on; those that have
/// lose their pixel.
WEDGE_FN uint openReceivers(ReceiverPacket* r, __global const uint* taken, uint lastSample)
{
    uint next = lastSample;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = r->pixel[lane];
        const uint done = i != WEDGE_NO_PIXEL ? taken[i] : lastSample;
        const bool open = done < lastSample;
        next = min(next, done); // all that are open have taken as many
        r->pixel[lane] = open ? i : WEDGE_NO_PIXEL;
        r->normalX[lane] = open ? r->normalX[lane] : 0.0f;
        r->normalY[lane] = open ? r->normalY[lane] : 0.0f;
        r->normalZ[lane] = open ? r->normalZ[lane] : 0.0f;
    }
    return next;
}

/// Counts rays, and what they were traced to.
WEDGE_FN void finishReceivers(
    const ReceiverPacket* r, const uint* traced, uint lights, __global uint* rays, __global uint* taken)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = r->pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            rays[i] += traced[lane];
            taken[i] = lights;
        }
    }
}

/// Whether a light reaches each lane. Those that face away from it trace no ray.
WEDGE_FN void traceLight(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const ReceiverPacket* r, Vec3 towards, float* cosine, uint* traced, uint* occluded)
{
    RayPacket packet;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        cosine[lane] = vecDot(laneNormal(r, lane), towards);
        setRay(&packet, lane, vec3(r->originX[lane], r->originY[lane], r->originZ[lane]), towards, 0.0f,
            cosine[lane] > 0.0f ? INFINITY : 0.0f);
        setTime(&packet, lane, receiverTime(r, lane));
        traced[lane] += cosine[lane] > 0.0f ? 1u : 0u;
    }
    anyHits(nodes, blocks, &packet, occluded);
}

/// Lights from the first that a pixel has not taken to the one before lastSample.
///
/// in      frame, BVH, receivers; lights: WEDGE_SHADOW_LIGHT_FLOATS each; widest: the exponent of the
///         Phong lobe that wider lobes are at least as wide as, or 0: there are none
/// in out  taken: lights, as many in all pixels that have not taken lastSample; mattSums (6 planes: shadowed,
///         unshadowed), over the diffuse reflectance; lobeSums (6, and 6 more of wider lobes), over the specular one;
///         rays
#include "pass/shadowLights.h"
#ifdef PASS_shadowLights
__kernel void shadowLights(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    const uint next = openReceivers(&receivers, taken, lastSample);
    uint traced[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        traced[lane] = 0u;
    }
    LitLanes matt;
    loadLit(mattSums, frame.planeSize, 0u, receivers.pixel, &matt);
#ifdef WEDGE_SPECULAR
    LobeSums lobes;
    beginLobes(&receivers, widest, &lobes);
    loadLobes(lobeSums, frame.planeSize, receivers.pixel, &lobes);
#endif
    for (uint k = next; k < lastSample; ++k) {
        const ShadowLight light = shadowLight(lights, k);
        if (!(fmax(light.irradiance.x, fmax(light.irradiance.y, light.irradiance.z)) > 0.0f)) {
            continue; // of a black part of the map
        }
        float cosine[WEDGE_PACKET_SIZE], weight[WEDGE_PACKET_SIZE];
        uint occluded[WEDGE_PACKET_SIZE];
        traceLight(nodes, blocks, &receivers, light.towards, cosine, traced, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            weight[lane] = WEDGE_INV_PI * fmax(cosine[lane], 0.0f);
        }
        addLight(light.irradiance, weight, occluded, &matt);
#ifdef WEDGE_SPECULAR
        addToLobes(&receivers, light, cosine, occluded, &lobes, weight);
#endif
    }
    storeLit(mattSums, frame.planeSize, 0u, receivers.pixel, &matt);
#ifdef WEDGE_SPECULAR
    storeLobes(lobeSums, frame.planeSize, receivers.pixel, &lobes);
#else
    (void)widest;
#endif
    finishReceivers(&receivers, traced, lastSample, rays, taken);
}
#endif

/// The lights that bring most to each lane, the most first.
typedef struct {
    float gain[WEDGE_MOST_CHOSEN][WEDGE_PACKET_SIZE]; ///< 0: there are no more
    uint light[WEDGE_MOST_CHOSEN][WEDGE_PACKET_SIZE];
} ChosenLanes;

WEDGE_FN void clearChosen(uint most, ChosenLanes* chosen)
{
    for (uint k = 0u; k < most; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            chosen->gain[k][lane] = 0.0f;
            chosen->light[k][lane] = 0u;
        }
    }
}

/// Of `most` lights a lane those that bring more than others, and of equal ones the first. gain: of this light
WEDGE_FN void chooseLight(uint most, const float* gain, uint light, ChosenLanes* chosen)
{
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        any |= gain[lane] > chosen->gain[most - 1u][lane] ? 1u : 0u;
    }
    if (any == 0u) {
        return;
    }
    float next[WEDGE_PACKET_SIZE];
    uint number[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        next[lane] = gain[lane];
        number[lane] = light;
    }
    for (uint k = 0u; k < most; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float held = chosen->gain[k][lane], given = next[lane];
            const uint heldLight = chosen->light[k][lane], givenLight = number[lane];
            const bool more = given > held;
            chosen->gain[k][lane] = more ? given : held;
            chosen->light[k][lane] = more ? givenLight : heldLight;
            next[lane] = more ? held : given;
            number[lane] = more ? heldLight : givenLight;
        }
    }
}

/// Rays to each lane's own light; those without one trace none.
WEDGE_FN void traceChosen(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const ReceiverPacket* r, __global const float* lights, const float* gain, const uint* number, uint* traced,
    uint* occluded)
{
    RayPacket packet;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool any = gain[lane] > 0.0f;
        const Vec3 towards = shadowLight(lights, any ? number[lane] : 0u).towards;
        setRay(&packet, lane, vec3(r->originX[lane], r->originY[lane], r->originZ[lane]), towards, 0.0f,
            any ? INFINITY : 0.0f);
        setTime(&packet, lane, receiverTime(r, lane));
        traced[lane] += any ? 1u : 0u;
    }
    anyHits(nodes, blocks, &packet, occluded);
}

/// Adds a light to a lane. weight: of what reaches it
WEDGE_INLINE void addToLane(Vec3 irradiance, float weight, bool hidden, uint lane, LitLanes* lit)
{
    const Vec3 all = vecScale(irradiance, weight);
    lit->unshadowed[0][lane] += all.x;
    lit->unshadowed[1][lane] += all.y;
    lit->unshadowed[2][lane] += all.z;
    lit->shadowed[0][lane] += hidden ? 0.0f : all.x;
    lit->shadowed[1][lane] += hidden ? 0.0f : all.y;
    lit->shadowed[2][lane] += hidden ? 0.0f : all.z;
}

/// Parts of all light of which this many make it: their share says of the rest as much as if they were all.
#define WEDGE_PARTS_KNOWN 2.0f

/// Of all light what is left where a part of it is known: the rest is hidden by as much if that part is half of all or
/// more, and the less of it the smaller the part is. Few of many lights know little of the others.
WEDGE_FN void shadowAsPart(const LitLanes* part, LitLanes* all)
{
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float of = part->unshadowed[channel][lane], left = part->shadowed[channel][lane];
            const float whole = all->unshadowed[channel][lane];
            const float hidden = of > 0.0f ? (of - left) / of : 0.0f,
                        known = of < whole ? fmin(WEDGE_PARTS_KNOWN * of / whole, 1.0f) : 1.0f;
            const float some = left + (1.0f - known * hidden) * fmax(whole - of, 0.0f);
            all->shadowed[channel][lane] = left < of ? fmin(some, whole) : whole;
        }
    }
}

#ifdef WEDGE_SPECULAR
WEDGE_INLINE void addToLaneOfLobes(
    const ReceiverPacket* r, ShadowLight light, float cosine, bool hidden, uint lane, LobeSums* lobes)
{
    if (cosine > 0.0f) {
        const float own = lobeOfLane(r, &lobes->ownLobes, light.towards, lane);
        addToLane(light.irradiance, cosine * own, hidden, lane, &lobes->own);
        if (lobes->widest > 0.0f) {
            const float wide = lobeOfLane(r, &lobes->wideLobes, light.towards, lane);
            addToLane(light.irradiance, cosine * wide, hidden, lane, &lobes->wide);
        }
    }
}
#endif

/// Least luminance of a reflectance where lights are ranked: black texels choose, too, as their neighbours may go by
/// what they see.
#define WEDGE_LEAST_RANKED 1e-3f

/// By how much a receiver reflects light of each kind: luminances of a plane; 0 in lanes without a pixel.
WEDGE_FN void loadLuminances(__global const float* reflectance, uint size, const uint* pixel, float* out)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool has = pixel[lane] != WEDGE_NO_PIXEL;
        out[lane] = has ? fmax(luminance(loadVec(reflectance, size, pixel[lane])), WEDGE_LEAST_RANKED) : 0.0f;
    }
}

/// All lights, of which each pixel traces rays to the `most` that bring it most, see shadowAsPart().
///
/// in      as of shadowLights; count: of lights; most: 1 to WEDGE_MOST_CHOSEN; diffuse, specular: 3 planes of
///         reflectances each
/// in out  taken: count, where it was less; mattSums, lobeSums: written there, as of shadowLights; rays
#include "pass/chosenLights.h"
#ifdef PASS_chosenLights
__kernel void chosenLights(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    openReceivers(&receivers, taken, count);
    const uint size = frame.planeSize;
    ChosenLanes chosen;
    clearChosen(most, &chosen);
    float ofDiffuse[WEDGE_PACKET_SIZE];
    loadLuminances(diffuse, size, receivers.pixel, ofDiffuse);
    LitLanes matt, part;
    clearLit(&matt);
    clearLit(&part);
#ifdef WEDGE_SPECULAR
    float ofSpecular[WEDGE_PACKET_SIZE];
    loadLuminances(specular, size, receivers.pixel, ofSpecular);
    LobeSums lobes, lobesPart;
    beginLobes(&receivers, widest, &lobes);
    lobesPart = lobes;
#endif
    uint occluded[WEDGE_PACKET_SIZE], traced[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        occluded[lane] = traced[lane] = 0u;
    }
    for (uint k = 0u; k < count; ++k) {
        const ShadowLight light = shadowLight(lights, k);
        const float bright = luminance(light.irradiance);
        float cosine[WEDGE_PACKET_SIZE], weight[WEDGE_PACKET_SIZE], gain[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            cosine[lane] = vecDot(laneNormal(&receivers, lane), light.towards);
            weight[lane] = WEDGE_INV_PI * fmax(cosine[lane], 0.0f);
            gain[lane] = bright * ofDiffuse[lane] * weight[lane];
        }
        addLight(light.irradiance, weight, occluded, &matt);
#ifdef WEDGE_SPECULAR
        addToLobes(&receivers, light, cosine, occluded, &lobes, weight);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            gain[lane] += bright * ofSpecular[lane] * weight[lane];
        }
#endif
        chooseLight(most, gain, k, &chosen);
    }
    for (uint k = 0u; k < most; ++k) {
        traceChosen(nodes, blocks, &receivers, lights, chosen.gain[k], chosen.light[k], traced, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool any = chosen.gain[k][lane] > 0.0f, hidden = occluded[lane] != 0u;
            const ShadowLight light = shadowLight(lights, any ? chosen.light[k][lane] : 0u);
            const float cosine = any ? vecDot(laneNormal(&receivers, lane), light.towards) : 0.0f;
            addToLane(light.irradiance, WEDGE_INV_PI * cosine, hidden, lane, &part);
#ifdef WEDGE_SPECULAR
            addToLaneOfLobes(&receivers, light, cosine, hidden, lane, &lobesPart);
#endif
        }
    }
    shadowAsPart(&part, &matt);
#ifdef WEDGE_SPECULAR
    shadowAsPart(&lobesPart.own, &lobes.own);
    shadowAsPart(&lobesPart.wide, &lobes.wide);
#endif
    storeLit(mattSums, size, 0u, receivers.pixel, &matt);
#ifdef WEDGE_SPECULAR
    storeLobes(lobeSums, size, receivers.pixel, &lobes);
#else
    (void)widest;
    (void)specular;
#endif
    finishReceivers(&receivers, traced, count, rays, taken);
}
#endif
