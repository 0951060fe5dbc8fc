// One sample of an area light as a receiver sees it.
#ifndef WEDGE_LIGHT_SAMPLE_H
#define WEDGE_LIGHT_SAMPLE_H

#include "pixel.h"
#include "shared/bsdf.h"
#include "shared/light.h"

/// The point a sample is for.
typedef struct {
    Vec3 origin;   ///< where its shadow rays start
    Vec3 position; ///< what is shaded
    Vec3 normal;   ///< unit
    Vec3 view;     ///< unit, to the eye
    Lobe lobe;     ///< of the specular reflection
    uint seed;     ///< of this pixel and light
} Receiver;

typedef struct {
    Vec3 ray;       ///< from the receiver's origin to the point on the light
    float diffuse;  ///< weight of the sample's visibility in the diffuse term, 0: no ray is needed
    float specular; ///< the same in the specular term
} LightSample;

/// The lobe of a gloss plane's value: its exponent, negative for Phong.
WEDGE_FN Lobe glossLobe(float gloss)
{
    return makeLobe(fabs(gloss), gloss < 0.0f ? WEDGE_SPECULAR_PHONG : WEDGE_SPECULAR_BLINN_PHONG);
}

WEDGE_FN Receiver loadReceiver(FrameParams frame, uint light, uint x, uint y, uint i,
                               __global const float* position, __global const float* normal,
                               __global const float* origin, __global const float* gloss)
{
    Receiver r;
    r.origin = loadVec(origin, frame.planeSize, i);
    r.position = loadVec(position, frame.planeSize, i);
    r.normal = loadVec(normal, frame.planeSize, i);
    r.view = vecNormalize(vecSub(frame.eye, r.position));
    r.lobe = glossLobe(gloss[i]);
    r.seed = hashCombine(hashCombine(frame.seed, light), y * frame.width + x);
    return r;
}

/// Weight of the light's point at vector d from the receiver in the specular term.
WEDGE_FN float specularWeight(Receiver r, Vec3 d, float geometry)
{
    return geometry * lobeValue(r.lobe, r.normal, r.view, vecNormalize(d));
}

/// Position in [0,1)^2 of sample `index` of `count`.
WEDGE_FN Vec2 samplePosition(SampleParams params, uint index, uint count, uint seed)
{
    if (params.sampler == WEDGE_SAMPLER_SOBOL) {
        return sobolOwen(index, seed);
    }
    // Each pass has strata of its own: the count of the second is not known during the first.
    return index < params.firstPass ? stratified(index, params.firstPass, seed)
                                    : stratified(index - params.firstPass, count - params.firstPass, hashUint(seed));
}

WEDGE_FN LightSample sampleLight(SampleParams params, AreaLight light, Receiver r, uint index, uint count)
{
    const Vec2 u = samplePosition(params, index, count, r.seed);
    const float a = lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
    const float b = lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
    const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, a, b);
    const Vec3 d = vecSub(point, r.position);
    const float geometry = geometryTerm(r.normal, d, light.normal, light.twoSided);
    LightSample s;
    s.ray = vecSub(point, r.origin);
    s.diffuse = params.shading == WEDGE_SHADING_SEPARATE ? (geometry > 0.0f ? 1.0f : 0.0f) : geometry;
    s.specular = 0.0f;
#ifdef WEDGE_SPECULAR
    if (geometry > 0.0f) {
        s.specular = params.shading == WEDGE_SHADING_SEPARATE ? 1.0f : specularWeight(r, d, geometry);
    }
#endif
    return s;
}

/// The quantity that is filtered: weighted mean visibility, or for WEDGE_SHADING_INSIDE the mean of the weights of
/// visible samples. Divides by what was taken, never by what was asked for; 0 where nothing was.
WEDGE_FN float termValue(uint shading, float weights, float visible, uint taken)
{
    if (shading == WEDGE_SHADING_INSIDE) {
        return taken > 0u ? visible / (float)taken : 0.0f;
    }
    return weights > 0.0f ? visible / weights : 0.0f;
}

#endif
