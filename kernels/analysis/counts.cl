// Sample counts from demands: n = clamp(C demand, least, most), and never fewer than there are, with one C for all
// kinds of samples, such that their rays are what was asked for. demand.cl makes demands of variances.
//
// C is bracketed. Sixteen scales are tried at once: stripes of rows add up what each would take, of each kind of
// samples, and between the two that enclose what was asked for the next sixteen lie. Several devices could add their
// sums up.
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"

/// Where C is looked for, in powers of two.
#define WEDGE_SCALE_LOG2_MIN -40.0f
#define WEDGE_SCALE_LOG2_MAX 60.0f

/// Sixteen numbers in equal proportions, from the first to the last.
WEDGE_FN float16 proportional(float log2First, float log2Last)
{
    const float16 steps =
        (float16)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f, 8.0f, 9.0f, 10.0f, 11.0f, 12.0f, 13.0f, 14.0f, 15.0f);
    return exp2Block(log2First + steps * ((log2Last - log2First) / (float)(WEDGE_SCALES - 1u)));
}

/// The first scales to try. One work-item.
#include "pass/firstScales.h"
#ifdef PASS_firstScales
__kernel void firstScales(PARAMETERS)
{
    if (get_global_id(0) == 0u) {
        vstore16(proportional(WEDGE_SCALE_LOG2_MIN, WEDGE_SCALE_LOG2_MAX), 0, scale);
    }
}
#endif

/// What one kind of samples would take at each scale, in rays: `rays` a sample. Pixels whose mask is 0 take none.
/// add: to what is there of other kinds. out  sums: WEDGE_SCALE_SUMS a stripe of rows
#include "pass/samplesAtScales.h"
#ifdef PASS_samplesAtScales
__kernel void samplesAtScales(PARAMETERS)
{
    const uint stripe = get_global_id(0);
    if (stripe >= WEDGE_SCALE_STRIPES) {
        return;
    }
    const float16 scales = vload16(0, scale);
    float16 sum = (float16)(0.0f);
    float pixels = 0.0f;
    for (uint y = p.y0 + stripe; y < p.y1; y += WEDGE_SCALE_STRIPES) {
        // Row by row: sums of few numbers are more exact.
        float16 ofRow = (float16)(0.0f);
        for (uint x = p.x0; x < p.x1; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            const float there = HAS_taken ? (float)LOAD_taken(p.planeSize, i) : 0.0f;
            const bool takes = !HAS_mask || LOAD_mask(p.planeSize, i) != 0u;
            const float16 n = max16(min16(scales * demand[i], (float16)(most)), (float16)(fmax(least, there)));
            ofRow += takes ? n : (float16)(0.0f);
            pixels += takes ? 1.0f : 0.0f;
        }
        sum += ofRow;
    }
    __global float* out = sums + stripe * WEDGE_SCALE_SUMS;
    vstore16(add != 0u ? vload16(0, out) + rays * sum : rays * sum, 0, out);
    out[WEDGE_SCALES] = pixels;
}
#endif

WEDGE_FN float16 sumOfStripes(__global const float* sums)
{
    float16 sum = (float16)(0.0f);
    for (uint stripe = 0u; stripe < WEDGE_SCALE_STRIPES; ++stripe) {
        sum += vload16(0, sums + stripe * WEDGE_SCALE_SUMS);
    }
    return sum;
}

/// Finds the two scales that enclose `rays` a pixel, what lies between them in proportion, the first kind's mean count
/// there, and the next scales to try. One work-item.
/// in      sums: of the first kind of samples, of one ray each; sumsOfOthers: of all other kinds
/// in out  scale
#include "pass/refineScales.h"
#ifdef PASS_refineScales
__kernel void refineScales(PARAMETERS)
{
    if (get_global_id(0) != 0u) {
        return;
    }
    float first[WEDGE_SCALES], all[WEDGE_SCALES];
    const float16 own = sumOfStripes(sums);
    vstore16(own, 0, first);
#if HAS_sumsOfOthers
    vstore16(own + sumOfStripes(sumsOfOthers), 0, all);
#else
    vstore16(own, 0, all);
#endif
    float pixels = 0.0f;
    for (uint stripe = 0u; stripe < WEDGE_SCALE_STRIPES; ++stripe) {
        pixels += sums[stripe * WEDGE_SCALE_SUMS + WEDGE_SCALES];
    }
    const float asked = rays * pixels;
    uint low = 0u;
    while (low + 2u < WEDGE_SCALES && all[low + 1u] <= asked) {
        ++low;
    }
    const float between = all[low + 1u] - all[low];
    const float share = between > 0.0f ? clamp((asked - all[low]) / between, 0.0f, 1.0f) : 0.0f;
    const float a = scale[low], b = scale[low + 1u];
    scale[WEDGE_SCALE_FOUND] = a + share * (b - a);
    scale[WEDGE_SCALE_MEAN] = (first[low] + share * (first[low + 1u] - first[low])) / fmax(pixels, 1.0f);
    scale[WEDGE_SCALE_EVEN] = 0.0f;
    vstore16(proportional(log2(a), log2(b)), 0, scale);
}
#endif

/// Noise that the image is to have of one kind of samples: the sum of variances over counts, where those are even by
/// none, a quarter, half, three quarters and all of the way. uncertainty: variance of a sample's ray, of the pixel's
/// own samples (demand.cl). add: to what is there of other kinds. out  sums: WEDGE_EVEN_SHARES a stripe of rows
#include "pass/noiseOfCounts.h"
#ifdef PASS_noiseOfCounts
__kernel void noiseOfCounts(PARAMETERS)
{
    const uint stripe = get_global_id(0);
    if (stripe >= WEDGE_SCALE_STRIPES) {
        return;
    }
    const float8 shares = (float8)(0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 1.0f, 1.0f, 1.0f);
    const float found = scale[WEDGE_SCALE_FOUND], mean = scale[WEDGE_SCALE_MEAN];
    float8 sum = (float8)(0.0f);
    for (uint y = p.y0 + stripe; y < p.y1; y += WEDGE_SCALE_STRIPES) {
        float8 ofRow = (float8)(0.0f);
        for (uint x = p.x0; x < p.x1; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            const float n = fmax(clamp(found * demand[i], least, most), (float)LOAD_taken(p.planeSize, i));
            ofRow += fmax(uncertainty[i], 0.0f) / (n + shares * (mean - n));
        }
        sum += ofRow;
    }
    __global float* out = sums + stripe * WEDGE_EVEN_SHARES;
    vstore8(add != 0u ? vload8(0, out) + rays * sum : rays * sum, 0, out);
}
#endif

/// How far the first kind's counts are to be even: where demands, which are of other pixels, say little of those that
/// have them, even counts have less noise. One work-item.
/// in      noise: of the first kind of samples; noiseOfOthers: of all other kinds
/// in out  scale
#include "pass/shareOfEven.h"
#ifdef PASS_shareOfEven
/// For a smaller gain, in parts of all noise, counts are not even: what tells of it is noisy.
#define WEDGE_LEAST_GAIN 0.1f

__kernel void shareOfEven(PARAMETERS)
{
    if (get_global_id(0) != 0u) {
        return;
    }
    float of[WEDGE_EVEN_SHARES];
    float8 own = (float8)(0.0f);
    float all = 0.0f;
    for (uint stripe = 0u; stripe < WEDGE_SCALE_STRIPES; ++stripe) {
        own += vload8(stripe, noise);
#if HAS_noiseOfOthers
        all += noiseOfOthers[stripe * WEDGE_EVEN_SHARES];
#endif
    }
    vstore8(own, 0, of);
    uint best = 0u;
    for (uint k = 1u; k <= 4u; ++k) {
        best = of[k] < of[best] ? k : best;
    }
    scale[WEDGE_SCALE_EVEN] = of[0] - of[best] > WEDGE_LEAST_GAIN * (of[0] + all) ? 0.25f * (float)best : 0.0f;
}
#endif

/// Wanted samples: clamp(C demand, least, most), nearer to the mean by the share of the way that counts are even
/// (evens), to the nearest, and never less than `taken`; 0 where the mask is.
#include "pass/countsFromDemand.h"
#ifdef PASS_countsFromDemand
__kernel void countsFromDemand(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float asked = clamp(scale[WEDGE_SCALE_FOUND] * demand[i], least, most);
    const float n = evens != 0u ? asked + scale[WEDGE_SCALE_EVEN] * (scale[WEDGE_SCALE_MEAN] - asked) : asked;
    const uint count = max((uint)(n + 0.5f), (uint)LOAD_taken(p.planeSize, i));
    wanted[i] = !HAS_mask || LOAD_mask(p.planeSize, i) != 0u ? count : 0u;
}
#endif

/// The same count for every pixel of the mask.
#include "pass/uniformCounts.h"
#ifdef PASS_uniformCounts
__kernel void uniformCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    wanted[i] = mask[i] != 0u ? count : 0u;
}
#endif
