// Lights as the kernels see them, and the measure on an area light.
#ifndef WEDGE_SHARED_LIGHT_H
#define WEDGE_SHARED_LIGHT_H

#include "maths.h"
#include "rng.h"
#include "vec.h"

#define WEDGE_PROFILE_UNIFORM 0u
#define WEDGE_PROFILE_GAUSSIAN 1u

/// Points of the light nearer to it than this fraction of the shadow ray do not count as occluders: they are the
/// light's own housing or the light itself.
#define WEDGE_SHADOW_RAY_END 0.9999f

/// How a light's samples are weighted and what is filtered (docs/soft-shadows.md).
#define WEDGE_SHADING_SEPARATE 0u ///< h = mean visibility, shaded with the light's centre (the thesis)
#define WEDGE_SHADING_INSIDE 1u   ///< the shaded radiance itself, cosine inside (Fig. 3.11a; plain Monte Carlo)
#define WEDGE_SHADING_RATIO 2u    ///< visibility weighted by the shading, times the unshadowed shading

/// How area lights are found: by points on them, by reflected directions that meet them, or by both.
#define WEDGE_LIGHTS_BOTH 0u
#define WEDGE_LIGHTS_SAMPLED 1u
#define WEDGE_LIGHTS_MET 2u

#define WEDGE_SAMPLER_SOBOL 0u
#define WEDGE_SAMPLER_STRATIFIED 1u

/// Nodes an axis of the quadratures over a light; their (coordinate, weight) pairs are in this order.
#define WEDGE_COARSE_NODES 5u
#define WEDGE_FINE_NODES 12u
#define WEDGE_FEW_NODES 3u ///< of the Gauss rule of the light's profile itself
#define WEDGE_FINE_OFFSET (2u * WEDGE_COARSE_NODES)
#define WEDGE_FEW_OFFSET (WEDGE_FINE_OFFSET + 2u * WEDGE_FINE_NODES)

WEDGE_SHARED_BEGIN

/// A planar quad light. Local coordinates (a, b) in [-1, 1]^2 map to centre + a halfU + b halfV.
typedef struct {
    Vec3 centre;
    float sigma;     ///< metres: standard deviation of the profile, geometric mean of the two axes
    Vec3 halfU;      ///< metres
    float cut;       ///< half extent in standard deviations (Gaussian)
    Vec3 halfV;      ///< metres
    float erfCut;    ///< erf(cut / sqrt 2): the Gaussian's mass inside the cut, one axis
    Vec3 normal;     ///< unit, the side that emits
    uint profile;    ///< WEDGE_PROFILE_*
    Vec3 power;      ///< W/sr: radiance at the centre times the integral of the profile over the quad
    uint twoSided;   ///< 1: both sides emit
    Vec3 radiance;   ///< W/(m^2 sr) at the centre
    uint visible;    ///< 1: the camera sees it
    float profileArea; ///< m^2: the profile's integral over the quad
    float pick;        ///< probability that a path's vertex samples this light
    uint padding[2];
} AreaLight;

/// A point light (directional = 0: vector is its position, colour its intensity in W/sr) or a directional one
/// (directional = 1: vector points towards the light, unit; colour is its irradiance in W/m^2).
typedef struct {
    Vec3 vector;
    uint directional;
    Vec3 colour;
    float pick; ///< probability that a path's vertex samples this light
} DeltaLight;

/// A directional light's shadow rays end this many scene diameters away.
#define WEDGE_FAR_DIAMETERS 4.0f

/// How a light is sampled and weighted.
typedef struct {
    uint shading;      ///< WEDGE_SHADING_*
    uint sampler;   ///< WEDGE_SAMPLER_*
    uint light;     ///< index of the light, part of the random seed
    uint firstPass; ///< samples of a first pass with strata of its own; 0: none
    uint lightSampling; ///< WEDGE_LIGHTS_*, for WEDGE_SHADING_INSIDE without a first pass
    uint strata; ///< samples that strata are made for after the first pass; 0: as many as the receiver is to have
    uint padding[2];
} SampleParams;

/// Inverse error function for |x| < 1 (Giles, Approximating the erfinv function, 2010; single precision). Both of its
/// ranges are worked out and one is chosen, again for vectors.
WEDGE_INLINE float erfInverse(float x)
{
    const float w = -logPositive((1.0f - x) * (1.0f + x));
    const float c = w - 2.5f;
    float central = 2.81022636e-08f;
    central = 3.43273939e-07f + central * c;
    central = -3.5233877e-06f + central * c;
    central = -4.39150654e-06f + central * c;
    central = 0.00021858087f + central * c;
    central = -0.00125372503f + central * c;
    central = -0.00417768164f + central * c;
    central = 0.246640727f + central * c;
    central = 1.50140941f + central * c;
    const float t = sqrt(fabs(w)) - 3.0f;
    float tail = -0.000200214257f;
    tail = 0.000100950558f + tail * t;
    tail = 0.00134934322f + tail * t;
    tail = -0.00367342844f + tail * t;
    tail = 0.00573950773f + tail * t;
    tail = -0.0076224613f + tail * t;
    tail = 0.00943887047f + tail * t;
    tail = 1.00167406f + tail * t;
    tail = 2.83297682f + tail * t;
    return (w < 5.0f ? central : tail) * x;
}

/// Local light coordinate in [-1, 1] of the uniform number u in [0, 1), distributed as the light's profile.
WEDGE_INLINE float lightCoordinate(float u, uint profile, float cut, float erfCut)
{
    const float x = 2.0f * u - 1.0f;
    return profile == WEDGE_PROFILE_GAUSSIAN ? 1.41421356f * erfInverse(x * erfCut) / cut : x;
}

/// From a receiver to the light, to where its shadow ray ends at t = 1.
WEDGE_FN Vec3 vectorToLight(DeltaLight light, float sceneDiameter, Vec3 origin)
{
    return light.directional != 0u ? vecScale(light.vector, WEDGE_FAR_DIAMETERS * sceneDiameter)
                                   : vecSub(light.vector, origin);
}

/// The light's profile at local coordinates (a, b), 1 at the centre.
WEDGE_INLINE float lightProfile(float a, float b, uint profile, float cut)
{
    return profile == WEDGE_PROFILE_GAUSSIAN ? exp2Bounded(-0.721347520f * cut * cut * (a * a + b * b)) : 1.0f;
}

/// The point of the light at local coordinates (a, b), metres.
WEDGE_INLINE Vec3 lightPoint(Vec3 centre, Vec3 halfU, Vec3 halfV, float a, float b)
{
    return vecMad(vecMad(centre, halfU, a), halfV, b);
}

/// The geometry term of receiver normal n and light normal m over the vector d from receiver to light (metres):
/// cos cos / d^2 in 1/m^2, 0 where the light is below the receiver's horizon or turned away from it.
WEDGE_INLINE float geometryTerm(Vec3 n, Vec3 d, Vec3 m, uint twoSided)
{
    const float receiver = vecDot(n, d);
    const float emitter = -vecDot(m, d);
    const float facing = twoSided != 0u ? fabs(emitter) : emitter;
    const float squared = vecDot(d, d);
    if (!(receiver > 0.0f) || !(facing > 0.0f)) {
        return 0.0f;
    }
    return receiver * facing / (squared * squared);
}

WEDGE_SHARED_END

#endif
