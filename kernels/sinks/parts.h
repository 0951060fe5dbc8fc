// The sink of parts: what the first of two parts of the samples (firstPart()) alone would be filtered as, for the noise
// that its difference from all of them tells.
#ifndef WEDGE_PARTS_H
#define WEDGE_PARTS_H

#include "shared/wedge.h"
#include "sinks/lanes.h"

typedef struct {
    float sum[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    uint samples[WEDGE_PACKET_SIZE]; ///< of the part
} Parts;

/// in  sums: of earlier launches
WEDGE_INLINE void beginParts(const Sampling* at, Parts* state, __global const float* sums)
{
    loadSums(at, sums, state->sum);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        state->samples[lane] = firstPart(at->wanted->strata[lane], at->firstPass);
    }
}

WEDGE_INLINE void takeParts(const Sampling* at, const Samples* s, Parts* state)
{
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        float ofPart[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const uint samples = state->samples[at->deal->receiver[lane]];
            ofPart[lane] = at->deal->index[lane] < samples ? s->value[k][lane] : 0.0f;
        }
        addLanes(at, ofPart, state->sum[k]);
    }
}

/// out  parts: as the effect's storePart() stores them, of parts that are complete. If one was before this launch, it
/// is there.
WEDGE_INLINE void finishParts(const Sampling* at, const Parts* state, __global float* parts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint n = state->samples[lane];
        if (!hasTaken(at, lane) || n < at->wanted->first[lane] || n > at->wanted->next[lane]) {
            continue;
        }
        float total[WEDGE_SUMS];
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            total[k] = state->sum[k][lane];
        }
        storePart(at, at->pixel[lane], total, n, parts);
    }
}

#endif
