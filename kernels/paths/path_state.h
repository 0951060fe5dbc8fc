// What paths of a packet's pixels carry from vertex to vertex, and their random numbers.
#ifndef WEDGE_PATH_STATE_H
#define WEDGE_PATH_STATE_H

#include "core/vec_lanes.h"
#include "light/light_packet.h"
#include "paths/media.h"
#include "shared/hit.h"

/// Dimensions of a path's random numbers: 0 for its first direction, then these for each vertex.
#define WEDGE_VERTEX_DIMENSIONS 3u
#define WEDGE_DIMENSION_LIGHT 1u ///< point on the light
#define WEDGE_DIMENSION_DIRECTION 2u ///< direction that the path goes on in
#define WEDGE_DIMENSION_CHOICE 3u ///< which light, which lobe

#ifdef WEDGE_TOUCHING_GLASS
/// Where an interface lies on a surface: glass that stands on a floor.
#define WEDGE_CONTACT_NONE 0u
#define WEDGE_CONTACT_ABOVE 1u ///< the path is at the interface, and comes from the glass
#define WEDGE_CONTACT_ON 2u ///< it is at the surface
#define WEDGE_CONTACT_BELOW 3u ///< it is at the interface, and comes from the surface

/// Glass that stands on a surface, while a path is between the two.
typedef struct {
    uint next; ///< what its ray meets: WEDGE_CONTACT_NONE, what there is; _ON, the surface; _BELOW, the glass
    Hit glass, surface;
    Media above; ///< what the path is inside of on the glass' side
} Contact;
#endif

typedef struct {
    VecLanes throughput;
    VecLanes radiance; ///< so far
    float pdf[WEDGE_PACKET_SIZE]; ///< of the current ray's direction, 1/sr
    float distance[WEDGE_PACKET_SIZE]; ///< to the first surface, metres; +inf where there is none
    uint seed[WEDGE_PACKET_SIZE];
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE]; ///< sample and number of samples, as samplePositions()
    uint rays[WEDGE_PACKET_SIZE], shadowRays[WEDGE_PACKET_SIZE];
#ifdef WEDGE_TOUCHING_GLASS
    Media inside[WEDGE_PACKET_SIZE]; ///< bodies of glass that the current ray is in
    Contact contact[WEDGE_PACKET_SIZE];
#endif
} PathPacket;

#ifdef WEDGE_TOUCHING_GLASS
/// Paths that begin where the camera is, or where it sees without glass between.
WEDGE_FN void beginInside(const PathParams* params, PathPacket* paths)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        paths->contact[lane].next = WEDGE_CONTACT_NONE;
        paths->inside[lane].count = params->mediaCount;
        for (uint i = 0u; i < params->mediaCount; ++i) {
            paths->inside[lane].body[i] = params->media[i];
        }
    }
}

/// A path goes on from where it is, through the interface or not. at: WEDGE_CONTACT_*
WEDGE_INLINE void leaveContact(uint at, bool through, Contact* contact)
{
    const bool toSurface = through ? at == WEDGE_CONTACT_ABOVE : at == WEDGE_CONTACT_BELOW;
    contact->next = at == WEDGE_CONTACT_ON ? WEDGE_CONTACT_BELOW : toSurface ? WEDGE_CONTACT_ON : WEDGE_CONTACT_NONE;
}
#endif

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
