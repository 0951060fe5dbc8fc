// What filters of samples leave of a pixel's samples that are known by their brightness alone (sinks/sample_bins.h):
// the mean that its term is to have, what the mean loses, and measures of its noise, which are no larger than before.
#include "core/formats.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "sinks/sample_bins.h"

/// Standard deviation of the luminances within a bin, of their mean: of those that are spread evenly over most bins.
#define WEDGE_BIN_DEVIATION 0.35f

/// Of a pixel's samples, by bins.
typedef struct {
    Vec3 sum, total; ///< means times weights, of what is kept and of all
    float weight, all; ///< sums of weights, likewise
    float squared; ///< of what is kept: mean squared luminances times weights
    float samples; ///< that are kept
    uint count; ///< all
    bool whole; ///< all are kept
} KeptBins;

WEDGE_FN KeptBins keptBins(__global const ushort* bins, __global const float* shares, uint size, uint i)
{
    KeptBins kept;
    kept.sum = kept.total = vec3(0.0f, 0.0f, 0.0f);
    kept.weight = kept.all = kept.squared = kept.samples = 0.0f;
    kept.count = 0u;
    kept.whole = true;
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        const SampleBin bin = loadSampleBin(bins, size, i, b);
        if (bin.count == 0u) {
            continue;
        }
        const float share = loadShort(shares, size, i, b), l = luminance(bin.mean);
        const float samples = share * (float)bin.count, weight = samples * bin.weight;
        kept.sum = vecMad(kept.sum, bin.mean, weight);
        kept.total = vecMad(kept.total, bin.mean, (float)bin.count * bin.weight);
        kept.weight += weight;
        kept.all += (float)bin.count * bin.weight;
        kept.squared += weight * l * l * (1.0f + WEDGE_BIN_DEVIATION * WEDGE_BIN_DEVIATION);
        kept.samples += samples;
        kept.count += bin.count;
        kept.whole = kept.whole && share == 1.0f;
    }
    return kept;
}

/// One channel of what is kept of a mean. Bins say in which proportion: their own means are rounded, and weigh all
/// channels alike. sum, total: the channel's; weight: what the sum is over
WEDGE_FN float keptOf(const KeptBins* kept, float value, float sum, float total, float weight)
{
    return total > 0.0f ? value * (sum / total) * (kept->all / fmax(weight, 1e-30f)) : value;
}

/// Variance of the luminance of a sample that is kept.
WEDGE_FN float varianceOfKept(const KeptBins* kept)
{
    const float per = 1.0f / fmax(kept->weight, 1e-30f), mean = luminance(vecScale(kept->sum, per));
    return fmax(kept->squared * per - mean * mean, 0.0f);
}

/// The variance of a primary sample's radiance (waves/accumulate.h) by which pixels ask for more: between that of what
/// is kept, its irradiance's and its texture's, and that of all, their geometric mean. What is left out is light that
/// is hard to find or light that does not matter, and one cannot tell.
/// k, e: luminances of texture and irradiance; ofTexture: variance; before: that of all, negative where it is not known
WEDGE_FN float varianceOfRadiance(const KeptBins* kept, float k, float e, float ofTexture, float before)
{
    const float own = k * k * varianceOfKept(kept) + e * e * ofTexture;
    return before < 0.0f ? own : sqrt(before * fmin(before, own));
}

/// in   bins, shares: of each bin, that is kept; lossy: 1: what is left out is missing, 0: the rest makes up for it; of
///      the term: value, deviation; texture, with spreads, or squares and textureSquares (waves/accumulate.h)
/// out  sums: the mean of what is kept (3 planes); taken: 1 where there are samples, else 0; excess: what the mean
///      loses (3 planes); kept: deviation, spreads, squares. Pixels that keep all have the bits that they had.
#include "pass/keepBins.h"
#ifdef PASS_keepBins
__kernel void keepBins(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const KeptBins kept = keptBins(bins, shares, size, i);
    const Vec3 all = LOAD_value(size, i), factor = LOAD_texture(size, i);
    const bool finite = finiteVec(all), whole = kept.whole && finite;
    const float weight = lossy != 0u ? kept.all : kept.weight;
    const Vec3 ofBins = vecScale(kept.sum, 1.0f / fmax(weight, 1e-30f));
    const Vec3 ofAll = vec3(keptOf(&kept, all.x, kept.sum.x, kept.total.x, weight),
        keptOf(&kept, all.y, kept.sum.y, kept.total.y, weight), keptOf(&kept, all.z, kept.sum.z, kept.total.z, weight));
    const Vec3 mean = whole ? all : finite ? ofAll : ofBins;
    storeVec(sums, size, i, mean);
    storeVec(excess, size, i, whole || !finite ? vec3(0.0f, 0.0f, 0.0f) : vecSub(all, mean));
    taken[i] = kept.count > 0u ? 1u : 0u;
    if (HAS_deviation) {
        const float before = LOAD_deviation(size, i);
        const float most = sqrt(varianceOfKept(&kept) / fmax(kept.samples, 1.0f));
        STORE_kept_deviation(size, i, whole ? before : clamp(before, -most, most));
    }
    const float k = luminance(factor), e = luminance(mean);
    if (HAS_spreads) {
        const float2 d = LOAD_spreads(size, i);
        const float variance = varianceOfRadiance(&kept, k, e, d.y * d.y, d.x * d.x);
        STORE_kept_spreads(size, i, whole ? d : (float2)(sqrt(variance), d.y));
    }
    if (HAS_squares) {
        const float before = luminance(vecMul(factor, all)), now = luminance(vecMul(factor, mean));
        const float squared = LOAD_squares(size, i), ofTexture = fmax(LOAD_textureSquares(size, i) - k * k, 0.0f);
        const float known = finite ? fmax(squared - before * before, 0.0f) : -1.0f;
        const float variance = varianceOfRadiance(&kept, k, e, ofTexture, known);
        STORE_kept_squares(size, i, whole ? squared : variance + now * now);
    }
}
#endif
