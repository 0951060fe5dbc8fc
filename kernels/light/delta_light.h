// What a point light or a directional one brings to a receiver where nothing hides it, and the rays that say whether
// something does.
#ifndef WEDGE_DELTA_LIGHT_H
#define WEDGE_DELTA_LIGHT_H

#include "light/light_packet.h"
#include "light/light_sample.h"
#include "trace/packet.h"

/// Radiance that a receiver reflects to where it is seen from. toLight: vectorToLight(); cosine: between it and the
/// receiver's normal, above 0.
WEDGE_FN Vec3 deltaLightAt(DeltaLight light, Receiver r, Vec3 toLight, float cosine, Vec3 diffuse, Vec3 specular)
{
    const float falloff = light.directional != 0u ? cosine : cosine / vecDot(toLight, toLight);
    const Vec3 lobe = vecScale(specular, lobeValue(r.lobe, r.normal, r.view, vecNormalize(toLight)));
    const Vec3 reflected = vecMad(lobe, diffuse, WEDGE_INV_PI);
    return vecScale(vecMul(reflected, light.colour), falloff);
}

/// A shadow ray to the light from each receiver that faces it; cosine: between its normal and that ray.
WEDGE_FN void deltaShadowRays(
    DeltaLight light, float sceneDiameter, const ReceiverPacket* receivers, RayPacket* packet, float* cosine)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 start = vec3(receivers->originX[lane], receivers->originY[lane], receivers->originZ[lane]);
        const Vec3 n = vec3(receivers->normalX[lane], receivers->normalY[lane], receivers->normalZ[lane]);
        const Vec3 toLight = vectorToLight(light, sceneDiameter, start);
        cosine[lane] = vecDot(n, vecNormalize(toLight));
        setRay(packet, lane, start, toLight, 0.0f, cosine[lane] > 0.0f ? WEDGE_SHADOW_RAY_END : 0.0f);
        setTime(packet, lane, receiverTime(receivers, lane));
    }
}

#endif
