// The primary pass of a wave: each receiver's ray through its pixel, the lens and the shutter, and what it hits.
//
// in   frame, camera, wave, BVH, surfaces, area lights (the camera sees those that are visible); pixelOf, sampleOf,
//      wanted: primary samples of each pixel
// out  planes of the wave: position, normal, origin (3 each), geometric (normal, packed), objectId (0: nothing to
// shade),
//      gloss (packed), view (packed direction back along the ray), time, diffuse, specular, emission
//      (3 each; emission holds background and light radiance where nothing is shaded), pixelSize (metres), depth
//      (along the view axis; +inf on a miss), motion (2 planes: pixels that the point moves in the image from shutter
//      open to close), rays and pathRays (0: for the effects to count in)
#include "core/receivers.h"
#include "light/seen_light.h"
#include "shared/camera.h"
#include "shared/wave.h"
#include "trace/environment.h"
#include "trace/packet.h"
#include "trace/surface.h"

#define WEDGE_LENS_SEED 0x6c656e73u
#define WEDGE_SHUTTER_SEED 0x74696d65u
#define WEDGE_PIXEL_SEED 0x70697865u

/// Two random numbers of a primary sample.
WEDGE_INLINE Vec2 cameraPair(FrameParams frame, WaveParams wave, uint what, uint x, uint y, uint index, uint count)
{
    const uint seed = hashCombine(hashCombine(frame.seed, what), y * frame.width + x);
    if (wave.sampler == WEDGE_SAMPLER_SOBOL) {
        return sobolOwen(index, seed);
    }
    // Strata of lens, time, light and hemisphere are paired at random: each pixel has an order of its own.
    const bool first = index < wave.firstPass;
    return first
        ? stratified(index, wave.firstPass, hashUint(seed ^ 0x55555555u), seed)
        : stratified(index - wave.firstPass, count - wave.firstPass, hashUint(seed ^ 0x33333333u), hashUint(seed));
}

WEDGE_INLINE CameraRay primaryRay(
    FrameParams frame, CameraParams camera, WaveParams wave, uint x, uint y, uint index, uint count)
{
    Vec2 lens = vec2(0.0f, 0.0f), at = vec2(0.5f, 0.5f);
    float time = 0.0f;
    if (camera.apertureRadius > 0.0f) {
        lens = aperturePoint(camera.gaussianAperture, cameraPair(frame, wave, WEDGE_LENS_SEED, x, y, index, count));
    }
    if (camera.shutter != 0u) {
        time = shutterTime(camera, cameraPair(frame, wave, WEDGE_SHUTTER_SEED, x, y, index, count).x);
    }
    if (camera.pixelFilter > 0.0f) {
        const Vec2 u = cameraPair(frame, wave, WEDGE_PIXEL_SEED, x, y, index, count);
        at = vec2(0.5f + camera.pixelFilter * (u.x - 0.5f), 0.5f + camera.pixelFilter * (u.y - 0.5f));
    }
    return cameraRay(camera, (float)frame.width, (float)frame.height, (float)x + at.x, (float)y + at.y, lens, time);
}

__kernel void wavePrimary(FrameParams frame, CameraParams camera, WaveParams wave,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_SURFACE_PARAMETERS, __global const uint* restrict objectIds, __global const AreaLight* restrict lights,
    uint lightCount, __global const uint* restrict pixelOf, __global const uint* restrict sampleOf,
    __global const uint* restrict wanted, __global float* restrict position, __global float* restrict normal,
    __global float* restrict origin, __global uint* restrict geometric, __global uint* restrict objectId,
    __global uint* restrict gloss, __global uint* restrict view, __global float* restrict time,
    __global float* restrict diffuse, __global float* restrict specular, __global float* restrict emission,
    __global float* restrict pixelSize, __global float* restrict depth, __global float* restrict motion,
    __global uint* restrict rays, __global uint* restrict pathRays, uint firstGroup)
{
    const SurfaceData data = WEDGE_SURFACE_ARGUMENTS;
    const uint size = wave.planeSize;
    const uint first = (firstGroup * get_local_size(0) + get_global_id(0)) * WEDGE_PACKET_SIZE;
    if (first >= wave.receivers) {
        return;
    }
    RayPacket packet;
    CameraRay sent[WEDGE_PACKET_SIZE];
    Vec3 lightRadiance[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool inside = first + lane < wave.receivers;
        const uint receiver = inside ? first + lane : first;
        const uint x = pixelOf[receiver] & 0xffffu, y = pixelOf[receiver] >> 16;
        sent[lane] = primaryRay(frame, camera, wave, x, y, sampleOf[receiver], wanted[pixelIndex(x, y, frame.stride)]);
        const LightHit seen = hitLights(lights, lightCount, sent[lane].origin, sent[lane].direction);
        setRay(&packet, lane, sent[lane].origin, sent[lane].direction, 0.0f, inside ? seen.t : 0.0f);
        setTime(&packet, lane, sent[lane].time);
        lightRadiance[lane] = seen.radiance;
    }
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = first + lane;
        if (i >= wave.receivers) {
            break;
        }
        const Hit hit = packetHit(&hits, lane);
        const CameraRay ray = sent[lane];
        time[i] = ray.time;
        rays[i] = pathRays[i] = 0u;
        depth[i] = hit.t;
        if (hit.triangle == WEDGE_NO_TRIANGLE) {
            objectId[i] = 0u;
            const Vec3 behind = vecAdd(frame.background, environmentRadiance(vecNormalize(ray.direction)));
            storeVec(emission, size, i, hit.t < INFINITY ? lightRadiance[lane] : behind);
            continue;
        }
        const Surface s = surfaceAt(data, hit, ray.direction, ray.time);
        storeVec(position, size, i, s.position);
        storeVec(normal, size, i, s.normal);
        storeVec(origin, size, i, s.origin);
        geometric[i] = packDirection(s.geometric);
        objectId[i] = objectIds[hit.triangle];
        gloss[i] = packGloss(s.gloss);
        view[i] = packDirection(vecScale(vecNormalize(ray.direction), -1.0f));
        storeVec(diffuse, size, i, s.diffuse);
        storeVec(specular, size, i, s.specular);
        storeVec(emission, size, i, s.emission);
        pixelSize[i] = projectedPixel(frame, s.geometric, ray.direction, hit.t);
        motion[i] = 0.0f;
        motion[size + i] = 0.0f;
        if (camera.shutter != 0u) {
            const Vec3 moved = hitMotion(data, hit);
            const Vec2 open = projectPoint(camera, vecMad(s.position, moved, -ray.time), 0.0f);
            const Vec2 close = projectPoint(camera, vecMad(s.position, moved, 1.0f - ray.time), 1.0f);
            motion[i] = close.x - open.x;
            motion[size + i] = close.y - open.y;
        }
    }
}
