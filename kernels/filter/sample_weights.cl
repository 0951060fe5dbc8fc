// Filters of samples that path density is compared with: of each, what the samples of a band's pixels count
// (filter/kept.h). All read stored samples (sinks/stored_samples.h): drawn, radiance, colours, ranges, exposure; and
// all store what is kept: sums, excess, parts, taken, notFinite.
#include "filter/kept.h"
#include "shared/filter_params.h"
#include "shared/maths.h"
#include "shared/wedge.h"
#include "sinks/sample_bins.h"

#define WEDGE_STORE_KEPT(kept)                                                                                         \
    storeKept(&(kept), p.planeSize, i, count, sums, excess, HAS_parts ? (__global float*)PLANE_parts : 0);             \
    taken[i] = count;                                                                                                  \
    notFinite[i] = count - (kept).count

/// What is taken away is not made up for by what is left.
WEDGE_FN void countWhole(Kept* kept)
{
    kept->weight = (float)kept->count;
    kept->partWeight = (float)kept->partCount;
}

/// Luminance of a sample; infinite where it is no number, so that it is the brightest.
WEDGE_INLINE float storedLuminance(const StoredSamples* s, uint pixel, uint index)
{
    const Vec3 radiance = storedRadiance(s, pixel, index);
    return finiteVec(radiance) ? luminance(radiance) : INFINITY;
}

/// Samples brighter than a level are made as bright as that, and keep their hue.
/// level: in exposed radiance
#include "pass/keepClamped.h"
#ifdef PASS_keepClamped
__kernel void keepClamped(PARAMETERS)
{
    WEDGE_KEPT_PIXEL(p, x, y, i, count)
    const StoredSamples stored = { radiance, colours, ranges, drawn, slots, perPixel };
    const uint ofPart = firstPart(count, firstPass);
    Kept kept = nothingKept();
    for (uint j = 0u; j < count; ++j) {
        const Vec3 sample = storedRadiance(&stored, i, j);
        const float l = exposure[0] * luminance(sample);
        keepSample(&kept, sample, l > level ? level / l : 1.0f, j < ofPart);
    }
    countWhole(&kept);
    WEDGE_STORE_KEPT(kept);
}
#endif

/// The alpha-trimmed mean: a share of the samples is left out at either end of their luminances; those that are equally
/// bright are in the order in which they were taken. At least one is kept.
#include "pass/keepTrimmed.h"
#ifdef PASS_keepTrimmed
__kernel void keepTrimmed(PARAMETERS)
{
    WEDGE_KEPT_PIXEL(p, x, y, i, count)
    (void)exposure; // orders of luminances are those of any
    const StoredSamples stored = { radiance, colours, ranges, drawn, slots, perPixel };
    const uint ofPart = firstPart(count, firstPass);
    const uint ends = min((uint)(share * (float)count), (count - 1u) / 2u);
    Kept kept = nothingKept();
    for (uint j = 0u; j < count; ++j) {
        const float own = storedLuminance(&stored, i, j);
        uint rank = 0u;
        for (uint k = 0u; k < count; ++k) {
            const float other = storedLuminance(&stored, i, k);
            // With fast maths a sample's luminance may differ from itself.
            rank += k != j && (other < own || (other == own && k < j)) ? 1u : 0u;
        }
        const bool within = rank >= ends && rank < count - ends;
        keepSample(&kept, storedRadiance(&stored, i, j), within ? 1.0f : 0.0f, j < ofPart);
    }
    WEDGE_STORE_KEPT(kept);
}
#endif

/// Adaptive median of means (Buisine et al., Firefly Removal in Monte Carlo Rendering with Adaptive Median of meaNs,
/// 2021): samples are dealt to groups, and of the groups' means, in the order of their luminance, as many are left out
/// at either end as their Gini coefficient says: of equal means none, of one that has all the light all but the median.
#include "pass/keepMedianOfMeans.h"
#ifdef PASS_keepMedianOfMeans
__kernel void keepMedianOfMeans(PARAMETERS)
{
    WEDGE_KEPT_PIXEL(p, x, y, i, count)
    (void)exposure; // orders of luminances are those of any
    const StoredSamples stored = { radiance, colours, ranges, drawn, slots, perPixel };
    const uint ofPart = firstPart(count, firstPass);
    const uint m = min(groups, count);
    float mean[WEDGE_MOST_GROUPS];
    uint rank[WEDGE_MOST_GROUPS];
    float total = 0.0f, spread = 0.0f;
    for (uint g = 0u; g < m; ++g) {
        mean[g] = 0.0f;
        for (uint j = g; j < count; j += m) {
            mean[g] += storedLuminance(&stored, i, j);
        }
        mean[g] /= (float)((count - g + m - 1u) / m);
    }
    for (uint g = 0u; g < m; ++g) {
        rank[g] = 0u;
        for (uint k = 0u; k < m; ++k) {
            rank[g] += mean[k] < mean[g] || (mean[k] == mean[g] && k < g) ? 1u : 0u;
        }
        total += mean[g];
        spread += (2.0f * (float)rank[g] + 1.0f - (float)m) * mean[g];
    }
    // What is not finite has all of the light, and is left out.
    const float gini = total > 0.0f ? (total < INFINITY ? spread / ((float)m * total) : 1.0f) : 0.0f;
    const uint ends = min((uint)(gini * (float)((m - 1u) / 2u) + 0.5f), (m - 1u) / 2u);
    Kept kept = nothingKept();
    for (uint j = 0u; j < count; ++j) {
        const bool within = rank[j % m] >= ends && rank[j % m] < m - ends;
        keepSample(&kept, storedRadiance(&stored, i, j), within ? 1.0f : 0.0f, j < ofPart);
    }
    WEDGE_STORE_KEPT(kept);
}
#endif

/// Brightness falls into cascades, each so many times as bright as the one before it, from 1 in exposed radiance on.
#define WEDGE_CASCADE_BASE 8.0f
#define WEDGE_CASCADES 6u

/// The lower of the two cascades that a sample of luminance l is shared out to, and its share there: so that both
/// cascades together are as bright as it is.
WEDGE_INLINE float shareOfCascade(float l, uint* cascade)
{
    float low = 1.0f;
    *cascade = 0u;
    while (*cascade + 2u < WEDGE_CASCADES && l >= low * WEDGE_CASCADE_BASE) {
        low *= WEDGE_CASCADE_BASE;
        ++*cascade;
    }
    const float share = (low / fmax(l, low) - 1.0f / WEDGE_CASCADE_BASE) / (1.0f - 1.0f / WEDGE_CASCADE_BASE);
    return clamp(share, 0.0f, 1.0f);
}

/// Light of a pixel, or of several, by cascades.
typedef struct {
    float light[WEDGE_CASCADES]; ///< exposed luminances
} Cascades;

WEDGE_FN Cascades noCascades(void)
{
    Cascades none;
    for (uint c = 0u; c < WEDGE_CASCADES; ++c) {
        none.light[c] = 0.0f;
    }
    return none;
}

/// Adds `count` samples of exposed luminance l.
WEDGE_FN void addToCascades(Cascades* cascades, float l, float count)
{
    uint cascade;
    const float lower = shareOfCascade(l, &cascade);
    cascades->light[cascade] += count * (lower * l);
    cascades->light[cascade + 1u] += count * ((1.0f - lower) * l);
}

/// Adds a pixel's stored samples.
WEDGE_FN void addCascades(const StoredSamples* s, uint pixel, float scale, Cascades* cascades)
{
    for (uint j = 0u; j < s->drawn[pixel]; ++j) {
        const Vec3 radiance = storedRadiance(s, pixel, j);
        if (finiteVec(radiance)) {
            addToCascades(cascades, scale * luminance(radiance), 1.0f);
        }
    }
}

/// A cascade and those beside it.
WEDGE_FN float besideCascade(const float* cascades, uint c)
{
    return cascades[c] + (c > 0u ? cascades[c - 1u] : 0.0f) + (c + 1u < WEDGE_CASCADES ? cascades[c + 1u] : 0.0f);
}

/// Re-weighting of bright samples (Zirr, Hanika, Dachsbacher, Re-weighting Firefly Samples for Improved Finite-Sample
/// Monte Carlo Estimates, 2018): how far a cascade of brightness is trusted goes by how many samples of about that
/// brightness there are in the pixel, or in 3x3 where those are few, and by how bright the pixel is without it.
/// n: samples of the pixel; kappa: samples of a brightness that are asked for; trust: of each cascade
WEDGE_FN void trustCascades(const Cascades* own, const Cascades* around, float n, float kappa, float* trust)
{
    const float perOfKappa = 1.0f / kappa;
    float brightness = 1.0f, level = 1.0f, light = 0.0f;
    float ownCounts[WEDGE_CASCADES], aroundCounts[WEDGE_CASCADES];
    for (uint c = 0u; c < WEDGE_CASCADES; ++c) {
        ownCounts[c] = own->light[c] / level;
        aroundCounts[c] = around->light[c] / (9.0f * level);
        level *= WEDGE_CASCADE_BASE;
    }
    level = 1.0f;
    for (uint c = 0u; c < WEDGE_CASCADES; ++c) {
        const float near = besideCascade(aroundCounts, c);
        const float samples = near < 1.0f ? near : besideCascade(ownCounts, c);
        brightness = fmax(brightness, light / n);
        const float more = WEDGE_CASCADE_BASE + (1.0f - WEDGE_CASCADE_BASE) * fmin(perOfKappa, 1.0f);
        trust[c] = clamp(0.5f * ((samples + n * brightness / level * more) * perOfKappa - perOfKappa), 0.0f, 1.0f);
        trust[c] = c == 0u ? 1.0f : trust[c];
        light += own->light[c] * trust[c];
        level *= WEDGE_CASCADE_BASE;
    }
}

/// What counts of a sample of exposed luminance l.
WEDGE_FN float trustOf(const float* trust, float l)
{
    uint cascade;
    const float lower = shareOfCascade(l, &cascade);
    return trust[cascade] == 1.0f && trust[cascade + 1u] == 1.0f
        ? 1.0f
        : lower * trust[cascade] + (1.0f - lower) * trust[cascade + 1u];
}

/// kappa: as trustCascades has it
#include "pass/keepReweighted.h"
#ifdef PASS_keepReweighted
__kernel void keepReweighted(PARAMETERS)
{
    WEDGE_KEPT_PIXEL(p, x, y, i, count)
    const StoredSamples stored = { radiance, colours, ranges, drawn, slots, perPixel };
    const uint ofPart = firstPart(count, firstPass);
    Cascades own = noCascades(), around = noCascades();
    addCascades(&stored, i, exposure[0], &own);
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const int u = (int)x + dx, v = (int)y + dy;
            if (u >= 0 && v >= 0 && u < (int)p.width && v < (int)p.height) {
                addCascades(&stored, pixelIndex((uint)u, (uint)v, p.stride), exposure[0], &around);
            }
        }
    }
    float trust[WEDGE_CASCADES];
    trustCascades(&own, &around, (float)count, kappa, trust);
    Kept kept = nothingKept();
    for (uint j = 0u; j < count; ++j) {
        const Vec3 sample = storedRadiance(&stored, i, j);
        keepSample(&kept, sample, trustOf(trust, exposure[0] * luminance(sample)), j < ofPart);
    }
    countWhole(&kept);
    WEDGE_STORE_KEPT(kept);
}
#endif

/// Adds a pixel's bins (sinks/sample_bins.h), whose samples are as bright as their mean. Returns how many there are.
WEDGE_FN float addBinCascades(__global const ushort* bins, uint size, uint pixel, float scale, Cascades* cascades)
{
    float samples = 0.0f;
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        const SampleBin bin = loadSampleBin(bins, size, pixel, b);
        if (bin.count > 0u) {
            addToCascades(cascades, scale * luminance(bin.mean), (float)bin.count);
            samples += (float)bin.count;
        }
    }
    return samples;
}

/// The same over bins.
/// out  shares: of each bin, that is kept (kept_bins.cl)
#include "pass/keepBinsReweighted.h"
#ifdef PASS_keepBinsReweighted
__kernel void keepBinsReweighted(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    Cascades own = noCascades(), around = noCascades();
    const float count = addBinCascades(bins, size, i, exposure[0], &own);
    for (int dy = -min(1, (int)y); dy <= min(1, (int)(p.height - 1u - y)); ++dy) {
        for (int dx = -min(1, (int)x); dx <= min(1, (int)(p.width - 1u - x)); ++dx) {
            addBinCascades(bins, size, (uint)((int)i + dy * (int)p.stride + dx), exposure[0], &around);
        }
    }
    float trust[WEDGE_CASCADES];
    trustCascades(&own, &around, fmax(count, 1.0f), kappa, trust);
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        const SampleBin bin = loadSampleBin(bins, size, i, b);
        storeShort(shares, size, i, b, bin.count > 0u ? trustOf(trust, exposure[0] * luminance(bin.mean)) : 1.0f);
    }
}
#endif

/// keepClamped over bins, all of whose samples are as bright as their mean.
/// out  shares: of each bin, that is kept (kept_bins.cl)
#include "pass/keepBinsClamped.h"
#ifdef PASS_keepBinsClamped
__kernel void keepBinsClamped(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        const float l = exposure[0] * luminance(loadSampleBin(bins, p.planeSize, i, b).mean);
        storeShort(shares, p.planeSize, i, b, l > level ? level / l : 1.0f);
    }
}
#endif
