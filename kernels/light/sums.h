// Choices by chance: rows of sums of probabilities, and where numbers fall in them.
#ifndef WEDGE_LIGHT_SUMS_H
#define WEDGE_LIGHT_SUMS_H

#include "shared/compat.h"

/// The first of the sums from `low` on that is more than `number`, at most `high`.
WEDGE_FN uint findSum(__global const float* upTo, uint low, uint high, float number)
{
    while (low < high) {
        const uint middle = (low + high) / 2u;
        const bool below = upTo[middle] <= number;
        low = below ? middle + 1u : low;
        high = below ? high : middle;
    }
    return low;
}

#endif
