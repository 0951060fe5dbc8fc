// Direct light from beyond the scene by directional lights that stand for its map, a shadow ray each: what they bring
// with shadows and without, and what that makes of the map's whole light. Both are kept without reflectances, so that
// textures are none of their business.
#include "light/light_packet.h"
#include "light/light_tree.h"
#include "light/unshadowed_environment.h"
#include "shared/filter_params.h"
#include "shared/shadow_lights.h"
#include "trace/packet.h"

/// What lights bring to each lane: R G B where nothing hides them, and of all.
typedef struct {
    float shadowed[3][WEDGE_PACKET_SIZE], unshadowed[3][WEDGE_PACKET_SIZE];
} LitLanes;

/// Six planes, from `first` on: shadowed R G B, unshadowed R G B. Lanes without a pixel begin with 0.
WEDGE_FN void loadLit(__global const float* planes, uint size, uint first, const uint* pixel, LitLanes* lit)
{
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool has = pixel[lane] != WEDGE_NO_PIXEL;
            lit->shadowed[channel][lane] = has ? planes[(first + channel) * size + pixel[lane]] : 0.0f;
            lit->unshadowed[channel][lane] = has ? planes[(first + channel + 3u) * size + pixel[lane]] : 0.0f;
        }
    }
}

WEDGE_FN void storeLit(__global float* planes, uint size, uint first, const uint* pixel, const LitLanes* lit)
{
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            if (pixel[lane] != WEDGE_NO_PIXEL) {
                planes[(first + channel) * size + pixel[lane]] = lit->shadowed[channel][lane];
                planes[(first + channel + 3u) * size + pixel[lane]] = lit->unshadowed[channel][lane];
            }
        }
    }
}

/// Adds a light. weight: of what reaches each lane, 1/sr; 0 behind it
WEDGE_FN void addLight(Vec3 irradiance, const float* weight, const uint* occluded, LitLanes* lit)
{
    const float colour[3] = { irradiance.x, irradiance.y, irradiance.z };
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float all = colour[channel] * weight[lane];
            lit->unshadowed[channel][lane] += all;
            lit->shadowed[channel][lane] += occluded[lane] != 0u ? 0.0f : all;
        }
    }
}

/// Whether a light reaches each lane. Those that face away from it trace no ray.
WEDGE_FN void traceLight(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const ReceiverPacket* r, Vec3 towards, float* cosine, uint* traced, uint* occluded)
{
    RayPacket packet;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        cosine[lane] = vecDot(vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), towards);
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
/// in out  taken: lights; mattSums (6 planes: shadowed, unshadowed), over the diffuse reflectance; lobeSums (6, and 6
///         more of wider lobes), over the specular one; rays
#include "pass/shadowLights.h"
#ifdef PASS_shadowLights
__kernel void shadowLights(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    uint traced[WEDGE_PACKET_SIZE], next = lastSample;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        traced[lane] = 0u;
        next = i != WEDGE_NO_PIXEL ? min(next, taken[i]) : next; // all have taken as many
    }
    LitLanes matt;
    loadLit(mattSums, frame.planeSize, 0u, receivers.pixel, &matt);
#ifdef WEDGE_SPECULAR
    LitLanes own, wide;
    LobeLanes ownLobes, wideLobes;
    lobesOf(&receivers, 0.0f, &ownLobes);
    loadLit(lobeSums, frame.planeSize, 0u, receivers.pixel, &own);
    if (widest > 0.0f) {
        lobesOf(&receivers, widest, &wideLobes);
        loadLit(lobeSums, frame.planeSize, 6u, receivers.pixel, &wide);
    }
#endif
    for (uint k = next; k < lastSample; ++k) {
        __global const float* light = lights + WEDGE_SHADOW_LIGHT_FLOATS * k;
        const Vec3 towards = vec3(light[0], light[1], light[2]), irradiance = vec3(light[3], light[4], light[5]);
        if (!(fmax(irradiance.x, fmax(irradiance.y, irradiance.z)) > 0.0f)) {
            continue; // of a black part of the map
        }
        float cosine[WEDGE_PACKET_SIZE], weight[WEDGE_PACKET_SIZE];
        uint occluded[WEDGE_PACKET_SIZE];
        traceLight(nodes, blocks, &receivers, towards, cosine, traced, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            weight[lane] = WEDGE_INV_PI * fmax(cosine[lane], 0.0f);
        }
        addLight(irradiance, weight, occluded, &matt);
#ifdef WEDGE_SPECULAR
        lobeWeights(&receivers, &ownLobes, towards, cosine, weight);
        addLight(irradiance, weight, occluded, &own);
        if (widest > 0.0f) {
            lobeWeights(&receivers, &wideLobes, towards, cosine, weight);
            addLight(irradiance, weight, occluded, &wide);
        }
#endif
    }
    storeLit(mattSums, frame.planeSize, 0u, receivers.pixel, &matt);
#ifdef WEDGE_SPECULAR
    storeLit(lobeSums, frame.planeSize, 0u, receivers.pixel, &own);
    if (widest > 0.0f) {
        storeLit(lobeSums, frame.planeSize, 6u, receivers.pixel, &wide);
    }
#else
    (void)widest;
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            rays[i] += traced[lane];
            taken[i] = lastSample;
        }
    }
}
#endif

/// Levels of the map's averages: chosen under two probes, where 512 directions of a lobe show which they are.
#define WEDGE_WHOLE_COARSER 1.5f

/// What lobes reflect of the map if nothing hides it, over their specular reflectance.
/// in      rings: of unshadowedLobe(); specular: 3 planes; the map, receivers
/// in out  whole: 3 planes, set where something is reflected
#include "pass/wholeLobes.h"
#ifdef PASS_wholeLobes
__kernel void wholeLobes(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL && luminance(loadVec(specular, frame.planeSize, i)) > 0.0f) {
            const Vec3 n = vec3(receivers.normalX[lane], receivers.normalY[lane], receivers.normalZ[lane]);
            const Vec3 v = laneView(&receivers, lane);
            storeVec(whole, frame.planeSize, i,
                unshadowedLobe(
                    environment[0], environmentTable, n, v, unpackGloss(gloss[i]), rings, WEDGE_WHOLE_COARSER));
        }
    }
}
#endif

/// What surfaces reflect of all of the map if nothing hides it, over their reflectances.
/// in      tree: `parts` of the map, see light_tree.h; least: see lobeLight(); specular: 3 planes; receivers
/// in out  wholeMatt, whole (of lobes): 3 planes each, set where there is a surface
#include "pass/wholeLight.h"
#ifdef PASS_wholeLight
__kernel void wholeLight(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    uint shaded[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        shaded[lane] = receivers.pixel[lane] != WEDGE_NO_PIXEL ? 1u : 0u;
    }
    MapLanes sum;
    clearLanes(&sum);
    mattLight(tree, parts, &receivers, shaded, &sum);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            storeVec(wholeMatt, frame.planeSize, i, vecScale(lightOf(&sum, lane), WEDGE_INV_PI));
        }
    }
#ifdef WEDGE_SPECULAR
    uint reflects[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        reflects[lane] = i != WEDGE_NO_PIXEL && luminance(loadVec(specular, frame.planeSize, i)) > 0.0f ? 1u : 0u;
    }
    clearLanes(&sum);
    lobeLight(tree, parts, &receivers, reflects, least, &sum);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            storeVec(whole, frame.planeSize, i, lightOf(&sum, lane));
        }
    }
#else
    (void)least;
    (void)specular;
#endif
}
#endif

/// Below it the share of what is hidden is not known of what lights bring: where there are none, nothing is.
#define WEDGE_LEAST_LIT 1e-30f

/// A channel of the map's whole light with the shadows of the lights: less what they lose, or times the share that is
/// left of them; or what they bring alone. unlit: what counts of the whole light where no light is that hides.
WEDGE_INLINE float withShadows(uint shadows, float complete, float shadowed, float unshadowed, float wideShadowed,
    float wideUnshadowed, float unlit)
{
    const float all = unshadowed + wideUnshadowed;
    const bool reached = all > WEDGE_LEAST_LIT;
    const float known = reached ? complete : unlit * complete;
    const float share = reached ? (shadowed + wideShadowed) / all : 1.0f;
    const float less = known - (unshadowed - shadowed);
    const float kept = shadows == WEDGE_SHADOWS_SUBTRACTIVE ? less : known * share;
    return shadows == WEDGE_SHADOWS_ADDITIVE ? shadowed : kept;
}

/// The same of all channels. sums: six planes of own lobes, and behind them, if widened, six of wider ones.
WEDGE_FN Vec3 allWithShadows(
    uint shadows, Vec3 complete, __global const float* sums, uint size, uint i, bool widened, float unlit)
{
    const Vec3 shadowed = loadVec(sums, size, i), unshadowed = loadVec(sums + 3u * size, size, i);
    const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
    const Vec3 a = widened ? loadVec(sums + 6u * size, size, i) : none;
    const Vec3 u = widened ? loadVec(sums + 9u * size, size, i) : none;
    return vec3(withShadows(shadows, complete.x, shadowed.x, unshadowed.x, a.x, u.x, unlit),
        withShadows(shadows, complete.y, shadowed.y, unshadowed.y, a.y, u.y, unlit),
        withShadows(shadows, complete.z, shadowed.z, unshadowed.z, a.z, u.z, unlit));
}

/// v, none of whose channels is below 0 if they are to be clamped; `below` then says whether one was.
WEDGE_INLINE Vec3 clampedLight(Vec3 v, uint clamps, bool* below)
{
    const bool any = clamps != 0u && fmin(v.x, fmin(v.y, v.z)) < 0.0f;
    *below = *below || any;
    const Vec3 least = vec3(fmax(v.x, 0.0f), fmax(v.y, 0.0f), fmax(v.z, 0.0f));
    return vecChoose(any, least, v);
}

/// What surfaces reflect of the map's light.
///
/// in      shadows: WEDGE_SHADOWS_*; complete: WEDGE_COMPLETE_*, the map's whole light: of all lights, of
///         `whole` (3 planes, of lobes) and what harmonics say, or of `wholeMatt` (3 planes) and `whole`;
///         clamps: 1: it is not below 0; wide: 1: lobeSums have wider lobes; mostRed, mostGreen, mostBlue: what
///         unshadowedLight() is a part of, W/m^2; the map, the G-buffer, sums
/// in out  lit (3 planes, radiance)
/// out     clamped: 1 in pixels where something was
#include "pass/combineShadowLights.h"
#ifdef PASS_combineShadowLights
__kernel void combineShadowLights(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    clamped[i] = 0u;
    if (taken[i] == 0u) {
        return;
    }
    const uint size = p.planeSize;
    const Vec3 n = loadVec(normal, size, i);
    bool below = false;
    Vec3 matt = loadVec(mattSums + 3u * size, size, i);
#if HAS_wholeMatt
    matt = vecChoose(complete == WEDGE_COMPLETE_MAP, loadVec(wholeMatt, size, i), matt);
#endif
    if (complete == WEDGE_COMPLETE_PREFILTERED) {
        const Vec3x16 light = unshadowedFrom(environment, environmentTable, splat3(n), 0.0f);
        const Vec3 most = vecScale(vec3(mostRed, mostGreen, mostBlue), WEDGE_INV_PI);
        matt = vecMul(most, vec3(light.x.s0, light.y.s0, light.z.s0));
    }
    // Harmonics bring light from where there is none.
    const float unlit = complete == WEDGE_COMPLETE_PREFILTERED ? 0.0f : 1.0f;
    matt = clampedLight(allWithShadows(shadows, matt, mattSums, size, i, false, unlit), clamps, &below);
    const Vec3 k = loadVec(diffuse, size, i);
    Vec3 sum = vecMul(matt, k);
    below = below && luminance(k) > 0.0f;
#ifdef WEDGE_SPECULAR
    const Vec3 reflectance = loadVec(specular, size, i);
    if (luminance(reflectance) > 0.0f) {
        Vec3 lobe = loadVec(lobeSums + 3u * size, size, i);
#if HAS_whole
        lobe = vecChoose(complete != WEDGE_COMPLETE_LIGHTS, loadVec(whole, size, i), lobe);
#endif
        lobe = clampedLight(allWithShadows(shadows, lobe, lobeSums, size, i, wide != 0u, 1.0f), clamps, &below);
        sum = vecAdd(sum, vecMul(lobe, reflectance));
    }
#else
    (void)specular;
    (void)wide;
#endif
    clamped[i] = below ? 1u : 0u;
    storeVec(lit, size, i, vecAdd(loadVec(lit, size, i), sum));
}
#endif
