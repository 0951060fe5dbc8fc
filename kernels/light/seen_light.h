// Area lights that a camera ray meets.
#ifndef WEDGE_SEEN_LIGHT_H
#define WEDGE_SEEN_LIGHT_H

#include "light/scene_light.h"

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

#endif
