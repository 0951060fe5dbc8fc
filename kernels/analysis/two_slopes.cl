// What filters of a light need that go by both slopes of its shadows (docs/maaf.md): the largest slope over the least
// one, and widths between both.
#include "analysis/smooth_slopes.h"
#include "core/packed_planes.h"
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"

/// s_max counts as no more than so many times s_min: what is farther apart no one filter is right for.
#define WEDGE_MOST_RATIO 4.0f
/// Weight of spread slopes below which a pixel counts as far from any shadow, as in analysis.cl.
#define WEDGE_LEAST_SPREAD 1e-4f
/// How far filters of both slopes may reach, over how far apart these are (betweenSlopes()).
#define WEDGE_APART 0.6f

/// smoothSlopes() (analysis.cl) of the largest slope, as it was measured: mean of log2 s_max over the pixels of the
/// same object that have one.
///
/// in      slopes: planes of the least and the largest
/// in out  logSlopes: the third plane; the second says where there are slopes
#include "pass/smoothLargest.h"
#ifdef PASS_smoothLargest
__kernel void smoothLargest(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 has = loadBlock(logSlopes + p.planeSize, i) > 0.0f;
    float16 mean = (float16)(0.0f);
    if (any(has)) {
        const SlopesAround around = slopesAround(p, radius, y, i, object, slopes + p.planeSize, objectId);
        // A pixel with an eroded slope may have none itself, and then none around but farther ones.
        const float16 some = around.sum / max16(around.count, (float16)(1.0f));
        const float16 own = around.count > 0.0f ? some : loadBlock(logSlopes, i);
        mean = has ? own : (float16)(0.0f);
    }
    vstore16(mean, 0, logSlopes + 2u * p.planeSize + i);
}
#endif

/// s_max / s_min of pixels, from 1 to WEDGE_MOST_RATIO: their own, else of what spread to them, else 1.
///
/// in   logSlopes, spread: planes of log2 s_min, weight, log2 s_max, as smoothSlopes(), smoothLargest() and their
/// spread out  ratio: of 16 bits
#include "pass/slopeRatios.h"
#ifdef PASS_slopeRatios
__kernel void slopeRatios(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 own = loadBlock(logSlopes + 2u * p.planeSize, i) - loadBlock(logSlopes, i);
    const float16 near = loadBlock(spread + p.planeSize, i);
    const float16 apart = loadBlock(spread + 2u * p.planeSize, i) - loadBlock(spread, i);
    const float16 spreadApart = near > WEDGE_LEAST_SPREAD ? apart / near : (float16)(0.0f);
    const float16 logRatio = loadBlock(logSlopes + p.planeSize, i) > 0.0f ? own : spreadApart;
    const float16 bounded =
        min16(max16(exp2Block(min16(logRatio, (float16)(8.0f))), (float16)(1.0f)), (float16)(WEDGE_MOST_RATIO));
    storeShortsBlock(ratio, p.planeSize, i, 0u, bounded);
}
#endif

/// The harmonic mean of both slopes over the lesser one.
WEDGE_FN float meanSlope(float ratio) { return 2.0f * ratio / (1.0f + ratio); }

/// How wide a filter of both slopes is, over one of the lesser alone: as their mean says, which it is sheared along,
/// unless they are far apart.
WEDGE_FN float betweenSlopes(float ratio)
{
    const float mean = meanSlope(ratio);
    return ratio > 1.0f ? fmin(mean, WEDGE_APART * ratio / (ratio - 1.0f)) : mean;
}

/// in out  beta: metres
#include "pass/widenBetweenSlopes.h"
#ifdef PASS_widenBetweenSlopes
__kernel void widenBetweenSlopes(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    beta[i] *= beta[i] > 0.0f ? betweenSlopes(loadShort(ratio, 0u, i, 0u)) : 1.0f;
}
#endif

/// in out  slopeWidth: as narrowSheared() (shear.cl) left it; then it goes with the slopes' mean alone
#include "pass/widthOfMeanSlope.h"
#ifdef PASS_widthOfMeanSlope
__kernel void widthOfMeanSlope(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float r = loadShort(ratio, 0u, i, 0u);
    storeShort(slopeWidth, 0u, i, 0u, loadShort(slopeWidth, 0u, i, 0u) * meanSlope(r) / betweenSlopes(r));
}
#endif
