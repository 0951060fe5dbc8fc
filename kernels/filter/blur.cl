// The image-space filters of lens and shutter (thesis 5.33, B.1): Gaussians around each pixel, as wide as what it shows
// is blurred already. A pair of pixels is weighted by the narrower of both kernels, so that what is sharp does not leak
// into what is blurred.
#include "core/formats.h"
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

/// Along the motion: of a term its texture, or a value of one number. along, directions, or vectors: of blurs() or
/// shadowBlurs() of distributed.cl
#include "pass/blurMotion.h"
#ifdef PASS_blurMotion
#define MOTION_BLUR(n, i)                                                                                              \
    (HAS_vectors ? blurOfVector(LOAD_vectors(n, i)) : blurAlongUnit(LOAD_along(n, i), LOAD_directions(n, i)))
#define BLURRED(n, i) (HAS_texture ? LOAD_texture(n, i) : vec3(LOAD_value(n, i), 0.0f, 0.0f))
__kernel void blurMotion(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const MotionBlur here = MOTION_BLUR(n, i);
    const int reach = min((int)(WEDGE_BLUR_CUT * here.sigma), WEDGE_MOTION_REACH);
    Vec3 sum = BLURRED(n, i);
    float weights = 1.0f;
    for (int k = -reach; k <= reach; ++k) {
        const uint j = pixelAlong(p, x, y, i, here.x, here.y, k);
        const float w = j != i ? motionWeight(here, MOTION_BLUR(n, j), k) : 0.0f;
        if (w > 0.0f) {
            weights += w;
            sum = vecMad(sum, BLURRED(n, j), w);
        }
    }
#if HAS_texture
    storeVec(out, n, i, vec3(sum.x / weights, sum.y / weights, sum.z / weights));
#else
    out[i] = sum.x / weights;
#endif
}
#endif
