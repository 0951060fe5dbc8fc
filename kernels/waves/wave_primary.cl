// The primary pass of a wave: each receiver's ray through its pixel, the lens and the shutter, and what it hits.
//
// in   frame, camera, wave, BVH, surfaces, area lights (the camera sees those that are visible); pixelOf, sampleOf,
//      wanted: primary samples of each pixel; known: what pixels see of lights (seen_lights.cl)
// out  planes of the wave: position, normal, origin (3 each; normals as primary.cl has them), geometric (normal,
// packed), objectId (0: nothing to shade),
//      gloss (packed), view (packed direction back along the ray), time, diffuse, specular, emission
//      (3 each; emission holds background and light radiance where nothing is shaded), pixelSize (metres), depth
//      (along the view axis; +inf on a miss), motion (2 planes: pixels that the point moves in the image from shutter
//      open to close), rays and pathRays (0: for the effects to count in)
#include "core/receivers.h"
#include "light/environment_map.h"
#include "light/seen_light.h"
#include "shared/camera.h"
#include "shared/wave.h"
#include "trace/packet.h"
#include "trace/surface_lanes.h"

#define WEDGE_LENS_SEED 0x6c656e73u
#define WEDGE_SHUTTER_SEED 0x74696d65u
#define WEDGE_PIXEL_SEED 0x70697865u

/// Two random numbers of a primary sample, not of the sequence.
WEDGE_FN Vec2 stratifiedCameraPair(
    FrameParams frame, WaveParams wave, uint what, uint x, uint y, uint index, uint count)
{
    const uint seed = hashCombine(hashCombine(frame.seed, what), y * frame.width + x);
    // Strata of lens, time, light and hemisphere are paired at random: each pixel has an order of its own.
    const bool first = index < wave.firstPass;
    return first
        ? stratified(index, wave.firstPass, hashUint(seed ^ 0x55555555u), seed)
        : stratified(index - wave.firstPass, count - wave.firstPass, hashUint(seed ^ 0x33333333u), hashUint(seed));
}

/// What a packet's samples are drawn for.
typedef struct {
    uint x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE]; ///< pixels
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE]; ///< primary samples, and how many their pixels have
} PrimaryLanes;

/// Two random numbers of each lane's primary sample.
WEDGE_FN void cameraPairs(
    FrameParams frame, WaveParams wave, uint what, const PrimaryLanes* at, float* restrict u, float* restrict v)
{
    if (wave.sampler == WEDGE_SAMPLER_SOBOL) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const uint seed = hashCombine(hashCombine(frame.seed, what), at->y[lane] * frame.width + at->x[lane]);
            const Vec2 p = sobolOwen(at->index[lane], seed);
            u[lane] = p.x;
            v[lane] = p.y;
        }
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec2 p =
            stratifiedCameraPair(frame, wave, what, at->x[lane], at->y[lane], at->index[lane], at->count[lane]);
        u[lane] = p.x;
        v[lane] = p.y;
    }
}

/// Each lane's ray, which does not end, and its time.
WEDGE_FN void sendRays(FrameParams frame, CameraParams camera, WaveParams wave, const PrimaryLanes* at, RayPacket* rays,
    float* restrict time)
{
    float lensX[WEDGE_PACKET_SIZE], lensY[WEDGE_PACKET_SIZE], u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        lensX[lane] = lensY[lane] = time[lane] = 0.0f;
    }
    if (camera.apertureRadius > 0.0f) {
        cameraPairs(frame, wave, WEDGE_LENS_SEED, at, u, v);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec2 lens = aperturePoint(camera.gaussianAperture, vec2(u[lane], v[lane]));
            lensX[lane] = lens.x;
            lensY[lane] = lens.y;
        }
    }
    if (camera.shutter != 0u) {
        cameraPairs(frame, wave, WEDGE_SHUTTER_SEED, at, u, v);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            time[lane] = shutterTime(camera, u[lane]);
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        u[lane] = v[lane] = 0.5f;
    }
    if (camera.pixelFilter != WEDGE_PIXEL_CENTRE) {
        cameraPairs(frame, wave, WEDGE_PIXEL_SEED, at, u, v);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            u[lane] = 0.5f + pixelOffset(camera.pixelFilter, u[lane]);
            v[lane] = 0.5f + pixelOffset(camera.pixelFilter, v[lane]);
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const CameraRay ray = cameraRay(camera, (float)frame.width, (float)frame.height, (float)at->x[lane] + u[lane],
            (float)at->y[lane] + v[lane], vec2(lensX[lane], lensY[lane]), time[lane]);
        setRay(rays, lane, ray.origin, ray.direction, 0.0f, INFINITY);
        setTime(rays, lane, time[lane]);
    }
}

/// The samples that the receivers from `first` on are, `count` of them; lanes beyond have the first one's.
WEDGE_FN void samplesOf(FrameParams frame, uint first, uint count, __global const uint* restrict pixelOf,
    __global const uint* restrict sampleOf, __global const uint* restrict wanted, PrimaryLanes* samples)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint receiver = lane < count ? first + lane : first;
        const uint x = pixelOf[receiver] & 0xffffu, y = pixelOf[receiver] >> 16;
        samples->x[lane] = x;
        samples->y[lane] = y;
        samples->index[lane] = sampleOf[receiver];
        samples->count[lane] = wanted[pixelIndex(x, y, frame.stride)];
    }
}

/// What each lane meets of the lights that its pixel is known to see, whatever lies before them.
WEDGE_FN void meetKnownLights(__global const AreaLight* restrict lights, uint lightCount, const RayPacket* rays,
    const VecLanes* known, VecLanes* met)
{
    uint lit = 0u, metCount[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 k = laneVec(known, lane);
        setLaneVec(met, lane, k);
        lit |= luminance(k) > 0.0f ? 1u : 0u;
    }
    if (lit != 0u) {
        lightsMet(lights, lightCount, rays, met, metCount);
    }
}

/// What arrives along each lane's ray: what the surface emits, or lies beyond all. emitted: before, of lights that end
/// rays. Where the pixel is known to see lights, that takes the place of what the sample meets of them.
WEDGE_FN void arriving(FrameParams frame, __global const EnvironmentMap* restrict environment,
    __global const float* restrict environmentTable, const RayPacket* rays, const PacketHits* hits,
    const SurfaceLanes* at, const VecLanes* known, const VecLanes* met, VecLanes* emitted)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (at->live[lane] != 0u) {
            setLaneVec(emitted, lane, laneVec(&at->emission, lane));
        } else if (!(hits->t[lane] < INFINITY)) {
            const Vec3 direction = vecNormalize(rayDirection(rays, lane));
            setLaneVec(emitted, lane, vecAdd(frame.background, cameraBeyond(environment, environmentTable, direction)));
        }
        // The difference's mean is what lights do not send for things before them.
        const Vec3 k = laneVec(known, lane);
        const Vec3 besides = vecSub(laneVec(emitted, lane), laneVec(met, lane));
        setLaneVecIf(emitted, lane, luminance(k) > 0.0f, vecAdd(besides, k));
    }
}

/// Pixels that each lane's point moves in the image from shutter open to close: x and y.
WEDGE_FN void imageMotions(SurfaceData data, CameraParams camera, const PacketHits* hits, const SurfaceLanes* at,
    const float* restrict times, VecLanes* shift)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(shift, lane, vec3(0.0f, 0.0f, 0.0f));
    }
    if (camera.shutter == 0u) {
        return;
    }
    VecLanes moved;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(
            &moved, lane, at->live[lane] != 0u ? hitMotion(data, packetHit(hits, lane)) : vec3(0.0f, 0.0f, 0.0f));
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 p = laneVec(&at->position, lane), m = laneVec(&moved, lane);
        const Vec2 open = projectPoint(camera, vecMad(p, m, -times[lane]), 0.0f);
        const Vec2 close = projectPoint(camera, vecMad(p, m, 1.0f - times[lane]), 1.0f);
        setLaneVec(shift, lane, vec3(close.x - open.x, close.y - open.y, 0.0f));
    }
}

/// How each lane sees its surface.
typedef struct {
    uint geometric[WEDGE_PACKET_SIZE], view[WEDGE_PACKET_SIZE]; ///< packed, the view back along the ray
    float pixelSize[WEDGE_PACKET_SIZE]; ///< metres
} SightLanes;

/// Of all lanes: what hits nothing has a surface that nobody asks for.
WEDGE_FN void sightsOf(
    FrameParams frame, const RayPacket* rays, const PacketHits* hits, const SurfaceLanes* at, SightLanes* sights)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 direction = rayDirection(rays, lane), facing = laneVec(&at->geometric, lane);
        sights->geometric[lane] = packDirection(facing);
        sights->view[lane] = packDirection(vecScale(vecNormalize(direction), -1.0f));
        sights->pixelSize[lane] = projectedPixel(frame, facing, direction, hits->t[lane]);
    }
}

/// The first `count` lanes to a plane.
WEDGE_INLINE void storeLanes(__global float* restrict plane, const float* restrict lanes, uint count)
{
    for (uint lane = 0u; lane < count; ++lane) {
        plane[lane] = lanes[lane];
    }
}

WEDGE_INLINE void storeVecLanes(__global float* restrict planes, uint planeSize, const VecLanes* v, uint count)
{
    storeLanes(planes, v->x, count);
    storeLanes(planes + planeSize, v->y, count);
    storeLanes(planes + 2u * planeSize, v->z, count);
}

#include "pass/wavePrimary.h"
#ifdef PASS_wavePrimary
__kernel void wavePrimary(PARAMETERS)
{
    const SurfaceData data = WEDGE_SURFACE_ARGUMENTS;
    const uint size = wave.planeSize;
    const uint first = (firstGroup * get_local_size(0) + get_global_id(0)) * WEDGE_PACKET_SIZE;
    if (first >= wave.receivers) {
        return;
    }
    const uint count = min((uint)WEDGE_PACKET_SIZE, wave.receivers - first);
    PrimaryLanes samples;
    RayPacket packet;
    float times[WEDGE_PACKET_SIZE];
    samplesOf(frame, first, count, pixelOf, sampleOf, wanted, &samples);
    sendRays(frame, camera, wave, &samples, &packet, times);
    VecLanes seen, met, emitted;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint pixel = pixelIndex(samples.x[lane], samples.y[lane], frame.stride);
        setLaneVec(&seen, lane, LOAD_known(frame.planeSize, pixel));
    }
    meetKnownLights(lights, lightCount, &packet, &seen, &met);
    endAtLights(lights, lightCount, &packet, &emitted);
    for (uint lane = count; lane < WEDGE_PACKET_SIZE; ++lane) {
        packet.tMax[lane] = 0.0f;
    }
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);

    SurfaceLanes at;
    VecLanes shift;
    SightLanes sights;
    surfacesAt(data, &packet, &hits, &at);
    arriving(frame, environment, environmentTable, &packet, &hits, &at, &seen, &met, &emitted);
    imageMotions(data, camera, &hits, &at, times, &shift);
    sightsOf(frame, &packet, &hits, &at, &sights);
    for (uint lane = 0u; lane < count; ++lane) {
        objectId[first + lane] = at.live[lane] != 0u ? objectIds[hits.triangle[lane]] : 0u;
        gloss[first + lane] = at.gloss[lane];
        geometric[first + lane] = sights.geometric[lane];
        view[first + lane] = sights.view[lane];
        rays[first + lane] = pathRays[first + lane] = 0u;
    }
    storeLanes(time + first, times, count);
    storeLanes(depth + first, hits.t, count);
    storeLanes(pixelSize + first, sights.pixelSize, count);
    storeVecLanes(position + first, size, &at.position, count);
    storeVecLanes(normal + first, size, &at.normal, count);
#ifdef WEDGE_NORMAL_MAPS
    storeVecLanes(normal + 3u * size + first, size, &at.unmapped, count);
#endif
    storeVecLanes(origin + first, size, &at.origin, count);
    storeVecLanes(diffuse + first, size, &at.diffuse, count);
    storeVecLanes(specular + first, size, &at.specular, count);
    storeVecLanes(emission + first, size, &emitted, count);
    storeLanes(motion + first, shift.x, count);
    storeLanes(motion + size + first, shift.y, count);
}
#endif
