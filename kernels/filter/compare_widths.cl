// One plane filtered with two widths at once: with pixels' own, and with what these are compared with (widen.cl). As
// gather.h does it, but that pixels which are not compared keep their own value, and that what comes out is how far the
// two are apart.
#define WEDGE_GATHER_CHANNELS 1
#include "filter/gather.h"

/// A plane filtered along lines, and the equal samples that this amounts to.
typedef struct {
    float16 value, count;
} LineMean;

typedef struct {
    LineMean narrow, wide;
} LineMeans;

WEDGE_INLINE GatherSum sumFrom(float16 own)
{
    GatherSum sum;
    sum.weights = ownWeight();
    sum.channel[0] = own;
    sum.moment[0] = (float16)(0.0f);
    return sum;
}

WEDGE_INLINE LineMean meanOf(FilterParams p, const GatherSum* sum, int16 gathers, LineMean before)
{
    LineMean mean;
    mean.value = gathers ? valueOfLine(p, sum, fitOf(sum->weights), 0u) : before.value;
    mean.count = before.count * (gathers ? countOfLine(sum->weights, p.fitted != 0u) : (float16)(1.0f));
    return mean;
}

/// Of a block of pixels; own: what they have so far; before, after: pixels that the line goes on to. narrow, wide:
/// planes of values along the line, which may be the same one. Where compared is 0 nothing is gathered and no neighbour
/// narrowed, where it is less there is no value to take.
WEDGE_INLINE LineMeans compareLine(FilterParams p, int i, int element, Vec3 step, int before, int after,
    __global const float* narrow, __global const float* wide, __global const float* beta,
    __global const float* compared, __global const float* position, __global const float* normal,
    __global const float* pixelSize, __global const uint* objectId, LineMeans own)
{
    const float16 wideHere = loadBlock(compared, i), narrowHere = loadBlock(beta, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 gathers = (wideHere > 0.0f) & (object != 0u), narrowGathers = gathers & (narrowHere > 0.0f);
    if (!any(gathers)) {
        return own;
    }
    const GatherBlock b = gatherBlock(p, i, object, position, normal, pixelSize);
    const GatherWidth ofWide = gatherWidth(p, b, step, gathers, wideHere),
                      ofNarrow = gatherWidth(p, b, step, narrowGathers, narrowHere);
    GatherSum wideSum = sumFrom(own.wide.value), narrowSum = sumFrom(own.narrow.value);
    const int radius = (int)largestOf(ofWide.radius), narrowRadius = (int)largestOf(ofNarrow.radius);
    for (int k = -min(radius, before); k <= min(radius, after); ++k) {
        if (k == 0) {
            continue;
        }
        const int j = i + k * element;
        const float steps = (float)k;
        const float16 wideThere = loadBlock(compared, j);
        const Neighbours n = neighboursAt(p, b, j, wideThere, position, normal, pixelSize, objectId);
        const float16 w = neighbourWeights(p, ofWide, n, wideThere, fabs(steps));
        addWeight(&wideSum.weights, w, steps);
        addValue(&wideSum, 0u, w, steps, loadBlock(wide, j));
        if (abs(k) <= (uint)narrowRadius) {
            const float16 narrowThere = wideThere > 0.0f ? loadBlock(beta, j) : (float16)(0.0f);
            const float16 v = neighbourWeights(p, ofNarrow, n, narrowThere, fabs(steps));
            addWeight(&narrowSum.weights, v, steps);
            addValue(&narrowSum, 0u, v, steps, loadBlock(narrow, j));
        }
    }
    LineMeans means;
    means.narrow = meanOf(p, &narrowSum, narrowGathers, own.narrow);
    means.wide = meanOf(p, &wideSum, gathers, own.wide);
    return means;
}

/// Along x.
/// in   value; beta: widths, metres; compared: those to compare with, 0 where beta is not less than they are or there
///      is no need to, -1 where there is no value
/// out  of both: rows filtered, and equal samples that they amount to
#include "pass/compareRows.h"
#ifdef PASS_compareRows
__kernel void compareRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    LineMeans own;
    own.narrow.value = own.wide.value = loadBlock(value, i);
    own.narrow.count = own.wide.count = (float16)(1.0f);
    const LineMeans means = compareLine(p, i, 1, p.right, WEDGE_MAX_RADIUS, WEDGE_MAX_RADIUS, value, value, beta,
        compared, position, normal, pixelSize, objectId, own);
    vstore16(means.narrow.value, 0, narrowRows + i);
    vstore16(means.wide.value, 0, wideRows + i);
    vstore16(means.narrow.count, 0, narrowCounts + i);
    vstore16(means.wide.count, 0, wideCounts + i);
}
#endif

/// Along y.
/// in      rows that compareRows() made
/// in out  difference: in the place of its narrow counts comes n - w; apart: in that of its wide counts what the
/// variance
///         of a pixel's mean is to be multiplied by for V of widen.cl, 0 where the wide filter does not gather more
#include "pass/compareColumns.h"
#ifdef PASS_compareColumns
__kernel void compareColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    LineMeans own;
    own.narrow.value = loadBlock(narrowRows, i);
    own.wide.value = loadBlock(wideRows, i);
    own.narrow.count = loadBlock(difference, i);
    own.wide.count = loadBlock(apart, i);
    const LineMeans means = compareLine(p, i, (int)p.stride, p.down, (int)y, (int)(p.height - 1u - y), narrowRows,
        wideRows, beta, compared, position, normal, pixelSize, objectId, own);
    const float16 k = means.narrow.count, kWide = means.wide.count;
    vstore16(means.narrow.value - means.wide.value, 0, difference + i);
    vstore16(kWide > k ? 1.0f / k - 2.0f / (k + kWide) : (float16)(0.0f), 0, apart + i);
}
#endif
