// Area lights that a camera ray meets.
#ifndef WEDGE_SEEN_LIGHT_H
#define WEDGE_SEEN_LIGHT_H

#include "core/vec_lanes.h"
#include "light/scene_light.h"
#include "trace/packet.h"

/// Ends each lane's ray at the nearest visible area light that it meets. radiance: what arrives from there, 0 where
/// there is none. Lanes with tMax 0 have no ray.
WEDGE_FN void endAtLights(__global const AreaLight* lights, uint count, RayPacket* rays, VecLanes* radiance)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(radiance, lane, vec3(0.0f, 0.0f, 0.0f));
    }
    for (uint i = 0; i < count; ++i) {
        const AreaLight light = lights[i];
        if (light.visible == 0u) {
            continue;
        }
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const LightMeeting m = meetLight(light, rayStart(rays, lane), rayDirection(rays, lane));
            const float end = meetingEnd(light, m);
            const bool nearer = end < rays->tMax[lane];
            setLaneVecIf(radiance, lane, nearer, vecScale(light.radiance, metProfile(light, m)));
            rays->tMax[lane] = nearer ? end : rays->tMax[lane];
        }
    }
}

/// What arrives from all visible area lights that a lane's ray meets, whatever else it meets before. met: how many
/// those are.
WEDGE_FN void lightsMet(
    __global const AreaLight* lights, uint count, const RayPacket* rays, VecLanes* radiance, uint* restrict met)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(radiance, lane, vec3(0.0f, 0.0f, 0.0f));
        met[lane] = 0u;
    }
    for (uint i = 0; i < count; ++i) {
        const AreaLight light = lights[i];
        if (light.visible == 0u) {
            continue;
        }
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const LightMeeting m = meetLight(light, rayStart(rays, lane), rayDirection(rays, lane));
            const Vec3 more = vecAdd(laneVec(radiance, lane), vecScale(light.radiance, metProfile(light, m)));
            setLaneVecIf(radiance, lane, m.t < INFINITY, more);
            met[lane] += m.t < INFINITY ? 1u : 0u;
        }
    }
}

#endif
