// Which pixel a work-item of a pass over distributed frames works on, and how sharp that is at least.
#ifndef WEDGE_DISTRIBUTED_PIXEL_H
#define WEDGE_DISTRIBUTED_PIXEL_H

#include "core/packed_planes.h"
#include "shared/distributed.h"
#include "shared/frame.h"

/// A term's texture and value; of a light its value has one plane where it is filtered.
WEDGE_FN Vec3 loadTexture(DistributedParams p, __global const float* texture, uint i)
{
    return loadColour(texture, p.planeSize, i, textureBits(p.packed, p.values == 1u));
}

WEDGE_FN Vec3 loadValue(DistributedParams p, __global const float* value, uint i)
{
    return loadColour(value, p.planeSize, i, valueBits(p.packed, p.values == 1u));
}

/// Smallest radius of the pixel's circles of confusion in pixels; 0 where it is in focus somewhere.
/// confusion: least and largest signed radius (2 planes; packed, the one nearest to 0).
WEDGE_FN float leastConfusion(DistributedParams p, __global const float* confusion, uint i)
{
    if (p.packed != 0u) {
        return fabs(loadShort(confusion, p.planeSize, i, 0u));
    }
    const float low = confusion[i], high = confusion[p.planeSize + i];
    return low > 0.0f ? low : high < 0.0f ? -high : 0.0f;
}

#endif
