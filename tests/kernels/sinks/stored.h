// A sink for tests: each sample by itself, its ray and what it counts.
#ifndef WEDGE_STORED_H
#define WEDGE_STORED_H

#include "sinks/lanes.h"

#define WEDGE_SINK_TAKES_RAYS
#ifndef WEDGE_STORED
#define WEDGE_STORED value ///< of Samples
#endif

/// Planes of a sample: the ray's direction, then what it adds to each sum.
#define WEDGE_STORED_PLANES (3u + WEDGE_SUMS)

typedef struct {
    uint count[WEDGE_PACKET_SIZE];
} Stored;

/// in out  storedCounts: samples so far
WEDGE_INLINE void beginStored(const Sampling* at, Stored* state, __global const uint* storedCounts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        state->count[lane] = at->pixel[lane] != WEDGE_NO_PIXEL ? storedCounts[at->pixel[lane]] : 0u;
    }
}

/// out  stored: `room` samples of a receiver, each WEDGE_STORED_PLANES planes
WEDGE_INLINE void takeStored(const Sampling* at, const Samples* s, Stored* state, uint room, __global float* stored)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint r = at->deal->receiver[lane];
        if (!takesSample(at, lane) || state->count[r] == room) {
            continue;
        }
        __global float* sample = stored + state->count[r] * WEDGE_STORED_PLANES * at->size + at->pixel[r];
        sample[0] = s->rays->directionX[lane];
        sample[at->size] = s->rays->directionY[lane];
        sample[2u * at->size] = s->rays->directionZ[lane];
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            sample[(3u + k) * at->size] = s->WEDGE_STORED[k][lane];
        }
        state->count[r] += 1u;
    }
}

WEDGE_INLINE void finishStored(const Sampling* at, const Stored* state, __global uint* storedCounts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(at, lane)) {
            storedCounts[at->pixel[lane]] = state->count[lane];
        }
    }
}

#endif
