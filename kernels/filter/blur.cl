// The lens' filter, of the whole image: along rows, then along columns.
#include "core/blur.h"
#include "core/formats.h"

/// One direction of the lens' filter. element: 1 along x, the stride along y.
WEDGE_FN void blurLine(DistributedParams p, uint i, int before, int after, int element, __global const float* lens,
    __global const float* in, __global float* out)
{
    const uint n = p.planeSize;
    Vec3 sum = loadVec(in, n, i);
    const float sigma = lens[i];
    float weights = 1.0f;
    const int reach = min((int)(WEDGE_BLUR_CUT * sigma), WEDGE_MAX_RADIUS);
    for (int k = -min(reach, before); k <= min(reach, after); ++k) {
        const uint j = (uint)((int)i + k * element);
        const float w = k != 0 ? blurWeight(sigma, lens[j], fabs((float)k)) : 0.0f;
        weights += w;
        sum = w > 0.0f ? vecMad(sum, loadVec(in, n, j), w) : sum;
    }
    storeVec(out, n, i, vecScale(sum, 1.0f / weights));
}

#include "pass/blurRows.h"
#ifdef PASS_blurRows
__kernel void blurRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    blurLine(p, i, (int)x, (int)(p.width - 1u - x), 1, lens, in, out);
}
#endif

#include "pass/blurColumns.h"
#ifdef PASS_blurColumns
__kernel void blurColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    blurLine(p, i, (int)y, (int)(p.height - 1u - y), (int)p.stride, lens, in, out);
}
#endif
