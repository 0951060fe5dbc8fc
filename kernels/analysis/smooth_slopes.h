// Means of slopes over the pixels around, of the least (analysis.cl) and of the largest (two_slopes.cl).
#ifndef WEDGE_SMOOTH_SLOPES_H
#define WEDGE_SMOOTH_SLOPES_H

#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/frame.h"

/// Of sixteen pixels: the sum of log2 s over those of the same object that have a slope, and how many these are.
typedef struct {
    float16 sum, count;
} SlopesAround;

/// Over pixels no more than `radius` (at most WEDGE_BLOCK_PIXELS) away along both axes of those at (x, y), i. object: 0
/// of pixels that have no surface, which get nothing
WEDGE_INLINE SlopesAround slopesAround(AnalysisParams p, int radius, uint y, int i, uint16 object,
    __global const float* slopes, __global const uint* objectId)
{
    SlopesAround around;
    around.sum = around.count = (float16)(0.0f);
    for (int dy = max(-radius, -(int)y); dy <= min(radius, (int)(p.height - 1u - y)); ++dy) {
        for (int dx = -radius; dx <= radius; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const float16 slope = loadBlock(slopes, j);
            const int16 taken = (slope > 0.0f) & (loadIdBlock(objectId, j) == object) & (object != 0u);
            around.sum += taken ? log2Block(slope) : (float16)(0.0f);
            around.count += taken ? (float16)(1.0f) : (float16)(0.0f);
        }
    }
    return around;
}

#endif
