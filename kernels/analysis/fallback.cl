// Where filtering is not to be trusted, pixels fall back to their own samples.
//
// u is a pixel's plain mean, f what filters made of it, V the variance of u and D the mean of (u - f)^2, both over the
// pixels of the object around. What is shown is
//
//     f + max(0, 1 - c V / D) (u - f)
//
// (shrink.h): where u and f differ by no more than noise does it is f, where the filter is off by more it is u, and
// whatever f is, its error is no larger than u's (c up to 2, many pixels). As samples become more V goes to 0 and with
// it what f is off by.
//
// Where light comes from something small that few paths meet, pixels that all missed it seem to have no noise, and f
// differs from them by what it brings from those that did not. Did each fall back to its own samples while what the
// others found is spread, pictures would become too dark. So V is what the filter makes of the variances of the pixels
// that it gathers, as those of f's pixels are alike if f is right, where that is more.
//
// Where pixels have several receivers u and f are a term's values, before they are multiplied by its texture, and
// squares are times that of the texture's luminance.
#include "analysis/shrink.h"
#include "core/packed_planes.h"

/// c: an error of f of up to c - 1 times the noise's variance counts as none. 1 would be best were V and D known; but
/// they are estimates, and what is taken for bias by mistake brings noise back.
#define WEDGE_FALLBACK_NOISE 2.0f

/// What is averaged.
/// in   filtered, noisy: 3 planes each; deviation: of noisy's luminance (composite.cl); variance: gathered as filtered
///      was, where `gathered`
/// out  squares: planes of (u - f)^2 and of the deviation's, of luminances, and, where `gathered`, of that variance
__kernel void fallbackSquares(AnalysisParams p, uint gathered, __global const float* restrict filtered,
    __global const float* restrict noisy, __global const float* restrict deviation,
    __global const float* restrict variance, __global float* restrict squares)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const float16 d = luminance16(sub16(loadVecBlock(noisy, p.planeSize, i), loadVecBlock(filtered, p.planeSize, i)));
    const float16 v = loadBlock(deviation, i);
    vstore16(d * d, 0, squares + i);
    vstore16(v * v, 0, squares + p.planeSize + i);
    if (gathered != 0u) {
        vstore16(loadBlock(variance, i), 0, squares + 2u * p.planeSize + i);
    }
}

/// Squares of a term's deviations, a value for filters.
__kernel void termVariance(
    AnalysisParams p, __global const float* restrict deviation, __global float* restrict variance)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const float16 d = loadDeviations16(deviation, i, p.packed);
    vstore16(d * d, 0, variance + i);
}

/// Sums over the pixels around; where there are none that differ those of the pixel itself.
WEDGE_FN SquaresAround squaresOfOthers(AnalysisParams p, uint y, int i, __global const uint* objectId,
    __global const float* difference, __global const float* variance)
{
    SquaresAround around = squaresAround(p, y, i, objectId, difference, variance, true);
    const int16 alone = !(around.difference > 0.0f);
    around.variance = alone ? loadBlock(variance, i) : around.variance;
    around.difference = alone ? loadBlock(difference, i) : around.difference;
    return around;
}

/// The share of their own samples that pixels differing from their filtered values show. others: squaresOfOthers()
WEDGE_FN float16 ownShare16(AnalysisParams p, uint y, int i, uint gathered, bool others, int16 differs,
    __global const float* squares, __global const uint* objectId)
{
    const uint size = p.planeSize;
    const SquaresAround around = others ? squaresOfOthers(p, y, i, objectId, squares, squares + size)
                                        : squaresAround(p, y, i, objectId, squares, squares + size, false);
    float16 variance = around.variance;
    if (gathered != 0u) {
        const SquaresAround all = others ? squaresOfOthers(p, y, i, objectId, squares, squares + 2u * size)
                                         : squaresAround(p, y, i, objectId, squares, squares + 2u * size, false);
        variance = max16(variance, all.variance);
    }
    const float16 least = max16(around.difference, (float16)(1e-37f));
    const float16 own = max16(1.0f - WEDGE_FALLBACK_NOISE * variance / least, (float16)(0.0f));
    const int16 known = differs & (around.difference > 0.0f);
    return known ? own : (float16)(0.0f);
}

/// Pixels with a surface whose filtered value is not their own.
WEDGE_FN int16 differing(__global const float* squares, __global const uint* objectId, int i)
{
    return (loadIdBlock(objectId, i) != 0u) & (loadBlock(squares, i) > 0.0f);
}

/// in out  filtered
__kernel void fallBack(AnalysisParams p, uint gathered, __global const float* restrict squares,
    __global const uint* restrict objectId, __global const float* restrict noisy, __global float* restrict filtered)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const int16 differs = differing(squares, objectId, i);
    if (!any(differs)) {
        return;
    }
    const float16 share = ownShare16(p, y, i, gathered, false, differs, squares, objectId);
    const Vec3x16 f = loadVecBlock(filtered, p.planeSize, i), u = loadVecBlock(noisy, p.planeSize, i);
    // Where nothing is shared what the other holds is not looked at.
    const int16 shares = share > 0.0f;
    vstore16(shares ? f.x + share * (u.x - f.x) : f.x, 0, filtered + i);
    vstore16(shares ? f.y + share * (u.y - f.y) : f.y, 0, filtered + p.planeSize + i);
    vstore16(shares ? f.z + share * (u.z - f.z) : f.z, 0, filtered + 2u * p.planeSize + i);
}

/// The shares of terms, of D and V without the pixel's own: two bright paths in one pixel, one in each half of its
/// samples, leave no trace in V, and would be all of D. (They are in the filtered values of the pixels around, too,
/// where others' noise is to outweigh them.) Where none around differs, as where none is of the
/// object, twigs and grains, it is the pixel's own that count.
///
/// out  shares
__kernel void ownShares(AnalysisParams p, uint gathered, __global const float* restrict squares,
    __global const uint* restrict objectId, __global float* restrict shares)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const int16 differs = differing(squares, objectId, i);
    float16 share = (float16)(0.0f);
    if (any(differs)) {
        share = ownShare16(p, y, i, gathered, true, differs, squares, objectId);
    }
    vstore16(share, 0, shares + i);
}
