// What paths of a packet's pixels carry from vertex to vertex, and their random numbers.
#ifndef WEDGE_PATH_STATE_H
#define WEDGE_PATH_STATE_H

#include "core/vec_lanes.h"
#include "light/light_packet.h"

/// Dimensions of a path's random numbers: 0 for its first direction, then these for each vertex.
#define WEDGE_VERTEX_DIMENSIONS 3u
#define WEDGE_DIMENSION_LIGHT 1u ///< point on the light
#define WEDGE_DIMENSION_DIRECTION 2u ///< direction that the path goes on in
#define WEDGE_DIMENSION_CHOICE 3u ///< which light, which lobe

typedef struct {
    VecLanes throughput;
    VecLanes radiance; ///< so far
    float pdf[WEDGE_PACKET_SIZE]; ///< of the current ray's direction, 1/sr
    float distance[WEDGE_PACKET_SIZE]; ///< to the first surface, metres; +inf where there is none
    uint seed[WEDGE_PACKET_SIZE];
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE]; ///< sample and number of samples, as samplePositions()
    uint rays[WEDGE_PACKET_SIZE], shadowRays[WEDGE_PACKET_SIZE];
} PathPacket;

/// Seed of one dimension of a lane's path. Strata of different dimensions are paired at random in each pixel.
WEDGE_INLINE uint dimensionSeed(const PathPacket* paths, uint lane, uint vertex, uint dimension)
{
    return hashCombine(paths->seed[lane], vertex * WEDGE_VERTEX_DIMENSIONS + dimension);
}

/// The random pair of one dimension of a lane's path.
WEDGE_FN Vec2 pathPair(SampleParams params, const PathPacket* paths, uint lane, uint vertex, uint dimension)
{
    const uint seed = dimensionSeed(paths, lane, vertex, dimension);
    return params.sampler == WEDGE_SAMPLER_SOBOL
        ? sobolOwen(paths->index[lane], seed)
        : stratifiedPosition(params, paths->index[lane], paths->count[lane], seed, hashUint(seed));
}

/// pathPair() of each live lane; others' do not matter.
WEDGE_FN void pathPairs(
    SampleParams params, const PathPacket* paths, const uint* live, uint vertex, uint dimension, float* u, float* v)
{
    if (params.sampler == WEDGE_SAMPLER_SOBOL) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec2 p = sobolOwen(paths->index[lane], dimensionSeed(paths, lane, vertex, dimension));
            u[lane] = p.x;
            v[lane] = p.y;
        }
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec2 p = live[lane] != 0u ? pathPair(params, paths, lane, vertex, dimension) : vec2(0.5f, 0.5f);
        u[lane] = p.x;
        v[lane] = p.y;
    }
}

#endif
