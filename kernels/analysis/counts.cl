// Sample counts from demands: n = C demand, clamped, with C such that the mean count is what was asked for. demand.cl
// makes demands of variances.
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"

/// The range that the histogram of log2 demand covers.
#define WEDGE_DEMAND_LOG2_MIN -24.0f
#define WEDGE_DEMAND_LOG2_MAX 8.0f

/// Per stripe of rows: a histogram of log2 demand. counts and sums: WEDGE_DEMAND_BINS a stripe; shaded: pixels that
/// take samples at all, a stripe: those whose mask is not 0. Pixels without demand are in no bin.
#include "pass/demandHistogram.h"
#ifdef PASS_demandHistogram
__kernel void demandHistogram(PARAMETERS)
{
    const uint stripe = get_global_id(0);
    if (stripe >= WEDGE_DEMAND_STRIPES) {
        return;
    }
    __global uint* bins = counts + stripe * WEDGE_DEMAND_BINS;
    __global float* totals = sums + stripe * WEDGE_DEMAND_BINS;
    for (uint b = 0u; b < WEDGE_DEMAND_BINS; ++b) {
        bins[b] = 0u;
        totals[b] = 0.0f;
    }
    const float scale = (float)WEDGE_DEMAND_BINS / (WEDGE_DEMAND_LOG2_MAX - WEDGE_DEMAND_LOG2_MIN);
    uint pixels = 0u;
    for (uint y = stripe; y < p.height; y += WEDGE_DEMAND_STRIPES) {
        for (uint x = 0u; x < p.width; x += WEDGE_BLOCK_PIXELS) {
            const int i = (int)pixelIndex(x, y, p.stride);
            float values[WEDGE_BLOCK_PIXELS];
            int index[WEDGE_BLOCK_PIXELS];
            const float16 d = loadBlock(demand, i);
            vstore16(d, 0, values);
            const float16 bin = (log2Block(max16(d, (float16)(1e-30f))) - WEDGE_DEMAND_LOG2_MIN) * scale;
            vstore16(convert_int16(clamp(bin, 0.0f, (float)WEDGE_DEMAND_BINS - 1.0f)), 0, index);
            for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
                if (mask[i + (int)lane] == 0u) {
                    continue;
                }
                ++pixels;
                if (values[lane] > 0.0f) {
                    bins[index[lane]] += 1u;
                    totals[index[lane]] += values[lane];
                }
            }
        }
    }
    shaded[stripe] = pixels;
}
#endif

/// Finds C such that the mean of clamp(C demand, least, cap) over the shaded pixels is `mean`, by bisection on the
/// summed histograms, and writes it to scale[0]. One work-item. The mean grows with C, so 40 halvings settle it.
#include "pass/solveCountScale.h"
#ifdef PASS_solveCountScale
__kernel void solveCountScale(PARAMETERS)
{
    if (get_global_id(0) != 0u) {
        return;
    }
    uint pixels = 0u;
    uint demanding = 0u;
    for (uint s = 0u; s < WEDGE_DEMAND_STRIPES; ++s) {
        pixels += shaded[s];
    }
    for (uint b = 0u; b < WEDGE_DEMAND_BINS; ++b) {
        uint count = 0u;
        float sum = 0.0f;
        for (uint s = 0u; s < WEDGE_DEMAND_STRIPES; ++s) {
            count += counts[s * WEDGE_DEMAND_BINS + b];
            sum += sums[s * WEDGE_DEMAND_BINS + b];
        }
        binCounts[b] = count;
        binSums[b] = sum;
        demanding += count;
    }
    const float target = mean * (float)pixels - least * (float)(pixels - demanding);
    float low = -20.0f;
    float high = 60.0f;
    for (uint step = 0u; step < 40u; ++step) {
        const float middle = 0.5f * (low + high);
        const float c = exp2(middle);
        float total = 0.0f;
        for (uint b = 0u; b < WEDGE_DEMAND_BINS; ++b) {
            if (binCounts[b] > 0u) {
                const float n = (float)binCounts[b];
                total += n * fmin(fmax(c * binSums[b] / n, least), cap);
            }
        }
        if (total < target) {
            low = middle;
        } else {
            high = middle;
        }
    }
    scale[0] = exp2(0.5f * (low + high));
}
#endif

/// Wanted samples: clamp(C demand, leastCount, cap); 0 where the mask is.
#include "pass/countsFromDemand.h"
#ifdef PASS_countsFromDemand
__kernel void countsFromDemand(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float count = fmin(fmax(scale[0] * demand[i], (float)p.leastCount), (float)p.countCap);
    wanted[i] = mask[i] != 0u ? (uint)(count + 0.5f) : 0u;
}
#endif

/// The same count for every pixel of the mask.
#include "pass/uniformCounts.h"
#ifdef PASS_uniformCounts
__kernel void uniformCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    wanted[i] = mask[i] != 0u ? count : 0u;
}
#endif
