// The primary pass: one ray through each pixel's centre, and what it hits, into the G-buffer.
//
// in   frame, BVH, surfaces, area lights (the camera sees those that are visible)
// out  position, normal, origin (3 planes each), geometric (normal, packed), objectId (0: nothing to shade), depth (ray
//      distance, +inf on a miss), pixelSize (projected edge of the pixel on the surface, metres), diffuse, specular,
//      emission (3 each; emission holds background and light radiance where nothing is shaded), gloss (packed;
//      negative: Phong)
#include "core/pixel.h"
#include "light/seen_light.h"
#include "trace/environment.h"
#include "trace/packet.h"
#include "trace/surface.h"

/// Through the centre of a pixel.
WEDGE_FN Vec3 pixelDirection(FrameParams frame, uint x, uint y)
{
    return cameraDirection(frame.forward, frame.right, frame.down, (float)frame.width, (float)frame.height,
        (float)x + 0.5f, (float)y + 0.5f);
}

__kernel void primary(FrameParams frame, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, WEDGE_SURFACE_PARAMETERS, __global const uint* restrict objectIds,
    __global const AreaLight* restrict lights, uint lightCount, __global float* restrict position,
    __global float* restrict normal, __global float* restrict origin, __global uint* restrict geometric,
    __global uint* restrict objectId, __global float* restrict depth, __global float* restrict pixelSize,
    __global float* restrict diffuse, __global float* restrict specular, __global float* restrict emission,
    __global uint* restrict gloss, uint firstGroup)
{
    const SurfaceData data = WEDGE_SURFACE_ARGUMENTS;
    const uint size = frame.planeSize;
    RayPacket packet;
    Vec3 lightRadiance[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint x, y;
        const bool inside = tilePixel(frame, firstGroup, lane, &x, &y);
        const Vec3 direction = pixelDirection(frame, inside ? x : 0u, inside ? y : 0u);
        const LightHit seen = hitLights(lights, lightCount, frame.eye, direction);
        setRay(&packet, lane, frame.eye, direction, 0.0f, inside ? seen.t : 0.0f);
        setTime(&packet, lane, 0.0f);
        lightRadiance[lane] = seen.radiance;
    }
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint x, y;
        if (!tilePixel(frame, firstGroup, lane, &x, &y)) {
            continue;
        }
        const uint i = pixelIndex(x, y, frame.stride);
        const Vec3 direction = pixelDirection(frame, x, y);
        const float length = vecLength(direction);
        const Hit hit = packetHit(&hits, lane);
        if (hit.triangle == WEDGE_NO_TRIANGLE) {
            objectId[i] = 0u;
            depth[i] = hit.t * length;
            const Vec3 behind = vecAdd(frame.background, environmentRadiance(vecNormalize(direction)));
            storeVec(emission, size, i, hit.t < INFINITY ? lightRadiance[lane] : behind);
            continue;
        }
        const Surface s = surfaceAt(data, hit, direction, timeOf(&packet, lane));
        storeVec(position, size, i, s.position);
        storeVec(normal, size, i, s.normal);
        storeVec(origin, size, i, s.origin);
        geometric[i] = packDirection(s.geometric);
        objectId[i] = objectIds[hit.triangle];
        depth[i] = hit.t * length;
        pixelSize[i] = projectedPixel(frame, s.geometric, direction, hit.t);
        storeVec(diffuse, size, i, s.diffuse);
        storeVec(specular, size, i, s.specular);
        storeVec(emission, size, i, s.emission);
        gloss[i] = packGloss(s.gloss);
    }
}
