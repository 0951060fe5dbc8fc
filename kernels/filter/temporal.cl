// The filter over time: means of light over a window of frames, each looked up where the surface was in it.
//
// E is what a pixel reflects by its reflectance. Of frame t and the n frames before it that exist
//
//     E' = E_t + 1/G sum_k g_k w_k (E_k - E_t),   G = 1 + sum_k g_k,   k = 1..n frames back
//
// g_k: 1 where frame k sees the pixel's surface point, which is where the camera and the object were then; else 0. w_k:
// whether the light is the same: Student's t of the differences of *unfiltered* samples over the pixels around, which
// are independent of each other. With w = 1 this is the plain mean. What w takes away goes to the pixel itself, and w
// does not tell E_k from E_t: so where frames differ by noise alone, E' has the mean of E_t, whatever w is.
// Where light moves by less than a block is large the differences' mean may be 0: so their squares are held against the
// noise's, too: that of two parts of the samples, or what pixels differ by from those beside them in the same frame.
//
// As published that is one frame back, at the nearest pixel, with w = 1.
//
// Light is kept in 47 bits, and differences are between what was kept: frames that are equal change nothing, to the
// bit.
#include "filter/temporal_lookup.h"
#include "shared/bsdf.h"

/// What light is divided by to make E of it, never 0.
WEDGE_FN Vec3 shownBy(TemporalParams p, Vec3 diffuse, Vec3 specular)
{
    if (p.open != 0u) {
        return vec3(1.0f, 1.0f, 1.0f);
    }
    return vecAdd(vecAdd(diffuse, specular), vec3(WEDGE_TEMPORAL_DARK, WEDGE_TEMPORAL_DARK, WEDGE_TEMPORAL_DARK));
}

WEDGE_FN Vec3 over(Vec3 a, Vec3 b) { return vec3(a.x / b.x, a.y / b.y, a.z / b.z); }

/// What of a frame is kept for those after it.
/// in   planes of the frame; indirect, indirectNoisy: of frames that have some
/// out  depth: along the camera's axis; facing: packNormal(); object; E of direct and of indirect light, 47 bits each;
/// and
///      its luminance before the filter, 16 bits;
///      variation: the variance of that where p.measured, or 0
#include "pass/keepFrame.h"
#ifdef PASS_keepFrame
__kernel void keepFrame(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const bool reflects = p.mixed != 0u || objectId[i] != 0u;
    const Vec3 black = vec3(0.0f, 0.0f, 0.0f), kd = LOAD_diffuse(n, i), ks = LOAD_specular(n, i);
    const Vec3 k = shownBy(p, kd, ks);
    depth[i] = vecDot(vecSub(loadVec(position, n, i), p.eye), p.forward);
    facing[i] = packNormal(LOAD_normal(n, i));
    object[i] = objectId[i];
#ifdef WEDGE_MIRRORS
    // What a mirror shows does not move with it: nothing earlier is found of it unless all is still.
    const Vec3 colour = vecAdd(kd, ks);
    object[i] = p.open == 0u && colour.x + colour.y + colour.z == 0.0f ? 0u : object[i];
#endif
    STORE_directLight(n, i, vecChoose(reflects, over(loadVec(direct, n, i), k), black));
    Vec3 unfiltered = loadVec(directNoisy, n, i);
    STORE_indirectLight(n, i, vecChoose(reflects, over(LOAD_indirect(n, i), k), black));
    unfiltered = HAS_indirectNoisy ? vecAdd(unfiltered, LOAD_indirectNoisy(n, i)) : unfiltered;
    STORE_noisy(n, i, reflects ? luminance(over(unfiltered, k)) : 0.0f);
    float deviation = 0.0f;
    if (p.measured != 0u && reflects) {
        // Of light of one colour.
        deviation = LOAD_directDeviation(n, i) / luminance(k);
        deviation += HAS_indirectDeviation ? LOAD_indirectDeviation(n, i) / luminance(k) : 0.0f;
    }
    STORE_variation(n, i, deviation * deviation);
}
#endif

/// What a pixel's light may differ by from that of the same surface in another frame, squared: of three pixels in a
/// row, what an eighth of a pixel's shift of their slope makes, since differFromFrame() takes out what is known of it
/// (half a pixel's let highlights and penumbrae of a moving camera lag behind); and, where noise is not `measured`, by
/// how much the middle one is off the slope, whose mean is the variance where light is even.
WEDGE_FN float roughness(float before, float own, float after, uint measured)
{
    const float bend = measured != 0u ? 0.0f : 2.0f * own - before - after, slope = after - before;
    return bend * bend * (1.0f / 6.0f) + slope * slope * (1.0f / 1536.0f);
}

/// How much the light of unfiltered samples varies around each pixel.
/// in      noisy, object: of keepFrame()
/// in out  variation: of it, 16 bits
#include "pass/findVariation.h"
#ifdef PASS_findVariation
__kernel void findVariation(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize, id = object[i];
    // Of what mirrors show no deviation is known.
    const uint measured = id != 0u ? p.measured : 0u;
    const float own = LOAD_noisy(n, i);
    float across = 0.0f, down = 0.0f, count = 0.0f;
    if (x > 0u && x + 1u < p.width && object[i - 1u] == id && object[i + 1u] == id) {
        across = roughness(LOAD_noisy(n, i - 1u), own, LOAD_noisy(n, i + 1u), measured);
        count += 1.0f;
    }
    if (y > 0u && y + 1u < p.height && object[i - p.stride] == id && object[i + p.stride] == id) {
        down = roughness(LOAD_noisy(n, i - p.stride), own, LOAD_noisy(n, i + p.stride), measured);
        count += 1.0f;
    }
    float sum = across + down;
    if (measured == 0u) {
        sum = count > 0.0f ? sum / count : own * own; // nothing is known of pixels by themselves
    }
    STORE_variation(n, i, LOAD_variation(n, i) + sum);
}
#endif

/// One earlier frame, as far as a pixel's surface is seen in it.
/// in   position, normal: of this frame; object, directLight, indirectLight, noisy: as keepFrame() made them of it;
///      earlierX: likewise of the earlier one; variation: findVariation(); motions: of objects, from this frame to that
/// out  difference: of directLight, 3 planes, and with p.indirect of indirectLight, 3 more; noise: of the luminance
///      before the filter, of the nearest pixel, less what light changes on the way to it; variations: the sum of both
///      pixels' own; share: g, 1 or 0
#include "pass/differFromFrame.h"
#ifdef PASS_differFromFrame
__kernel void differFromFrame(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    SoughtPoint point;
    point.object = object[i];
    point.position = loadVec(position, n, i);
    point.normal = LOAD_normal(n, i);
    bool still;
    Vec2 at = vec2(0.0f, 0.0f);
    float depth;
    const Vec3 black = vec3(0.0f, 0.0f, 0.0f);
    Vec3 direct = black, indirect = black;
    float shift = 0.0f, weight = 0.0f, nearest = 0.0f, unfiltered = 0.0f, varies = 0.0f;
    if (movedBack(p, motions, &point, &still)) {
        if (still) {
            if (p.objectsStill != 0u
                || seesSurface(
                    p, point, planeOf(p, point), (int)x, (int)y, earlierDepth, earlierFacing, earlierObject)) {
                weight = 1.0f;
                direct = LOAD_earlierDirect(n, i);
                indirect = LOAD_earlierIndirect(n, i);
                unfiltered = LOAD_earlierNoisy(n, i);
                varies = LOAD_earlierVariation(n, i);
            }
        } else if (temporalProject(p, point.position, &at, &depth)) {
            const SoughtPlane plane = planeOf(p, point);
            // Of the four pixels around it those that see the surface.
            const float left = floor(at.x - 0.5f), top = floor(at.y - 0.5f);
            float fx = at.x - 0.5f - left, fy = at.y - 0.5f - top;
            if (p.published != 0u) {
                fx = floor(fx + 0.5f);
                fy = floor(fy + 0.5f);
            }
            int nearestX = 0, nearestY = 0;
            for (int tap = 0; tap < 4; ++tap) {
                const int tx = (int)left + (tap & 1), ty = (int)top + (tap >> 1);
                const float w = ((tap & 1) != 0 ? fx : 1.0f - fx) * ((tap >> 1) != 0 ? fy : 1.0f - fy);
                if (w > 0.0f && seesSurface(p, point, plane, tx, ty, earlierDepth, earlierFacing, earlierObject)) {
                    const uint j = pixelIndex((uint)tx, (uint)ty, p.stride);
                    weight += w;
                    direct = vecMad(direct, LOAD_earlierDirect(n, j), w);
                    indirect = vecMad(indirect, LOAD_earlierIndirect(n, j), w);
                    if (w > nearest) {
                        nearestX = tx;
                        nearestY = ty;
                        unfiltered = LOAD_earlierNoisy(n, j);
                        varies = LOAD_earlierVariation(n, j);
                    }
                    nearest = fmax(nearest, w);
                }
            }
            if (nearest > 0.0f) {
                const KeptSurfaces kept = { earlierDepth, earlierFacing, earlierObject };
                const AroundTap around = aroundTap(p, point, plane, nearestX, nearestY, kept);
                const Vec2 away = vec2((float)nearestX - left - fx, (float)nearestY - top - fy);
                const Vec2 curve =
                    weight > WEDGE_ALL_TAPS ? vec2(0.5f * fx * (1.0f - fx), 0.5f * fy * (1.0f - fy)) : vec2(0.0f, 0.0f);
                shift = straighten(n, around, earlierDirect, away, curve, &direct);
                if (HAS_earlierIndirect) {
                    shift += straighten(n, around, PLANE_earlierIndirect, away, curve, &indirect);
                }
            }
        }
    }
    const bool seen = weight > WEDGE_LEAST_TAPS;
    const float scale = seen ? 1.0f / weight : 0.0f;
    share[i] = seen ? 1.0f : 0.0f;
    noise[i] = seen ? unfiltered - LOAD_noisy(n, i) - shift : 0.0f;
    variations[i] = seen ? varies + LOAD_variation(n, i) : 0.0f;
    const Vec3 own = LOAD_directLight(n, i);
    storeVec(difference, n, i, seen ? vecMad(vecScale(own, -1.0f), direct, scale) : black);
    if (HAS_indirectLight) {
        const Vec3 ownIndirect = LOAD_indirectLight(n, i);
        storeVec(difference + 3u * n, n, i, seen ? vecMad(vecScale(ownIndirect, -1.0f), indirect, scale) : black);
    }
}
#endif

/// Sums over the pixels of a block: how many are seen in the earlier frame, their differences, and the squares of
/// those. out  sums: 4 numbers a block
#include "pass/sumBlocks.h"
#ifdef PASS_sumBlocks
__kernel void sumBlocks(PARAMETERS)
{
    const uint block = (uint)get_global_id(0);
    if (block >= blocks) {
        return;
    }
    const uint x0 = block % p.blocksX * WEDGE_TEMPORAL_BLOCK, y0 = block / p.blocksX * WEDGE_TEMPORAL_BLOCK;
    float count = 0.0f, sum = 0.0f, squares = 0.0f, expected = 0.0f;
    for (uint y = y0; y < min(y0 + WEDGE_TEMPORAL_BLOCK, p.height); ++y) {
        for (uint x = x0; x < min(x0 + WEDGE_TEMPORAL_BLOCK, p.width); ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            count += share[i];
            sum += noise[i];
            squares += noise[i] * noise[i];
            expected += variations[i];
        }
    }
    sums[4u * block] = count;
    sums[4u * block + 1u] = sum;
    sums[4u * block + 2u] = squares;
    sums[4u * block + 3u] = expected;
}
#endif

/// Student's t, squared, of differences whose mean is to be 0.
WEDGE_FN float squaredT(float count, float sum, float squares)
{
    if (count < 2.0f) {
        return 0.0f;
    }
    const float mean = sum / count;
    const float variance = fmax(squares - sum * mean, 0.0f) / ((count - 1.0f) * count);
    const float square = mean * mean;
    return square > 0.0f ? fmin(square / fmax(variance, 1e-30f), 1e6f) : 0.0f;
}

/// Whether the light of a block is that of the earlier frame: where neither its own pixels nor those around differ in
/// the mean, and its own by no more than by noise. The latter finds what is brighter here and darker there. out
/// weights: w of each block
#include "pass/weighBlocks.h"
#ifdef PASS_weighBlocks
__kernel void weighBlocks(PARAMETERS)
{
    const uint block = (uint)get_global_id(0);
    if (block >= blocks) {
        return;
    }
    const int bx = (int)(block % p.blocksX), by = (int)(block / p.blocksX);
    float count = 0.0f, sum = 0.0f, squares = 0.0f, ratio = 0.0f;
    for (int y = max(by - WEDGE_TEMPORAL_REACH, 0); y <= min(by + WEDGE_TEMPORAL_REACH, (int)p.blocksY - 1); ++y) {
        for (int x = max(bx - WEDGE_TEMPORAL_REACH, 0); x <= min(bx + WEDGE_TEMPORAL_REACH, (int)p.blocksX - 1); ++x) {
            const uint at = 4u * ((uint)y * p.blocksX + (uint)x);
            count += sums[at];
            sum += sums[at + 1u];
            squares += sums[at + 2u];
            if (abs(x - bx) <= 1 && abs(y - by) <= 1 && sums[at + 2u] > 0.0f) {
                ratio = fmax(ratio, sums[at + 2u] / fmax(sums[at + 3u], 1e-30f));
            }
        }
    }
    const uint own = 4u * block;
    const float t = fmax(squaredT(count, sum, squares), squaredT(sums[own], sums[own + 1u], sums[own + 2u]));
    weights[block] = temporalTrust(t, ratio);
}
#endif

/// Weights of blocks, interpolated between their centres.
WEDGE_FN float weightAt(TemporalParams p, __global const float* weights, uint x, uint y)
{
    const float scale = 1.0f / (float)WEDGE_TEMPORAL_BLOCK;
    const float bx = clamp(((float)x + 0.5f) * scale - 0.5f, 0.0f, (float)(p.blocksX - 1u));
    const float by = clamp(((float)y + 0.5f) * scale - 0.5f, 0.0f, (float)(p.blocksY - 1u));
    const uint left = (uint)bx, top = (uint)by;
    const uint right = min(left + 1u, p.blocksX - 1u), below = min(top + 1u, p.blocksY - 1u);
    const float fx = bx - (float)left, fy = by - (float)top;
    const float above = mix(weights[top * p.blocksX + left], weights[top * p.blocksX + right], fx);
    const float under = mix(weights[below * p.blocksX + left], weights[below * p.blocksX + right], fx);
    return mix(above, under, fy);
}

/// Adds an earlier frame.
/// in      difference, share; weights: none as published
/// in out  sum: of g w times the difference, as many planes; counts: of g
#include "pass/addFrame.h"
#ifdef PASS_addFrame
__kernel void addFrame(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    if (share[i] == 0.0f) {
        return;
    }
    const float w = HAS_weights ? weightAt(p, PLANE_weights, x, y) : 1.0f;
    const uint planes = p.indirect != 0u ? 6u : 3u;
    for (uint plane = 0u; plane < planes; ++plane) {
        const uint at = plane * p.planeSize + i;
        sum[at] += w * difference[at];
    }
    counts[i] += 1.0f;
}
#endif

/// Puts the mean in the frame's place.
/// in      sum, counts: of all earlier frames
/// in out  direct, indirect (where there is some), beauty
#include "pass/finishTemporal.h"
#ifdef PASS_finishTemporal
__kernel void finishTemporal(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 k = vecScale(shownBy(p, LOAD_diffuse(n, i), LOAD_specular(n, i)), 1.0f / (1.0f + counts[i]));
    Vec3 more = vecMul(k, loadVec(sum, n, i));
    storeVec(direct, n, i, vecAdd(loadVec(direct, n, i), more));
    if (HAS_indirect) {
        const Vec3 other = vecMul(k, loadVec(sum + 3u * n, n, i));
        STORE_indirect(n, i, vecAdd(LOAD_indirect(n, i), other));
        more = vecAdd(more, other);
    }
    storeVec(beauty, n, i, vecAdd(loadVec(beauty, n, i), more));
}
#endif
