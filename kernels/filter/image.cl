// Filters of images: linear radiance, 3 planes, whatever it shows. Pixels that are not finite in a channel
// are left out of what others are made of, and something is made of those.
#include "core/finite.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "shared/image_filter.h"
#include "shared/maths.h"

/// Of a Gaussian in powers of two, exp(-d^2 / (2 s^2)) = 2^(that d^2 / s^2).
#define WEDGE_GAUSSIAN_LOG2 (-0.72134752f)
#define WEDGE_LOG2_E 1.44269504f
/// The least normal float. Less luminance is as good as none, and some devices take it for 0.
#define WEDGE_LEAST_NORMAL 1.17549435e-38f

/// Black in place of what is not finite.
WEDGE_INLINE Vec3 finiteOrBlack(Vec3 v) { return vecChoose(finiteVec(v), v, vec3(0.0f, 0.0f, 0.0f)); }

/// A weighted mean around a pixel, as base + sum / weights, where sum is of differences from base: so that what is
/// constant stays the same to the bit.
typedef struct {
    Vec3 base; ///< the pixel's own colour; 0 where that is not finite
    Vec3 sum;
    float weights;
} ImageMean;

/// own: of weight 1 if it is finite, else 0.
WEDGE_INLINE ImageMean meanFrom(Vec3 own)
{
    ImageMean mean;
    mean.base = finiteOrBlack(own);
    mean.sum = vec3(0.0f, 0.0f, 0.0f);
    mean.weights = finiteVec(own) ? 1.0f : 0.0f;
    return mean;
}

/// v: finite.
WEDGE_INLINE void addToMean(ImageMean* mean, Vec3 v, float weight)
{
    mean->sum = vecMad(mean->sum, vecSub(v, mean->base), weight);
    mean->weights += weight;
}

/// 0 where nothing finite was there.
WEDGE_INLINE Vec3 meanOf(ImageMean mean)
{
    return vecMad(mean.base, mean.sum, mean.weights > 0.0f ? 1.0f / mean.weights : 0.0f);
}

/// The Gaussian along a line of pixels that are `element` apart, of which so many lie before and after the pixel.
WEDGE_INLINE ImageMean gaussianOfLine(
    __global const float* image, uint planeSize, uint i, int before, int after, int element, float sigma)
{
    const int reach = (int)ceil(WEDGE_IMAGE_CUT * sigma);
    const float falloff = WEDGE_GAUSSIAN_LOG2 / (sigma * sigma);
    ImageMean mean = meanFrom(loadVec(image, planeSize, i));
    for (int k = -min(reach, before); k <= min(reach, after); ++k) {
        const Vec3 v = loadVec(image, planeSize, (uint)((int)i + k * element));
        // The pixel itself has gone in, or is left out.
        if (k != 0 && finiteVec(v)) {
            addToMean(&mean, v, exp2Bounded(falloff * (float)(k * k)));
        }
    }
    return mean;
}

/// A Gaussian along x; beyond the image there is nothing, and weights are divided by their sum.
/// in   image, sigma: pixels
/// out  out: where the image is not finite, the mean of the others; not a number where there is none, so that columns
///      leave it out
#include "pass/imageRows.h"
#ifdef PASS_imageRows
__kernel void imageRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const ImageMean mean = gaussianOfLine(image, p.planeSize, i, (int)x, (int)(p.width - 1u - x), 1, sigma);
    storeVec(out, p.planeSize, i, vecIf(mean.weights > 0.0f, meanOf(mean)));
}
#endif

/// The same along y.
/// in   image, sigma: pixels
/// out  out
#include "pass/imageColumns.h"
#ifdef PASS_imageColumns
__kernel void imageColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    storeVec(out, p.planeSize, i,
        meanOf(gaussianOfLine(image, p.planeSize, i, (int)y, (int)(p.height - 1u - y), (int)p.stride, sigma)));
}
#endif

#include "pass/imageBilateral.h"
#ifdef PASS_imageBilateral
/// The square of how many stops one luminance is brighter than another, both normal. A quotient beyond what floats hold
/// counts as 127 stops or more, as logPositive() takes what is not normal.
WEDGE_INLINE float squaredStops(float there, float here)
{
    const float stops = WEDGE_LOG2_E * logPositive(there / here);
    return stops * stops;
}

/// The bilateral filter (Tomasi and Manduchi, Bilateral Filtering for Gray and Color Images, ICCV 1998), brightness
/// compared in stops: a Gaussian over the square around the pixel, times one over the stops that luminances differ by.
/// What is black is averaged with what is black alone. A pixel that is not finite is not compared: it becomes the plain
/// Gaussian's.
/// in   image, sigma: pixels, tolerance: stops
/// out  out
__kernel void imageBilateral(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const int reach = (int)ceil(WEDGE_IMAGE_CUT * sigma);
    const float falloff = WEDGE_GAUSSIAN_LOG2 / (sigma * sigma);
    const float ofStops = WEDGE_GAUSSIAN_LOG2 / (tolerance * tolerance);
    const Vec3 own = loadVec(image, n, i);
    const bool known = finiteVec(own);
    const float here = luminance(own);
    const int left = -min(reach, (int)x), right = min(reach, (int)(p.width - 1u - x));
    const int top = -min(reach, (int)y), bottom = min(reach, (int)(p.height - 1u - y));
    ImageMean mean = meanFrom(own);
    for (int dy = top; dy <= bottom; ++dy) {
        for (int dx = left; dx <= right; ++dx) {
            const Vec3 v = loadVec(image, n, (uint)((int)i + dy * (int)p.stride + dx));
            if ((dx == 0 && dy == 0) || !finiteVec(v)) {
                continue;
            }
            float power = falloff * (float)(dx * dx + dy * dy);
            if (known) {
                const float there = luminance(v);
                const bool lit = here >= WEDGE_LEAST_NORMAL, litThere = there >= WEDGE_LEAST_NORMAL;
                if (lit != litThere) {
                    continue;
                }
                power += lit ? ofStops * squaredStops(there, here) : 0.0f;
            }
            addToMean(&mean, v, exp2Bounded(power));
        }
    }
    storeVec(out, n, i, meanOf(mean));
}
#endif

/// The mean of the finite pixels in the square around the pixel.
/// in   image, radius: pixels
/// out  out
#include "pass/imageBox.h"
#ifdef PASS_imageBox
__kernel void imageBox(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const int reach = (int)radius;
    const int left = -min(reach, (int)x), right = min(reach, (int)(p.width - 1u - x));
    const int top = -min(reach, (int)y), bottom = min(reach, (int)(p.height - 1u - y));
    ImageMean mean = meanFrom(loadVec(image, n, i));
    for (int dy = top; dy <= bottom; ++dy) {
        for (int dx = left; dx <= right; ++dx) {
            const Vec3 v = loadVec(image, n, (uint)((int)i + dy * (int)p.stride + dx));
            if ((dx != 0 || dy != 0) && finiteVec(v)) {
                addToMean(&mean, v, 1.0f);
            }
        }
    }
    storeVec(out, n, i, meanOf(mean));
}
#endif

#include "pass/imageMedian.h"
#ifdef PASS_imageMedian
/// Adds v to so many sorted numbers, which have room for it.
WEDGE_FN void insertSorted(float* sorted, uint count, float v)
{
    uint at = count;
    for (; at > 0u && sorted[at - 1u] > v; --at) {
        sorted[at] = sorted[at - 1u];
    }
    sorted[at] = v;
}

/// Of at least one number; of an even count the mean of the middle two, which is theirs to the bit where they are
/// equal.
WEDGE_FN float medianOfSorted(const float* sorted, uint count)
{
    const float lower = sorted[(count - 1u) / 2u], upper = sorted[count / 2u];
    return lower + 0.5f * (upper - lower);
}

/// The median of how far they lie from the median. Distances grow to both sides of it, so that the next larger one is
/// always one of two.
WEDGE_FN float deviationOfSorted(const float* sorted, uint count, float median)
{
    uint above = 0u;
    while (above < count && sorted[above] <= median) {
        ++above;
    }
    uint below = above; // those before it are next
    float lower = 0.0f, upper = 0.0f;
    for (uint taken = 0u; taken <= count / 2u; ++taken) {
        lower = upper;
        if (above >= count || (below > 0u && median - sorted[below - 1u] <= sorted[above] - median)) {
            --below;
            upper = median - sorted[below];
        } else {
            upper = sorted[above] - median;
            ++above;
        }
    }
    return count % 2u != 0u ? upper : lower + 0.5f * (upper - lower);
}

/// A channel's value, or the median in its place. known: the pixel is finite, and may stay.
WEDGE_FN float medianOrOwn(const float* sorted, uint count, float own, bool known, float factor)
{
    if (count == 0u) {
        return 0.0f;
    }
    const float median = medianOfSorted(sorted, count);
    if (!known || factor < 0.0f) {
        return median;
    }
    return fabs(own - median) > factor * deviationOfSorted(sorted, count, median) ? median : own;
}

/// Each channel's median over the square around the pixel, or in place of what lies more than `factor` times the median
/// absolute deviation off it alone.
/// in   image, radius: pixels, at most 3; factor: below 0 for the median everywhere
/// out  out: where the image is not finite, the median of the others
__kernel void imageMedian(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const int reach = min((int)radius, WEDGE_IMAGE_MEDIAN_RADIUS);
    const Vec3 own = loadVec(image, n, i);
    const bool known = finiteVec(own);
    const int left = -min(reach, (int)x), right = min(reach, (int)(p.width - 1u - x));
    const int top = -min(reach, (int)y), bottom = min(reach, (int)(p.height - 1u - y));
    float red[WEDGE_IMAGE_MEDIAN_PIXELS], green[WEDGE_IMAGE_MEDIAN_PIXELS], blue[WEDGE_IMAGE_MEDIAN_PIXELS];
    uint count = 0u;
    for (int dy = top; dy <= bottom; ++dy) {
        for (int dx = left; dx <= right; ++dx) {
            const Vec3 v = loadVec(image, n, (uint)((int)i + dy * (int)p.stride + dx));
            if (finiteVec(v)) {
                insertSorted(red, count, v.x);
                insertSorted(green, count, v.y);
                insertSorted(blue, count, v.z);
                ++count;
            }
        }
    }
    storeVec(out, n, i,
        vec3(medianOrOwn(red, count, own.x, known, factor), medianOrOwn(green, count, own.y, known, factor),
            medianOrOwn(blue, count, own.z, known, factor)));
}
#endif

/// What a blur takes away, added once more: image + amount (image - blurred), not below 0.
/// in   image, blurred; amount
/// out  out
#include "pass/sharpenImage.h"
#ifdef PASS_sharpenImage
__kernel void sharpenImage(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 v = finiteOrBlack(loadVec(image, p.planeSize, i));
    const Vec3 sharp = vecMad(v, vecSub(v, finiteOrBlack(loadVec(blurred, p.planeSize, i))), amount);
    storeVec(out, p.planeSize, i, vec3(fmax(sharp.x, 0.0f), fmax(sharp.y, 0.0f), fmax(sharp.z, 0.0f)));
}
#endif

/// What of each pixel is brighter than a luminance, in its colour.
/// in   image, threshold: luminance, at least 0
/// out  out: 0 where the image is not brighter
#include "pass/brightParts.h"
#ifdef PASS_brightParts
__kernel void brightParts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 v = finiteOrBlack(loadVec(image, p.planeSize, i));
    const float l = luminance(v);
    // Not (l - threshold) / l: of no threshold all remains, to the bit.
    storeVec(out, p.planeSize, i, vecScale(v, l > threshold ? 1.0f - threshold / l : 0.0f));
}
#endif

/// Adds three Gaussians of what is bright, the wider the less: image + strength (near / 2 + middle / 3 + far / 6).
/// in   image; near, middle, far: blurred more and more; strength
/// out  out
#include "pass/addBloom.h"
#ifdef PASS_addBloom
__kernel void addBloom(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    Vec3 bloom = vecScale(finiteOrBlack(loadVec(near, n, i)), 1.0f / 2.0f);
    bloom = vecMad(bloom, finiteOrBlack(loadVec(middle, n, i)), 1.0f / 3.0f);
    bloom = vecMad(bloom, finiteOrBlack(loadVec(far, n, i)), 1.0f / 6.0f);
    storeVec(out, n, i, vecMad(finiteOrBlack(loadVec(image, n, i)), bloom, strength));
}
#endif

/// Multiplies by a colour, as much of it as `density` says: 0 leaves the image as it is, to the bit.
/// in   image; red, green, blue: gains; density: 0 to 1
/// out  out
#include "pass/colourImage.h"
#ifdef PASS_colourImage
__kernel void colourImage(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 gain =
        vec3(1.0f + density * (red - 1.0f), 1.0f + density * (green - 1.0f), 1.0f + density * (blue - 1.0f));
    storeVec(out, p.planeSize, i, vecMul(finiteOrBlack(loadVec(image, p.planeSize, i)), gain));
}
#endif
