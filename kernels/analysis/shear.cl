// What the sheared filter of a light's term takes besides widths (gather_sheared.h, docs/soft-shadows.md): gradients,
// and widths that follow pixels' own counts.
#include "core/packed_planes.h"
#include "core/vector16.h"
#include "shared/filter_params.h"

#ifdef WEDGE_SPECULAR
#define WEDGE_CHANNELS 2u
#else
#define WEDGE_CHANNELS 1u
#endif

/// Of each channel and axis of the light how fast the part of it that is seen changes where the light, in its own
/// coordinates, moves: mean of (V - h) q over the samples, V their visibility, h its mean, q their scores (scoreOf()).
/// Less the mean, so that where all is seen, or nothing, it is 0 whatever the samples.
///
/// in   sums (light_sampling.h), scores (light/scores.h)
/// out  gradients: two planes a channel
__kernel void shadowGradients(AnalysisParams p, __global const float* restrict sums,
    __global const float* restrict scores, __global float* restrict gradients)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    for (uint c = 0u; c < WEDGE_CHANNELS; ++c) {
        const float16 all = loadBlock(sums + 2u * c * p.planeSize, i);
        const float16 seen = loadBlock(sums + (2u * c + 1u) * p.planeSize, i);
        const float16 perAll = all > 0.0f ? 1.0f / all : (float16)(0.0f);
        for (uint axis = 0u; axis < 2u; ++axis) {
            const float16 ofAll = loadBlock(scores + (4u * c + axis) * p.planeSize, i);
            const float16 ofSeen = loadBlock(scores + (4u * c + 2u + axis) * p.planeSize, i);
            vstore16((ofSeen - seen * perAll * ofAll) * perAll, 0, gradients + (2u * c + axis) * p.planeSize + i);
        }
    }
}

/// Widths are made for pixels that take the mean count: those that take more are less noisy, and as wide filters would
/// put more off than they smooth. beta ~ (mean / count)^exponent.
///
/// in out  beta: metres
/// out     slopeWidth: what it was, which goes with the occluders' slopes alone
__kernel void narrowByCounts(AnalysisParams p, float mean, float exponent, __global const uint* restrict taken,
    __global float* restrict slopeWidth, __global float* restrict beta)
{
    const uint x = p.x0 + get_global_id(0);
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint i = pixelIndex(x, y, p.stride);
    const float width = beta[i];
    slopeWidth[i] = width;
    beta[i] = width > 0.0f ? width * exp2(exponent * log2(mean / (float)max(taken[i], 1u))) : width;
}
