// Widths of the filters of environment light along the image's axes, from curvatures in screen space (6.20) and the
// nearest occluders (thesis sections 6.6 and 6.7).
#include "core/packed_planes.h"
#include "core/vector16.h"
#include "shared/curvature.h"
#include "shared/path.h"

/// From a block of pixels to others.
typedef struct {
    float16 curvature; ///< 1/m
    int16 known; ///< of the same object, and elsewhere
} Bend;

/// (6.20): the angle between both normals over the distance of both positions. Convex surfaces, whose normals turn with
/// the step, have positive ones. (The thesis takes the sign from the step and one normal, which is the same on smooth
/// surfaces, and noise on facets with smooth normals.) The angle comes of the normals' difference, since arc cosines of
/// small angles are rounding.
WEDGE_FN Bend bendTo(CurvatureParams p, int i, int j, __global const float* position, __global const float* normal,
    __global const uint* objectId)
{
    const Vec3x16 d = sub16(loadVecBlock(position, p.planeSize, j), loadVecBlock(position, p.planeSize, i));
    const Vec3x16 turn = sub16(loadVecBlock(normal, p.planeSize, j), loadVecBlock(normal, p.planeSize, i));
    const float16 squared = dot16(d, d);
    const float16 chord = min16(0.5f * sqrt(dot16(turn, turn)), (float16)(1.0f));
    const float16 angle = 2.0f * asin(chord);
    const float16 size = angle * rsqrt(max16(squared, (float16)(1e-30f)));
    Bend bend;
    bend.curvature = dot16(d, turn) < 0.0f ? -size : size;
    bend.known = (loadIdBlock(objectId, j) == loadIdBlock(objectId, i)) & (squared > 0.0f);
    return bend;
}

/// With the next pixel or, where that is not of the object, the one before; 0 where neither is.
WEDGE_FN float16 curvatureAlong(CurvatureParams p, int i, int before, int after, __global const float* position,
    __global const float* normal, __global const uint* objectId)
{
    const Bend next = bendTo(p, i, after, position, normal, objectId);
    const Bend last = bendTo(p, i, before, position, normal, objectId);
    return next.known ? next.curvature : last.known ? last.curvature : (float16)(0.0f);
}

/// The least distance of an occluder that a pixel of the object around found, metres, 0 where none did.
#include "pass/nearestOccluders.h"
#ifdef PASS_nearestOccluders
__kernel void nearestOccluders(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int reach = WEDGE_OCCLUDER_REACH;
    const uint16 object = loadIdBlock(objectId, i);
    float16 least = (float16)(INFINITY);
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const float16 there = loadBlock(occluders, j);
            const int16 counts = (loadIdBlock(objectId, j) == object) & (there > 0.0f);
            least = counts ? min16(least, there) : least;
        }
    }
    vstore16(least < INFINITY ? least : (float16)(0.0f), 0, nearest + i);
}
#endif

/// The geometric mean of the distances of the object's pixels around that have one, metres, 0 where none has.
#include "pass/meanOccluders.h"
#ifdef PASS_meanOccluders
__kernel void meanOccluders(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int reach = WEDGE_OCCLUDER_MEAN_REACH;
    const uint16 object = loadIdBlock(objectId, i);
    const float16 none = (float16)(0.0f), one = (float16)(1.0f);
    float16 sum = none, pixels = none;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const float16 there = loadBlock(nearest, j);
            const int16 counts = (loadIdBlock(objectId, j) == object) & (there > 0.0f);
            sum += counts ? log2Block(max16(there, (float16)(1e-20f))) : none;
            pixels += counts ? one : none;
        }
    }
    vstore16(pixels > 0.0f ? exp2Block(sum / max16(pixels, one)) : none, 0, mean + i);
}
#endif

/// Standard deviations of kernels exp(-2 B^2 r^2), 1 / (2 |B|), metres, along x and along y, and their mean; -1 where
/// the pixel has no such term. occluders: the least r / cos theta of a hidden direction, metres, 0 where there is none.
#include "pass/curvatureWidths.h"
#ifdef PASS_curvatureWidths
__kernel void curvatureWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int above = y > 0u ? i - (int)p.stride : i, below = y + 1u < p.height ? i + (int)p.stride : i;
    float bendX[WEDGE_BLOCK_PIXELS], bendY[WEDGE_BLOCK_PIXELS], occluded[WEDGE_BLOCK_PIXELS], size[WEDGE_BLOCK_PIXELS];
    float along[WEDGE_BLOCK_PIXELS], across[WEDGE_BLOCK_PIXELS];
    // The padding of the rows holds objectId 0.
    vstore16(curvatureAlong(p, i, i - 1, i + 1, position, normal, objectId), 0, bendX);
    vstore16(curvatureAlong(p, i, above, below, position, normal, objectId), 0, bendY);
    const float16 nearest = loadBlock(occluders, i);
    vstore16(nearest > 0.0f ? 1.0f / max16(nearest, (float16)(1e-20f)) : (float16)(0.0f), 0, occluded);
    vstore16(loadBlock(pixelSize, i), 0, size);
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const float lobe = WEDGE_IS_GLOSSY(p.component) ? lobeBandwidth(unpackGloss(gloss[(uint)i + lane])) : 0.0f;
        const float least = p.leastPixels * size[lane], most = p.mostPixels * size[lane];
        const float ofX = fabs(curvatureBandwidth(p, bendX[lane], occluded[lane], lobe));
        const float ofY = fabs(curvatureBandwidth(p, bendY[lane], occluded[lane], lobe));
        along[lane] = fmin(fmax(0.5f / fmax(ofX, 1e-30f), least), most);
        across[lane] = fmin(fmax(0.5f / fmax(ofY, 1e-30f), least), most);
    }
    const int16 has = loadIdBlock(taken, i) > 0u;
    const float16 none = (float16)(-1.0f), ofX = vload16(0, along), ofY = vload16(0, across);
    vstore16(has ? ofX : none, 0, widthX + i);
    vstore16(has ? ofY : none, 0, widthY + i);
    vstore16(has ? 0.5f * (ofX + ofY) : none, 0, beta + i);
}
#endif
