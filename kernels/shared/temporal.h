// Parameters of the filter over time, and where a frame's pixel lies in an earlier one.
#ifndef WEDGE_SHARED_TEMPORAL_H
#define WEDGE_SHARED_TEMPORAL_H

#include "rng.h"
#include "vec.h"

/// Edge of the blocks of pixels that one test of the light is made of.
#define WEDGE_TEMPORAL_BLOCK 4u
/// Blocks around one, either way, that its wider test is over.
#define WEDGE_TEMPORAL_REACH 2
/// Added to reflectances that light is divided by: what is darker is not told from noise.
#define WEDGE_TEMPORAL_DARK 0.01f
/// Floats of an object's motion: three rows of an affine map, and WEDGE_TEMPORAL_* of its kind.
#define WEDGE_TEMPORAL_MOTION 13u
#define WEDGE_TEMPORAL_UNKNOWN 0.0f
#define WEDGE_TEMPORAL_STILL 1.0f
#define WEDGE_TEMPORAL_MOVED 2.0f
/// Parallel to the view axis, metres: what is nearer has no place in the image.
#define WEDGE_TEMPORAL_NEAREST 1e-6f

WEDGE_SHARED_BEGIN

typedef struct {
    uint x0, y0, x1, y1; ///< the pixels to produce, half open
    uint width, height, stride, planeSize;
    uint blocksX, blocksY; ///< blocks of the image
    uint cameraStill; ///< 1: the camera is that of the earlier frame
    uint objectsStill; ///< 1: no object has moved, and there are no motions
    uint objects; ///< that there are motions of
    uint mixed; ///< 1: pixels have several receivers, and those of none reflect, too
    uint indirect; ///< 1: there is indirect light
    uint open; ///< 1: what is shown is how open surfaces' surroundings are, and no reflectance
    uint measured; ///< 1: the noise of unfiltered light is known
    uint published; ///< 1: of the nearest pixel, and whatever lights it
    float normalCosine; ///< the least between both normals of what is one surface
    Vec3 eye, forward, right, down; ///< of the frame that is read, or, kept, of this one: as FrameParams has them
} TemporalParams;

/// Where a camera sees a point, pixels from the image's corner, and how deep along its axis; false: nowhere.
WEDGE_FN bool temporalProject(TemporalParams p, Vec3 point, Vec2* at, float* depth)
{
    const Vec3 d = vecSub(point, p.eye);
    *depth = vecDot(d, p.forward);
    if (!(*depth > WEDGE_TEMPORAL_NEAREST)) {
        return false;
    }
    *at = vec2(vecDot(d, p.right) / (vecDot(p.right, p.right) * *depth) + 0.5f * (float)p.width,
        vecDot(d, p.down) / (vecDot(p.down, p.down) * *depth) + 0.5f * (float)p.height);
    return at->x > -1.0f && at->y > -1.0f && at->x < (float)p.width + 1.0f && at->y < (float)p.height + 1.0f;
}

/// 1 up to `from`, 0 from `to` on.
WEDGE_FN float temporalFall(float x, float from, float to)
{
    const float over = clamp((x - from) / (to - from), 0.0f, 1.0f);
    return 1.0f - over * over * (3.0f - 2.0f * over);
}

/// Weight of an earlier frame's light from Student's t of the differences, squared, and from the ratio of their squares
/// to what noise makes of them: 1 up to 3 deviations and a ratio of 4, 0 from 4 deviations or a ratio of 8 on.
WEDGE_FN float temporalTrust(float tSquared, float ratio)
{
    return temporalFall(sqrt(tSquared), 3.0f, 4.0f) * temporalFall(ratio, 4.0f, 8.0f);
}

WEDGE_SHARED_END

#endif
