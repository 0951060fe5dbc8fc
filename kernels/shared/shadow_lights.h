// The lights that stand for a map of what is beyond the scene (kernels/light/shadow_lights.cl).
#ifndef WEDGE_SHARED_SHADOW_LIGHTS_H
#define WEDGE_SHARED_SHADOW_LIGHTS_H

/// Numbers of each in the list of them: the unit direction towards it, and the irradiance, R G B, W/m^2, of what faces
/// it.
#define WEDGE_SHADOW_LIGHT_FLOATS 6u

/// Most lights that a pixel may choose to trace rays to.
#define WEDGE_MOST_CHOSEN 64u

/// Numbers of each part of the map's light (kernels/light/light_tree.h): irradiance, R G B, W/m^2; unit direction to
/// the middle of the light; variance of its directions about it along either axis, radians squared; how many parts
/// there are from this one to the last below it, itself included; the largest angle between the middle and what is in
/// the part, radians.
#define WEDGE_TREE_FLOATS 9u

/// How what they bring is put together with the map's whole light: render::Shadows.
#define WEDGE_SHADOWS_ADDITIVE 1u
#define WEDGE_SHADOWS_SUBTRACTIVE 2u
#define WEDGE_SHADOWS_RATIO 3u

/// Tables of the map's whole light by the normal (kernels/light/light_cache.cl): texels along either side.
#define WEDGE_CACHE_SIDE 128u
/// Of microfacets there are two tables of each exponent: of Gloss::rise 0 and of this.
#define WEDGE_CACHE_RISE 15.0f

/// What counts as the map's whole light: render::WholeLight, of which Cache finds the same planes as Map.
#define WEDGE_COMPLETE_MAP 0u
#define WEDGE_COMPLETE_PREFILTERED 1u
#define WEDGE_COMPLETE_LIGHTS 2u

#endif
