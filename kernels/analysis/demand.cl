// From variances to demands: which pixels' samples are worth most.
//
// The variance of what a filter makes of a pixel's samples is about v / (n K), with v that of one sample, n the samples
// of a pixel and K the number of equal pixels that the filter gathers. Counts are n = C (v / K)^exponent (counts.cl).
// v / K is a pixel's *uncertainty* here, -1 where a pixel has none of such samples.
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"

/// Uncertainty of filtered visibilities: v = p (1 - p), at least varianceFloor, since few rays miss thin occluders.
/// -1 where no slope reaches (beta <= 0).
#include "pass/visibilityUncertainty.h"
#ifdef PASS_visibilityUncertainty
__kernel void visibilityUncertainty(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 one = (float16)(1.0f), seen = min16(max16(loadBlock(filtered, i), (float16)(0.0f)), one);
    const float16 v = max16(seen * (one - seen), (float16)(p.varianceFloor));
    vstore16(loadBlock(beta, i) > 0.0f ? v / max16(loadBlock(effective, i), one) : -one, 0, uncertainty + i);
}
#endif

/// Uncertainty of samples of variance v; -1 where beta < 0.
#include "pass/uncertaintyOf.h"
#ifdef PASS_uncertaintyOf
__kernel void uncertaintyOf(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 one = (float16)(1.0f);
    const float16 u = loadBlock(variance, i) / max16(loadBlock(effective, i), one);
    vstore16(loadBlock(beta, i) >= 0.0f ? u : -one, 0, uncertainty + i);
}
#endif

/// Sums over pixels around.
typedef struct {
    float16 largest, sum, count; ///< largest of all, sum and number of the nearest
    float16 within; ///< number of all
} Around;

WEDGE_INLINE void addAround(Around* a, float16 there, int16 counts, bool nearest)
{
    const float16 one = (float16)(1.0f), none = (float16)(0.0f);
    a->largest = counts ? max16(a->largest, there) : a->largest;
    a->within += counts ? one : none;
    if (nearest) {
        a->sum += counts ? there : none;
        a->count += counts ? one : none;
    }
}

/// demand = u^exponent, 0 where there is none. u is the mean uncertainty of the eight nearest pixels, at least
/// varianceSpread of the largest within 5x5, with ownToo at least the pixel's own; the pixel's own where no other has
/// any. oneObject: 1: of the pixel's object alone.
/// A count that follows the samples that it then divides makes means of bright and rare samples too small: pixels whose
/// first samples happened to be bright take more, which outvote those. So terms of that kind look at others alone. The
/// visibility of an area light is between 0 and 1, where the error near 0 is that near 1 with its sign turned, and in
/// small penumbrae no pixel around has the same.
#include "pass/demandOf.h"
#ifdef PASS_demandOf
__kernel void demandOf(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 own = loadBlock(uncertainty, i), one = (float16)(1.0f), none = (float16)(0.0f);
    if (!any(own >= 0.0f)) {
        vstore16(none, 0, demand + i);
        return;
    }
    const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) + (int)x;
    const uint16 object = oneObject != 0u ? loadIdBlock(objectId, i) : (uint16)(0u);
    Around around;
    around.largest = around.sum = around.count = around.within = none;
    const int reach = (int)WEDGE_DEMAND_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            if (dx == 0 && dy == 0) {
                continue;
            }
            const int j = i + dy * (int)p.stride + dx;
            const float16 there = loadBlock(uncertainty, j);
            int16 counts = (there >= 0.0f) & (lanes >= -dx) & (lanes < (int)p.width - dx);
            counts &= oneObject != 0u ? loadIdBlock(objectId, j) == object : (int16)(-1);
            addAround(&around, there, counts, abs(dx) <= 1 && abs(dy) <= 1);
        }
    }
    const float16 others = max16(around.sum / max16(around.count, one), p.varianceSpread * around.largest);
    const float16 u = around.within > 0.0f ? (ownToo != 0u ? max16(others, own) : others) : own;
    const int16 wants = (own >= 0.0f) & (u > 1e-30f);
    vstore16(wants ? exp2Block(p.countExponent * log2Block(u)) : none, 0, demand + i);
}
#endif
