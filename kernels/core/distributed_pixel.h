// How sharp a pixel of a distributed frame is at least.
#ifndef WEDGE_DISTRIBUTED_PIXEL_H
#define WEDGE_DISTRIBUTED_PIXEL_H

#include "shared/distributed.h"
#include "shared/frame.h"

/// Smallest radius of a pixel's circles of confusion in pixels; 0 where it is in focus somewhere. confusion: least and
/// largest signed radius.
WEDGE_FN float leastConfusion(float2 confusion)
{
    return confusion.x > 0.0f ? confusion.x : confusion.y < 0.0f ? -confusion.y : 0.0f;
}

#endif
