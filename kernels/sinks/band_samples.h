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
    float low[WEDGE_PACKET_SIZE], high[WEDGE_PACKET_SIZE]; ///< of the receivers, least and largest L*
} BandSamples;

/// in  slots: pixels that there is memory for; exposure; ranges: least and largest L* of each slot's earlier samples
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
    float l[WEDGE_PACKET_SIZE], a[WEDGE_PACKET_SIZE], b[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float scale = state->exposure;
        const Vec3 lab = labOf(vec3(scale * s->value[0][lane], scale * s->value[1][lane], scale * s->value[2][lane]));
        l[lane] = unpackShort(packShort(lab.x * (1.0f / WEDGE_LAB_PIXEL)));
        a[lane] = lab.y * (1.0f / WEDGE_LAB_PIXEL);
        b[lane] = lab.z * (1.0f / WEDGE_LAB_PIXEL);
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint receiver = at->deal->receiver[lane], index = at->deal->index[lane];
        if (!takesSample(at, lane) || index >= perPixel) {
            continue;
        }
        const size_t first = firstStored(at->pixel[receiver], slots, perPixel) + index;
        const bool finite = storesFinite(vec3(s->value[0][lane], s->value[1][lane], s->value[2][lane]));
        for (uint channel = 0u; channel < 3u; ++channel) {
            radiance[first + channel * perPixel] = s->value[channel][lane];
        }
        const float stored = finite ? l[lane] : WEDGE_FARTHEST_LAB;
        colours[first] = (ushort)packShort(stored);
        colours[first + perPixel] = (ushort)packShort(finite ? a[lane] : 0.0f);
        colours[first + 2u * perPixel] = (ushort)packShort(finite ? b[lane] : 0.0f);
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
