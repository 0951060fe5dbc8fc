// The image-space filters of lens and shutter (thesis 5.33, B.1): Gaussians around each pixel, as wide as what it shows
// is blurred already. A pair of pixels is weighted by the narrower of both kernels, so that what is sharp does not leak
// into what is blurred.
#ifndef WEDGE_BLUR_H
#define WEDGE_BLUR_H

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

/// Of one whose standard deviation is the length of v, as lean frames keep it.
WEDGE_FN MotionBlur blurOfVector(float2 v)
{
    MotionBlur b;
    b.sigma = sqrt(v.x * v.x + v.y * v.y);
    b.x = b.sigma > 0.0f ? v.x / b.sigma : 1.0f;
    b.y = b.sigma > 0.0f ? v.y / b.sigma : 0.0f;
    return b;
}

WEDGE_FN MotionBlur blurAlongUnit(float sigma, float2 direction)
{
    MotionBlur b;
    b.sigma = sigma;
    b.x = direction.x;
    b.y = direction.y;
    return b;
}

/// Weight of a pixel k steps along the motion of another: 0 for another motion.
WEDGE_FN float motionWeight(MotionBlur here, MotionBlur there, int k)
{
    const float turn = here.x * there.x + here.y * there.y;
    return turn > WEDGE_SAME_DIRECTION ? blurWeight(here.sigma, there.sigma, fabs((float)k)) : 0.0f;
}

#endif
