// What mirrors and glass show: paths of the camera that go on from them. As long as they meet nothing else, they see
// what the camera would see from there; on the first other surface they are lit as it is and go on as paths do, with
// as many bounces as the frame has.
//
// in      frame, BVH, surfaces, lights, emitters, receivers; sampleOf: of a wave, the primary sample that each is;
//         lastSample: where this launch ends
// in out  taken (of pixels: samples so far), rays (all), pathRays (those that look for the nearest surface), sums (3
//         planes, radiance of the samples); nothing of receivers that are no mirrors
#include "core/deal.h"
#include "light/seen_light.h"
#include "paths/path_packet.h"
#include "shared/filter_params.h"

// Programs of scenes that have none are empty.
#ifdef WEDGE_MIRRORS
/// R, G, B
#define WEDGE_CHANNELS 3u
#define WEDGE_MIRROR_SEED 0x6d697272u
/// Vertices of random numbers before the first other surface, far from those of paths.
#define WEDGE_MIRROR_VERTEX 0x10000u

/// Receivers, lane by lane.
typedef struct {
    uint at[WEDGE_PACKET_SIZE], seed[WEDGE_PACKET_SIZE], kind[WEDGE_PACKET_SIZE];
    VecLanes position, origin, normal, geometric, view;
    float time[WEDGE_PACKET_SIZE];
} MirrorPacket;

/// The receivers of this work-item: those that are no mirrors want no samples.
WEDGE_FN void loadMirrors(FrameParams frame, uint firstGroup, ReceiverData data, __global const uint* sampleOf,
    uint lastSample, __global const uint* taken, MirrorPacket* own, Wanted* wanted)
{
    const bool wave = frame.receivers > 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint i = 0u, x = 0u, y = 0u;
        bool mirror = receiverOf(frame, data, firstGroup, lane, &i, &x, &y);
        mirror = mirror && data.objectId[i] != 0u && WEDGE_IS_MIRROR(data.gloss[i]);
        own->at[lane] = mirror ? i : 0u;
        own->seed[lane] = hashCombine(hashCombine(frame.seed, WEDGE_MIRROR_SEED), pixelNumber(frame, x, y));
        own->kind[lane] = mirror ? data.gloss[i] : 0u;
        const Vec3 none = vec3(0.0f, 0.0f, 1.0f), position = mirror ? loadVec(data.position, frame.planeSize, i) : none;
        setLaneVec(&own->position, lane, position);
        setLaneVec(&own->origin, lane, mirror ? loadVec(data.origin, frame.planeSize, i) : none);
        setLaneVec(&own->normal, lane, mirror ? loadVec(data.normal, frame.planeSize, i) : none);
        setLaneVec(&own->geometric, lane, mirror ? unpackDirection(data.geometric[i]) : none);
        setLaneVec(&own->view, lane, mirror ? viewOf(frame, data, i, position) : none);
        own->time[lane] = mirror && wave ? data.time[i] : 0.0f;
        const uint first = !mirror ? 0u : wave ? sampleOf[i] : taken[i];
        wanted->first[lane] = wanted->next[lane] = first;
        wanted->last[lane] = !mirror ? 0u : wave ? first + 1u : max(lastSample, first);
        wanted->strata[lane] = wanted->last[lane];
    }
}

/// The receivers whose samples the lanes take.
WEDGE_FN void dealMirrors(const MirrorPacket* own, const Deal* deal, MirrorPacket* dealt)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint from = deal->receiver[lane];
        dealt->at[lane] = own->at[from];
        dealt->seed[lane] = own->seed[from];
        dealt->kind[lane] = own->kind[from];
        dealt->time[lane] = own->time[from];
        setLaneVec(&dealt->position, lane, laneVec(&own->position, from));
        setLaneVec(&dealt->origin, lane, laneVec(&own->origin, from));
        setLaneVec(&dealt->normal, lane, laneVec(&own->normal, from));
        setLaneVec(&dealt->geometric, lane, laneVec(&own->geometric, from));
        setLaneVec(&dealt->view, lane, laneVec(&own->view, from));
    }
}

/// Each lane's choice at the mirror of that number on its path.
WEDGE_FN void mirrorChoices(SampleParams sampling, const PathPacket* paths, uint number, float* choice)
{
    float unused[WEDGE_PACKET_SIZE];
    uint all[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        all[lane] = 1u;
    }
    pathPairs(sampling, paths, all, WEDGE_MIRROR_VERTEX + number, WEDGE_DIMENSION_CHOICE, choice, unused);
}

#ifdef WEDGE_TOUCHING_GLASS
/// The number of the first mirror that followMirrors() looks for.
#define WEDGE_FIRST_FOLLOWED 0u

/// Begins a path of each lane that takes a sample: its first ray, which meets the receiver anew, with what lies in one
/// place with it.
WEDGE_FN void leaveReceivers(SurfaceData surfaces, SampleParams sampling, const MirrorPacket* m, const Deal* deal,
    PathPacket* paths, RayPacket* rays)
{
    (void)surfaces;
    (void)sampling;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool takes = deal->index[lane] < deal->last[lane];
        setRay(rays, lane, laneVec(&m->origin, lane), vecScale(laneVec(&m->view, lane), -1.0f), 0.0f,
            takes ? INFINITY : 0.0f);
        setTime(rays, lane, m->time[lane]);
    }
    beginPaths(rays, paths);
}
#else
#define WEDGE_FIRST_FOLLOWED 1u

/// Begins a path of each lane that takes a sample: its first ray.
WEDGE_FN void leaveReceivers(SurfaceData surfaces, SampleParams sampling, const MirrorPacket* m, const Deal* deal,
    PathPacket* paths, RayPacket* rays)
{
    float choice[WEDGE_PACKET_SIZE];
    mirrorChoices(sampling, paths, 0u, choice);
    VecLanes carried;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool takes = deal->index[lane] < deal->last[lane];
        Vec3 start = vec3(0.0f, 0.0f, 0.0f), direction = vec3(0.0f, 0.0f, 1.0f), weight = start;
        if (takes) {
            const MirrorRay ray =
                mirrorRay(surfaces.materials, m->kind[lane], laneVec(&m->position, lane), laneVec(&m->origin, lane),
                    laneVec(&m->normal, lane), laneVec(&m->geometric, lane), laneVec(&m->view, lane), choice[lane]);
            start = ray.start;
            direction = ray.to.direction;
            weight = ray.to.weight;
        }
        setRay(rays, lane, start, direction, 0.0f, takes ? INFINITY : 0.0f);
        setTime(rays, lane, m->time[lane]);
        setLaneVec(&carried, lane, weight);
    }
    beginPaths(rays, paths);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&paths->throughput, lane, laneVec(&carried, lane));
    }
}
#endif

/// Whose sample each lane's path is.
WEDGE_FN void numberMirrored(const MirrorPacket* m, const Deal* deal, PathPacket* paths)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        paths->seed[lane] = m->seed[lane];
        paths->index[lane] = deal->index[lane];
        paths->count[lane] = deal->count[lane];
    }
}

/// What the camera would see along the rays: the nearest visible light, what surfaces emit, and what is behind all.
/// Ends rays at lights; hits: of the surfaces. number: of the mirror that is looked for; of number 0 the camera has
/// seen all that it is before.
WEDGE_FN void seeAlong(FrameParams frame, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, SurfaceData surfaces, LightData lights,
    __global const EnvironmentMap* environment, __global const float* environmentTable, uint number,
    WEDGE_MEETS_PARAMETER RayPacket* rays, PacketHits* hits, PathPacket* paths)
{
    VecLanes seen;
    endAtLights(lights.area, lights.areaCount, rays, &seen);
#ifdef WEDGE_TOUCHING_GLASS
    meetInterfaces(nodes, blocks, surfaces, lights.touching, rays, hits, paths, met);
#else
    (void)number;
    closestHits(nodes, blocks, rays, hits);
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Hit hit = packetHit(hits, lane);
        Vec3 radiance = laneVec(&seen, lane);
        if (hit.triangle != WEDGE_NO_TRIANGLE) {
            radiance = finishOf(surfaces, hit).emission;
        } else if (!(rays->tMax[lane] < INFINITY)) {
            radiance = vecAdd(
                frame.background, cameraBeyond(environment, environmentTable, vecNormalize(rayDirection(rays, lane))));
        }
#ifdef WEDGE_TOUCHING_GLASS
        radiance = vecScale(radiance, number > 0u || met->passed[lane] != 0u ? 1.0f : 0.0f);
#endif
        setLaneVec(&seen, lane, radiance);
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 carried = vecMul(laneVec(&paths->throughput, lane), laneVec(&seen, lane));
        setLaneVecIf(&paths->radiance, lane, rays->tMax[lane] > 0.0f, vecAdd(laneVec(&paths->radiance, lane), carried));
    }
}

/// Whether the Russian roulette at the mirror of that number lets a lane's path go on.
WEDGE_FN bool survives(const PathPacket* paths, uint lane, uint number)
{
    const uint path = hashCombine(paths->seed[lane], paths->index[lane]);
    return toUnitFloat(hashCombine(path, WEDGE_MIRROR_VERTEX + number)) < WEDGE_MIRRORED_SURVIVAL;
}

/// Follows paths from mirror to mirror. `lit` are their rays to the first surface that is none; no rays where there is
/// no such surface. From mostMirrored mirrors and glass on Russian roulette is played wherever they reflect: paths that
/// pass surfaces come out.
WEDGE_FN void followMirrors(FrameParams frame, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, SurfaceData surfaces, LightData lights, SampleParams sampling,
    __global const EnvironmentMap* environment, __global const float* environmentTable, uint mostMirrored,
    RayPacket* rays, PathPacket* paths, RayPacket* lit)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setRay(lit, lane, rayStart(rays, lane), rayDirection(rays, lane), 0.0f, 0.0f);
        setTime(lit, lane, timeOf(rays, lane));
    }
    for (uint number = WEDGE_FIRST_FOLLOWED;; ++number) {
        PacketHits hits;
#ifdef WEDGE_TOUCHING_GLASS
        Interfaces interfaces;
        Interfaces* met = &interfaces;
#endif
        seeAlong(frame, nodes, blocks, surfaces, lights, environment, environmentTable, number, WEDGE_MET_ARGUMENT rays,
            &hits, paths);
        VertexPacket at;
        loadVertices(surfaces, rays, &hits, &at);
        float choice[WEDGE_PACKET_SIZE];
        mirrorChoices(sampling, paths, number, choice);
        bool any = false;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool mirror = WEDGE_IS_MIRROR(at.kind[lane]);
            if (at.live[lane] != 0u && !mirror) {
                setRay(lit, lane, rayStart(rays, lane), rayDirection(rays, lane), 0.0f, rays->tMax[lane]);
#ifdef WEDGE_TOUCHING_GLASS
                beginBehind(lit, lane, rays->tMin[lane], rays->after[lane]);
                reachSurface(met, lane, packetHit(&hits, lane), paths);
#endif
            }
            Vec3 start = rayStart(rays, lane), direction = rayDirection(rays, lane);
            bool goes = at.live[lane] != 0u && mirror;
            if (goes) {
                const MirrorRay ray =
                    followDeflection(surfaces.materials, &at, WEDGE_MET_ARGUMENT lane, choice[lane], paths);
                Vec3 carried = vecMul(laneVec(&paths->throughput, lane), ray.to.weight);
                if (number >= mostMirrored && ray.to.through == 0u) {
                    carried = survives(paths, lane, number) ? vecScale(carried, 1.0f / WEDGE_MIRRORED_SURVIVAL)
                                                            : vec3(0.0f, 0.0f, 0.0f);
                }
                setLaneVec(&paths->throughput, lane, carried);
                start = ray.start;
                direction = ray.to.direction;
                goes = luminance(carried) > 0.0f;
            }
            setRay(rays, lane, start, direction, 0.0f, goes ? INFINITY : 0.0f);
            paths->rays[lane] += goes ? 1u : 0u;
            any |= goes;
        }
        if (!any) {
            return;
        }
    }
}
#include "pass/sampleMirrors.h"
#ifdef PASS_sampleMirrors
__kernel void sampleMirrors(PARAMETERS)
{
    const SurfaceData surfaces = WEDGE_SURFACE_ARGUMENTS;
    LightData lights = lightData(params, areaLights, deltaLights, surfaces, emitters, emitterPicks, environment,
        environmentTable, PLANE_environmentSamples);
#ifdef WEDGE_CUTOUTS
    lights.emitters.cutouts = WEDGE_CUTOUT_TABLE(nodes, blocks);
#endif
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    SampleParams sampling;
    sampling.shading = WEDGE_SHADING_INSIDE;
    sampling.sampler = WEDGE_SAMPLER_SOBOL; // counts are one at a time
    sampling.light = WEDGE_MIRROR_SEED;
    sampling.firstPass = sampling.strata = 0u;
    sampling.lightSampling = params.lightSampling;
    MirrorPacket own, dealt;
    Wanted wanted;
    Deal deal;
    loadMirrors(frame, firstGroup, data, PLANE_sampleOf, lastSample, PLANE_taken, &own, &wanted);
    float sum[WEDGE_CHANNELS][WEDGE_PACKET_SIZE];
    uint traced[WEDGE_PACKET_SIZE], followed[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool has = wanted.last[lane] > wanted.first[lane];
        for (uint channel = 0u; channel < WEDGE_CHANNELS; ++channel) {
            sum[channel][lane] = has ? sums[channel * frame.planeSize + own.at[lane]] : 0.0f;
        }
        traced[lane] = followed[lane] = 0u;
    }
    while (dealSamples(&wanted, &deal)) {
        dealMirrors(&own, &deal, &dealt);
        for (uint step = 0u; step < deal.steps; ++step) {
            PathPacket paths;
            RayPacket packet, lit;
            numberMirrored(&dealt, &deal, &paths);
#ifdef WEDGE_TOUCHING_GLASS
            beginInside(&params, &paths);
#endif
            leaveReceivers(surfaces, sampling, &dealt, &deal, &paths, &packet);
            followMirrors(frame, nodes, blocks, surfaces, lights, sampling, environment, environmentTable,
                params.mostMirrored, &packet, &paths, &lit);
            followPaths(nodes, blocks, surfaces, lights, sampling, params.bounces, &lit, &paths);
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                if (deal.index[lane] < deal.last[lane]) {
                    const uint receiver = deal.receiver[lane];
                    sum[0][receiver] += paths.radiance.x[lane];
                    sum[1][receiver] += paths.radiance.y[lane];
                    sum[2][receiver] += paths.radiance.z[lane];
                    traced[receiver] += paths.rays[lane] + paths.shadowRays[lane];
                    followed[receiver] += paths.rays[lane];
                }
            }
            nextStep(&deal);
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (wanted.last[lane] > wanted.first[lane]) {
            const uint i = own.at[lane];
            storeVec(sums, frame.planeSize, i, vec3(sum[0][lane], sum[1][lane], sum[2][lane]));
            rays[i] += traced[lane];
            pathRays[i] += followed[lane];
            if (frame.receivers == 0u) {
                STORE_taken(frame.planeSize, i, wanted.last[lane]);
            }
        }
    }
}
#endif

/// Makes means of the sums of what mirrors show (3 planes), where the pixels are the receivers.
#include "pass/meanOfMirrored.h"
#ifdef PASS_meanOfMirrored
__kernel void meanOfMirrored(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float n = fmax((float)taken[i], 1.0f);
    storeVec(sums, p.planeSize, i, vecScale(loadVec(sums, p.planeSize, i), 1.0f / n));
}
#endif
#endif
