// The sink of distances: how far away the surfaces are that the samples of a receiver come from.
#ifndef WEDGE_DISTANCES_H
#define WEDGE_DISTANCES_H

#include "paths/path_sampling.h"
#include "sinks/lanes.h"

/// Emitters' shadow rays look for the nearest occluder (paths/emitter_rays.h).
#define WEDGE_SINK_TAKES_DISTANCES

typedef struct {
    float nearest[WEDGE_PACKET_SIZE], farthest[WEDGE_PACKET_SIZE], inverse[WEDGE_PACKET_SIZE];
} Distances;

/// in out  reflectors: planes of the least and the largest distance in metres of a surface that a ray hit, 0 where none
///         did; and of the sum of inverse distances
WEDGE_INLINE void beginDistances(const Sampling* at, Distances* state, __global const float* reflectors)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = at->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? at->pixel[lane] : 0u;
        state->nearest[lane] = shaded && reflectors[i] > 0.0f ? reflectors[i] : INFINITY;
        state->farthest[lane] = shaded ? reflectors[at->size + i] : 0.0f;
        state->inverse[lane] = shaded ? reflectors[2u * at->size + i] : 0.0f;
    }
}

WEDGE_INLINE void takeDistances(const Sampling* at, const Samples* s, Distances* state)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float distance = s->distance[lane];
        if (takesSample(at, lane) && distance < INFINITY) {
            const uint r = at->deal->receiver[lane];
            state->nearest[r] = fmin(state->nearest[r], distance);
            state->farthest[r] = fmax(state->farthest[r], distance);
            state->inverse[r] += 1.0f / fmax(distance, 1e-20f);
        }
    }
}

WEDGE_INLINE void finishDistances(const Sampling* at, const Distances* state, __global float* reflectors)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(at, lane)) {
            const uint i = at->pixel[lane];
            reflectors[i] = state->nearest[lane] < INFINITY ? state->nearest[lane] : 0.0f;
            reflectors[at->size + i] = state->farthest[lane];
            reflectors[2u * at->size + i] = state->inverse[lane];
        }
    }
}

#endif
