// The lights that stand for a map of what is beyond the scene (kernels/light/shadow_lights.cl).
#ifndef WEDGE_SHARED_SHADOW_LIGHTS_H
#define WEDGE_SHARED_SHADOW_LIGHTS_H

/// Numbers of each in the list of them: the unit direction towards it, and the irradiance, R G B, W/m^2, of what faces
/// it.
#define WEDGE_SHADOW_LIGHT_FLOATS 6u

/// How what they bring is put together with the map's whole light: render::Shadows.
#define WEDGE_SHADOWS_ADDITIVE 1u
#define WEDGE_SHADOWS_SUBTRACTIVE 2u
#define WEDGE_SHADOWS_RATIO 3u

#endif
