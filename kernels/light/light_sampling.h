// What the samples of area lights are for their sinks (sinks/sums.h).
#ifndef WEDGE_LIGHT_SAMPLING_H
#define WEDGE_LIGHT_SAMPLING_H

#include "core/packed_planes.h"
#include "light/light_packet.h"
#include "light/light_values.h"

/// A packet's receivers, and their samples. Members are pointers, so that compilers see through it.
typedef struct {
    uint size; ///< elements of a plane
    uint shading; ///< WEDGE_SHADING_*
    uint firstPass; ///< samples of a first pass; 0: there is none
    const ReceiverPacket* dealt; ///< the receiver of each lane
    const uint* pixel; ///< of the packet's receivers
    const Wanted* wanted; ///< of the packet's receivers
    const Deal* deal;
} Sampling;

/// One sample of each lane.
typedef struct {
    const float (*value)[WEDGE_PACKET_SIZE]; ///< WEDGE_SUMS of them
    const float (*points)[WEDGE_PACKET_SIZE]; ///< the part of it that points on the light have, without directions
    const RayPacket* rays; ///< to the points on the light, where they are 1; tMax is 0 where none was traced
    const PacketHits* hits; ///< of rays to points on the light, where sinks take hits; else null
} Samples;

WEDGE_INLINE void storeValue(const Sampling* at, uint i, const float* sums, uint n, __global float* value)
{
    storeTermValues(at->shading, at->size, i, sums, n, value);
}

/// The same of a part of the samples, in 16 bits each (packed_planes.h): it is compared with the whole, for its
/// noise, which seems to be 1e-3 of the value at least, then.
WEDGE_INLINE void storePart(const Sampling* at, uint i, const float* sums, uint n, __global float* part)
{
    const float diffuse = termValue(at->shading, sums[0], sums[1], n);
    storeShort(part, at->size, i, 0u, diffuse);
#ifdef WEDGE_SPECULAR
    const bool reached = sums[2] > 0.0f || at->shading == WEDGE_SHADING_INSIDE;
    storeShort(part, at->size, i, 1u, reached ? termValue(at->shading, sums[2], sums[3], n) : diffuse);
#endif
}

#endif
