// The image-space filters of lens and shutter (thesis 5.33, B.1): Gaussians around each pixel, as wide as what it shows
// is blurred already. A pair of pixels is weighted by the narrower of both kernels, so that what is sharp does not leak
// into what is blurred.
#include "core/distributed_pixel.h"
#include "core/pixel.h"
#include "shared/distributed.h"

/// Kernels end at this many standard deviations.
#define WEDGE_BLUR_CUT 2.5f
/// Least cosine between motions of pixels that are averaged.
#define WEDGE_SAME_DIRECTION 0.9f

WEDGE_FN float blurWeight(float sigma, float there, float d)
{
    const float s = fmin(sigma, there);
    return s > 0.0f && d <= WEDGE_BLUR_CUT * s ? exp(-0.5f * d * d / (s * s)) : 0.0f;
}

/// One direction of the lens' filter. element: 1 along x, the stride along y.
WEDGE_FN void blurLine(DistributedParams p, uint i, int before, int after, int element, __global const float* lens,
    __global const float* in, __global float* out)
{
    const uint n = p.planeSize;
    Vec3 sum = loadVec(in, n, i);
    const float sigma = lens[i];
    float weights = 1.0f;
    const int reach = min((int)(WEDGE_BLUR_CUT * sigma), WEDGE_MAX_RADIUS);
    for (int k = -min(reach, before); k <= min(reach, after); ++k) {
        const uint j = (uint)((int)i + k * element);
        const float w = k != 0 ? blurWeight(sigma, lens[j], fabs((float)k)) : 0.0f;
        weights += w;
        sum = w > 0.0f ? vecMad(sum, loadVec(in, n, j), w) : sum;
    }
    storeVec(out, n, i, vecScale(sum, 1.0f / weights));
}

#include "pass/blurRows.h"
#ifdef PASS_blurRows
__kernel void blurRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    blurLine(p, i, (int)x, (int)(p.width - 1u - x), 1, lens, in, out);
}
#endif

#include "pass/blurColumns.h"
#ifdef PASS_blurColumns
__kernel void blurColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    blurLine(p, i, (int)y, (int)(p.height - 1u - y), (int)p.stride, lens, in, out);
}
#endif

/// Index of the pixel k steps along direction (dx, dy) from (x, y); the pixel's own beyond the image.
WEDGE_FN uint pixelAlong(DistributedParams p, uint x, uint y, uint i, float dx, float dy, int k)
{
    const int px = (int)floor((float)x + 0.5f + (float)k * dx), py = (int)floor((float)y + 0.5f + (float)k * dy);
    return px < 0 || py < 0 || px >= (int)p.width || py >= (int)p.height ? i : pixelIndex((uint)px, (uint)py, p.stride);
}

/// A pixel's filter along its motion, of that standard deviation and direction.
typedef struct {
    float sigma, x, y;
} MotionBlur;

/// As distributed.cl stores them: packed, `directions` have it all.
WEDGE_FN MotionBlur motionBlur(
    DistributedParams p, uint i, __global const float* along, __global const float* directions)
{
    MotionBlur b;
    if (p.packed == 0u) {
        b.sigma = along[i];
        b.x = directions[i];
        b.y = directions[p.planeSize + i];
        return b;
    }
    b.x = loadShort(directions, p.planeSize, i, 0u);
    b.y = loadShort(directions, p.planeSize, i, 1u);
    b.sigma = sqrt(b.x * b.x + b.y * b.y);
    b.x = b.sigma > 0.0f ? b.x / b.sigma : 1.0f;
    b.y = b.sigma > 0.0f ? b.y / b.sigma : 0.0f;
    return b;
}

/// Weight of a pixel k steps along the motion of another: 0 for another motion.
WEDGE_FN float motionWeight(MotionBlur here, MotionBlur there, int k)
{
    const float turn = here.x * there.x + here.y * there.y;
    return turn > WEDGE_SAME_DIRECTION ? blurWeight(here.sigma, there.sigma, fabs((float)k)) : 0.0f;
}

/// What is filtered along motions: one plane, or a term's texture.
WEDGE_FN void loadChannels(DistributedParams p, uint channels, __global const float* in, uint i, float* out)
{
    if (channels == 1u) {
        out[0] = in[i];
        return;
    }
    const Vec3 k = loadTexture(p, in, i);
    out[0] = k.x;
    out[1] = k.y;
    out[2] = k.z;
}

/// Along the motion; channels: 1, or 3 of a term's texture.
#include "pass/blurMotion.h"
#ifdef PASS_blurMotion
__kernel void blurMotion(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const MotionBlur here = motionBlur(p, i, along, directions);
    const int reach = min((int)(WEDGE_BLUR_CUT * here.sigma), WEDGE_MOTION_REACH);
    float sum[3], there[3];
    loadChannels(p, channels, in, i, sum);
    float weights = 1.0f;
    for (int k = -reach; k <= reach; ++k) {
        const uint j = pixelAlong(p, x, y, i, here.x, here.y, k);
        const float w = j != i ? motionWeight(here, motionBlur(p, j, along, directions), k) : 0.0f;
        if (w > 0.0f) {
            weights += w;
            loadChannels(p, channels, in, j, there);
            for (uint c = 0u; c < channels; ++c) {
                sum[c] += w * there[c];
            }
        }
    }
    for (uint c = 0u; c < channels; ++c) {
        out[c * n + i] = sum[c] / weights;
    }
}
#endif
