// The primary pass: one ray through each pixel's centre, and what it hits, into the G-buffer.
//
// in   frame, BVH, surfaces, area lights (the camera sees those that are visible)
// out  position, normal, origin (3 planes each; normals with maps have 3 more, without them), geometric (normal,
// packed), objectId (0: nothing to shade), depth (ray
//      distance, +inf on a miss), pixelSize (projected edge of the pixel on the surface, metres), diffuse, specular,
//      emission (3 each; emission holds background and light radiance where nothing is shaded), gloss (packed;
//      negative: Phong)
#include "core/formats.h"
#include "core/pixel.h"
#include "light/environment_map.h"
#include "light/seen_light.h"
#include "trace/packet.h"
#include "trace/surface_lanes.h"

/// Through the centre of a pixel.
WEDGE_FN Vec3 pixelDirection(FrameParams frame, uint x, uint y)
{
    return cameraDirection(frame.forward, frame.right, frame.down, (float)frame.width, (float)frame.height,
        (float)x + 0.5f, (float)y + 0.5f);
}

#include "pass/primary.h"
#ifdef PASS_primary
__kernel void primary(PARAMETERS)
{
    const SurfaceData data = WEDGE_SURFACE_ARGUMENTS;
    const uint size = frame.planeSize;
    RayPacket packet;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint x, y;
        const bool inside = tilePixel(frame, firstGroup, lane, &x, &y);
        const Vec3 direction = pixelDirection(frame, inside ? x : 0u, inside ? y : 0u);
        setRay(&packet, lane, frame.eye, direction, 0.0f, inside ? INFINITY : 0.0f);
        setTime(&packet, lane, 0.0f);
    }
    VecLanes emitted;
    endAtLights(lights, lightCount, &packet, &emitted);
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);
    SurfaceLanes at;
    surfacesAt(data, &packet, &hits, &at);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint x, y;
        if (!tilePixel(frame, firstGroup, lane, &x, &y)) {
            continue;
        }
        const uint i = pixelIndex(x, y, frame.stride);
        const Vec3 direction = rayDirection(&packet, lane);
        const Hit hit = packetHit(&hits, lane);
        depth[i] = hit.t * vecLength(direction);
        if (at.live[lane] == 0u) {
            objectId[i] = 0u;
            const Vec3 behind =
                vecAdd(frame.background, cameraBeyond(environment, environmentTable, vecNormalize(direction)));
            storeVec(emission, size, i, vecChoose(hit.t < INFINITY, laneVec(&emitted, lane), behind));
            continue;
        }
        const Vec3 facing = laneVec(&at.geometric, lane);
        storeVec(position, size, i, laneVec(&at.position, lane));
        storeVec(normal, size, i, laneVec(&at.normal, lane));
#ifdef WEDGE_NORMAL_MAPS
        WEDGE_OF_FORMAT(store_unmapped, FORMAT_normal)(normal, size, i, laneVec(&at.unmapped, lane));
#endif
        storeVec(origin, size, i, laneVec(&at.origin, lane));
        geometric[i] = packDirection(facing);
        objectId[i] = objectIds[hit.triangle];
        pixelSize[i] = projectedPixel(frame, facing, direction, hit.t);
        storeVec(diffuse, size, i, laneVec(&at.diffuse, lane));
        storeVec(specular, size, i, laneVec(&at.specular, lane));
        storeVec(emission, size, i, laneVec(&at.emission, lane));
        gloss[i] = at.gloss[lane];
    }
}
#endif
