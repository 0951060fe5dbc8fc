// Area lights that a camera ray meets.
#ifndef WEDGE_SEEN_LIGHT_H
#define WEDGE_SEEN_LIGHT_H

#include "core/vec_lanes.h"
#include "light/scene_light.h"
#include "trace/packet.h"

typedef struct {
    float t; ///< along the camera direction; +inf where no light is hit
    Vec3 radiance;
} LightHit;

/// Nearest visible area light along the ray.
WEDGE_FN LightHit hitLights(__global const AreaLight* lights, uint count, Vec3 eye, Vec3 direction)
{
    LightHit hit;
    hit.t = INFINITY;
    hit.radiance = vec3(0.0f, 0.0f, 0.0f);
    for (uint i = 0; i < count; ++i) {
        const LightMeeting m = meetLight(lights[i], eye, direction);
        if (lights[i].visible != 0u && m.t < hit.t) {
            hit.t = m.t;
            hit.radiance = vecScale(lights[i].radiance, metProfile(lights[i], m));
        }
    }
    return hit;
}

/// The same of each lane's ray, which ends there: lanes with tMax 0 have none.
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
            const bool nearer = m.t < rays->tMax[lane];
            setLaneVecIf(radiance, lane, nearer, vecScale(light.radiance, metProfile(light, m)));
            rays->tMax[lane] = nearer ? m.t : rays->tMax[lane];
        }
    }
}

#endif
