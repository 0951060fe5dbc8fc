// Which pixel a work-item of a tiled pass works on.
#ifndef WEDGE_PIXEL_H
#define WEDGE_PIXEL_H

#include "core/packet_size.h"
#include "shared/frame.h"

/// Pixel `inTile` of the tile that is taken as number `slot`, less than frame.tileCount; false beyond the rectangle.
WEDGE_FN bool slotPixel(FrameParams frame, uint slot, uint inTile, uint* x, uint* y)
{
    const uint strips = frame.tileCount / WEDGE_STRIP_TILES, strip = slot / WEDGE_STRIP_TILES;
    const uint distant = strip < strips ? (uint)(((ulong)strip * frame.tileStep) % strips) : strip;
    const uint tile = distant * WEDGE_STRIP_TILES + slot % WEDGE_STRIP_TILES;
    const uint block = inTile / 16u;
    *x = frame.x0 + (tile % frame.tilesX) * WEDGE_TILE + block % 2u * 4u + inTile % 4u;
    *y = frame.y0 + (tile / frame.tilesX) * WEDGE_TILE + block / 2u * 4u + inTile % 16u / 4u;
    return *x < frame.x1 && *y < frame.y1;
}

/// Pixel of one lane of this work-item, which has WEDGE_PACKET_SIZE of them; false beyond the rectangle. Items take 8x8
/// tiles, and in them blocks of 4x4 pixels, so that a packet of 16 is such a block, whatever the size of work-groups.
/// Strips of tiles that follow each other in their row are taken as wholes, and the strips of a large image in an order
/// in which the next is a distant one: so that a costly part of the image does not end up with one thread, and lines of
/// memory, and the pages that rows of pixels are in, are still there for the next tile.
/// firstGroup: the work-groups of the pass that went before this launch.
WEDGE_FN bool tilePixel(FrameParams frame, uint firstGroup, uint lane, uint* x, uint* y)
{
    const ulong item = (ulong)firstGroup * get_local_size(0) + get_global_id(0);
    const ulong pixel = item * WEDGE_PACKET_SIZE + lane;
    const ulong slot = pixel / WEDGE_TILE_PIXELS;
    if (slot >= frame.tileCount) {
        return false;
    }
    return slotPixel(frame, (uint)slot, (uint)(pixel % WEDGE_TILE_PIXELS), x, y);
}

/// Cosine that the projected pixel size does not go below, against infinities at grazing views.
#define WEDGE_MIN_VIEW_COSINE 0.01f

/// Projected edge in metres of a pixel on a surface of that normal, where the ray of that direction, whose part along
/// the view axis is 1, meets it at t.
WEDGE_FN float projectedPixel(FrameParams frame, Vec3 normal, Vec3 direction, float t)
{
    const float length = vecLength(direction);
    // Solid angle of a pixel off the axis: area / distance^2 times the cosine to the image plane, cos^3 in all.
    const float axis = 1.0f / length;
    const float solidAngle = vecLength(vecCross(frame.right, frame.down)) * axis * axis * axis;
    const float cosine = fmax(fabs(vecDot(normal, direction)) * axis, WEDGE_MIN_VIEW_COSINE);
    return t * length * sqrt(solidAngle / cosine);
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
