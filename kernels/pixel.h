// Which pixel a work-item of a tiled pass works on.
#ifndef WEDGE_PIXEL_H
#define WEDGE_PIXEL_H

#include "shared/frame.h"

/// Pixel of this work-item; false beyond the rectangle. Items take 8x8 tiles, whatever the size of the work-groups;
/// consecutive tiles are distant ones, so that a costly part of the image does not end up with one thread.
/// firstGroup: the work-groups of the pass that went before this launch.
WEDGE_FN bool tilePixel(FrameParams frame, uint firstGroup, uint* x, uint* y)
{
    const ulong item = (ulong)firstGroup * get_local_size(0) + get_global_id(0);
    const ulong slot = item / WEDGE_TILE_PIXELS;
    if (slot >= frame.tileCount) {
        return false;
    }
    const uint tile = (uint)((slot * frame.tileStep) % frame.tileCount);
    const uint inTile = (uint)(item % WEDGE_TILE_PIXELS);
    *x = frame.x0 + (tile % frame.tilesX) * WEDGE_TILE + inTile % WEDGE_TILE;
    *y = frame.y0 + (tile / frame.tilesX) * WEDGE_TILE + inTile / WEDGE_TILE;
    return *x < frame.x1 && *y < frame.y1;
}

WEDGE_FN Vec3 loadVec(__global const float* planes, uint planeSize, uint i)
{
    return vec3(planes[i], planes[planeSize + i], planes[2u * planeSize + i]);
}

WEDGE_FN void storeVec(__global float* planes, uint planeSize, uint i, Vec3 v)
{
    planes[i] = v.x;
    planes[planeSize + i] = v.y;
    planes[2u * planeSize + i] = v.z;
}

#endif
