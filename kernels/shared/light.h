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
#define WEDGE_SHADING_INSIDE 1u ///< the shaded radiance itself, cosine inside (Fig. 3.11a; plain Monte Carlo)
#define WEDGE_SHADING_RATIO 2u ///< visibility weighted by the shading, times the unshadowed shading

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
#define WEDGE_FITTED_NODES                                                                                             \
    16u ///< of the Gauss-Legendre rule on [-1, 1], weights summing to 2, for rules fitted to a receiver
#define WEDGE_FITTED_OFFSET (WEDGE_FEW_OFFSET + 2u * WEDGE_FEW_NODES)
#define WEDGE_CLIPPED_NODES 8u ///< likewise, on the part of a light above a receiver's horizon
#define WEDGE_CLIPPED_OFFSET (WEDGE_FITTED_OFFSET + 2u * WEDGE_FITTED_NODES)
#define WEDGE_MEDIUM_NODES 8u ///< of the Gauss rule of the light's profile itself
#define WEDGE_MEDIUM_OFFSET (WEDGE_CLIPPED_OFFSET + 2u * WEDGE_CLIPPED_NODES)

WEDGE_SHARED_BEGIN

/// A planar quad light. Local coordinates (a, b) in [-1, 1]^2 map to centre + a halfU + b halfV.
typedef struct {
    Vec3 centre;
    float sigma; ///< metres: standard deviation of the profile, geometric mean of the two axes
    Vec3 halfU; ///< metres
    float cut; ///< half extent in standard deviations (Gaussian)
    Vec3 halfV; ///< metres
    float erfCut; ///< erf(cut / sqrt 2): the Gaussian's mass inside the cut, one axis
    Vec3 normal; ///< unit, the side that emits
    uint profile; ///< WEDGE_PROFILE_*
    Vec3 power; ///< W/sr: radiance at the centre times the integral of the profile over the quad
    uint twoSided; ///< 1: both sides emit
    Vec3 radiance; ///< W/(m^2 sr) at the centre
    uint visible; ///< 1: the camera sees it
    float profileArea; ///< m^2: the profile's integral over the quad
    float pick; ///< probability that a path's vertex samples this light
    float sharedPick; ///< probability that a sample of the term that lights share is of this one; less than 0: it has a
                      ///< term of its own
    float lift; ///< metres: how far from the quad shadow rays end that lies in a surface; 0: it lies in none. On the
                ///< sides that emit rays meet it before what is as near
} AreaLight;

/// A point light (directional = 0: vector is its position, colour its intensity in W/sr) or a directional one
/// (directional = 1: vector points towards the light, unit; colour is its irradiance in W/m^2).
typedef struct {
    Vec3 vector;
    uint directional;
    Vec3 colour;
    float pick; ///< probability that a path's vertex samples this light
} DeltaLight;

/// Where shadow rays to a light end, in their lengths. What lies just before a light that is in no surface is its
/// housing; rays to one that is in a surface are lifted off it and meet all that is before it.
WEDGE_INLINE float shadowRayEnd(AreaLight light) { return light.lift > 0.0f ? 1.0f : WEDGE_SHADOW_RAY_END; }

/// A ray to a point of a light, lifted off the surface that the light is in, if any.
WEDGE_INLINE Vec3 liftedRay(AreaLight light, Vec3 ray)
{
    return vecMad(ray, light.normal, vecDot(light.normal, ray) > 0.0f ? -light.lift : light.lift);
}

/// The score of a light's profile l, -l' / l: integrals over the light weighted by it are derivatives of what the light
/// does where it moves. docs/soft-shadows.md
typedef struct {
    Vec3 centre;
    float inner; ///< of the score's two parts, see scoreOf()
    Vec3 alongU, alongV; ///< 1/m: local coordinates are their products with what a point is off the centre
    float outer;
} LightScore;

/// At a local coordinate from -1 to 1, per unit of it. The derivative of a profile that is cut has a step at either end
/// as well, which what rises steeply towards it stands for, of the same first moment.
WEDGE_INLINE float scoreOf(LightScore light, float a)
{
    const float squared = a * a;
    return a * (light.inner + light.outer * squared * squared * squared);
}

/// A directional light's shadow rays end this many scene diameters away.
#define WEDGE_FAR_DIAMETERS 4.0f

/// How a light is sampled and weighted.
typedef struct {
    uint shading; ///< WEDGE_SHADING_*
    uint sampler; ///< WEDGE_SAMPLER_*
    uint light; ///< index of the light, part of the random seed
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

/// Error function, to 3e-7 (Abramowitz and Stegun 7.1.26).
WEDGE_INLINE float errorFunction(float x)
{
    const float t = 1.0f / (1.0f + 0.3275911f * fabs(x));
    const float p =
        t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
    const float y = 1.0f - p * exp2Bounded(-1.44269504f * x * x);
    return x < 0.0f ? -y : y;
}

/// Local light coordinate in [-1, 1] of the uniform number u in [0, 1), distributed as the light's profile.
WEDGE_INLINE float lightCoordinate(float u, uint profile, float cut, float erfCut)
{
    const float x = 2.0f * u - 1.0f;
    // A wide cut has erfCut round to 1, and the inverse of 1 lies anywhere.
    const float bounded = clamp(x * erfCut, -0.99999994f, 0.99999994f);
    const float gaussian = clamp(1.41421356f * erfInverse(bounded) / cut, -1.0f, 1.0f);
    return profile == WEDGE_PROFILE_GAUSSIAN ? gaussian : x;
}

/// The number whose lightCoordinate() is a.
WEDGE_INLINE float lightFraction(float a, uint profile, float cut, float erfCut)
{
    const float gaussian = 0.5f + 0.5f * errorFunction(0.70710678f * a * cut) / erfCut;
    return profile == WEDGE_PROFILE_GAUSSIAN ? gaussian : 0.5f + 0.5f * a;
}

/// The part of a light above the horizon of a receiver, and how it is sampled: first the outer of the light's axes, as
/// far as points of it may be above, then the inner one, along which the horizon changes most, from the horizon on. So
/// every sample is of light that may arrive, be there ever so little.
typedef struct {
    uint cut; ///< 0: all of the light is above, or nothing: the rest does not matter
    uint turned; ///< 1: the inner axis is halfV
    float first, range; ///< sample numbers of the outer axis
    float height; ///< of the light's centre over the horizon, metres
    float inner, outer; ///< of the half axes
} LightPart;

/// A sample of it: local coordinates, and what it weighs against one of the whole light.
typedef struct {
    float a, b, mass;
} PartSample;

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

/// Sample numbers of one axis whose points are above a horizon, height + slope a > 0: the first, and how far they
/// reach.
WEDGE_INLINE Vec2 numbersAbove(AreaLight light, float height, float slope)
{
    // Also where nothing is above, by a rounding: then the end that is nearest to it.
    const bool cut = height < fabs(slope);
    const float along = fabs(slope) > 1e-20f ? slope : 1e-20f;
    const float at = lightFraction(clamp(-height / along, -1.0f, 1.0f), light.profile, light.cut, light.erfCut);
    // What rounding leaves out would be missing from the light: a little too much costs nothing.
    const float lo = cut && along > 0.0f ? clamp(at - 2e-6f, 0.0f, 0.99999f) : 0.0f;
    const float hi = cut && along < 0.0f ? clamp(at + 2e-6f, 0.00001f, 1.0f) : 1.0f;
    return vec2(lo, hi - lo);
}

WEDGE_INLINE LightPart partAboveHorizon(AreaLight light, Vec3 position, Vec3 normal)
{
    LightPart part;
    const float u = vecDot(normal, light.halfU), v = vecDot(normal, light.halfV);
    part.height = vecDot(normal, vecSub(light.centre, position));
    part.cut = fabs(part.height) < fabs(u) + fabs(v) ? 1u : 0u;
    part.turned = fabs(v) > fabs(u) ? 1u : 0u;
    part.inner = part.turned != 0u ? v : u;
    part.outer = part.turned != 0u ? u : v;
    const Vec2 numbers = numbersAbove(light, part.height + fabs(part.inner), part.outer);
    part.first = part.cut != 0u ? numbers.x : 0.0f;
    part.range = part.cut != 0u ? numbers.y : 1.0f;
    return part;
}

/// Sample numbers of the inner axis beside coordinate `outer` of the other one.
WEDGE_INLINE Vec2 innerNumbers(AreaLight light, LightPart part, float outer)
{
    const Vec2 above = numbersAbove(light, part.height + part.outer * outer, part.inner);
    return vec2(part.cut != 0u ? above.x : 0.0f, part.cut != 0u ? above.y : 1.0f);
}

/// What samples at local coordinates (a, b) weigh.
WEDGE_INLINE float partMass(AreaLight light, LightPart part, float a, float b)
{
    return part.range * innerNumbers(light, part, part.turned != 0u ? a : b).y;
}

/// The sample of the numbers u, distributed as the light's profile along the inner axis.
WEDGE_INLINE PartSample samplePart(AreaLight light, LightPart part, Vec2 u)
{
    const bool turned = part.cut != 0u && part.turned != 0u;
    const float outer =
        lightCoordinate(part.first + part.range * (turned ? u.x : u.y), light.profile, light.cut, light.erfCut);
    const Vec2 numbers = innerNumbers(light, part, outer);
    const float inner =
        lightCoordinate(numbers.x + numbers.y * (turned ? u.y : u.x), light.profile, light.cut, light.erfCut);
    PartSample s;
    s.a = turned ? outer : inner;
    s.b = turned ? inner : outer;
    s.mass = part.range * numbers.y;
    return s;
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
