// Path density (DeCoro et al., Density-based Outlier Rejection in Monte Carlo Rendering, 2010): samples that lie alone
// among those of their pixel and its neighbours, in the image and in colour, are left out. The distance of two samples
// is that of their pixels plus that of their colours, d = |dx| + |dLab| / 20, at most 4: so nothing beyond 4 pixels
// counts, and a band of rows with as many around it has all that there is to know. How alone a sample is, its
// isolation, is its mean distance to the k nearest. Colours may be RGB instead (sinks/band_samples.h): nothing here
// asks what their three numbers are. Neighbours may be approximate, by a factor `stretch` = 1 + epsilon (Arya et al.,
// An Optimal Algorithm for Approximate Nearest Neighbor Searching, 1998): what is passed over is by no more than that
// nearer than the farthest of those that are found, so the nth nearest is at most that often as far as the true one.
#include "filter/kept.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"
#include "sinks/sample_bins.h"

/// Pixels around one by their distance, nearest first: all that are nearer than WEDGE_SAMPLE_REACH. x, y.
__constant char densityOffsets[] = { 0, 0, -1, 0, 0, -1, 0, 1, 1, 0, -1, -1, -1, 1, 1, -1, 1, 1, -2, 0, 0, -2, 0, 2, 2,
    0, -2, -1, -2, 1, -1, -2, -1, 2, 1, -2, 1, 2, 2, -1, 2, 1, -2, -2, -2, 2, 2, -2, 2, 2, -3, 0, 0, -3, 0, 3, 3, 0, -3,
    -1, -3, 1, -1, -3, -1, 3, 1, -3, 1, 3, 3, -1, 3, 1, -3, -2, -3, 2, -2, -3, -2, 3, 2, -3, 2, 3, 3, -2, 3, 2 };
#define WEDGE_DENSITY_PIXELS 45u

/// How far the pixel with number `o` is from the one in the middle.
WEDGE_INLINE float densityDistance(uint o)
{
    const int dx = densityOffsets[2u * o], dy = densityOffsets[2u * o + 1u];
    return sqrt((float)(dx * dx + dy * dy));
}

/// Its index; false beyond the image.
WEDGE_INLINE bool densityPixel(AnalysisParams p, uint x, uint y, uint o, uint* index)
{
    const int u = (int)x + densityOffsets[2u * o], v = (int)y + densityOffsets[2u * o + 1u];
    *index = pixelIndex((uint)u, (uint)v, p.stride);
    return u >= 0 && v >= 0 && u < (int)p.width && v < (int)p.height;
}

/// The k least distances so far of one sample; as many are the largest there is as are not known.
typedef struct {
    float distance[WEDGE_MOST_NEAREST];
    float sum, largest;
    uint at; ///< of the largest
    uint k;
} Nearest;

WEDGE_FN void nothingNear(Nearest* nearest, uint k)
{
    nearest->k = k;
    for (uint i = 0u; i < k; ++i) {
        nearest->distance[i] = (float)WEDGE_SAMPLE_REACH;
    }
    nearest->sum = (float)(k * WEDGE_SAMPLE_REACH);
    nearest->largest = (float)WEDGE_SAMPLE_REACH;
    nearest->at = 0u;
}

/// d: less than the largest, in whose place it comes.
WEDGE_FN void addNear(Nearest* nearest, float d)
{
    nearest->sum += d - nearest->largest;
    nearest->distance[nearest->at] = d;
    nearest->largest = nearest->distance[0];
    nearest->at = 0u;
    for (uint i = 1u; i < nearest->k; ++i) {
        const bool larger = nearest->distance[i] > nearest->largest;
        nearest->largest = larger ? nearest->distance[i] : nearest->largest;
        nearest->at = larger ? i : nearest->at;
    }
}

/// One pixel's colours of sixteen samples from `at` on.
typedef struct {
    float16 l, a, b;
} Colours16;

WEDGE_INLINE Colours16 storedColours16(const StoredSamples* s, size_t at)
{
    Colours16 c;
    c.l = as_float16(convert_uint16(vload16(0, s->colours + at)) << 16);
    c.a = as_float16(convert_uint16(vload16(0, s->colours + at + s->perPixel)) << 16);
    c.b = as_float16(convert_uint16(vload16(0, s->colours + at + 2u * s->perPixel)) << 16);
    return c;
}

/// That of one.
WEDGE_INLINE Vec3 storedColour(const StoredSamples* s, size_t at)
{
    return vec3(unpackShort(s->colours[at]), unpackShort(s->colours[at + s->perPixel]),
        unpackShort(s->colours[at + 2u * s->perPixel]));
}

WEDGE_INLINE float16 colourDistance16(Colours16 c, Vec3 other)
{
    const float16 dl = c.l - other.x, da = c.a - other.y, db = c.b - other.z;
    return sqrt(dl * dl + da * da + db * db);
}

/// Which of sixteen come before the end.
WEDGE_INLINE int16 before16(uint first, uint end)
{
    const int16 steps = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return steps + (int)first < (int)end;
}

/// Adds the samples of one pixel, `dx` pixels away, to the nearest of sample `own`, whose index is `self` where it is
/// of that pixel. enough: the sum with which no more are wanted.
WEDGE_FN void addPixel(
    const StoredSamples* s, uint pixel, float dx, Vec3 own, uint self, float enough, Nearest* nearest)
{
    const uint count = s->drawn[pixel];
    const size_t first = firstStored(pixel, s->slots, s->perPixel);
    for (uint j = 0u; j < count && nearest->sum > enough; j += 16u) {
        const float16 d = dx + colourDistance16(storedColours16(s, first + j), own);
        const int16 nearer = before16(j, count) & (d < nearest->largest);
        if (!any(nearer)) {
            continue;
        }
        float distances[16];
        int is[16];
        vstore16(d, 0, distances);
        vstore16(nearer, 0, is);
        for (uint lane = 0u; lane < 16u; ++lane) {
            if (is[lane] != 0 && j + lane != self && distances[lane] < nearest->largest) {
                addNear(nearest, distances[lane]);
            }
        }
    }
}

/// The isolation of sample `index` of a pixel; anything up to `enough` where it is no more than that.
WEDGE_FN float isolationOf(
    const StoredSamples* s, AnalysisParams p, uint x, uint y, uint index, uint k, float stretch, float enough)
{
    const uint i = pixelIndex(x, y, p.stride);
    const Vec3 own = storedColour(s, firstStored(i, s->slots, s->perPixel) + index);
    Nearest nearest;
    nothingNear(&nearest, k);
    for (uint o = 0u; o < WEDGE_DENSITY_PIXELS; ++o) {
        const float far = densityDistance(o);
        if (stretch * far >= nearest.largest || nearest.sum <= enough * (float)k) {
            break;
        }
        uint j;
        if (!densityPixel(p, x, y, o, &j) || s->drawn[j] == 0u) {
            continue;
        }
        // No sample there is nearer than the range of colours' first number is, whatever that is: a Euclidean distance
        // is not below the difference of one of its coordinates.
        const float low = s->ranges[2u * (j % s->slots)], high = s->ranges[2u * (j % s->slots) + 1u];
        if (stretch * (far + fmax(0.0f, fmax(low - own.x, own.x - high))) < nearest.largest) {
            addPixel(s, j, far, own, o == 0u ? index : s->perPixel, enough * (float)k, &nearest);
        }
    }
    // Sums of differences may end a little off: what has ended early is not above what it has ended at.
    const float mean = fmax(nearest.sum / (float)k, 0.0f);
    return nearest.sum <= enough * (float)k ? fmin(mean, enough) : mean;
}

/// Of sixteen samples of a pixel from `first` on, which have k others of the pixel itself within `within`: those have
/// no larger isolation.
WEDGE_FN int16 amongOthers(const StoredSamples* s, uint i, uint first, uint k, float within)
{
    const uint count = s->drawn[i];
    const size_t start = firstStored(i, s->slots, s->perPixel);
    const Colours16 own = storedColours16(s, start + first);
    const int16 wanted = before16(first, count);
    int16 near = 1; // each is near to itself
    for (uint j = 0u; j < count; ++j) {
        const float16 d = colourDistance16(own, storedColour(s, start + j));
        near += d <= within; // -1 for each
        if (j % 8u == 7u && all((near <= -(int)k) | ~wanted)) {
            break;
        }
    }
    return near <= -(int)k;
}

/// What is kept of the samples of a band's pixels: a sample whose isolation is up to `low` whole, one of `high` or more
/// not at all, and in between in proportion. A pixel keeps its least isolated sample, whatever that is.
/// in   drawn, radiance, colours, ranges: stored samples; k: nearest, up to WEDGE_MOST_NEAREST; stretch: 1, or that
///      of approximate neighbours; firstPass: of parts
/// out  sums, excess, parts (kept.h), taken: samples; notFinite: those of them that are left out for it; density: mean
///      isolation
#include "pass/keepByDensity.h"
#ifdef PASS_keepByDensity
__kernel void keepByDensity(PARAMETERS)
{
    WEDGE_KEPT_PIXEL(p, x, y, i, count)
    (void)exposure; // colours have it
    const StoredSamples stored = { radiance, colours, ranges, drawn, slots, perPixel };
    const uint ofPart = firstPart(count, firstPass);
    Kept kept = nothingKept();
    float isolations = 0.0f, least = INFINITY;
    uint plainest = 0u;
    for (uint first = 0u; first < count; first += 16u) {
        int among[16];
        vstore16(HAS_density ? (int16)(0) : amongOthers(&stored, i, first, k, low), 0, among);
        for (uint lane = 0u; lane < 16u && first + lane < count; ++lane) {
            const uint j = first + lane;
            const float isolation =
                among[lane] != 0 ? 0.0f : isolationOf(&stored, p, x, y, j, k, stretch, HAS_density ? 0.0f : low);
            isolations += isolation;
            const Vec3 sample = storedRadiance(&stored, i, j);
            plainest = isolation < least && finiteVec(sample) ? j : plainest;
            least = finiteVec(sample) ? fmin(least, isolation) : least;
            const float weight = isolation <= low ? 1.0f : fmax(0.0f, (high - isolation) / (high - low));
            keepSample(&kept, sample, weight, j < ofPart);
        }
    }
    if (kept.count > 0u && kept.weight < WEDGE_LEAST_KEPT) {
        keepOnly(&kept, storedRadiance(&stored, i, plainest));
    }
    storeKept(&kept, p.planeSize, i, count, sums, excess, HAS_parts ? (__global float*)PLANE_parts : 0);
    taken[i] = count;
    notFinite[i] = count - kept.count;
#if HAS_density
    density[i] = isolations / (float)count;
#else
    (void)isolations;
#endif
}
#endif

/// The same where samples are known by bins of brightness: all of a bin are as far from others as its mean is, and no
/// distance from each other.
typedef struct {
    __global const ushort* bins;
    uint size;
    float exposure;
} BinnedSamples;

/// Colour of a bin's mean, in pixels.
WEDGE_INLINE Vec3 binColour(const BinnedSamples* s, SampleBin bin)
{
    return vecScale(labOf(vecScale(bin.mean, s->exposure)), 1.0f / WEDGE_LAB_PIXEL);
}

/// Adds a pixel's bins, `far` pixels away, to the nearest of a sample whose colour is `own`. self: its bin, where it is
/// of that pixel; else WEDGE_SAMPLE_BINS
WEDGE_FN void addBinsOf(
    const BinnedSamples* s, uint pixel, float far, Vec3 own, uint self, float stretch, Nearest* nearest)
{
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        // No bin is nearer than its ends are, but for rounding.
        const float begin = b > 0u ? sampleBinEnds[b - 1u] : -INFINITY;
        const float end = b + 1u < WEDGE_SAMPLE_BINS ? sampleBinEnds[b] : INFINITY;
        if (stretch * (far + 0.99f * fmax(begin - own.x, own.x - end)) >= nearest->largest) {
            continue;
        }
        const SampleBin bin = loadSampleBin(s->bins, s->size, pixel, b);
        uint count = bin.count - (b == self ? 1u : 0u);
        if (count == 0u) {
            continue;
        }
        const float d = b == self ? far : far + vecLength(vecSub(binColour(s, bin), own));
        for (; count > 0u && d < nearest->largest; --count) {
            addNear(nearest, d);
        }
    }
}

/// The isolation of the samples of a pixel's bin; anything up to `enough` where it is no more than that.
WEDGE_FN float isolationOfBin(
    const BinnedSamples* s, AnalysisParams p, uint x, uint y, uint bin, Vec3 own, uint k, float stretch, float enough)
{
    Nearest nearest;
    nothingNear(&nearest, k);
    for (uint o = 0u; o < WEDGE_DENSITY_PIXELS; ++o) {
        const float far = densityDistance(o);
        if (stretch * far >= nearest.largest || nearest.sum <= enough * (float)k) {
            break;
        }
        uint j;
        if (densityPixel(p, x, y, o, &j)) {
            addBinsOf(s, j, far, own, o == 0u ? bin : WEDGE_SAMPLE_BINS, stretch, &nearest);
        }
    }
    return fmax(nearest.sum / (float)k, 0.0f);
}

/// What is kept of the samples of each of a pixel's bins, as keepByDensity keeps them.
/// in   bins; exposure; k, low, high, stretch
/// out  shares: of each bin (kept_bins.cl); density: mean isolation
#include "pass/keepBinsByDensity.h"
#ifdef PASS_keepBinsByDensity
__kernel void keepBinsByDensity(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const BinnedSamples binned = { bins, size, exposure[0] };
    float isolations = 0.0f, least = INFINITY, weight = 0.0f;
    uint count = 0u, plainest = 0u;
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        const SampleBin bin = loadSampleBin(bins, size, i, b);
        float share = 1.0f;
        if (bin.count > 0u) {
            const float isolation = bin.count > k
                ? 0.0f
                : isolationOfBin(&binned, p, x, y, b, binColour(&binned, bin), k, stretch, HAS_density ? 0.0f : low);
            share = isolation <= low ? 1.0f : fmax(0.0f, (high - isolation) / (high - low));
            plainest = isolation < least ? b : plainest;
            least = fmin(least, isolation);
            isolations += isolation * (float)bin.count;
            count += bin.count;
            weight += share * (float)bin.count;
        }
        storeShort(shares, size, i, b, share);
    }
    if (weight < WEDGE_LEAST_KEPT && count > 0u) {
        storeShort(shares, size, i, plainest, 1.0f);
    }
#if HAS_density
    density[i] = count > 0u ? isolations / (float)count : 0.0f;
#else
    (void)isolations;
#endif
}
#endif
