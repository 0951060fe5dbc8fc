// What all sinks ask of a packet's receivers and lanes.
#ifndef WEDGE_LANES_H
#define WEDGE_LANES_H

#include "core/packet_size.h"
#include "core/receivers.h"

/// Whether the lane takes the sample in hand.
WEDGE_INLINE bool takesSample(const Sampling* at, uint lane) { return at->deal->index[lane] < at->deal->last[lane]; }

/// Whether there is a receiver, and it has taken samples in this launch.
WEDGE_INLINE bool hasTaken(const Sampling* at, uint receiver)
{
    return at->pixel[receiver] != WEDGE_NO_PIXEL && at->wanted->next[receiver] > at->wanted->first[receiver];
}

/// Adds what each lane has to its receiver's, in the samples' order.
WEDGE_INLINE void addLanes(const Sampling* at, const float* lanes, float* receivers)
{
    if (at->deal->own) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            receivers[lane] += lanes[lane];
        }
        return;
    }
    if (at->deal->whole) {
        // The same sum, but not by way of memory from one lane to the next.
        float sum = receivers[at->deal->receiver[0]];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            sum += lanes[lane];
        }
        receivers[at->deal->receiver[0]] = sum;
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        receivers[at->deal->receiver[lane]] += lanes[lane];
    }
}

/// The sums of earlier launches; 0 in lanes without a receiver.
WEDGE_INLINE void loadSums(const Sampling* at, __global const float* sums, float (*out)[WEDGE_PACKET_SIZE])
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = at->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? at->pixel[lane] : 0u;
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            out[k][lane] = shaded ? sums[k * at->size + i] : 0.0f;
        }
    }
}

#endif
