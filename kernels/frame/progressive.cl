// Progressive frames: two independent halves, of which the image is the mean, and how far from the truth they say it
// is.
#include "core/distributed_pixel.h"
#include "core/pixel.h"
#include "shared/distributed.h"
#include "shared/wave.h"

/// Copies an image (3 planes).
__kernel void copyImage(DistributedParams p, __global const float* restrict in, __global float* restrict out)
{
    uint x, y, i;
    if (pixelOf(p, &x, &y, &i)) {
        storeVec(out, p.planeSize, i, loadVec(in, p.planeSize, i));
    }
}

/// What the first half weighs of two with so many samples: one that has none yet has no say.
WEDGE_FN float shareOfFirst(uint first, uint second) { return second == 0u ? 1.0f : first == 0u ? 0.0f : 0.5f; }

/// mean = the mean of the halves' `planes`; takenA, takenB: their primary samples.
__kernel void meanOfHalves(DistributedParams p, uint planes, __global const uint* restrict takenA,
    __global const uint* restrict takenB, __global const float* restrict a, __global const float* restrict b,
    __global float* restrict mean)
{
    uint x, y, i;
    if (!pixelOf(p, &x, &y, &i)) {
        return;
    }
    const float share = shareOfFirst(takenA[i], takenB[i]);
    for (uint plane = 0u; plane < planes; ++plane) {
        const uint at = plane * p.planeSize + i;
        mean[at] = share * a[at] + (1.0f - share) * b[at];
    }
}

/// Objects: WEDGE_MIXED where the halves' differ.
__kernel void joinObjects(DistributedParams p, __global const uint* restrict objectA,
    __global const uint* restrict objectB, __global uint* restrict object)
{
    uint x, y, i;
    if (pixelOf(p, &x, &y, &i)) {
        const uint a = objectA[i], b = objectB[i];
        object[i] = a == 0u || a == b ? b : b == 0u ? a : WEDGE_MIXED;
    }
}

/// What is known of surfaces alone, of both halves' hits: positions, normals (3 planes each), sizes of pixels, and
/// distances (that of one half where the other missed).
__kernel void joinSurfaces(DistributedParams p, __global const uint* restrict hitsA,
    __global const uint* restrict hitsB, __global const float* restrict positionA,
    __global const float* restrict positionB, __global const float* restrict normalA,
    __global const float* restrict normalB, __global const float* restrict pixelSizeA,
    __global const float* restrict pixelSizeB, __global const float* restrict depthA,
    __global const float* restrict depthB, __global float* restrict position, __global float* restrict normal,
    __global float* restrict pixelSize, __global float* restrict depth)
{
    uint x, y, i;
    if (!pixelOf(p, &x, &y, &i)) {
        return;
    }
    const uint n = p.planeSize, a = hitsA[i], b = hitsB[i];
    const float share = a + b > 0u ? (float)a / (float)(a + b) : 0.5f, rest = 1.0f - share;
    storeVec(position, n, i, vecMad(vecScale(loadVec(positionA, n, i), share), loadVec(positionB, n, i), rest));
    const Vec3 sum = vecMad(vecScale(loadVec(normalA, n, i), share), loadVec(normalB, n, i), rest);
    storeVec(normal, n, i, a + b > 0u && vecDot(sum, sum) > 0.0f ? vecNormalize(sum) : vec3(0.0f, 0.0f, 0.0f));
    pixelSize[i] = share * pixelSizeA[i] + rest * pixelSizeB[i];
    // Not a weighted sum: either may be infinite.
    depth[i] = a == 0u && b > 0u ? depthB[i] : b == 0u ? depthA[i] : share * depthA[i] + rest * depthB[i];
}

/// sum = a + b.
__kernel void sumOfHalves(
    DistributedParams p, __global const uint* restrict a, __global const uint* restrict b, __global uint* restrict sum)
{
    uint x, y, i;
    if (pixelOf(p, &x, &y, &i)) {
        sum[i] = a[i] + b[i];
    }
}

/// The same of lists of `count` numbers.
__kernel void sumOfLists(
    uint count, __global const uint* restrict a, __global const uint* restrict b, __global uint* restrict sum)
{
    const uint i = get_global_id(0);
    if (i < count) {
        sum[i] = a[i] + b[i];
    }
}

/// The squared error of the mean of the halves F_A and F_B, in two parts, each the mean over the channels.
/// in   beauty: F; plain: N, the same before any filter, whose mean is the truth
/// out  noise: ((F_A - F_B) / 2)^2, on average the variance of the mean
///      bias: (F_A - N_A) (F_B - N_B), on average the squared bias, as the halves know nothing of each other; 0 without
///      a filter (filtered: 0)
__kernel void errorOfHalves(DistributedParams p, uint filtered, __global const float* restrict beautyA,
    __global const float* restrict plainA, __global const float* restrict beautyB,
    __global const float* restrict plainB, __global float* restrict noise, __global float* restrict bias)
{
    uint x, y, i;
    if (!pixelOf(p, &x, &y, &i)) {
        return;
    }
    const uint n = p.planeSize;
    const Vec3 a = loadVec(beautyA, n, i), b = loadVec(beautyB, n, i), d = vecSub(a, b);
    const Vec3 changeA = vecSub(a, loadVec(plainA, n, i)), changeB = vecSub(b, loadVec(plainB, n, i));
    noise[i] = vecDot(d, d) / 12.0f;
    bias[i] = filtered != 0u ? vecDot(changeA, changeB) / 3.0f : 0.0f;
}
