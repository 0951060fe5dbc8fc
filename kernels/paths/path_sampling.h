// What the samples of paths are for their sinks (sinks/sums.h).
#ifndef WEDGE_PATH_SAMPLING_H
#define WEDGE_PATH_SAMPLING_H

#include "core/packed_planes.h"
#include "light/light_packet.h"

/// Numbers of a sample: R, G, B, squared luminance. Of fractions the last is the luminance of what would be seen if
/// nothing were hidden.
#define WEDGE_SUMS 4u
#define WEDGE_VALUES 3u ///< that are filtered: means of R, G, B

/// A packet's receivers, and their samples. Members are pointers, so that compilers see through it.
typedef struct {
    uint size; ///< elements of a plane
    uint firstPass; ///< samples of a first pass; 0: there is none
    uint fractions; ///< 1: the samples are such
    const ReceiverPacket* dealt; ///< the receiver of each lane
    const uint* pixel; ///< of the packet's receivers
    const Wanted* wanted; ///< of the packet's receivers
    const Deal* deal;
} Sampling;

/// One sample of each lane.
typedef struct {
    const float (*value)[WEDGE_PACKET_SIZE]; ///< WEDGE_SUMS of them
    const RayPacket* rays; ///< the first rays of the paths, where sinks take rays; else null
    const float* distance; ///< to the first surface, metres; +inf where there is none
} Samples;

WEDGE_INLINE void storeValue(const Sampling* at, uint i, const float* sums, uint n, __global float* value)
{
    storeVec(value, at->size, i, vecScale(vec3(sums[0], sums[1], sums[2]), 1.0f / (float)n));
}

/// The same of a part of the samples, in 48 bits (packed_planes.h); of fractions the luminances of what is seen, and of
/// what would be.
WEDGE_INLINE void storePart(const Sampling* at, uint i, const float* sums, uint n, __global float* part)
{
    const Vec3 seen = vec3(sums[0], sums[1], sums[2]);
    const Vec3 stored = at->fractions != 0u ? vec3(luminance(seen), sums[3], 0.0f) : seen;
    storeColour(part, at->size, i, vecScale(stored, 1.0f / (float)n));
}

#endif
