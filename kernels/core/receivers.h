// Receivers: points of surfaces that light is gathered for. They are the pixels of a rectangle, one each, in the
// frame's own planes; or those of a wave, in planes of the wave's, many to a pixel (waves.cl).
#ifndef WEDGE_RECEIVERS_H
#define WEDGE_RECEIVERS_H

#include "core/pixel.h"

#define WEDGE_NO_PIXEL 0xffffffffu ///< the index of a lane without a receiver

/// The planes that effects sample at.
typedef struct {
    __global const float *position, *normal, *origin; ///< 3 planes each, as primary.cl has them
    __global const uint* geometric;
    __global const uint* objectId; ///< 0: nothing to shade
    __global const uint* gloss; ///< packGloss()
    __global const uint* pixelOf; ///< of a wave: x in the lower 16 bits, y in the upper
    __global const uint* view; ///< of a wave: packed direction to where the primary ray came from
    __global const float* time; ///< of a wave: in [0, 1] while the shutter is open
} ReceiverData;

/// The ReceiverData of a kernel's parameters of these names.
#define WEDGE_RECEIVER_ARGUMENTS                                                                                       \
    receiverData(position, normal, origin, geometric, objectId, gloss, PLANE_pixelOf, PLANE_view, PLANE_time)

WEDGE_FN ReceiverData receiverData(__global const float* position, __global const float* normal,
    __global const float* origin, __global const uint* geometric, __global const uint* objectId,
    __global const uint* gloss, __global const uint* pixelOf, __global const uint* view, __global const float* time)
{
    ReceiverData data;
    data.position = position;
    data.normal = normal;
    data.origin = origin;
    data.geometric = geometric;
    data.objectId = objectId;
    data.gloss = gloss;
    data.pixelOf = pixelOf;
    data.view = view;
    data.time = time;
    return data;
}

/// Where one lane's receiver lies in the planes, and its pixel; false where there is none.
WEDGE_FN bool receiverOf(FrameParams frame, ReceiverData data, uint firstGroup, uint lane, uint* i, uint* x, uint* y)
{
    if (frame.receivers == 0u) {
        const bool inside = tilePixel(frame, firstGroup, lane, x, y);
        *i = inside ? pixelIndex(*x, *y, frame.stride) : 0u;
        return inside;
    }
    const ulong receiver = ((ulong)firstGroup * get_local_size(0) + get_global_id(0)) * WEDGE_PACKET_SIZE + lane;
    if (receiver >= frame.receivers) {
        return false;
    }
    *i = (uint)receiver;
    *x = data.pixelOf[*i] & 0xffffu;
    *y = data.pixelOf[*i] >> 16;
    return true;
}

/// Unit vector from a receiver to where it is seen from.
WEDGE_FN Vec3 viewOf(FrameParams frame, ReceiverData data, uint i, Vec3 at)
{
    return frame.receivers == 0u ? vecNormalize(vecSub(frame.eye, at)) : unpackDirection(data.view[i]);
}

#endif
