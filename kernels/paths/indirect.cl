// Rays over the hemispheres of what the camera sees: indirect light by paths, direct light of meshes that emit, and
// ambient occlusion.
//
// in      frame, BVH, surfaces, lights, emitters, receivers; wanted: samples a pixel; lastSample: where this launch
// ends in out  sums (planes: R, G, B, squared luminance), taken (samples so far), reflectors (planes: least and largest
//         distance in metres of a surface that a ray hit, 0 where none did; sum of inverse distances; where
//         params.keepsDistances), rays (all), pathRays (those that look for the nearest surface)
// out     value (R, G, B): means, which are filtered; of frames with a first pass then those of the first of the
//         samples' two parts (firstPart())
#include "paths/emitter_rays.h"
#include "paths/path_packet.h"
#include "shared/wedge.h"

#define WEDGE_PATH_SEED 0x70617468u

/// What the samples of a packet's pixels add up to.
typedef struct {
    Vec3 radiance[WEDGE_PACKET_SIZE];
    float squared[WEDGE_PACKET_SIZE];
    float nearest[WEDGE_PACKET_SIZE], farthest[WEDGE_PACKET_SIZE], inverse[WEDGE_PACKET_SIZE];
    uint rays[WEDGE_PACKET_SIZE], pathRays[WEDGE_PACKET_SIZE];
    Vec3 part[WEDGE_PACKET_SIZE]; ///< radiance when the first of two parts of the samples was complete
    uint partSamples[WEDGE_PACKET_SIZE], partComplete[WEDGE_PACKET_SIZE];
} PathSums;

WEDGE_FN void loadSums(uint size, bool distances, const ReceiverPacket* receivers, __global const float* sums,
    __global const float* reflectors, PathSums* out)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = receivers->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? receivers->pixel[lane] : 0u;
        out->radiance[lane] = shaded ? loadVec(sums, size, i) : vec3(0.0f, 0.0f, 0.0f);
        out->squared[lane] = shaded ? sums[3u * size + i] : 0.0f;
        const bool known = shaded && distances;
        out->nearest[lane] = known && reflectors[i] > 0.0f ? reflectors[i] : INFINITY;
        out->farthest[lane] = known ? reflectors[size + i] : 0.0f;
        out->inverse[lane] = known ? reflectors[2u * size + i] : 0.0f;
        out->rays[lane] = out->pathRays[lane] = 0u;
        out->part[lane] = vec3(0.0f, 0.0f, 0.0f);
        out->partComplete[lane] = 0u;
    }
}

/// Keeps the radiance of lanes that have as many samples as the first part.
WEDGE_FN void keepPart(const PathPacket* paths, PathSums* sums)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (paths->index[lane] == sums->partSamples[lane]) {
            sums->part[lane] = sums->radiance[lane];
            sums->partComplete[lane] = 1u;
        }
    }
}

/// First rays of one sample a lane, and in weight what their radiance counts. Directions below the horizon of either
/// normal are not traced.
WEDGE_FN void firstRays(FrameParams frame, PathParams params, SampleParams sampling, const ReceiverPacket* r,
    const Vec3* geometric, const PathPacket* paths, const uint* last, RayPacket* rays, float* weight)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    samplePositions(sampling, hashCombine(frame.seed, params.component), r->seed, paths->index, paths->count, u, v);
    const float end = params.component == WEDGE_COMPONENT_AMBIENT ? params.ambientDistance : INFINITY;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        Vec3 l = cosineDirection(n, vec2(u[lane], v[lane]));
        weight[lane] = 1.0f;
#ifdef WEDGE_SPECULAR
        if (WEDGE_IS_GLOSSY(params.component)) {
            const Lobe lobe = laneLobe(r, lane);
            l = sampleLobe(lobe, n, laneView(r, lane), vec2(u[lane], v[lane]));
            weight[lane] = lobeOverPdf(lobe, n, laneView(r, lane), l) * vecDot(n, l);
        }
#endif
        const bool wanted = r->pixel[lane] != WEDGE_NO_PIXEL && paths->index[lane] < last[lane];
        const bool traced = wanted && weight[lane] > 0.0f && vecDot(geometric[lane], l) > 0.0f && vecDot(n, l) > 0.0f;
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
        paths->radiance[lane] = vec3(occluded, occluded, occluded);
        paths->distance[lane] = hit ? hits.t[lane] : INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
    }
}

WEDGE_FN void addPaths(const PathPacket* paths, const float* weight, const uint* last, PathSums* sums)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (paths->index[lane] >= last[lane]) {
            continue;
        }
        const Vec3 radiance = vecScale(paths->radiance[lane], weight[lane]);
        const float l = luminance(radiance);
        sums->radiance[lane] = vecAdd(sums->radiance[lane], radiance);
        sums->squared[lane] += l * l;
        sums->nearest[lane] = fmin(sums->nearest[lane], paths->distance[lane]);
        if (paths->distance[lane] < INFINITY) {
            sums->farthest[lane] = fmax(sums->farthest[lane], paths->distance[lane]);
            sums->inverse[lane] += 1.0f / fmax(paths->distance[lane], 1e-20f);
        }
        sums->rays[lane] += paths->rays[lane] + paths->shadowRays[lane];
        sums->pathRays[lane] += paths->rays[lane];
    }
}

WEDGE_FN void storeSums(uint size, bool distances, const ReceiverPacket* receivers, const PathSums* s,
    const PathPacket* paths, __global float* sums, __global uint* taken, __global float* value,
    __global float* reflectors, __global uint* rays, __global uint* pathRays)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers->pixel[lane];
        if (i == WEDGE_NO_PIXEL || paths->index[lane] == 0u) {
            continue;
        }
        storeVec(sums, size, i, s->radiance[lane]);
        sums[3u * size + i] = s->squared[lane];
        storeVec(value, size, i, vecScale(s->radiance[lane], 1.0f / (float)paths->index[lane]));
        if (s->partComplete[lane] != 0u) {
            storeVec(value + 3u * size, size, i, vecScale(s->part[lane], 1.0f / (float)s->partSamples[lane]));
        }
        taken[i] = paths->index[lane];
        if (distances) {
            reflectors[i] = s->nearest[lane] < INFINITY ? s->nearest[lane] : 0.0f;
            reflectors[size + i] = s->farthest[lane];
            reflectors[2u * size + i] = s->inverse[lane];
        }
        rays[i] += s->rays[lane];
        pathRays[i] += s->pathRays[lane];
    }
}

WEDGE_FN LightData lightData(PathParams params, __global const AreaLight* area, __global const DeltaLight* delta,
    SurfaceData surfaces, __global const Emitter* emitters, __global const float* emitterPicks)
{
    LightData lights;
    lights.emitters.surfaces = surfaces;
    lights.emitters.list = emitters;
    lights.emitters.picks = emitterPicks;
    lights.emitters.count = params.emitters;
    lights.emitters.share = params.emitterShare;
    lights.area = area;
    lights.delta = delta;
    lights.areaCount = params.areaLights;
    lights.deltaCount = params.deltaLights;
    lights.sceneDiameter = params.sceneDiameter;
    lights.sampling = params.lightSampling;
    return lights;
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

/// Sets each lane's geometric normal, samples taken and wanted, and where this launch ends; takes lanes out of
/// `receivers` that do not have the component. Returns the most samples that a lane takes now.
WEDGE_FN uint preparePaths(uint size, PathParams params, uint lastSample, __global const float* specular,
    __global const uint* geometric, __global const uint* taken, __global const uint* wanted, ReceiverPacket* receivers,
    Vec3* facing, PathPacket* paths, uint* last)
{
    uint steps = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint at = receivers->pixel[lane];
        const bool reflects = at != WEDGE_NO_PIXEL
            && (!WEDGE_IS_GLOSSY(params.component) || luminance(loadVec(specular, size, at)) > 0.0f);
        receivers->pixel[lane] = reflects ? at : WEDGE_NO_PIXEL;
        const uint i = reflects ? at : 0u;
        facing[lane] = reflects ? unpackDirection(geometric[i]) : vec3(0.0f, 0.0f, 1.0f);
        paths->seed[lane] = receivers->seed[lane];
        paths->index[lane] = reflects ? taken[i] : 0u;
        last[lane] = reflects ? min(wanted[i], lastSample) : 0u;
        paths->count[lane] = params.strata > 0u ? params.strata : reflects ? wanted[i] : 0u;
        steps = max(steps, last[lane] > paths->index[lane] ? last[lane] - paths->index[lane] : 0u);
    }
    return steps;
}

__kernel void samplePaths(FrameParams frame, PathParams params, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, WEDGE_SURFACE_PARAMETERS,
    __global const AreaLight* restrict areaLights, __global const DeltaLight* restrict deltaLights,
    WEDGE_EMITTER_PARAMETERS, WEDGE_RECEIVER_PARAMETERS, __global const float* restrict specular,
    __global const uint* restrict wanted, uint lastSample, __global float* restrict sums, __global uint* restrict taken,
    __global float* restrict value, __global float* restrict reflectors, __global uint* restrict rays,
    __global uint* restrict pathRays, uint firstGroup)
{
    const uint size = frame.planeSize;
    const SurfaceData surfaces = WEDGE_SURFACE_ARGUMENTS;
    const LightData lights = lightData(params, areaLights, deltaLights, surfaces, emitters, emitterPicks);
    const SampleParams sampling = samplingOf(params);
    ReceiverPacket receivers;
    loadReceivers(frame, sampling.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &receivers);
    Vec3 facing[WEDGE_PACKET_SIZE];
    PathPacket paths;
    uint last[WEDGE_PACKET_SIZE];
    const uint steps =
        preparePaths(size, params, lastSample, specular, geometric, taken, wanted, &receivers, facing, &paths, last);
    PathSums sum;
    const bool distances = params.keepsDistances != 0u;
    loadSums(size, distances, &receivers, sums, reflectors, &sum);
    const bool parts = params.firstPass > 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        sum.partSamples[lane] = parts ? firstPart(paths.count[lane], params.firstPass) : 0xffffffffu;
    }
    if (parts) {
        keepPart(&paths, &sum);
    }
    for (uint step = 0u; step < steps; ++step) {
        RayPacket packet;
        float weight[WEDGE_PACKET_SIZE];
        firstRays(frame, params, sampling, &receivers, facing, &paths, last, &packet, weight);
        if (params.component == WEDGE_COMPONENT_AMBIENT) {
            traceAmbient(nodes, blocks, &packet, &paths);
        } else if (WEDGE_IS_OF_EMITTERS(params.component)) {
            traceEmitters(nodes, blocks, lights.emitters, sampling, distances,
                params.component == WEDGE_COMPONENT_EMITTERS_GLOSSY, &receivers, facing, last, &packet, weight, &paths);
        } else {
            tracePaths(nodes, blocks, surfaces, lights, sampling, params.bounces, &packet, &paths);
        }
        addPaths(&paths, weight, last, &sum);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            paths.index[lane] += paths.index[lane] < last[lane] ? 1u : 0u;
        }
        if (parts) {
            keepPart(&paths, &sum);
        }
    }
    storeSums(size, distances, &receivers, &sum, &paths, sums, taken, value, reflectors, rays, pathRays);
}
