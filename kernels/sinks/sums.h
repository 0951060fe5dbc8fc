// The sink of sums: what the samples of each receiver add up to.
//
// A sink is what becomes of samples. A kernel that samples defines Sampling, the receivers of a packet and how many
// samples each has, and Samples, one of each lane, and hands them to the functions of its sink.h, which is generated
// from what the pass declares (host/graph/interface.h); they call beginX(), takeX() and finishX() of each sink X:
//
// begin   before the launch's samples are taken: at->first says how many a receiver has of earlier launches
// take    a sample of each lane: at->index says which one of its receiver it is, from 0. Several times for one index
//         where an effect samples in several ways, as often as the packet's lanes ask for: a way that a lane does not
//         take, and lanes of which there is no sample (takesSample()), have values of 0 and no ray
// finish  at->index says how many samples there are now; lanes without new ones (hasTaken()) keep what was there
#ifndef WEDGE_SUMS_H
#define WEDGE_SUMS_H

#include "sinks/lanes.h"

typedef struct {
    float sum[WEDGE_SUMS][WEDGE_PACKET_SIZE];
} Sums;

/// in out  sums: WEDGE_SUMS planes
WEDGE_INLINE void beginSums(const Sampling* at, Sums* state, __global const float* sums)
{
    loadSums(at, sums, state->sum);
}

WEDGE_INLINE void takeSums(const Sampling* at, const Samples* s, Sums* state)
{
    (void)at;
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            state->sum[k][lane] += s->value[k][lane];
        }
    }
}

WEDGE_INLINE void finishSums(const Sampling* at, const Sums* state, __global float* sums)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            sums[k * at->size + at->pixel[lane]] = state->sum[k][lane];
        }
    }
}

#endif
