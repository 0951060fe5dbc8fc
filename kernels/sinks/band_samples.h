// The sink of stored samples: each by itself, for filters that compare samples (filter/kept.h). Memory is that of a
// band of rows: pixels that lie a band's rows apart have the same slot.
#ifndef WEDGE_BAND_SAMPLES_H
#define WEDGE_BAND_SAMPLES_H

#include "shared/lab.h"
#include "shared/packed.h"
#include "sinks/lanes.h"
#include "sinks/stored_samples.h"

/// Colours of what is no number.
#define WEDGE_FARTHEST_LAB 1e30f

typedef struct {
    float exposure; ///< what radiance is multiplied by before it is a colour
    float low[WEDGE_PACKET_SIZE], high[WEDGE_PACKET_SIZE]; ///< of the receivers, ends of their colours' first number
} BandSamples;

/// The colour by which samples are compared, pixels, of exposed radiance: CIELAB, or with WEDGE_RGB_SAMPLES itself.
WEDGE_INLINE Vec3 comparedColour(Vec3 exposed)
{
#ifdef WEDGE_RGB_SAMPLES
    const float most = 1e18f; // whose square is still a number
    return vec3(fmin(WEDGE_RGB_PIXELS * exposed.x, most), fmin(WEDGE_RGB_PIXELS * exposed.y, most),
        fmin(WEDGE_RGB_PIXELS * exposed.z, most));
#else
    return vecScale(labOf(exposed), 1.0f / WEDGE_LAB_PIXEL);
#endif
}

/// in  slots: pixels that there is memory for; exposure; ranges: of the colours' first number, of each slot's earlier
/// samples
WEDGE_INLINE void beginBandSamples(
    const Sampling* at, BandSamples* state, uint slots, __global const float* exposure, __global const float* ranges)
{
    state->exposure = exposure[0];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool more = at->pixel[lane] != WEDGE_NO_PIXEL && at->wanted->first[lane] > 0u;
        const uint slot = more ? at->pixel[lane] % slots : 0u;
        state->low[lane] = more ? ranges[2u * slot] : WEDGE_FARTHEST_LAB;
        state->high[lane] = more ? ranges[2u * slot + 1u] : -WEDGE_FARTHEST_LAB;
    }
}

/// in   perPixel: samples that a slot has room for
/// out  radiance, colours (stored_samples.h)
WEDGE_INLINE void takeBandSamples(const Sampling* at, const Samples* s, BandSamples* state, uint slots, uint perPixel,
    __global float* radiance, __global ushort* colours)
{
    float first[WEDGE_PACKET_SIZE], second[WEDGE_PACKET_SIZE], third[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float scale = state->exposure;
        const Vec3 colour =
            comparedColour(vec3(scale * s->value[0][lane], scale * s->value[1][lane], scale * s->value[2][lane]));
        first[lane] = unpackShort(packShort(colour.x)); // as it is stored: its range is exact
        second[lane] = colour.y;
        third[lane] = colour.z;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint receiver = at->deal->receiver[lane], index = at->deal->index[lane];
        if (!takesSample(at, lane) || index >= perPixel) {
            continue;
        }
        const size_t to = firstStored(at->pixel[receiver], slots, perPixel) + index;
        const bool finite = finiteVec(vec3(s->value[0][lane], s->value[1][lane], s->value[2][lane]));
        for (uint channel = 0u; channel < 3u; ++channel) {
            radiance[to + channel * perPixel] = s->value[channel][lane];
        }
        const float stored = finite ? first[lane] : WEDGE_FARTHEST_LAB;
        colours[to] = (ushort)packShort(stored);
        colours[to + perPixel] = (ushort)packShort(finite ? second[lane] : 0.0f);
        colours[to + 2u * perPixel] = (ushort)packShort(finite ? third[lane] : 0.0f);
        state->low[receiver] = fmin(state->low[receiver], stored);
        state->high[receiver] = fmax(state->high[receiver], stored);
    }
}

/// out  ranges
WEDGE_INLINE void finishBandSamples(const Sampling* at, const BandSamples* state, uint slots, __global float* ranges)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(at, lane)) {
            const uint slot = at->pixel[lane] % slots;
            ranges[2u * slot] = state->low[lane];
            ranges[2u * slot + 1u] = state->high[lane];
        }
    }
}

#endif
