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

WEDGE_SHARED_BEGIN

typedef struct {
    uint width, height;  ///< pixels of the full image
    uint stride;         ///< floats from one row of a plane to the next
    uint planeSize;      ///< floats of a plane
    uint x0, y0, x1, y1; ///< the rectangle of pixels to work on, half open
    uint tilesX;         ///< tiles of that rectangle in x
    uint tileCount;
    uint tileStep; ///< coprime to tileCount: consecutive work-groups take distant tiles
    uint seed;
    Vec3 eye;     ///< metres
    Vec3 forward; ///< unit
    Vec3 right;   ///< image-plane step of one pixel in x at distance 1
    Vec3 down;    ///< image-plane step of one pixel in y at distance 1
    Vec3 background;
    uint padding;
} FrameParams;

/// Index of pixel (x, y) in a plane.
WEDGE_FN uint pixelIndex(uint x, uint y, uint stride) { return WEDGE_ROW_PADDING + y * stride + x; }

/// Direction through image position (x, y) in pixels, not normalised: its component along forward is 1.
WEDGE_FN Vec3 cameraDirection(Vec3 forward, Vec3 right, Vec3 down, float width, float height, float x, float y)
{
    return vecMad(vecMad(forward, right, x - 0.5f * width), down, y - 0.5f * height);
}

WEDGE_SHARED_END

#endif
