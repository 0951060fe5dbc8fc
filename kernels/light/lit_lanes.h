// Sums of what lights bring to the pixels of a packet, lane by lane.
#ifndef WEDGE_LIT_LANES_H
#define WEDGE_LIT_LANES_H

#include "light/lobe_lanes.h"
#include "shared/shadow_lights.h"

typedef struct {
    Vec3 towards; ///< unit
    Vec3 irradiance; ///< of what faces it, W/m^2
} ShadowLight;

/// lights: WEDGE_SHADOW_LIGHT_FLOATS each
WEDGE_INLINE ShadowLight shadowLight(__global const float* lights, uint k)
{
    __global const float* at = lights + WEDGE_SHADOW_LIGHT_FLOATS * k;
    ShadowLight light;
    light.towards = vec3(at[0], at[1], at[2]);
    light.irradiance = vec3(at[3], at[4], at[5]);
    return light;
}

/// What lights bring to each lane: R G B where nothing hides them, and of all.
typedef struct {
    float shadowed[3][WEDGE_PACKET_SIZE], unshadowed[3][WEDGE_PACKET_SIZE];
} LitLanes;

WEDGE_FN void clearLit(LitLanes* lit)
{
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            lit->shadowed[channel][lane] = 0.0f;
            lit->unshadowed[channel][lane] = 0.0f;
        }
    }
}

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

#ifdef WEDGE_SPECULAR
/// Light that lobes reflect, as they are and at least as wide as Phong's of the exponent `widest`; 0: there are no
/// wider ones.
typedef struct {
    LitLanes own, wide;
    LobeLanes ownLobes, wideLobes;
    float widest;
} LobeSums;

WEDGE_FN void beginLobes(const ReceiverPacket* r, float widest, LobeSums* lobes)
{
    lobes->widest = widest;
    lobesOf(r, 0.0f, &lobes->ownLobes);
    lobesOf(r, widest, &lobes->wideLobes);
    clearLit(&lobes->own);
    clearLit(&lobes->wide);
}

/// planes: 6, and if there are wider lobes 6 more
WEDGE_FN void loadLobes(__global const float* planes, uint size, const uint* pixel, LobeSums* lobes)
{
    loadLit(planes, size, 0u, pixel, &lobes->own);
    if (lobes->widest > 0.0f) {
        loadLit(planes, size, 6u, pixel, &lobes->wide);
    }
}

WEDGE_FN void storeLobes(__global float* planes, uint size, const uint* pixel, const LobeSums* lobes)
{
    storeLit(planes, size, 0u, pixel, &lobes->own);
    if (lobes->widest > 0.0f) {
        storeLit(planes, size, 6u, pixel, &lobes->wide);
    }
}

/// What wider lobes count for where lights are chosen: enough to tell lights apart that own lobes do not reflect.
#define WEDGE_WIDE_GAIN 0.02f

/// Adds a light. weight: made here, how much lobes reflect of it
WEDGE_FN void addToLobes(const ReceiverPacket* r, ShadowLight light, const float* cosine, const uint* occluded,
    LobeSums* lobes, float* weight)
{
    lobeWeights(r, &lobes->ownLobes, light.towards, cosine, weight);
    addLight(light.irradiance, weight, occluded, &lobes->own);
    if (lobes->widest > 0.0f) {
        float wide[WEDGE_PACKET_SIZE];
        lobeWeights(r, &lobes->wideLobes, light.towards, cosine, wide);
        addLight(light.irradiance, wide, occluded, &lobes->wide);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            weight[lane] += WEDGE_WIDE_GAIN * wide[lane];
        }
    }
}
#endif

#endif
