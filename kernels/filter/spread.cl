// Where the light of rejected samples goes: to pixels around, of the same surface, by a Gaussian. What each pixel loses
// is divided by the weights of those that get it, so that none is lost; and what leaves a surface's neighbours alone
// cannot leak to others. Its width is the same for all, or grows with what a pixel loses (Rushmeier and Ward 1994).
#include "core/formats.h"
#include "core/pixel.h"
#include "core/vector16.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "shared/sample_filter.h"

/// Normals of one surface differ by less than this cosine's angle, 26 degrees.
#define WEDGE_SPREAD_COSINE 0.9f

WEDGE_INLINE int spreadReach(float sigma) { return (int)ceil(WEDGE_SPREAD_CUT * sigma); }

/// Columns of sixteen neighbours from dx on, pixels from a pixel's own.
WEDGE_INLINE float16 columnsFrom(int dx)
{
    return (float16)((float)dx)
        + (float16)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f, 8.0f, 9.0f, 10.0f, 11.0f, 12.0f, 13.0f, 14.0f,
            15.0f);
}

/// The Gaussian's weights of such offsets: exp(-d^2 / (2 s^2)).
WEDGE_INLINE float16 spreadWeights(float16 dx, int dy, float sigma)
{
    return exp2Block((dx * dx + (float)(dy * dy)) * (-0.72134752f / (sigma * sigma)));
}

WEDGE_INLINE float lanesSum(float16 v)
{
    const float8 a = v.lo + v.hi;
    const float4 b = a.lo + a.hi;
    return b.x + b.y + b.z + b.w;
}

/// To which of sixteen pixels from j on light of a pixel may go: to those of its surface that have the term.
#define WEDGE_SPREADS(size, j, own, facing)                                                                            \
    ((loadIdBlock(objectId, j) == (own)) & (loadIdBlock(taken, j) != 0u)                                               \
        & (dot16(LOAD16_normal(size, j), facing) >= WEDGE_SPREAD_COSINE))

/// What each pixel that loses something is to be divided by; and, where there is a plane for it, how wide that goes:
/// the narrowest of sigma, 2 sigma, 4 sigma and so on, at which the luminance of what the pixel itself gets back is at
/// most a share of the mean around it. `widest`, the last of these, where there is none.
///
/// in   objectId, normal, taken: samples; excess: what pixels lose (3 planes); sigma, widest: pixels; sums: R, G, B of
///      what is kept of pixels' samples, absent where all widths are sigma
/// out  per: one over the sum of weights; width: pixels, or absent; both 0 where nothing is lost
#include "pass/spreadSums.h"
#ifdef PASS_spreadSums
__kernel void spreadSums(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3 lost = loadVec(excess, size, i);
    float sum = 0.0f, chosen = 0.0f;
    if (taken[i] != 0u && (lost.x != 0.0f || lost.y != 0.0f || lost.z != 0.0f)) {
        const uint own = objectId[i];
        const Vec3x16 facing = splat3(LOAD_normal(size, i));
        const float loss = fabs(luminance(lost));
        bool wider = false;
        chosen = sigma;
        do {
            const int reach = spreadReach(chosen), last = min(reach, (int)(p.width - 1u - x));
            float16 weights = (float16)(0.0f), bright = (float16)(0.0f);
            for (int dy = -min(reach, (int)y); dy <= min(reach, (int)(p.height - 1u - y)); ++dy) {
                for (int dx = -min(reach, (int)x); dx <= last; dx += (int)WEDGE_BLOCK_PIXELS) {
                    const int j = (int)i + dy * (int)p.stride + dx;
                    const float16 across = columnsFrom(dx);
                    const int16 there = (across <= (float)last) & WEDGE_SPREADS(size, j, own, facing);
                    const float16 weight = there ? spreadWeights(across, dy, chosen) : (float16)(0.0f);
                    weights += weight;
#if HAS_sums
                    const float16 mean =
                        luminance16(loadVecBlock(sums, size, j)) / convert_float16(loadIdBlock(taken, j));
                    bright += there ? weight * mean : (float16)(0.0f);
#endif
                }
            }
            sum = lanesSum(weights);
            // loss / sum against bright / sum: the sum of the weights goes out.
            wider = chosen < widest && loss > WEDGE_SPREAD_SHARE * lanesSum(bright);
            chosen *= wider ? 2.0f : 1.0f;
        } while (wider);
    }
    per[i] = sum > 0.0f ? 1.0f / sum : 0.0f;
#if HAS_width
    width[i] = chosen;
#endif
}
#endif

/// Adds to each pixel what others lose.
/// in      as before; per; sigma: the widest; width: absent where all have that width
/// in out  sums: R, G, B of a pixel's samples; parts: mean of a part of them (colours in 48 bits)
#include "pass/spreadExcess.h"
#ifdef PASS_spreadExcess
__kernel void spreadExcess(PARAMETERS)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint i = pixelIndex(x, y, p.stride), size = p.planeSize;
    const uint16 own = loadIdBlock(objectId, (int)i), count = loadIdBlock(taken, (int)i);
    const Vec3x16 facing = LOAD16_normal(size, (int)i);
    const int reach = spreadReach(sigma);
    const int first = max((int)x - reach, 0),
              last = min((int)x + (int)WEDGE_BLOCK_PIXELS - 1 + reach, (int)p.width - 1);
    Vec3x16 gained = splat3(vec3(0.0f, 0.0f, 0.0f));
    for (int v = max((int)y - reach, 0); v <= min((int)y + reach, (int)p.height - 1); ++v) {
        for (int u = first; u <= last; u += (int)WEDGE_BLOCK_PIXELS) {
            const int block = (int)pixelIndex((uint)u, (uint)v, p.stride);
            // Most pixels lose nothing.
            if (!any(loadBlock(per, block) > 0.0f)) {
                continue;
            }
            for (int lane = 0; lane < (int)WEDGE_BLOCK_PIXELS; ++lane) {
                const uint j = (uint)(block + lane);
                if (u + lane > last || per[j] <= 0.0f) {
                    continue;
                }
#if HAS_width
                const float there = width[j];
#else
                const float there = sigma;
#endif
                // Beyond the reach are pixels that a crop has not made.
                const int dy = v - (int)y, far = min(spreadReach(there), reach);
                if (abs(dy) > (uint)far) {
                    continue;
                }
                const float16 across = columnsFrom((int)x - u - lane);
                const int16 gets = (fabs(across) <= (float)far) & (own == (uint16)(objectId[j])) & (count != 0u)
                    & (dot16(facing, splat3(LOAD_normal(size, j))) >= WEDGE_SPREAD_COSINE);
                if (any(gets)) {
                    const float16 part = per[j] * spreadWeights(across, dy, there), none = (float16)(0.0f);
                    const Vec3 lost = loadVec(excess, size, j);
                    gained.x += gets ? lost.x * part : none;
                    gained.y += gets ? lost.y * part : none;
                    gained.z += gets ? lost.z * part : none;
                }
            }
        }
    }
    const float16 n = convert_float16(count);
    // What dark samples that are left out lack is taken from others, as far as these have it.
    const Vec3x16 sum = loadVecBlock(sums, size, (int)i);
    const float16 none = (float16)(0.0f);
    vstore16(max16(sum.x + n * gained.x, none), 0, sums + i);
    vstore16(max16(sum.y + n * gained.y, none), 0, sums + size + i);
    vstore16(max16(sum.z + n * gained.z, none), 0, sums + 2u * size + i);
#if HAS_parts
    float red[WEDGE_BLOCK_PIXELS], green[WEDGE_BLOCK_PIXELS], blue[WEDGE_BLOCK_PIXELS];
    vstore16(gained.x, 0, red);
    vstore16(gained.y, 0, green);
    vstore16(gained.z, 0, blue);
    for (uint k = 0u; k < WEDGE_BLOCK_PIXELS; ++k) {
        STORE_parts(size, i + k, vecAdd(LOAD_parts(size, i + k), vec3(red[k], green[k], blue[k])));
    }
#endif
}
#endif

/// Means of the sums, what is filtered or shown.
/// in   sums (3 planes), taken
/// out  mean: colours
#include "pass/meanOfKept.h"
#ifdef PASS_meanOfKept
__kernel void meanOfKept(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float per = taken[i] != 0u ? 1.0f / (float)taken[i] : 0.0f;
    STORE_mean(p.planeSize, i, vecScale(loadVec(sums, p.planeSize, i), per));
}
#endif
