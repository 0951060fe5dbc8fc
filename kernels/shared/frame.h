// One frame's constants as the kernels see them, and the layout of its per-pixel planes.
#ifndef WEDGE_SHARED_FRAME_H
#define WEDGE_SHARED_FRAME_H

#include "vec.h"

/// Pixels of a vector block: the filters work on 16 neighbours of a row at once.
#define WEDGE_BLOCK_PIXELS 16u
/// Padding between rows of a plane, a multiple of the block: a gather may read this far beyond a row's ends
/// and finds objectId 0 there.
#define WEDGE_ROW_PADDING 48u
/// Largest radius of a gather in pixels, at most WEDGE_ROW_PADDING.
#define WEDGE_MAX_RADIUS 40
/// Edge of the square pixel tiles that one work-group traces.
#define WEDGE_TILE 8u
#define WEDGE_TILE_PIXELS 64u
/// Tiles of a strip, which follow each other in their row, or from its end to the next one's start.
#define WEDGE_STRIP_TILES 8u

WEDGE_SHARED_BEGIN

typedef struct {
    uint width, height; ///< pixels of the full image, margins included
    uint stride; ///< floats from one row of a plane to the next
    uint planeSize; ///< floats of a plane
    uint x0, y0, x1, y1; ///< the rectangle of pixels to work on, half open
    uint tilesX; ///< tiles of that rectangle in x
    uint tileCount;
    uint tileStep; ///< coprime to the number of whole strips: of many the next is distant
    uint seed;
    Vec3 eye; ///< metres
    Vec3 forward; ///< unit
    Vec3 right; ///< image-plane step of one pixel in x at distance 1
    Vec3 down; ///< image-plane step of one pixel in y at distance 1
    Vec3 background;
    uint receivers; ///< of a wave, which lie one after the other; 0: the pixels of the rectangle are the receivers
    uint margin; ///< pixels along each border that are beyond the image that is shown
} FrameParams;

/// A number of each pixel, for its random numbers: in the image the same with a margin and without.
WEDGE_FN uint pixelNumber(FrameParams frame, uint x, uint y)
{
    return (y - frame.margin) * (frame.width - 2u * frame.margin) + (x - frame.margin);
}

/// Index of pixel (x, y) in a plane.
WEDGE_FN uint pixelIndex(uint x, uint y, uint stride) { return WEDGE_ROW_PADDING + y * stride + x; }

/// Direction through image position (x, y) in pixels, not normalised: its component along forward is 1.
WEDGE_FN Vec3 cameraDirection(Vec3 forward, Vec3 right, Vec3 down, float width, float height, float x, float y)
{
    return vecMad(vecMad(forward, right, x - 0.5f * width), down, y - 0.5f * height);
}

/// A unit vector in 32 bits: 16 an axis of the octahedron's map, 1e-4 radians exact.
WEDGE_FN uint packDirection(Vec3 v)
{
    const float scale = 1.0f / (fabs(v.x) + fabs(v.y) + fabs(v.z));
    const float x = v.x * scale, y = v.y * scale;
    const bool upper = v.z >= 0.0f;
    const float a = upper ? x : (1.0f - fabs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    const float b = upper ? y : (1.0f - fabs(x)) * (y < 0.0f ? -1.0f : 1.0f);
    return (uint)((0.5f * a + 0.5f) * 65535.0f + 0.5f) | ((uint)((0.5f * b + 0.5f) * 65535.0f + 0.5f) << 16);
}

/// The vector, of unit length, that packDirection() packed.
WEDGE_FN Vec3 unpackDirection(uint packed)
{
    const float a = (float)(packed & 65535u) * (2.0f / 65535.0f) - 1.0f;
    const float b = (float)(packed >> 16) * (2.0f / 65535.0f) - 1.0f;
    const float z = 1.0f - fabs(a) - fabs(b);
    const float x = z >= 0.0f ? a : (1.0f - fabs(b)) * (a < 0.0f ? -1.0f : 1.0f);
    const float y = z >= 0.0f ? b : (1.0f - fabs(a)) * (b < 0.0f ? -1.0f : 1.0f);
    return vecNormalize(vec3(x, y, z));
}

WEDGE_SHARED_END

#endif
