// Which pixel a work-item of a tiled pass works on.
#ifndef WEDGE_PIXEL_H
#define WEDGE_PIXEL_H

#include "packet_size.h"
#include "shared/frame.h"

/// Pixel of one lane of this work-item, which has WEDGE_PACKET_SIZE of them; false beyond the rectangle. Items take 8x8
/// tiles, and in them blocks of 4x4 pixels, so that a packet of 16 is such a block, whatever the size of work-groups.
/// Consecutive tiles are distant ones, so that a costly part of the image does not end up with one thread.
/// firstGroup: the work-groups of the pass that went before this launch.
WEDGE_FN bool tilePixel(FrameParams frame, uint firstGroup, uint lane, uint* x, uint* y)
{
    const ulong item = (ulong)firstGroup * get_local_size(0) + get_global_id(0);
    const ulong pixel = item * WEDGE_PACKET_SIZE + lane;
    const ulong slot = pixel / WEDGE_TILE_PIXELS;
    if (slot >= frame.tileCount) {
        return false;
    }
    const uint tile = (uint)((slot * frame.tileStep) % frame.tileCount);
    const uint inTile = (uint)(pixel % WEDGE_TILE_PIXELS);
    const uint block = inTile / 16u;
    *x = frame.x0 + (tile % frame.tilesX) * WEDGE_TILE + block % 2u * 4u + inTile % 4u;
    *y = frame.y0 + (tile / frame.tilesX) * WEDGE_TILE + block / 2u * 4u + inTile % 16u / 4u;
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
