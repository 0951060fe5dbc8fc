// From the distances of reflectors to filter widths, and to sample counts.
//
// Published (thesis section 4.5): widths and counts from each pixel's least and largest distance. Default: widths from
// the harmonic mean of distances, counts from the variance of what the filter gathers.
#include "core/formats.h"
#include "core/vector16.h"
#include "shared/indirect.h"
#include "shared/path.h"

/// Bounds of what the camera sees, one stripe of rows each: planes of WEDGE_EXTENT_STRIPES least x, y, z and largest x,
/// y, z.
#include "pass/visibleBounds.h"
#ifdef PASS_visibleBounds
__kernel void visibleBounds(PARAMETERS)
{
    const uint stripe = get_global_id(0);
    if (stripe >= WEDGE_EXTENT_STRIPES) {
        return;
    }
    for (uint axis = 0u; axis < 3u; ++axis) {
        float16 least = (float16)(INFINITY);
        float16 largest = (float16)(-INFINITY);
        for (uint y = stripe; y < p.height; y += WEDGE_EXTENT_STRIPES) {
            for (uint x = 0u; x < p.width; x += WEDGE_BLOCK_PIXELS) {
                const int i = (int)pixelIndex(x, y, p.stride);
                const int16 surface = loadIdBlock(objectId, i) != 0u;
                const float16 at = loadBlock(position + axis * p.planeSize, i);
                least = surface ? min16(least, at) : least;
                largest = surface ? max16(largest, at) : largest;
            }
        }
        bounds[axis * WEDGE_EXTENT_STRIPES + stripe] = -largestOf(-least);
        bounds[(3u + axis) * WEDGE_EXTENT_STRIPES + stripe] = largestOf(largest);
    }
}
#endif

/// Largest dimension of the bounds, metres; 0 where nothing is seen. One work-item.
#include "pass/visibleExtent.h"
#ifdef PASS_visibleExtent
__kernel void visibleExtent(PARAMETERS)
{
    if (get_global_id(0) != 0u) {
        return;
    }
    float size = 0.0f;
    for (uint axis = 0u; axis < 3u; ++axis) {
        float least = INFINITY;
        float largest = -INFINITY;
        for (uint s = 0u; s < WEDGE_EXTENT_STRIPES; ++s) {
            least = fmin(least, bounds[axis * WEDGE_EXTENT_STRIPES + s]);
            largest = fmax(largest, bounds[(3u + axis) * WEDGE_EXTENT_STRIPES + s]);
        }
        size = fmax(size, largest - least);
    }
    extent[0] = size;
}
#endif

/// Image widths that what the camera sees counts as at most, as wide as they are where a pixel's surface is.
#define WEDGE_MOST_VIEWS 4.0f

/// The least distances that count, metres: a fraction of what the camera sees, but no more of what lies far beyond the
/// pixel's surface than a few times what the image shows there, or floors that go on to the horizon would make all
/// filters wide. size: of pixels
WEDGE_FN float16 leastDistances(ReflectorParams p, __global const float* extent, float16 size)
{
    const float16 view = WEDGE_MOST_VIEWS * (float)max(p.width, p.height) * size;
    const float16 seen = p.extent > 0.0f ? (float16)(p.extent) : min16((float16)(extent[0]), view);
    return max16(p.leastReflector * seen, (float16)(1e-12f));
}

/// Bandlimit of a pixel's transfer function.
WEDGE_FN float bandlimitOf(uint component, Gloss lobe)
{
    return WEDGE_IS_GLOSSY(component) ? glossyBandlimit(lobe.exponent, lobe.kind) : WEDGE_DIFFUSE_BANDLIMIT;
}

/// Distances, infinite where nothing was hit.
typedef struct {
    float16 mean, least;
} Nearness;

/// Harmonic means of the distances that the rays of the object's pixels around found, and of the least one of each;
/// rays and pixels that hit nothing count as infinitely far. Not of the pixel's own, if there are others: a width that
/// follows the samples that it then weighs makes the image too dark, as pixels that found something bright and near
/// would get narrower filters than those around that did not, and count less in these. Of glossy light pixels count
/// that met something: `taken` of several receivers has matt ones' samples, too.
WEDGE_FN Nearness nearness(ReflectorParams p, uint y, int i, __global const float* reflectors,
    __global const uint* objectId, __global const uint* taken)
{
    const int reach = (int)WEDGE_NEARNESS_REACH;
    const bool glossy = WEDGE_IS_GLOSSY(p.component);
    __global const float* inverse = reflectors + (p.meanOnly != 0u ? 0u : 2u * p.planeSize);
    const uint16 object = loadIdBlock(objectId, i);
    const float16 none = (float16)(0.0f), one = (float16)(1.0f);
    float16 sum = none, rays = none, leasts = none, pixels = none;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            if (dx == 0 && dy == 0) {
                continue;
            }
            const int j = i + dy * (int)p.stride + dx;
            const float16 there = loadBlock(inverse, j), least = loadBlock(reflectors, j);
            const uint16 samples = loadIdBlock(taken, j);
            int16 counts = (loadIdBlock(objectId, j) == object) & (samples > 0u);
            counts &= glossy ? there > 0.0f : (int16)(-1);
            sum += counts ? there : none;
            rays += counts ? convert_float16(samples) : none;
            leasts += (counts & (least > 0.0f)) ? one / least : none;
            pixels += counts ? one : none;
        }
    }
    const int16 alone = !(pixels > 0.0f);
    const float16 own = loadBlock(reflectors, i);
    sum = alone ? loadBlock(inverse, i) : sum;
    rays = alone ? convert_float16(loadIdBlock(taken, i)) : rays;
    leasts = !alone ? leasts : own > 0.0f ? one / own : none;
    pixels = alone ? one : pixels;
    Nearness near;
    near.mean = sum > 0.0f ? rays / sum : (float16)(INFINITY);
    near.least = leasts > 0.0f ? pixels / leasts : (float16)(INFINITY);
    return near;
}

/// z_min of a block of pixels, metres: the least distance, as published of the pixel's own rays, or, if that is nearer,
/// a fraction of their harmonic mean, in which rays that hit nothing count as infinitely far: an estimate of the same
/// from all rays, with less noise.
WEDGE_FN void nearestReflectors(ReflectorParams p, uint y, int i, __global const float* reflectors,
    __global const uint* objectId, __global const float* extent, __global const uint* taken, float16 size,
    float* nearest)
{
    const float16 own = loadBlock(reflectors, i);
    float16 near = own > 0.0f ? own : (float16)(INFINITY);
    if (p.meanFraction > 0.0f) {
        const Nearness around = nearness(p, y, i, reflectors, objectId, taken);
        // What is nearer than the fraction of the mean counts itself: of open scenes most rays hit nothing. Where there
        // is but one number for both, it has that in it.
        near = p.meanFraction * around.mean;
        near = p.meanOnly != 0u ? near : min16(near, around.least);
    }
    // Where no ray hit anything, nothing is nearer than what there is is large.
    const float far = p.extent > 0.0f ? p.extent : extent[0];
    near = near < INFINITY ? near : (float16)(far);
    vstore16(max16(near, leastDistances(p, extent, size)), 0, nearest);
}

/// Widths in metres (4.15), (4.16), -1 where the pixel has no such term, 0, which filters nothing, of
/// what lobes see beyond the scene. fixedWidth replaces the analysis. meanOnly:
/// reflectors have but one plane, the sum of inverse distances, or what stands for it (WEDGE_NEAREST_FRACTION).
#include "pass/reflectorWidths.h"
#ifdef PASS_reflectorWidths
__kernel void reflectorWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    float zMin[WEDGE_BLOCK_PIXELS], size[WEDGE_BLOCK_PIXELS], width[WEDGE_BLOCK_PIXELS];
    const float16 sizes = LOAD16_pixelSize(p.planeSize, i);
    nearestReflectors(p, y, i, reflectors, objectId, extent, taken, sizes, zMin);
    vstore16(sizes, 0, size);
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const float bandlimit = bandlimitOf(p.component, LOAD_gloss(p.planeSize, (uint)i + lane));
        const float bandwidth = indirectBandwidth(zMin[lane], bandlimit, size[lane], p.mu, p.alpha);
        const float adaptive = p.component == WEDGE_COMPONENT_ENVIRONMENT_GLOSSY ? 0.0f : p.widthScale / bandwidth;
        width[lane] = p.fixedWidth > 0.0f ? p.fixedWidth * size[lane] : adaptive;
    }
    vstore16(loadIdBlock(taken, i) > 0u ? vload16(0, width) : (float16)(-1.0f), 0, beta + i);
}
#endif

/// Counts (4.21), 0 where the pixel has no such term. reflectors: of all planes
#include "pass/reflectorCounts.h"
#ifdef PASS_reflectorCounts
__kernel void reflectorCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint first = pixelIndex(x, y, p.stride);
    float zMin[WEDGE_BLOCK_PIXELS];
    nearestReflectors(p, y, (int)first, reflectors, objectId, extent, taken, loadBlock(pixelSize, (int)first), zMin);
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const uint i = first + lane;
        const Gloss lobe = unpackGloss(gloss[i]);
        const float zMax = fmax(reflectors[p.planeSize + i], zMin[lane]);
        const float gamma = WEDGE_IS_GLOSSY(p.component) ? glossyGamma(lobe.exponent) : WEDGE_DIFFUSE_GAMMA;
        const float count =
            indirectCount(zMin[lane], zMax, bandlimitOf(p.component, lobe), gamma, pixelSize[i], p.mu, p.alpha);
        const float bounded = fmin(fmax(count, (float)WEDGE_INDIRECT_FIRST_RAYS), (float)p.countCap);
        wanted[i] = taken[i] > 0u ? (uint)(bounded + 0.5f) : 0u;
    }
}
#endif

/// Variance of a sample's luminance as the image shows it, (sum l^2 - n mean^2) / (n - 1) times the squared luminance
/// of the reflectance: planes R, G, B, all 1 for ambient occlusion. Of fractions V it is n / (n - 1) V (1 - V) in the
/// place of the first, as if a sample saw all or nothing.
#include "pass/sampleVariance.h"
#ifdef PASS_sampleVariance
__kernel void sampleVariance(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 n = convert_float16(loadIdBlock(taken, i));
    const Vec3x16 sum = loadVecBlock(sums, p.planeSize, i);
    const float16 total = 0.2126f * sum.x + 0.7152f * sum.y + 0.0722f * sum.z;
    const float16 last = loadBlock(sums + 3u * p.planeSize, i);
    float16 spread = last - total * total / max16(n, (float16)(1.0f));
    if (p.fractions != 0u) {
        const float16 fraction = last > 0.0f ? total / last : (float16)(0.0f);
        spread = n * fraction * (1.0f - fraction);
    }
    const Vec3x16 k = loadVecBlock(reflectance, p.planeSize, i);
    const float16 shown =
        p.component == WEDGE_COMPONENT_AMBIENT ? (float16)(1.0f) : 0.2126f * k.x + 0.7152f * k.y + 0.0722f * k.z;
    const float16 v = max16(spread, (float16)(0.0f)) / max16(n - 1.0f, (float16)(1.0f));
    vstore16(n > 1.0f ? v * shown * shown : (float16)(0.0f), 0, variance + i);
}
#endif
