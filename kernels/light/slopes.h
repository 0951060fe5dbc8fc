// The sink of slopes: the least and the largest one of what occludes a receiver, from the nearest occluder along each
// ray to a point on the light.
#ifndef WEDGE_SLOPES_H
#define WEDGE_SLOPES_H

#include "light/light_sampling.h"
#include "shared/wedge.h"
#include "sinks/lanes.h"

#define WEDGE_SINK_TAKES_HITS

typedef struct {
    float least[WEDGE_PACKET_SIZE], largest[WEDGE_PACKET_SIZE];
} Slopes;

/// in out  slopes: planes of the least and the largest; 0 where no ray was occluded
WEDGE_INLINE void beginSlopes(const Sampling* at, Slopes* state, __global const float* slopes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = at->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? at->pixel[lane] : 0u;
        const float largest = shaded ? slopes[at->size + i] : 0.0f;
        state->least[lane] = largest > 0.0f ? slopes[i] : WEDGE_SLOPE_MAX * 2.0f;
        state->largest[lane] = largest;
    }
}

WEDGE_INLINE void takeSlopes(const Sampling* at, const Samples* s, Slopes* state)
{
    if (s->hits == 0) {
        return;
    }
    float least[WEDGE_PACKET_SIZE], largest[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float slope = slopeOfHit(s->hits->t[lane]);
        const bool hit = s->hits->triangle[lane] != WEDGE_NO_TRIANGLE;
        least[lane] = hit ? slope : WEDGE_SLOPE_MAX * 2.0f;
        largest[lane] = hit ? slope : 0.0f;
    }
    if (at->deal->own) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            state->least[lane] = fmin(state->least[lane], least[lane]);
            state->largest[lane] = fmax(state->largest[lane], largest[lane]);
        }
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint r = at->deal->receiver[lane];
        state->least[r] = fmin(state->least[r], least[lane]);
        state->largest[r] = fmax(state->largest[r], largest[lane]);
    }
}

WEDGE_INLINE void finishSlopes(const Sampling* at, const Slopes* state, __global float* slopes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(at, lane)) {
            slopes[at->pixel[lane]] = state->largest[lane] > 0.0f ? state->least[lane] : 0.0f;
            slopes[at->size + at->pixel[lane]] = state->largest[lane];
        }
    }
}

#endif
