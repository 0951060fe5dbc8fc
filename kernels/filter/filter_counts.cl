// How many equal samples the filter of filter.cl gathers at each pixel, of whatever value: those along its row
// times those along its column (countOfLine()).
//
// in   as for filter.cl, without values
// out  effective
#include "filter/gather.h"

WEDGE_INLINE void addNeighbour(FilterParams p, GatherBlock b, GatherWidth width, int j, float steps,
    __global const float* beta, __global const float* position, __global const float* normal,
    __global const float* pixelSize, __global const uint* objectId, LineWeights* weights)
{
    const float16 betaThere = loadBlock(beta, j);
    const Neighbours n = neighboursAt(p, b, j, betaThere, position, normal, pixelSize, objectId);
    const float16 w = neighbourWeights(p, width, n, betaThere, fabs(steps));
    addWeight(weights, w, steps);
}

/// Along image step `step`, whose pixels lie `element` apart; before, after: pixels that the line goes on to.
WEDGE_INLINE float16 countAlong(FilterParams p, GatherBlock b, int i, int element, Vec3 step, int before, int after,
    int16 gathers, float16 betaHere, __global const float* beta, __global const float* position,
    __global const float* normal, __global const float* pixelSize, __global const uint* objectId)
{
    const GatherWidth width = gatherWidth(p, b, step, gathers, betaHere);
    LineWeights weights = ownWeight();
    const int radius = (int)largestOf(width.radius);
    for (int k = 1; k <= radius; ++k) {
        if (k <= before) {
            addNeighbour(
                p, b, width, i - k * element, -(float)k, beta, position, normal, pixelSize, objectId, &weights);
        }
        if (k <= after) {
            addNeighbour(p, b, width, i + k * element, (float)k, beta, position, normal, pixelSize, objectId, &weights);
        }
    }
    return gathers ? countOfLine(weights, p.fitted != 0u) : (float16)(1.0f);
}

#include "pass/gatherCounts.h"
#ifdef PASS_gatherCounts
__kernel void gatherCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 betaHere = loadBlock(beta, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 gathers = (betaHere > 0.0f) & (object != 0u);
    float16 count = (float16)(1.0f);
    if (any(gathers)) {
        const GatherBlock b = gatherBlock(p, i, object, position, normal, pixelSize);
        // The padding of the rows holds objectId 0, so no tap has to ask where the row ends.
        count = countAlong(p, b, i, 1, p.right, WEDGE_MAX_RADIUS, WEDGE_MAX_RADIUS, gathers, betaHere, beta, position,
            normal, pixelSize, objectId);
        count *= countAlong(p, b, i, (int)p.stride, p.down, (int)y, (int)(p.height - 1u - y), gathers, betaHere, beta,
            position, normal, pixelSize, objectId);
    }
    vstore16(count, 0, effective + i);
}
#endif
