// Where the light of rejected samples goes: to pixels around, of the same surface, by a Gaussian. What each pixel loses
// is divided by the weights of those that get it, so that none is lost; and what leaves a surface's neighbours alone
// cannot leak to others. Its width is the same for all, or grows with what a pixel loses (Rushmeier and Ward 1994).
#include "core/formats.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "shared/maths.h"
#include "shared/sample_filter.h"

/// Normals of one surface differ by less than this cosine's angle, 26 degrees.
#define WEDGE_SPREAD_COSINE 0.9f

/// The Gaussian's weight of an offset, in powers of two: exp(-d^2 / (2 s^2)).
WEDGE_INLINE float spreadWeight(int dx, int dy, float sigma)
{
    return exp2Bounded(-0.72134752f * (float)(dx * dx + dy * dy) / (sigma * sigma));
}

WEDGE_INLINE int spreadReach(float sigma) { return (int)ceil(WEDGE_SPREAD_CUT * sigma); }

/// Whether light of pixel i may go to pixel j, which has the term.
#define WEDGE_SPREADS(size, i, j, own, facing)                                                                         \
    (objectId[j] == (own) && taken[j] != 0u && vecDot(LOAD_normal(size, j), facing) >= WEDGE_SPREAD_COSINE)

/// What each pixel that loses something is to be divided by.
/// in   objectId, normal, taken: samples; excess: what pixels lose (3 planes); sigma: pixels
/// out  per: one over the sum of weights; 0 where nothing is lost
#include "pass/spreadSums.h"
#ifdef PASS_spreadSums
__kernel void spreadSums(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3 lost = loadVec(excess, size, i);
    if (taken[i] == 0u || (lost.x == 0.0f && lost.y == 0.0f && lost.z == 0.0f)) {
        per[i] = 0.0f;
        return;
    }
    const int reach = spreadReach(sigma);
    const uint own = objectId[i];
    const Vec3 facing = LOAD_normal(size, i);
    float sum = 0.0f;
    for (int dy = -min(reach, (int)y); dy <= min(reach, (int)(p.height - 1u - y)); ++dy) {
        for (int dx = -min(reach, (int)x); dx <= min(reach, (int)(p.width - 1u - x)); ++dx) {
            const uint j = (uint)((int)i + dy * (int)p.stride + dx);
            sum += WEDGE_SPREADS(size, i, j, own, facing) ? spreadWeight(dx, dy, sigma) : 0.0f;
        }
    }
    per[i] = sum > 0.0f ? 1.0f / sum : 0.0f;
}
#endif

/// The same where the width follows from what a pixel loses: the narrowest of sigma, 2 sigma, 4 sigma and so on, at
/// which the luminance of what the pixel itself gets back is at most a share of the mean around it. `widest`, the last
/// of these, where there is none.
///
/// in   as before; sums: R, G, B of what is kept of pixels' samples; taken: samples
/// out  per; width: pixels; both 0 where nothing is lost
#include "pass/spreadWidths.h"
#ifdef PASS_spreadWidths
__kernel void spreadWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3 lost = loadVec(excess, size, i);
    if (taken[i] == 0u || (lost.x == 0.0f && lost.y == 0.0f && lost.z == 0.0f)) {
        per[i] = width[i] = 0.0f;
        return;
    }
    const uint own = objectId[i];
    const Vec3 facing = LOAD_normal(size, i);
    const float loss = fabs(luminance(lost));
    float sum = 0.0f, chosen = sigma;
    for (;;) {
        const int reach = spreadReach(chosen);
        float bright = 0.0f;
        sum = 0.0f;
        for (int dy = -min(reach, (int)y); dy <= min(reach, (int)(p.height - 1u - y)); ++dy) {
            for (int dx = -min(reach, (int)x); dx <= min(reach, (int)(p.width - 1u - x)); ++dx) {
                const uint j = (uint)((int)i + dy * (int)p.stride + dx);
                if (WEDGE_SPREADS(size, i, j, own, facing)) {
                    const float weight = spreadWeight(dx, dy, chosen);
                    sum += weight;
                    bright += weight * (luminance(loadVec(sums, size, j)) / (float)taken[j]);
                }
            }
        }
        // loss / sum against bright / sum: the sum of the weights goes out.
        if (loss <= WEDGE_SPREAD_SHARE * bright || chosen >= widest) {
            break;
        }
        chosen *= 2.0f;
    }
    width[i] = chosen;
    per[i] = sum > 0.0f ? 1.0f / sum : 0.0f;
}
#endif

/// The largest width of a block of pixels whose upper left corner a pixel is: few pixels spread far, and others pass
/// over most of what lies around them by blocks.
/// in   width
/// out  widths: pixels
#include "pass/spreadBlocks.h"
#ifdef PASS_spreadBlocks
__kernel void spreadBlocks(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    float most = 0.0f;
    for (uint dy = 0u; dy < min((uint)WEDGE_SPREAD_BLOCK, p.height - y); ++dy) {
        for (uint dx = 0u; dx < min((uint)WEDGE_SPREAD_BLOCK, p.width - x); ++dx) {
            most = fmax(most, width[i + dy * p.stride + dx]);
        }
    }
    widths[i] = most;
}
#endif

/// Adds to each pixel what others lose.
/// in      as before; per; sigma: the widest; width, widths: absent where all have that width
/// in out  sums: R, G, B of a pixel's samples; parts: mean of a part of them (colours in 48 bits)
#include "pass/spreadExcess.h"
#ifdef PASS_spreadExcess
__kernel void spreadExcess(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    if (taken[i] == 0u) {
        return;
    }
    const int reach = spreadReach(sigma);
    const uint own = objectId[i];
    const Vec3 facing = LOAD_normal(size, i);
    Vec3 gained = vec3(0.0f, 0.0f, 0.0f);
#if HAS_width
    for (int by = -min(reach, (int)y); by <= min(reach, (int)(p.height - 1u - y)); by += WEDGE_SPREAD_BLOCK) {
        for (int bx = -min(reach, (int)x); bx <= min(reach, (int)(p.width - 1u - x)); bx += WEDGE_SPREAD_BLOCK) {
            // Of the block's pixels the nearest along each axis.
            const int nearX = max(max(bx, -(bx + WEDGE_SPREAD_BLOCK - 1)), 0);
            const int nearY = max(max(by, -(by + WEDGE_SPREAD_BLOCK - 1)), 0);
            if (max(nearX, nearY) > spreadReach(widths[(int)i + by * (int)p.stride + bx])) {
                continue;
            }
            const int lastY = min(min(by + WEDGE_SPREAD_BLOCK - 1, reach), (int)(p.height - 1u - y));
            const int lastX = min(min(bx + WEDGE_SPREAD_BLOCK - 1, reach), (int)(p.width - 1u - x));
            for (int dy = by; dy <= lastY; ++dy) {
                for (int dx = bx; dx <= lastX; ++dx) {
                    const uint j = (uint)((int)i + dy * (int)p.stride + dx);
                    const float share = per[j];
                    if (share > 0.0f && max(abs(dx), abs(dy)) <= (uint)spreadReach(width[j])
                        && WEDGE_SPREADS(size, i, j, own, facing)) {
                        gained = vecMad(gained, loadVec(excess, size, j), share * spreadWeight(dx, dy, width[j]));
                    }
                }
            }
        }
    }
#else
    for (int dy = -min(reach, (int)y); dy <= min(reach, (int)(p.height - 1u - y)); ++dy) {
        for (int dx = -min(reach, (int)x); dx <= min(reach, (int)(p.width - 1u - x)); ++dx) {
            const uint j = (uint)((int)i + dy * (int)p.stride + dx);
            const float share = per[j];
            if (share > 0.0f && WEDGE_SPREADS(size, i, j, own, facing)) {
                gained = vecMad(gained, loadVec(excess, size, j), share * spreadWeight(dx, dy, sigma));
            }
        }
    }
#endif
    const float n = (float)taken[i];
    // What dark samples that are left out lack is taken from others, as far as these have it.
    sums[i] = fmax(sums[i] + n * gained.x, 0.0f);
    sums[size + i] = fmax(sums[size + i] + n * gained.y, 0.0f);
    sums[2u * size + i] = fmax(sums[2u * size + i] + n * gained.z, 0.0f);
#if HAS_parts
    STORE_parts(size, i, vecAdd(LOAD_parts(size, i), gained));
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
