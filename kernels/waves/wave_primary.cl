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
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint receiver = lane < count ? first + lane : first;
        const uint x = pixelOf[receiver] & 0xffffu, y = pixelOf[receiver] >> 16;
        samples.x[lane] = x;
        samples.y[lane] = y;
        samples.index[lane] = sampleOf[receiver];
        samples.count[lane] = wanted[pixelIndex(x, y, frame.stride)];
    }
    RayPacket packet;
    float times[WEDGE_PACKET_SIZE];
    VecLanes emitted;
    sendRays(frame, camera, wave, &samples, &packet, times);
    VecLanes light, met;
    uint lit = 0u, metCount[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint pixel = pixelIndex(samples.x[lane], samples.y[lane], frame.stride);
        const Vec3 k = LOAD_known(frame.planeSize, pixel);
        setLaneVec(&light, lane, k);
        setLaneVec(&met, lane, k);
        lit |= luminance(k) > 0.0f ? 1u : 0u;
    }
    if (lit != 0u) {
        lightsMet(lights, lightCount, &packet, &met, metCount);
    }
    endAtLights(lights, lightCount, &packet, &emitted);
    for (uint lane = count; lane < WEDGE_PACKET_SIZE; ++lane) {
        packet.tMax[lane] = 0.0f;
    }
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);

    SurfaceLanes at;
    surfacesAt(data, &packet, &hits, &at);
    VecLanes moved;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Hit hit = packetHit(&hits, lane);
        const bool live = at.live[lane] != 0u;
        Vec3 motionOfHit = vec3(0.0f, 0.0f, 0.0f);
        uint object = 0u;
        if (live) {
            object = objectIds[hit.triangle];
            motionOfHit = hitMotion(data, hit);
            setLaneVec(&emitted, lane, laneVec(&at.emission, lane));
        } else if (!(hit.t < INFINITY)) {
            const Vec3 direction = vecNormalize(rayDirection(&packet, lane));
            setLaneVec(
                &emitted, lane, vecAdd(frame.background, cameraBeyond(environment, environmentTable, direction)));
        }
        // The difference's mean is what lights do not send for things before them.
        const Vec3 l = laneVec(&light, lane);
        const Vec3 besides = vecSub(laneVec(&emitted, lane), laneVec(&met, lane));
        setLaneVecIf(&emitted, lane, luminance(l) > 0.0f, vecAdd(besides, l));
        setLaneVec(&moved, lane, motionOfHit);
        if (lane < count) {
            objectId[first + lane] = object;
            gloss[first + lane] = at.gloss[lane];
            rays[first + lane] = pathRays[first + lane] = 0u;
        }
    }
    // What hits nothing has a surface that nobody asks for.
    uint geometrics[WEDGE_PACKET_SIZE], views[WEDGE_PACKET_SIZE];
    float sizes[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 direction = rayDirection(&packet, lane), facing = laneVec(&at.geometric, lane);
        geometrics[lane] = packDirection(facing);
        views[lane] = packDirection(vecScale(vecNormalize(direction), -1.0f));
        sizes[lane] = projectedPixel(frame, facing, direction, hits.t[lane]);
    }
    for (uint lane = 0u; lane < count; ++lane) {
        geometric[first + lane] = geometrics[lane];
        view[first + lane] = views[lane];
    }
    storeLanes(time + first, times, count);
    storeLanes(depth + first, hits.t, count);
    storeLanes(pixelSize + first, sizes, count);
    storeVecLanes(position + first, size, &at.position, count);
    storeVecLanes(normal + first, size, &at.normal, count);
#ifdef WEDGE_NORMAL_MAPS
    storeVecLanes(normal + 3u * size + first, size, &at.unmapped, count);
#endif
    storeVecLanes(origin + first, size, &at.origin, count);
    storeVecLanes(diffuse + first, size, &at.diffuse, count);
    storeVecLanes(specular + first, size, &at.specular, count);
    storeVecLanes(emission + first, size, &emitted, count);
    VecLanes shift;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&shift, lane, vec3(0.0f, 0.0f, 0.0f));
    }
    if (camera.shutter != 0u) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec3 p = laneVec(&at.position, lane), m = laneVec(&moved, lane);
            const Vec2 open = projectPoint(camera, vecMad(p, m, -times[lane]), 0.0f);
            const Vec2 close = projectPoint(camera, vecMad(p, m, 1.0f - times[lane]), 1.0f);
            setLaneVec(&shift, lane, vec3(close.x - open.x, close.y - open.y, 0.0f));
        }
    }
    storeLanes(motion + first, shift.x, count);
    storeLanes(motion + size + first, shift.y, count);
}
#endif
