// What decides between an estimate and one of less noise and more bias: how far they are apart and how much of that is
// noise, over the pixels around. V of noise in D, the first keeps max(0, 1 - c V / D): the positive-part estimator of
// W. James and C. Stein (1961), which shrinks the first towards the second.
#ifndef WEDGE_SHRINK_H
#define WEDGE_SHRINK_H

#include "core/vector16.h"
#include "shared/filter_params.h"

/// Sums over the pixels of an object around a block of them.
typedef struct {
    float16 difference, variance;
} SquaresAround;

/// Of pixels i of row y, over those of the same object within WEDGE_SHRINK_REACH.
WEDGE_FN SquaresAround squaresAround(AnalysisParams p, uint y, int i, __global const uint* objectId,
    __global const float* difference, __global const float* variance)
{
    const uint16 object = loadIdBlock(objectId, i);
    SquaresAround sum;
    sum.difference = sum.variance = (float16)(0.0f);
    const int reach = (int)WEDGE_SHRINK_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const int16 same = loadIdBlock(objectId, j) == object;
            sum.difference += same ? loadBlock(difference, j) : (float16)(0.0f);
            sum.variance += same ? loadBlock(variance, j) : (float16)(0.0f);
        }
    }
    return sum;
}

#endif
