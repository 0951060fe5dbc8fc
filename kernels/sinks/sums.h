// The sink of sums: what the samples of each receiver add up to.
//
// A sink is what becomes of samples. A kernel that samples defines Sampling, the receivers of a packet and how many
// samples each has, and Samples, one of each lane, and hands them to the functions of its interface, which is generated
// from what the pass declares (host/graph/interface.h); they call beginX(), takeX() and finishX() of each sink X. What
// they keep is of the packet's receivers, and a lane's sample may be of any of them (core/deal.h):
//
// begin   before the launch's samples are taken: at->wanted->first says how many a receiver has of earlier launches
// take    a sample of each lane: at->deal->receiver says whose, and at->deal->index which one of its, from 0. Several
//         ways to sample come together. Lanes of which there is no sample (takesSample()) have values of 0 and no ray
// finish  at->wanted->next says how many samples there are now; receivers without new ones (hasTaken()) keep what was
//         there
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
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        addLanes(at, s->value[k], state->sum[k]);
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
