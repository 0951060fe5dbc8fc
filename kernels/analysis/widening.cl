// Where a term's filter is narrow and its samples do not say that it has to be, it is widened.
//
// A width follows from the nearest occluder or reflector that a pixel's first rays found. Where a surface shadows
// itself, or something small is near and all else is far, that is next to no width, and pixels keep the noise of their
// own samples. So pixels whose width is less than a few pixels are filtered twice, with it (n) and with those few
// pixels (w). Of the blend n + t (w - n) that t has the least error, as James and Stein's has (shrink.h), for which
//
//     t = max(0, (c V - r (D - q c V)) / D)
//
// with D the mean of (n - w)^2 over the pixels of the object around and V what noise makes of n's error that w does not
// have in common with it. With v the variance of a pixel's own mean, and Gaussians that amount to K_n and K_w equal
// pixels, one inside the other, n has the variance v / K_n, in common with w 2 v / (K_n + K_w), and their difference
// has q V, q = 1 - K_n / K_w. What else is in D is bias, of which n has a part already: bias goes with the square of
// widths, so that it is r = K_n / (K_w - K_n) times what w has more. The pixel's filter gets a width that is as far
// between both widths. That blurs edges more than the blend and keeps less noise.
#define WEDGE_GATHER_CHANNELS 1

#include "analysis/deviation.h"
#include "analysis/shrink.h"
#include "core/formats.h"
#include "filter/gather.h"
#include "shared/bsdf.h"
#include "shared/path.h"

/// The widths to compare with, `pixels` on the surfaces that a block of pixels sees, in metres: projectedPixel() of
/// sixteen. normal: without its map
WEDGE_FN float16 comparedWidth16(FrameParams frame, float pixels, Vec3x16 position, Vec3x16 normal)
{
    const Vec3x16 ray = sub16(position, splat3(frame.eye));
    const float16 squared = max16(dot16(ray, ray), (float16)(1e-30f)), inverse = rsqrt(squared);
    // Solid angle of a pixel off the axis: area / distance^2 times the cosine to the image plane.
    const float16 axis = max16(
        (ray.x * frame.forward.x + ray.y * frame.forward.y + ray.z * frame.forward.z) * inverse, (float16)(1e-10f));
    const float16 facing = fabs(dot16(normal, ray)) * inverse;
    const float pixel = vecLength(vecCross(frame.right, frame.down));
    return pixels * sqrt(pixel * squared * axis * axis * axis / max16(facing, (float16)(WEDGE_MIN_VIEW_COSINE)));
}

#define COMPARED_WIDTH(i)                                                                                              \
    comparedWidth16(frame, pixels, LOAD16_position(p.planeSize, i),                                                    \
        WEDGE_OF_FORMAT(load16_unmapped, FORMAT_normal)(normal, p.planeSize, i))

/// The widths to compare with, where a pixel's own is narrower; 0 where it is not or nothing is noisy, -1 where it has
/// none.
/// in   deviation: of the value that is filtered; beta, metres
/// out  compared: metres
#include "pass/comparedWidths.h"
#ifdef PASS_comparedWidths
__kernel void comparedWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 own = loadBlock(beta, i);
    const int16 has = (loadIdBlock(objectId, i) != 0u) & (own >= 0.0f);
    // Where there is no noise in the block or in those whose squares count where its own do, V is 0, and no width
    // changes.
    const int reach = 3 * WEDGE_SHRINK_REACH, block = (int)WEDGE_BLOCK_PIXELS;
    const int first = x >= WEDGE_BLOCK_PIXELS ? -block : 0, last = x + WEDGE_BLOCK_PIXELS < p.width ? block : 0;
    const int end = min((int)(p.height - 1u - y), reach);
    bool noisy = false;
    for (int dy = -min((int)y, reach); !noisy && dy <= end; ++dy) {
        for (int dx = first; dx <= last; dx += block) {
            noisy = noisy || any(LOAD16_deviation(p.planeSize, i + dy * (int)p.stride + dx) != 0.0f);
        }
    }
    const float16 wide = noisy ? COMPARED_WIDTH(i) : (float16)(0.0f);
    vstore16(!has ? (float16)(-1.0f) : own < wide ? wide : (float16)(0.0f), 0, compared + i);
}
#endif

/// Of pixels that are the receivers, a light in one number: what is seen of it, diffuse and specular together.
/// in   value: diffuse and, where something is specular, specular visibility, and both of the first of two parts of the
///      samples; taken: these samples; sums: of them, see light_sampling.h
/// out  visibility; deviation, as deviation16() has it; weights: the luminance that is reflected where all is visible,
///      1/m^2
#include "pass/oneOfLight.h"
#ifdef PASS_oneOfLight
__kernel void oneOfLight(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const uint16 count = loadIdBlock(taken, i);
    const float16 scale = 1.0f / max16(convert_float16(count), (float16)(1.0f));
    float16 weight = WEDGE_INV_PI * luminance16(loadVecBlock(diffuse, size, i)) * loadBlock(sums, i) * scale;
#ifdef WEDGE_SPECULAR
    const float16 mirrored = luminance16(loadVecBlock(specular, size, i)) * loadBlock(sums + 2u * size, i) * scale;
    const float16 seen = weight * loadBlock(value, i) + mirrored * loadBlock(value + size, i);
    const float16 first = weight * loadShortsBlock(parts, size, i, 0u) + mirrored * loadShortsBlock(parts, size, i, 1u);
    weight += mirrored;
#else
    (void)specular;
    const float16 seen = weight * loadBlock(value, i), first = weight * loadShortsBlock(parts, size, i, 0u);
#endif
    storeOne(weight, seen, first, count, firstPass, i, visibility, deviation, weights);
}
#endif

/// The same of indirect light: the irradiance that is reflected.
/// in       reflectance: 3 planes; component: WEDGE_COMPONENT_*; of ambient occlusion all is reflected; fractions: 1:
///          sums are those of fractions (path_sampling.h)
///          parts: of the first part, colours in 48 bits; taken: samples
/// in out   value: sums of the samples, 3 planes, of which the means are made, and one in whose place comes the square
///          of the deviation, for filters (fallback.cl)
#include "pass/oneOfPaths.h"
#ifdef PASS_oneOfPaths
__kernel void oneOfPaths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3x16 k =
        component == WEDGE_COMPONENT_AMBIENT ? splat3(vec3(1.0f, 1.0f, 1.0f)) : loadVecBlock(reflectance, size, i);
    const uint16 count = loadIdBlock(taken, i);
    const float16 scale = 1.0f / max16(convert_float16(count), (float16)(1.0f));
    Vec3x16 all = loadVecBlock(value, size, i);
    Vec3x16 ofPart = LOAD16_parts(size, i);
    if (fractions != 0u) {
        const float16 whole = loadBlock(value + 3u * size, i);
        // Where no sample would have brought anything, nothing is hidden: 0 would darken neighbours.
        const float16 none = count != 0u ? (float16)(1.0f) : (float16)(0.0f);
        all.x = all.y = all.z = whole > 0.0f ? luminance16(all) / whole : none;
        ofPart.x = ofPart.y = ofPart.z = ofPart.y > 0.0f ? ofPart.x / ofPart.y : all.x;
    } else {
        all.x *= scale;
        all.y *= scale;
        all.z *= scale;
    }
    storeOne(luminance16(k), luminance16(mul16(k, all)), luminance16(mul16(k, ofPart)), count, firstPass, i, irradiance,
        deviation, weights);
    const float16 d = loadBlock(deviation, i);
    vstore16(all.x, 0, value + i);
    vstore16(all.y, 0, value + size + i);
    vstore16(all.z, 0, value + 2u * size + i);
    vstore16(d * d, 0, value + 3u * size + i);
}
#endif

/// One plane filtered with two widths at once, with pixels' own and with what these are compared with, as gather.h does
/// it. Pixels that are not compared keep their own value. A value so far, and the equal samples that it amounts to:
typedef struct {
    float16 value, count;
} LineMean;

typedef struct {
    LineMean narrow, wide;
} LineMeans;

WEDGE_INLINE GatherSum sumFrom(float16 own)
{
    GatherSum sum;
    sum.weights = ownWeight();
    sum.channel[0] = own;
    sum.moment[0] = (float16)(0.0f);
    return sum;
}

WEDGE_INLINE LineMean meanOf(FilterParams p, const GatherSum* sum, int16 gathers, LineMean before)
{
    LineMean mean;
    mean.value = gathers ? valueOfLine(p, sum, fitOf(sum->weights), 0u) : before.value;
    mean.count = before.count * (gathers ? countOfLine(sum->weights, p.fitted != 0u) : (float16)(1.0f));
    return mean;
}

/// Of a block of pixels; own: what they have so far; before, after: pixels that the line goes on to. narrow, wide:
/// planes of values along the line, which may be the same one. Where compared is 0 nothing is gathered and no neighbour
/// narrowed, where it is less there is no value to take.
WEDGE_INLINE LineMeans compareLine(FilterParams p, int i, int element, Vec3 step, int before, int after,
    __global const float* narrow, __global const float* wide, __global const float* beta,
    __global const float* compared, __global const float* position, __global const float* normal,
    __global const float* pixelSize, __global const uint* objectId, LineMeans own)
{
    const float16 wideHere = loadBlock(compared, i), narrowHere = loadBlock(beta, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 gathers = (wideHere > 0.0f) & (object != 0u), narrowGathers = gathers & (narrowHere > 0.0f);
    if (!any(gathers)) {
        return own;
    }
    const GatherBlock b = gatherBlock(p, i, object, position, normal, pixelSize);
    const GatherWidth ofWide = gatherWidth(p, b, step, gathers, wideHere),
                      ofNarrow = gatherWidth(p, b, step, narrowGathers, narrowHere);
    GatherSum wideSum = sumFrom(own.wide.value), narrowSum = sumFrom(own.narrow.value);
    const int radius = (int)largestOf(ofWide.radius), narrowRadius = (int)largestOf(ofNarrow.radius);
    for (int k = -min(radius, before); k <= min(radius, after); ++k) {
        if (k == 0) {
            continue;
        }
        const int j = i + k * element;
        const float steps = (float)k;
        const float16 wideThere = loadBlock(compared, j);
        const Neighbours n = neighboursAt(p, b, j, wideThere, position, normal, pixelSize, objectId);
        const float16 w = neighbourWeights(p, ofWide, n, wideThere, fabs(steps));
        addWeight(&wideSum.weights, w, steps);
        addValue(&wideSum, 0u, w, steps, loadBlock(wide, j));
        if (abs(k) <= (uint)narrowRadius) {
            const float16 narrowThere = wideThere > 0.0f ? loadBlock(beta, j) : (float16)(0.0f);
            const float16 v = neighbourWeights(p, ofNarrow, n, narrowThere, fabs(steps));
            addWeight(&narrowSum.weights, v, steps);
            addValue(&narrowSum, 0u, v, steps, loadBlock(narrow, j));
        }
    }
    LineMeans means;
    means.narrow = meanOf(p, &narrowSum, narrowGathers, own.narrow);
    means.wide = meanOf(p, &wideSum, gathers, own.wide);
    return means;
}

/// Along x.
/// in   value; beta: widths, metres; compared: those to compare with, 0 where beta is not less than they are or there
///      is no need to, -1 where there is no value
/// out  of both: rows filtered, and equal samples that they amount to
#include "pass/compareRows.h"
#ifdef PASS_compareRows
__kernel void compareRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    LineMeans own;
    own.narrow.value = own.wide.value = loadBlock(value, i);
    own.narrow.count = own.wide.count = (float16)(1.0f);
    const LineMeans means = compareLine(p, i, 1, p.right, WEDGE_MAX_RADIUS, WEDGE_MAX_RADIUS, value, value, beta,
        compared, position, normal, pixelSize, objectId, own);
    vstore16(means.narrow.value, 0, narrowRows + i);
    vstore16(means.wide.value, 0, wideRows + i);
    vstore16(means.narrow.count, 0, narrowCounts + i);
    vstore16(means.wide.count, 0, wideCounts + i);
}
#endif

/// Along y.
/// in      rows that compareRows() made
/// in out  difference: in the place of its narrow counts comes n - w; apart: in that of its wide counts what the
///         variance of a pixel's mean is to be multiplied by for V, 0 where the wide filter does not gather more
#include "pass/compareColumns.h"
#ifdef PASS_compareColumns
__kernel void compareColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    LineMeans own;
    own.narrow.value = loadBlock(narrowRows, i);
    own.wide.value = loadBlock(wideRows, i);
    own.narrow.count = loadBlock(difference, i);
    own.wide.count = loadBlock(apart, i);
    const LineMeans means = compareLine(p, i, (int)p.stride, p.down, (int)y, (int)(p.height - 1u - y), narrowRows,
        wideRows, beta, compared, position, normal, pixelSize, objectId, own);
    const float16 k = means.narrow.count, kWide = means.wide.count;
    vstore16(means.narrow.value - means.wide.value, 0, difference + i);
    vstore16(kWide > k ? 1.0f / k - 2.0f / (k + kWide) : (float16)(0.0f), 0, apart + i);
}
#endif

/// What is averaged, both of what is shown and not of irradiances, which may be noisy where there is little of them to
/// see.
/// in   difference, apart: of compareColumns(); deviation: its square is v; weights: of what n and w are multiplied by
/// out  squares: (n - w)^2; variance: V. Both are 0 where the wide filter does not gather more.
#include "pass/widenSquares.h"
#ifdef PASS_widenSquares
__kernel void widenSquares(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 ofVariance = loadBlock(apart, i), t = loadBlock(weights, i);
    const int16 wider = ofVariance > 0.0f;
    const float16 own = t * LOAD16_deviation(p.planeSize, i), d = t * loadBlock(difference, i);
    vstore16(wider ? own * own * ofVariance : (float16)(0.0f), 0, variance + i);
    vstore16(wider ? d * d : (float16)(0.0f), 0, squares + i);
}
#endif

/// t of the head of this file. ratio: of the squared widths
WEDGE_FN float16 wideShare(float16 difference, float16 variance, float16 ratio)
{
    const float16 rest = max16(1.0f - ratio, (float16)(1e-3f));
    const float16 bias = max16(difference - rest * variance, (float16)(0.0f));
    const float16 share = (variance - ratio / rest * bias) / max16(difference, (float16)(1e-36f));
    return min16(max16(share, (float16)(0.0f)), (float16)(1.0f));
}

/// in   noise: c; difference, variance: of widenSquares(); beta, metres
/// out  shares: t; -1 of pixels that have no wider filter to compare with
#include "pass/wideShares.h"
#ifdef PASS_wideShares
__kernel void wideShares(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    vstore16((float16)(-1.0f), 0, shares + i);
    const int16 differs = (loadIdBlock(objectId, i) != 0u) & (loadBlock(difference, i) > 0.0f);
    if (!any(differs)) {
        return;
    }
    const SquaresAround around = squaresAround(p, y, i, objectId, difference, variance);
    const float16 wide = COMPARED_WIDTH(i), own = loadBlock(beta, i);
    const float16 ratio = own * own / max16(wide * wide, (float16)(1e-30f));
    const float16 share = wideShare(around.difference, noise * around.variance, ratio);
    // Of a sum that is no number nothing follows.
    const int16 known = differs & (around.difference > 0.0f);
    vstore16(known ? share : (float16)(-1.0f), 0, shares + i);
}
#endif

/// Widths by the mean of the shares around: where it changes from pixel to pixel a filter takes more from one side than
/// from the other, as pairs are weighted by the narrower of both, and shifts what has a gradient.
/// in out  beta, metres
#include "pass/widen.h"
#ifdef PASS_widen
__kernel void widen(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 own = loadBlock(shares, i);
    if (!any((own >= 0.0f) & (loadIdBlock(objectId, i) != 0u))) {
        return;
    }
    const uint16 object = loadIdBlock(objectId, i);
    float16 sum = (float16)(0.0f), count = (float16)(0.0f);
    const int reach = (int)WEDGE_SHRINK_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const float16 share = loadBlock(shares, j);
            const int16 taken = (loadIdBlock(objectId, j) == object) & (share >= 0.0f);
            sum += taken ? share : (float16)(0.0f);
            count += taken ? (float16)(1.0f) : (float16)(0.0f);
        }
    }
    const int16 compared = (object != 0u) & (own >= 0.0f);
    const float16 narrow = loadBlock(beta, i), wide = COMPARED_WIDTH(i);
    const float16 mean = sum / max16(count, (float16)(1.0f));
    vstore16(compared ? narrow + mean * max16(wide - narrow, (float16)(0.0f)) : narrow, 0, beta + i);
}
#endif
