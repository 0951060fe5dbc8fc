// Rays over the hemispheres of what the camera sees: indirect light by paths, direct light of meshes that emit, and
// ambient occlusion. Sinks (sinks/sums.h) say what becomes of the samples.
//
// in      frame, BVH, surfaces, lights, emitters, receivers; wanted: samples a pixel; lastSample: where this launch
//         ends
// in out  taken (samples so far), rays (all), pathRays (those that look for the nearest surface), and what the sinks
//         have
#include "paths/path_packet.h"
#include "paths/path_sampling.h"

#include "pass/samplePaths.h"

// After the sinks, of which it asks whether they take distances.
#include "paths/emitter_rays.h"
#include "paths/environment_rays.h"

#define WEDGE_PATH_SEED 0x70617468u

/// A packet's samples while they are taken.
typedef struct {
    Wanted wanted; ///< of the receivers
    Deal deal;
    uint rays[WEDGE_PACKET_SIZE], pathRays[WEDGE_PACKET_SIZE]; ///< traced for each receiver
    uint laneRays[WEDGE_PACKET_SIZE], lanePathRays[WEDGE_PACKET_SIZE]; ///< and of those, in the lanes of this deal
} PathCounts;

/// The receivers of the lanes, and their geometric normals.
typedef struct {
    ReceiverPacket receivers;
    VecLanes facing;
} PathLanes;

/// First rays of one sample a lane, and in weight what their radiance counts. Directions below the horizon of either
/// normal are not traced, nor are those of lanes that follow none.
WEDGE_FN void firstRays(FrameParams frame, PathParams params, SampleParams sampling, const PathLanes* lanes,
    const PathPacket* paths, const uint* last, const uint* follows, RayPacket* rays, float* weight)
{
    const ReceiverPacket* r = &lanes->receivers;
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    samplePositions(sampling, hashCombine(frame.seed, params.component), r->seed, paths->index, paths->count, u, v);
    const float end = params.component == WEDGE_COMPONENT_AMBIENT ? params.ambientDistance : INFINITY;
    VecLanes directions;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        setLaneVec(&directions, lane, cosineDirection(n, vec2(u[lane], v[lane])));
        weight[lane] = 1.0f;
    }
#ifdef WEDGE_SPECULAR
    if (WEDGE_IS_GLOSSY(params.component)) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
            const Lobe lobe = laneLobe(r, lane);
            const Vec3 l = sampleLobe(lobe, n, laneView(r, lane), vec2(u[lane], v[lane]));
            setLaneVec(&directions, lane, l);
            weight[lane] = lobeOverPdf(lobe, n, laneView(r, lane), l) * vecDot(n, l);
        }
    }
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), l = laneVec(&directions, lane);
        const bool wanted = r->pixel[lane] != WEDGE_NO_PIXEL && paths->index[lane] < last[lane];
        const bool traced = wanted && follows[lane] != 0u && weight[lane] > 0.0f
            && vecDot(laneVec(&lanes->facing, lane), l) > 0.0f && vecDot(n, l) > 0.0f;
        setRay(rays, lane, vec3(r->originX[lane], r->originY[lane], r->originZ[lane]), l, 0.0f, traced ? end : 0.0f);
        setTime(rays, lane, receiverTime(r, lane));
    }
}

/// How far it is to the nearest surface, and nothing else.
WEDGE_FN void traceAmbient(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const RayPacket* rays, PathPacket* paths)
{
    PacketHits hits;
    closestHits(nodes, blocks, rays, &hits);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool hit = hits.triangle[lane] != WEDGE_NO_TRIANGLE;
        // Directions below a horizon, which are not traced, lie in the surface itself.
        const float occluded = hit || !(rays->tMax[lane] > 0.0f) ? 1.0f : 0.0f;
        setLaneVec(&paths->radiance, lane, vec3(occluded, occluded, occluded));
        paths->distance[lane] = hit ? hits.t[lane] : INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
    }
}

/// Takes a path of each lane, whose radiance counts `weight`, or of fractions it and `whole`. Receivers that have all
/// their samples wait for the others.
WEDGE_FN void takePaths(const PathPacket* paths, const float* weight, const float* whole, const RayPacket* rays,
    const Sampling* at, PathCounts* counts, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    float numbers[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool taken = takesSample(at, lane);
        const Vec3 radiance = vecScale(laneVec(&paths->radiance, lane), weight[lane]);
        const float l = luminance(radiance);
        numbers[0][lane] = taken ? radiance.x : 0.0f;
        numbers[1][lane] = taken ? radiance.y : 0.0f;
        numbers[2][lane] = taken ? radiance.z : 0.0f;
        const float last = at->fractions != 0u ? whole[lane] : l * l;
        numbers[3][lane] = taken ? last : 0.0f;
        counts->laneRays[lane] += taken ? paths->rays[lane] + paths->shadowRays[lane] : 0u;
        counts->lanePathRays[lane] += taken ? paths->rays[lane] : 0u;
    }
    const Samples samples = { numbers, rays, paths->distance };
    takeSamples(at, &samples, sink, WEDGE_SINK_ARGUMENTS);
}

WEDGE_FN SampleParams samplingOf(PathParams params)
{
    SampleParams sampling;
    sampling.shading = WEDGE_SHADING_INSIDE;
    sampling.sampler = params.sampler;
    sampling.light = WEDGE_PATH_SEED + params.component;
    sampling.firstPass = params.firstPass;
    sampling.lightSampling = params.lightSampling;
    sampling.strata = 0u;
    return sampling;
}

/// Sets geometric normals, and what each receiver has and is to have; takes those out that do not have the component.
WEDGE_FN void preparePaths(uint size, PathParams params, uint lastSample, __global const float* specular,
    __global const uint* geometric, __global const uint* taken, __global const uint* wanted, PathLanes* own,
    PathCounts* counts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint at = own->receivers.pixel[lane];
        bool reflects = at != WEDGE_NO_PIXEL
            && (!WEDGE_IS_GLOSSY(params.component) || luminance(loadVec(specular, size, at)) > 0.0f);
#ifdef WEDGE_MIRRORS
        reflects &= params.skipsMirrors == 0u || !WEDGE_IS_MIRROR(own->receivers.gloss[lane]);
#endif
        own->receivers.pixel[lane] = reflects ? at : WEDGE_NO_PIXEL;
        const uint i = reflects ? at : 0u;
        setLaneVec(&own->facing, lane, reflects ? unpackDirection(geometric[i]) : vec3(0.0f, 0.0f, 1.0f));
        counts->wanted.first[lane] = counts->wanted.next[lane] = reflects ? taken[i] : 0u;
        counts->wanted.last[lane] = reflects ? min(wanted[i], lastSample) : 0u;
        counts->wanted.strata[lane] = params.strata > 0u ? params.strata : reflects ? wanted[i] : 0u;
        counts->rays[lane] = counts->pathRays[lane] = 0u;
        counts->laneRays[lane] = counts->lanePathRays[lane] = 0u;
    }
}

/// The lanes of a deal that does not keep the receivers' own.
WEDGE_FN void dealLanes(const PathLanes* own, const Deal* deal, PathLanes* dealt)
{
    dealReceivers(&own->receivers, deal, &dealt->receivers);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&dealt->facing, lane, laneVec(&own->facing, deal->receiver[lane]));
    }
}

/// What paths need for their random numbers.
WEDGE_FN void numberPaths(const ReceiverPacket* receivers, const Deal* deal, PathPacket* paths)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        paths->seed[lane] = receivers->seed[lane];
        paths->index[lane] = deal->index[lane];
        paths->count[lane] = deal->count[lane];
    }
}

__kernel void samplePaths(PARAMETERS)
{
    const SurfaceData surfaces = WEDGE_SURFACE_ARGUMENTS;
    LightData lights = lightData(params, areaLights, deltaLights, surfaces, emitters, emitterPicks, environment,
        environmentTable, PLANE_environmentSamples);
#ifdef WEDGE_CUTOUTS
    lights.emitters.cutouts = WEDGE_CUTOUT_TABLE(nodes, blocks);
#endif
    const SampleParams sampling = samplingOf(params);
    PathLanes own, dealt;
    loadReceivers(frame, sampling.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &own.receivers);
    const uint* pixel = own.receivers.pixel;
    PathCounts counts;
    preparePaths(frame.planeSize, params, lastSample, specular, geometric, taken, wanted, &own, &counts);
    Sampling at = { frame.planeSize, params.firstPass, params.fractions, &own.receivers, pixel, &counts.wanted,
        &counts.deal };
    Sink sink;
    beginReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    while (dealSamples(&counts.wanted, &counts.deal)) {
        if (!counts.deal.own) {
            dealLanes(&own, &counts.deal, &dealt);
        }
        const PathLanes* lanes = counts.deal.own ? &own : &dealt;
        at.dealt = &lanes->receivers;
        for (uint step = 0u; step < counts.deal.steps; ++step) {
            PathPacket paths;
            numberPaths(at.dealt, &counts.deal, &paths);
            RayPacket packet;
            float weight[WEDGE_PACKET_SIZE], whole[WEDGE_PACKET_SIZE];
            uint follows[WEDGE_PACKET_SIZE];
            followDirections(params, at.dealt, follows);
            firstRays(frame, params, sampling, lanes, &paths, counts.deal.last, follows, &packet, weight);
#ifdef WEDGE_SINK_TAKES_RAYS
            const RayPacket first = packet; // paths go on in the packet
            const RayPacket* firstOnes = &first;
#else
            const RayPacket* firstOnes = 0;
#endif
            if (params.component == WEDGE_COMPONENT_AMBIENT) {
                traceAmbient(nodes, blocks, &packet, &paths);
            } else if (WEDGE_IS_OF_EMITTERS(params.component)) {
                traceEmitters(nodes, blocks, lights, sampling, params.component == WEDGE_COMPONENT_EMITTERS_GLOSSY,
                    at.dealt, &lanes->facing, counts.deal.last, follows, &packet, weight, &paths);
            } else if (WEDGE_ENVIRONMENT_MAP != 0 && WEDGE_IS_OF_ENVIRONMENT(params.component)) {
                traceEnvironment(nodes, blocks, lights.beyond, sampling,
                    params.component == WEDGE_COMPONENT_ENVIRONMENT_GLOSSY, params.fractions != 0u, params.occluders,
                    at.dealt, &lanes->facing, counts.deal.last, &packet, weight, &paths, whole);
                if (params.relative != 0u) {
                    divideByUnshadowed(environment, lights.beyond, at.dealt, &paths);
                }
            } else {
#ifdef WEDGE_TOUCHING_GLASS
                beginInside(&params, &paths);
#endif
                tracePaths(nodes, blocks, surfaces, lights, sampling, params.bounces, &packet, &paths);
            }
            takePaths(&paths, weight, whole, firstOnes, &at, &counts, &sink, WEDGE_SINK_ARGUMENTS);
            nextStep(&counts.deal);
        }
        moveToReceivers(&counts.deal, counts.laneRays, counts.rays);
        moveToReceivers(&counts.deal, counts.lanePathRays, counts.pathRays);
    }
    finishReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(&at, lane)) {
            const uint i = pixel[lane];
            taken[i] = counts.wanted.next[lane];
            rays[i] += counts.rays[lane];
            pathRays[i] += counts.pathRays[lane];
        }
    }
}
