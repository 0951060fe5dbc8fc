// The analysis of distributed frames as thesis chapter 5 and appendix B have it: flags (5.30), widths (5.18), (5.22),
// counts (5.24) to (5.28), with (5.29).
#include "core/distributed_pixel.h"
#include "core/pixel.h"
#include "shared/defocus.h"
#include "shared/distributed.h"
#include "shared/indirect.h"
#include "shared/path.h"
#include "shared/wedge.h"

/// (5.31) and (5.33).
#define WEDGE_PUBLISHED_KERNEL_FACTOR 16.0f

WEDGE_FN float largestConfusion(float2 confusion) { return fmax(fabs(confusion.x), fabs(confusion.y)); }

/// 1 where |L - k E| is small enough (5.30), else 0.
#include "pass/publishedFlags.h"
#ifdef PASS_publishedFlags
__kernel void publishedFlags(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 k = loadVec(texture, p.planeSize, i);
    const Vec3 e = p.values == 3u ? loadVec(value, p.planeSize, i) : vec3(value[i], value[i], value[i]);
    const float error = vecLength(vecSub(loadVec(termRadiance, p.planeSize, i), vecMul(k, e)));
    flags[i] = p.never == 0u && error < p.factoringError ? 1.0f : 0.0f;
}
#endif

/// The median of the flags around a pixel.
WEDGE_FN bool medianFlag(DistributedParams p, __global const float* flags, uint x, uint y)
{
    float sum = 0.0f, count = 0.0f;
    for (int dy = -WEDGE_MEDIAN_RADIUS; dy <= WEDGE_MEDIAN_RADIUS; ++dy) {
        for (int dx = -WEDGE_MEDIAN_RADIUS; dx <= WEDGE_MEDIAN_RADIUS; ++dx) {
            const int px = (int)x + dx, py = (int)y + dy;
            if (px >= 0 && py >= 0 && px < (int)p.width && py < (int)p.height) {
                sum += flags[pixelIndex((uint)px, (uint)py, p.stride)];
                count += 1.0f;
            }
        }
    }
    return 2.0f * sum > count;
}

/// Width of the irradiance's filter, metres, -1 where it is not taken apart from the texture.
WEDGE_FN float publishedWidth(bool apart, float bandlimit, float pixelSize)
{
    return apart ? kernelDeviation(bandlimit, WEDGE_PUBLISHED_KERNEL_FACTOR) * pixelSize : -1.0f;
}

/// A light's widths (5.18) and counts (5.25), (5.27). slopes: s_min, s_max; lightExtent: l_I, metres.
/// out  beta, demand: the count
#include "pass/publishedShadows.h"
#ifdef PASS_publishedShadows
__kernel void publishedShadows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float sMin = slopes[i], sMax = slopes[p.planeSize + i];
    const float2 range = LOAD_confusion(p.planeSize, i);
    const float rMin = leastConfusion(range), rMax = largestConfusion(range);
    const bool apart = medianFlag(p, flags, x, y);
    const float factored = scaledBandlimit(shadowBandlimit(sMin, lightExtent, pixelSize[i], rMin), mu);
    const float combined = scaledBandlimit(defocusBandlimit(rMin), mu);
    beta[i] = objectId[i] != 0u ? publishedWidth(apart, factored, pixelSize[i]) : -1.0f;
    demand[i] =
        objectId[i] != 0u ? directCount(apart ? factored : combined, rMax, sMax, lightExtent, pixelSize[i]) : 0.0f;
}
#endif

/// A component's widths (5.22) and counts (5.26), (5.28). reflectors: z_min, z_max.
#include "pass/publishedReflectors.h"
#ifdef PASS_publishedReflectors
__kernel void publishedReflectors(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Gloss lobe = unpackGloss(gloss[i]);
    const float transfer =
        WEDGE_IS_GLOSSY(component) ? glossyBandlimit(lobe.exponent, lobe.kind) : WEDGE_DIFFUSE_BANDLIMIT;
    const float2 range = LOAD_confusion(p.planeSize, i);
    const float rMin = leastConfusion(range), rMax = largestConfusion(range);
    const bool apart = medianFlag(p, flags, x, y);
    const float factored = scaledBandlimit(indirectBandlimit(reflectors[i], transfer, pixelSize[i], rMin), mu);
    const float combined = scaledBandlimit(defocusBandlimit(rMin), mu);
    beta[i] = objectId[i] != 0u ? publishedWidth(apart, factored, pixelSize[i]) : -1.0f;
    demand[i] = objectId[i] != 0u
        ? indirectRayCount(apart ? factored : combined, rMax, reflectors[p.planeSize + i], transfer, pixelSize[i])
        : 0.0f;
}
#endif

/// n_p: (5.24), where something moves (B.3), and `mixed` where motions differ.
#include "pass/publishedPrimary.h"
#ifdef PASS_publishedPrimary
__kernel void publishedPrimary(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float2 range = LOAD_confusion(p.planeSize, i), moved = LOAD_motion(p.planeSize, i);
    const float band = scaledBandlimit(defocusBandlimit(leastConfusion(range)), mu);
    const float ofLens = primaryCount(band, largestConfusion(range));
    const float speed = sqrt(moved.x * moved.x + moved.y * moved.y);
    const float spread = LOAD_motionSpread(p.planeSize, i);
    const float ofMotion = motionCountPrinted(scaledBandlimit(motionBandlimit(speed), mu), speed);
    const bool several = fmax(speed, spread) >= p.leastRadius && spread > p.oneVelocity * speed;
    demand[i] = fmax(ofLens, several ? mixed : speed >= p.leastRadius ? ofMotion : 1.0f);
}
#endif

/// wanted = the largest demand within 3x3 pixels, rounded up, `most` at most; but never less than `least` and `taken`.
#include "pass/publishedCounts.h"
#ifdef PASS_publishedCounts
__kernel void publishedCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    float largest = 0.0f;
    for (int dy = -min((int)y, 1); dy <= min((int)(p.height - 1u - y), 1); ++dy) {
        for (int dx = -min((int)x, 1); dx <= min((int)(p.width - 1u - x), 1); ++dx) {
            largest = fmax(largest, demand[(int)i + dy * (int)p.stride + dx]);
        }
    }
    const uint n = (uint)fmin(ceil(largest), (float)most);
    wanted[i] = max(max(n, least[i]), taken[i]);
}
#endif
