// The passes of gather.h's filter, of as many planes as WEDGE_GATHER_CHANNELS says. Programs whose filters follow
// gradients set WEDGE_GATHER_SHEARED, and WEDGE_GATHER_CURVED for second derivatives too; those of lean frames in
// which nothing reads the effective counts set WEDGE_GATHER_VALUE_ONLY.
//
// in   value, beta (metres, along the pass's axis; 0: keep the pixel's own value, still a neighbour of others;
//      negative: neither), position, normal, pixelSize, objectId, and for the second pass the first one's effective
//      counts
//      sheared also gradients, of each channel along both of the light's axes, and slopeWidth (gather_sheared.h), of
//      16 bits
// out  filtered (like value), effective: the number of equal samples that the gather amounts to (countOfLine()), times
//      that of the pass before
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

/// What the passes read; of values and gradients the first planes.
typedef struct {
    __global const float *value, *beta, *position, *normal, *pixelSize;
    __global const uint* objectId;
#ifdef WEDGE_GATHER_SHEARED
    __global const float *gradients, *slopeWidth;
#endif
} GatherPlanes;

/// And write.
typedef struct {
    __global float *filtered, *effective;
#ifdef WEDGE_GATHER_SHEARED
    __global float* gradients; ///< null: of the last pass
#endif
} GatheredPlanes;

#ifdef WEDGE_GATHER_SHEARED
#include "filter/gather_sheared.h"
#endif

/// Adds the neighbours at element j, `steps` pixels away; negative: before the pixel.
WEDGE_INLINE void gatherTap(
    FilterParams p, GatherBlock b, GatherWidth width, GatherPlanes in, int j, float steps, GatherSum* sum)
{
    const float16 betaThere = loadBlock(in.beta, j);
    const Neighbours n = neighboursAt(p, b, j, betaThere, in.position, in.normal, in.pixelSize, in.objectId);
    const float16 w = neighbourWeights(p, width, n, betaThere, fabs(steps));
    addWeight(&sum->weights, w, steps);
#ifdef WEDGE_GATHER_SHEARED
    const Shear shear = shearOf(p, width, n);
#endif
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        const float16 value = loadBlock(in.value + c * p.planeSize, j);
#ifdef WEDGE_GATHER_SHEARED
        addValue(sum, c, w, steps, sheared(p, in.gradients, shear, c, j, w, value, sum));
#else
        addValue(sum, c, w, steps, value);
#endif
    }
}

WEDGE_INLINE void gatherLine(FilterParams p, uint x, uint y, int element, Vec3 step, int before, int after,
    GatherPlanes in, float16 effectiveBefore, GatheredPlanes out)
{
    const int i = (int)pixelIndex(x, y, p.stride);
    const float16 betaHere = loadBlock(in.beta, i);
    const uint16 object = loadIdBlock(in.objectId, i);
    const int16 gathers = (betaHere > 0.0f) & (object != 0u);
    float16 own[WEDGE_GATHER_CHANNELS];
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        own[c] = loadBlock(in.value + c * p.planeSize, i);
    }
    if (!any(gathers)) {
        for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
            vstore16(own[c], 0, out.filtered + c * p.planeSize + i);
        }
#ifdef WEDGE_GATHER_SHEARED
        keepGradients(p, in.gradients, i, out.gradients);
#endif
        storeEffective(effectiveBefore, out.effective + i);
        return;
    }
    const GatherBlock b = gatherBlock(p, i, object, in.position, in.normal, in.pixelSize);
    GatherWidth width = gatherWidth(p, b, step, gathers, betaHere);
    GatherSum sum;
    sum.weights = ownWeight();
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        sum.channel[c] = own[c];
        sum.moment[c] = (float16)(0.0f);
    }
#ifdef WEDGE_GATHER_SHEARED
    beginShear(p, in, i, &width, &sum);
#endif
    const int radius = (int)largestOf(width.radius);
    for (int k = 1; k <= radius; ++k) {
        if (k <= before) {
            gatherTap(p, b, width, in, i - k * element, -(float)k, &sum);
        }
        if (k <= after) {
            gatherTap(p, b, width, in, i + k * element, (float)k, &sum);
        }
    }
    const LineFit fit = fitOf(sum.weights);
    for (uint c = 0u; c < WEDGE_GATHER_CHANNELS; ++c) {
        vstore16(gathers ? valueOfLine(p, &sum, fit, c) : own[c], 0, out.filtered + c * p.planeSize + i);
    }
#ifdef WEDGE_GATHER_SHEARED
    storeGradients(p, in.gradients, i, gathers, &sum, fit, out.gradients);
#endif
    const float16 count = gathers ? countOfLine(sum.weights, p.fitted != 0u) : (float16)(1.0f);
    storeEffective(effectiveBefore * count, out.effective + i);
}

/// Along x. The padding of the rows holds objectId 0, so no tap has to ask where the row ends.
WEDGE_INLINE void gatherRow(FilterParams p, GatherPlanes in, GatheredPlanes out)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        gatherLine(p, x, y, 1, p.right, WEDGE_MAX_RADIUS, WEDGE_MAX_RADIUS, in, (float16)(1.0f), out);
    }
}

/// Along y. Effective counts are multiplied by those of the rows.
WEDGE_INLINE void gatherColumn(FilterParams p, GatherPlanes in, __global const float* effectiveRows, GatheredPlanes out)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        gatherLine(p, x, y, (int)p.stride, p.down, (int)y, (int)(p.height - 1u - y), in,
            loadBlock(effectiveRows, (int)pixelIndex(x, y, p.stride)), out);
    }
}

#ifndef WEDGE_GATHER_SHEARED
#include "pass/filterRows.h"
#ifdef PASS_filterRows
__kernel void filterRows(PARAMETERS)
{
    const GatherPlanes in = { value, beta, position, normal, pixelSize, objectId };
    const GatheredPlanes out = { filtered, effective };
    gatherRow(p, in, out);
}
#endif

#include "pass/filterColumns.h"
#ifdef PASS_filterColumns
__kernel void filterColumns(PARAMETERS)
{
    const GatherPlanes in = { value, beta, position, normal, pixelSize, objectId };
    const GatheredPlanes out = { filtered, effective };
    gatherColumn(p, in, effectiveRows, out);
}
#endif
#else
#include "pass/shearRows.h"
#ifdef PASS_shearRows
__kernel void shearRows(PARAMETERS)
{
    const GatherPlanes in = { value, beta, position, normal, pixelSize, objectId, gradients, slopeWidth };
    const GatheredPlanes out = { filtered, effective, gradientsOfRows };
    gatherRow(p, in, out);
}
#endif

#include "pass/shearColumns.h"
#ifdef PASS_shearColumns
__kernel void shearColumns(PARAMETERS)
{
    const GatherPlanes in = { value, beta, position, normal, pixelSize, objectId, gradients, slopeWidth };
    const GatheredPlanes out = { filtered, effective, 0 };
    gatherColumn(p, in, effectiveRows, out);
}
#endif
#endif
