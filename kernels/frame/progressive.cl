// Progressive frames: two independent halves, of which the image is the mean, and how far from the truth they say it
// is.
#include "core/pixel.h"
#include "shared/distributed.h"
#include "shared/frame.h"
#include "shared/wave.h"

/// Copies an image (3 planes).
#include "pass/copyImage.h"
#ifdef PASS_copyImage
__kernel void copyImage(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    storeVec(out, p.planeSize, i, loadVec(in, p.planeSize, i));
}
#endif

/// What the first half weighs of two with so many samples: one that has none yet has no say.
WEDGE_FN float shareOfFirst(uint first, uint second) { return second == 0u ? 1.0f : first == 0u ? 0.0f : 0.5f; }

/// mean = the mean of the halves' `planes`; takenA, takenB: their primary samples.
#include "pass/meanOfHalves.h"
#ifdef PASS_meanOfHalves
__kernel void meanOfHalves(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float share = shareOfFirst(takenA[i], takenB[i]);
    for (uint plane = 0u; plane < planes; ++plane) {
        const uint at = plane * p.planeSize + i;
        mean[at] = share * a[at] + (1.0f - share) * b[at];
    }
}
#endif

/// Objects: WEDGE_MIXED where the halves' differ.
#include "pass/joinObjects.h"
#ifdef PASS_joinObjects
__kernel void joinObjects(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint a = objectA[i], b = objectB[i];
    object[i] = a == 0u || a == b ? b : b == 0u ? a : WEDGE_MIXED;
}
#endif

/// What is known of surfaces alone, of both halves' hits: positions, normals (3 planes each), sizes of pixels, and
/// distances (that of one half where the other missed).
#include "pass/joinSurfaces.h"
#ifdef PASS_joinSurfaces
__kernel void joinSurfaces(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize, a = hitsA[i], b = hitsB[i];
    const float share = a + b > 0u ? (float)a / (float)(a + b) : 0.5f, rest = 1.0f - share;
    storeVec(position, n, i, vecMad(vecScale(loadVec(positionA, n, i), share), loadVec(positionB, n, i), rest));
    const Vec3 sum = vecMad(vecScale(loadVec(normalA, n, i), share), loadVec(normalB, n, i), rest);
    storeVec(normal, n, i, a + b > 0u && vecDot(sum, sum) > 0.0f ? vecNormalize(sum) : vec3(0.0f, 0.0f, 0.0f));
    pixelSize[i] = share * pixelSizeA[i] + rest * pixelSizeB[i];
    // Not a weighted sum: either may be infinite.
    depth[i] = a == 0u && b > 0u ? depthB[i] : b == 0u ? depthA[i] : share * depthA[i] + rest * depthB[i];
}
#endif

/// sum = a + b.
#include "pass/sumOfHalves.h"
#ifdef PASS_sumOfHalves
__kernel void sumOfHalves(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    sum[i] = a[i] + b[i];
}
#endif

/// The same of lists of `count` numbers.
#include "pass/sumOfLists.h"
#ifdef PASS_sumOfLists
__kernel void sumOfLists(PARAMETERS)
{
    const uint i = get_global_id(0);
    if (i < count) {
        sum[i] = a[i] + b[i];
    }
}
#endif

/// The squared error of the mean of the halves F_A and F_B, in two parts, each the mean over the channels.
/// in   beauty: F; plain: N, the same before any filter, whose mean is the truth
/// out  noise: ((F_A - F_B) / 2)^2, on average the variance of the mean
///      bias: (F_A - N_A) (F_B - N_B), on average the squared bias, as the halves know nothing of each other; 0 without
///      a filter (filtered: 0)
#include "pass/errorOfHalves.h"
#ifdef PASS_errorOfHalves
__kernel void errorOfHalves(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 a = loadVec(beautyA, n, i), b = loadVec(beautyB, n, i), d = vecSub(a, b);
    const Vec3 changeA = vecSub(a, loadVec(plainA, n, i)), changeB = vecSub(b, loadVec(plainB, n, i));
    noise[i] = vecDot(d, d) / 12.0f;
    bias[i] = filtered != 0u ? vecDot(changeA, changeB) / 3.0f : 0.0f;
}
#endif
