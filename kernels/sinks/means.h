// The sink of what is filtered: the effect's storeValue() of the sums, which the sink before it has stored.
#ifndef WEDGE_MEANS_H
#define WEDGE_MEANS_H

#include "sinks/lanes.h"

/// in   sums: as finishSums() leaves them
/// out  value: WEDGE_VALUES planes
WEDGE_INLINE void finishMeans(const Sampling* at, __global const float* sums, __global float* value)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        float total[WEDGE_SUMS];
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            total[k] = sums[k * at->size + at->pixel[lane]];
        }
        storeValue(at, at->pixel[lane], total, at->wanted->next[lane], value);
    }
}

#endif
