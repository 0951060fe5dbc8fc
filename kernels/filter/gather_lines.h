// The passes of gather.h's filter. Programs of packed frames in which nothing reads the effective counts set
// WEDGE_GATHER_VALUE_ONLY.
//
// in   value, beta (metres, along the pass's axis; 0: keep the pixel's own value, still a neighbour of others;
//      negative: neither), position, normal, pixelSize, objectId, and for the second pass the first one's effective
//      counts
// out  filtered (like value), effective: the number of equal samples that the gather amounts to (countOfLine()), times
//      that of the pass before
#ifndef WEDGE_GATHER_LINES_H
#define WEDGE_GATHER_LINES_H

#include "filter/gather.h"

WEDGE_INLINE void storeEffective(float16 count, __global float* effective)
{
#ifdef WEDGE_GATHER_VALUE_ONLY
    (void)count;
    (void)effective;
#else
    vstore16(count, 0, effective);
#endif
}

/// Adds the neighbours at element j, `steps` pixels away; negative: before the pixel.
WEDGE_INLINE void gatherTap(FilterParams p, GatherBlock b, GatherWidth width, int j, float steps,
    __global const float* value, __global const float* beta, __global const float* position,
    __global const float* normal, __global const float* pixelSize, __global const uint* objectId, GatherSum* sum)
{
    const float16 betaThere = loadBlock(beta, j);
    const Neighbours n = neighboursAt(p, b, j, betaThere, position, normal, pixelSize, objectId);
    const float16 w = neighbourWeights(p, width, n, betaThere, fabs(steps));
    addWeight(&sum->weights, w, steps);
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        addValue(sum, c, w, steps, loadBlock(value + c * p.planeSize, j));
    }
}

WEDGE_INLINE void gatherLine(FilterParams p, uint x, uint y, int element, Vec3 step, int before, int after,
    __global const float* value, __global const float* beta, __global const float* position,
    __global const float* normal, __global const float* pixelSize, __global const uint* objectId,
    float16 effectiveBefore, __global float* filtered, __global float* effective)
{
    const int i = (int)pixelIndex(x, y, p.stride);
    const float16 betaHere = loadBlock(beta, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 gathers = (betaHere > 0.0f) & (object != 0u);
    float16 own[WEDGE_GATHER_CHANNELS];
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        own[c] = loadBlock(value + c * p.planeSize, i);
    }
    if (!any(gathers)) {
        for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
            vstore16(own[c], 0, filtered + c * p.planeSize + i);
        }
        storeEffective(effectiveBefore, effective + i);
        return;
    }
    const GatherBlock b = gatherBlock(p, i, object, position, normal, pixelSize);
    const GatherWidth width = gatherWidth(p, b, step, gathers, betaHere);
    GatherSum sum;
    sum.weights = ownWeight();
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        sum.channel[c] = own[c];
        sum.moment[c] = (float16)(0.0f);
    }
    const int radius = (int)largestOf(width.radius);
    for (int k = 1; k <= radius; ++k) {
        if (k <= before) {
            gatherTap(
                p, b, width, i - k * element, -(float)k, value, beta, position, normal, pixelSize, objectId, &sum);
        }
        if (k <= after) {
            gatherTap(p, b, width, i + k * element, (float)k, value, beta, position, normal, pixelSize, objectId, &sum);
        }
    }
    const LineFit fit = fitOf(sum.weights);
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        vstore16(gathers ? valueOfLine(p, &sum, fit, c) : own[c], 0, filtered + c * p.planeSize + i);
    }
    const float16 count = gathers ? countOfLine(sum.weights, p.fitted != 0u) : (float16)(1.0f);
    storeEffective(effectiveBefore * count, effective + i);
}

/// Along x. The padding of the rows holds objectId 0, so no tap has to ask where the row ends.
__kernel void filterRows(FilterParams p, __global const float* restrict value, __global const float* restrict beta,
    __global const float* restrict position, __global const float* restrict normal,
    __global const float* restrict pixelSize, __global const uint* restrict objectId, __global float* restrict filtered,
    __global float* restrict effective)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        gatherLine(p, x, y, 1, p.right, WEDGE_MAX_RADIUS, WEDGE_MAX_RADIUS, value, beta, position, normal, pixelSize,
            objectId, (float16)(1.0f), filtered, effective);
    }
}

/// Along y. The effective counts may be in the place of those of the rows: of each block these are read first.
__kernel void filterColumns(FilterParams p, __global const float* restrict value, __global const float* restrict beta,
    __global const float* restrict position, __global const float* restrict normal,
    __global const float* restrict pixelSize, __global const uint* restrict objectId,
    __global const float* effectiveRows, __global float* restrict filtered, __global float* effective)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        gatherLine(p, x, y, (int)p.stride, p.down, (int)y, (int)(p.height - 1u - y), value, beta, position, normal,
            pixelSize, objectId, loadBlock(effectiveRows, (int)pixelIndex(x, y, p.stride)), filtered, effective);
    }
}

#endif
