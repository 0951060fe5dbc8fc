// Where filtering is not to be trusted, pixels fall back to their own samples.
//
// u is a pixel's plain mean, f what filters made of it, d = u - f, V the variance of u, and sums are over the pixels of
// the object around. First f is scaled so that sums agree where they differ by more than noise makes them,
//
//     f' = f + r f,   r = max(0, 1 - c1 sum V / (sum d)^2) sum d / sum f
//
// which is what highlights need that a filter spreads: all pixels there are off by less than their noise, and by more
// together. Then what is shown is
//
//     f' + max(0, 1 - c2 sum V / sum d'^2) (u - f'),   d' = u - f'
//
// (the positive-part estimator of W. James and C. Stein, 1961, which shrinks u towards f'): where u and f' differ by no
// more than noise does it is f', where the filter is off by more it is u, and whatever f' is, its error is no larger
// than u's (c2 up to 2, many pixels). As samples become more V goes to 0 and with it what f is off by.
//
// Where light comes from something small that few paths meet, pixels that all missed it seem to have no noise, and f
// differs from them by what it brings from those that did not. Did each fall back to its own samples while what the
// others found is spread, pictures would become too dark. So V is what the filter makes of the variances of the pixels
// that it gathers, as those of f's pixels are alike if f is right, where that is more.
//
// Where pixels have several receivers u and f are a term's values, and d and f in the sums are luminances of what they
// make with its texture.
#include "core/formats.h"
#include "core/vector16.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"

/// c1: sums count as different where the square of their difference is more than this times its variance. Where few
/// paths meet a small light, sums that are too bright by chance stand out, and those that are too dark do not: with
/// less pictures become brighter.
#define WEDGE_FALLBACK_CHANCE 6.0f
/// c2: an error of f' of up to c2 - 1 times the noise's variance counts as none. 1 would be best were V and d' known;
/// but they are estimates, and what is taken for bias by mistake brings noise back.
#define WEDGE_FALLBACK_NOISE 2.0f

/// What is summed, of luminances. texture: what both are multiplied by to be seen; beta: pixels below 0 keep their own,
/// and nothing is averaged of them; both where there are such.
/// in   filtered: of `values` planes; noisy; deviation: of noisy's luminance, where it is seen without a texture;
///      variance: gathered as filtered was, where it is
/// out  differences: d, V, f, and, where there is a variance, that
#include "pass/fallbackDifferences.h"
#ifdef PASS_fallbackDifferences
__kernel void fallbackDifferences(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 f = values == 3u ? loadVec(filtered, n, i) : vec3(filtered[i], filtered[i], filtered[i]);
    const Vec3 u = LOAD_noisy(n, i);
#if HAS_texture
    const Vec3 k = LOAD_texture(n, i);
    const float t = luminance(k), v = t * LOAD_deviation(n, i);
    const float d = luminance(vecMul(k, vecSub(u, f))), level = luminance(vecMul(k, f));
#else
    const float t = 1.0f, v = LOAD_deviation(n, i);
    const float d = luminance(vecSub(u, f)), level = luminance(f);
#endif
    const bool counts = !HAS_beta || LOAD_beta(n, i) >= 0.0f;
    storeShort(differences, n, i, 0u, counts ? d : 0.0f);
    storeShort(differences, n, i, 1u, counts ? v * v : 0.0f);
    storeShort(differences, n, i, 2u, counts ? level : 0.0f);
    if (HAS_variance) {
        storeShort(differences, n, i, 3u, counts ? t * t * LOAD_variance(n, i) : 0.0f);
    }
}
#endif

/// Squares of a term's deviations, a value for filters.
#include "pass/termVariance.h"
#ifdef PASS_termVariance
__kernel void termVariance(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 d = LOAD16_deviation(p.planeSize, i);
    vstore16(d * d, 0, variance + i);
}
#endif

/// Sums over pixels.
typedef struct {
    float16 d, f, dd, df, ff; ///< of d, f and their products
    float16 variance, gathered;
} Differences;

/// Of pixels i that count; others may hold anything.
WEDGE_INLINE void addDifferences(
    Differences* sum, AnalysisParams p, uint gathered, int16 counts, __global const float* differences, int i)
{
    const float16 none = (float16)(0.0f);
    const float16 d = counts ? loadShortsBlock(differences, p.planeSize, i, 0u) : none;
    const float16 f = counts ? loadShortsBlock(differences, p.planeSize, i, 2u) : none;
    sum->d += d;
    sum->f += f;
    sum->dd += d * d;
    sum->df += d * f;
    sum->ff += f * f;
    sum->variance += counts ? loadShortsBlock(differences, p.planeSize, i, 1u) : none;
    if (gathered != 0u) {
        sum->gathered += counts ? loadShortsBlock(differences, p.planeSize, i, 3u) : none;
    }
}

WEDGE_INLINE Differences noDifferences(void)
{
    Differences sum;
    sum.d = sum.f = sum.dd = sum.df = sum.ff = sum.variance = sum.gathered = (float16)(0.0f);
    return sum;
}

/// Over the pixels of the object within WEDGE_SHRINK_REACH. others: without the pixel's own, unless none of them
/// differs
WEDGE_FN Differences differencesAround(AnalysisParams p, uint gathered, bool others, uint y, int i,
    __global const float* differences, __global const uint* objectId)
{
    const uint16 object = loadIdBlock(objectId, i);
    Differences sum = noDifferences();
    const int reach = (int)WEDGE_SHRINK_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            if (others && dy == 0 && dx == 0) {
                continue;
            }
            const int j = i + dy * (int)p.stride + dx;
            addDifferences(&sum, p, gathered, loadIdBlock(objectId, j) == object, differences, j);
        }
    }
    if (others) {
        const int16 alone = !(sum.dd > 0.0f);
        Differences own = noDifferences();
        addDifferences(&own, p, gathered, alone, differences, i);
        sum.d = alone ? own.d : sum.d;
        sum.f = alone ? own.f : sum.f;
        sum.dd = alone ? own.dd : sum.dd;
        sum.df = alone ? own.df : sum.df;
        sum.ff = alone ? own.ff : sum.ff;
        sum.variance = alone ? own.variance : sum.variance;
        sum.gathered = alone ? own.gathered : sum.gathered;
    }
    return sum;
}

/// How far pixels fall back.
typedef struct {
    float16 ratio; ///< r
    float16 own; ///< share of their own samples
} Fallback;

/// differs: pixels whose filtered value is not their own; the others do not fall back.
WEDGE_FN Fallback fallbackOf(AnalysisParams p, uint gathered, bool others, uint y, int i, int16 differs,
    __global const float* differences, __global const uint* objectId)
{
    const Differences sum = differencesAround(p, gathered, others, y, i, differences, objectId);
    const float16 none = (float16)(0.0f), least = (float16)(1e-37f);
    // The second where the first is no number, which makes nothing sure.
    const float16 variance = max16(sum.gathered, sum.variance);
    const float16 sure = max16(1.0f - WEDGE_FALLBACK_CHANCE * variance / max16(sum.d * sum.d, least), none);
    const float16 ratio = max16(sure * sum.d / max16(sum.f, least), (float16)(-1.0f));
    Fallback out;
    // Of sums that are no numbers nothing follows.
    const int16 known = differs & isfinite(sum.d) & isfinite(ratio);
    out.ratio = (known & (sure > 0.0f) & (sum.f > 0.0f)) ? ratio : none;
    const float16 left = sum.dd + out.ratio * (out.ratio * sum.ff - 2.0f * sum.df);
    const float16 own = max16(1.0f - WEDGE_FALLBACK_NOISE * variance / max16(left, least), none);
    out.own = (differs & (left > 0.0f)) ? own : none;
    return out;
}

/// Pixels with a surface whose filtered value is not their own.
WEDGE_FN int16 differing(__global const float* differences, __global const uint* objectId, int i)
{
    return (loadIdBlock(objectId, i) != 0u) & (loadShortBlock(differences, i) != 0.0f);
}

/// How far pixels fall back: ratio and own of Fallback, what addReflected() and addFilteredTerm() are handed.
///
/// Of terms, `others`, sums are without the pixel's own: two bright paths in one pixel, one in each half of its
/// samples, leave no trace in V, and would be all of d. (They are in the filtered values of the pixels around, too,
/// where others' noise is to outweigh them.) Where none around differs, as where none is of the object, twigs and
/// grains, it is the pixel's own that count.
///
/// out  shares: the share of own samples, and r
#include "pass/ownShares.h"
#ifdef PASS_ownShares
__kernel void ownShares(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 differs = differing(differences, objectId, i);
    Fallback fallback;
    fallback.ratio = fallback.own = (float16)(0.0f);
    if (any(differs)) {
        fallback = fallbackOf(p, gathered, others != 0u, y, i, differs, differences, objectId);
    }
    WEDGE_OF_FORMAT(storePair16, FORMAT_shares)(shares, p.planeSize, i, fallback.own, fallback.ratio);
}
#endif
