// Point and directional lights: one shadow ray each, nothing to filter.
//
// in      frame, BVH, the lights, G-buffer
// in out  lit (3 planes, radiance), rays
#include "light/delta_light.h"

#include "pass/deltaLights.h"
#ifdef PASS_deltaLights
__kernel void deltaLights(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    Vec3 radiance[WEDGE_PACKET_SIZE];
    uint traced[WEDGE_PACKET_SIZE], occluded[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        radiance[lane] = vec3(0.0f, 0.0f, 0.0f);
        traced[lane] = 0u;
    }
    for (uint k = 0u; k < lightCount; ++k) {
        const DeltaLight light = lights[k];
        RayPacket packet;
        float cosine[WEDGE_PACKET_SIZE];
        deltaShadowRays(light, sceneDiameter, &receivers, &packet, cosine);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            traced[lane] += cosine[lane] > 0.0f ? 1u : 0u;
        }
        anyHits(nodes, blocks, &packet, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const uint i = receivers.pixel[lane];
            if (!(cosine[lane] > 0.0f) || occluded[lane] != 0u || i == WEDGE_NO_PIXEL) {
                continue;
            }
            const Receiver r = loadReceiver(frame, data, i);
            const Vec3 toLight = vectorToLight(light, sceneDiameter, r.origin);
            radiance[lane] = vecAdd(radiance[lane],
                deltaLightAt(light, r, toLight, cosine[lane], loadVec(diffuse, frame.planeSize, i),
                    loadVec(specular, frame.planeSize, i)));
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            rays[i] += traced[lane];
            storeVec(lit, frame.planeSize, i, vecAdd(loadVec(lit, frame.planeSize, i), radiance[lane]));
        }
    }
}
#endif
