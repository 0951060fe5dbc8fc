// From filtered terms to radiance: each light's value times its unshadowed shading and the surface's reflectance,
// added up over lights, then with what surfaces and background emit.
#include "analysis/deviation.h"
#include "core/fallen_back.h"
#include "core/finite.h"
#include "core/packed_planes.h"
#include "light/light_sample.h"
#include "light/unshadowed.h"
#include "shared/filter_params.h"
#include "shared/path.h"

/// Adds light's value times `shading` (already times the reflectance) to planes of radiance.
WEDGE_FN void addBlock(__global float* planes, uint size, int i, float16 value, Vec3x16 shading)
{
    vstore16(loadBlock(planes, i) + value * shading.x, 0, planes + i);
    vstore16(loadBlock(planes + size, i) + value * shading.y, 0, planes + size + i);
    vstore16(loadBlock(planes + 2u * size, i) + value * shading.z, 0, planes + 2u * size + i);
}

/// Adds to a plane of 16 bits.
WEDGE_FN void addShorts(__global float* plane, uint size, int i, float16 more)
{
    storeShortsBlock(plane, size, i, 0u, loadShortsBlock(plane, size, i, 0u) + more);
}

/// Adds deviations of one term, times what it is shaded with, to those of the luminance.
WEDGE_FN void addDeviation(__global float* plane, uint size, int i, float16 deviation, Vec3x16 shading)
{
    const float16 shown = 0.2126f * shading.x + 0.7152f * shading.y + 0.0722f * shading.z;
    addShorts(plane, size, i, deviation * shown);
}

/// What matt surfaces reflect of all of a light, lanes `surface`, kd: their reflectance.
WEDGE_FN Vec3x16 reflectedDiffuse(SampleParams params, AreaLight light, Vec3x16 at, Vec3x16 facing, Vec3x16 kd,
    __global const float* nodes, int16 surface)
{
    float16 shading = (float16)(1.0f);
    if (params.shading == WEDGE_SHADING_SEPARATE) {
        shading = geometryTerm16(facing, sub16(splat3(light.centre), at), light.normal, light.twoSided);
    } else if (params.shading == WEDGE_SHADING_RATIO) {
        shading = unshadowedDiffuse(light, mattReceivers(at, facing), nodes, surface);
    }
    shading = surface ? shading * WEDGE_INV_PI : (float16)(0.0f);
    Vec3x16 reflected;
    reflected.x = shading * kd.x * light.power.x;
    reflected.y = shading * kd.y * light.power.y;
    reflected.z = shading * kd.z * light.power.z;
    return reflected;
}

/// One light's diffuse reflection.
/// in      value: filtered; noisy: not filtered; parts: of frames with a first pass (params.firstPass) the same of the
///         first of two parts of the samples, in 16 bits each; nodes: of the quadratures, (coordinate, weight) pairs;
///         taken: the samples of value
/// in out  direct, directNoisy (3 planes each), deviation (of directNoisy's luminance, as deviation16() has it, in 16
/// bits)
#include "pass/addDiffuse.h"
#ifdef PASS_addDiffuse
__kernel void addDiffuse(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const int16 surface = loadIdBlock(objectId, i) != 0u;
    if (!any(surface)) {
        return;
    }
    const Vec3x16 reflected = reflectedDiffuse(params, light, loadVecBlock(position, size, i),
        loadVecBlock(normal, size, i), loadVecBlock(diffuse, size, i), nodes, surface);
    addBlock(direct, size, i, loadBlock(value, i), reflected);
    const float16 mean = loadBlock(noisy, i);
    addBlock(directNoisy, size, i, mean, reflected);
    if (HAS_parts && params.firstPass > 0u) {
        const float16 ofPart = loadShortsBlock(PLANE_parts, size, i, 0u);
        addDeviation(deviation, size, i, deviation16(mean, ofPart, loadIdBlock(taken, i), params.firstPass), reflected);
    }
}
#endif

/// Unshadowed specular shading in the way of the term, of lanes `wanted`.
WEDGE_FN float16 specularShading(SampleParams params, AreaLight light, Receivers16 r, __global const float* nodes,
    int16 wanted, LobeDirections directions)
{
    if (params.shading == WEDGE_SHADING_INSIDE) {
        return (float16)(1.0f);
    }
    if (params.shading == WEDGE_SHADING_RATIO) {
        return unshadowedSpecular(light, r, nodes, wanted, directions);
    }
    return arrivesFrom(light, r, splat3(light.centre), true) * normalization16(r);
}

/// What the lobes of a block at (x, y) reflect of all of a light, lanes `mirrors`, ks: their reflectance.
WEDGE_FN Vec3x16 reflectedSpecular(SampleParams params, AreaLight light, FrameParams frame, uint x, uint y,
    uint directions, Vec3x16 at, Vec3x16 facing, Vec3x16 ks, uint16 gloss, __global const float* nodes, int16 mirrors)
{
    const Receivers16 r = glossyReceivers(at, facing, unit16(sub16(splat3(frame.eye), at)), gloss);
    LobeDirections lobes;
    lobes.pixel = (x + (uint16)(0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 11u, 12u, 13u, 14u, 15u)) | (y << 16);
    lobes.first = (uint16)(0u);
    lobes.count = directions;
    lobes.seed = frame.seed;
    const float16 shading = mirrors ? specularShading(params, light, r, nodes, mirrors, lobes) : (float16)(0.0f);
    Vec3x16 reflected;
    reflected.x = shading * ks.x * light.power.x;
    reflected.y = shading * ks.y * light.power.y;
    reflected.z = shading * ks.z * light.power.z;
    return reflected;
}

/// One light's specular reflection; value, noisy and parts hold the specular term in their second planes. directions:
/// of each lobe that is too sharp for a rule
#include "pass/addSpecular.h"
#ifdef PASS_addSpecular
__kernel void addSpecular(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3x16 ks = loadVecBlock(specular, size, i);
    const int16 mirrors = (loadIdBlock(objectId, i) != 0u) & (ks.x + ks.y + ks.z > 0.0f);
    if (!any(mirrors)) {
        return;
    }
    const Vec3x16 reflected = reflectedSpecular(params, light, frame, x, y, directions, loadVecBlock(position, size, i),
        loadVecBlock(normal, size, i), ks, loadIdBlock(gloss, i), nodes, mirrors);
    // What misses hold is not looked at: 0 times a NaN would let it in.
    addBlock(direct, size, i, mirrors ? loadBlock(value + size, i) : (float16)(0.0f), reflected);
    const float16 mean = mirrors ? loadBlock(noisy + size, i) : (float16)(0.0f);
    addBlock(directNoisy, size, i, mean, reflected);
    if (HAS_parts && params.firstPass > 0u) {
        const float16 ofPart = mirrors ? loadShortsBlock(PLANE_parts, size, i, 1u) : (float16)(0.0f);
        addDeviation(deviation, size, i, deviation16(mean, ofPart, loadIdBlock(taken, i), params.firstPass), reflected);
    }
}
#endif

/// Adds what changes of what is seen, of each colour, times the shading, to a change of radiance.
WEDGE_FN void addChangeBlock(
    __global float* change, uint size, int i, __global const float* more, int16 lanes, Vec3x16 reflected)
{
    const float16 none = (float16)(0.0f);
    Vec3x16 light = loadVecBlock(more, size, i);
    light.x = lanes ? light.x * reflected.x : none;
    light.y = lanes ? light.y * reflected.y : none;
    light.z = lanes ? light.z * reflected.z : none;
    addBlock(change, size, i, (float16)(1.0f), light);
}

/// One light's diffuse reflection, as far as what is seen of it changes.
/// in      more: R G B to be added to what is seen of the light; else as of addDiffuse()
/// in out  change: of radiance, 3 planes
#include "pass/addDiffuseChange.h"
#ifdef PASS_addDiffuseChange
__kernel void addDiffuseChange(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const int16 surface = loadIdBlock(objectId, i) != 0u;
    if (any(surface)) {
        const Vec3x16 reflected = reflectedDiffuse(params, light, loadVecBlock(position, size, i),
            loadVecBlock(normal, size, i), loadVecBlock(diffuse, size, i), nodes, surface);
        addChangeBlock(change, size, i, more, surface, reflected);
    }
}
#endif

/// Its specular reflection, likewise. more: R G B of matt surfaces, and then of lobes
#include "pass/addSpecularChange.h"
#ifdef PASS_addSpecularChange
__kernel void addSpecularChange(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const Vec3x16 ks = loadVecBlock(specular, size, i);
    const int16 mirrors = (loadIdBlock(objectId, i) != 0u) & (ks.x + ks.y + ks.z > 0.0f);
    if (any(mirrors)) {
        const Vec3x16 reflected = reflectedSpecular(params, light, frame, x, y, directions,
            loadVecBlock(position, size, i), loadVecBlock(normal, size, i), ks, loadIdBlock(gloss, i), nodes, mirrors);
        addChangeBlock(change, size, i, more + 3u * size, mirrors, reflected);
    }
}
#endif

/// What one term of indirect light is multiplied by in the image. component: WEDGE_COMPONENT_*; of ambient occlusion
/// the open part of the hemisphere is shown, on white. reflectance: 3 planes
WEDGE_FN Vec3x16 reflectanceOf(AnalysisParams p, uint component, __global const float* restrict reflectance, int i)
{
    return component == WEDGE_COMPONENT_AMBIENT ? splat3(vec3(1.0f, 1.0f, 1.0f))
                                                : loadVecBlock(reflectance, p.planeSize, i);
}

/// Adds a term, of pixels that have it, to the sum of all.
WEDGE_FN void addTerm(AnalysisParams p, uint component, Vec3x16 k, int16 has, __global const float* restrict value,
    int i, __global float* restrict sum)
{
    const Vec3x16 arrives = loadVecBlock(value, p.planeSize, i);
    const float16 zero = (float16)(0.0f);
    const bool ambient = component == WEDGE_COMPONENT_AMBIENT;
    Vec3x16 all = loadVecBlock(sum, p.planeSize, i);
    // What was never sampled holds anything.
    all.x += has ? k.x * (ambient ? 1.0f - arrives.x : arrives.x) : zero;
    all.y += has ? k.y * (ambient ? 1.0f - arrives.y : arrives.y) : zero;
    all.z += has ? k.z * (ambient ? 1.0f - arrives.z : arrives.z) : zero;
    vstore16(all.x, 0, sum + i);
    vstore16(all.y, 0, sum + p.planeSize + i);
    vstore16(all.z, 0, sum + 2u * p.planeSize + i);
}

/// The samples of one term of indirect light, as they are.
/// in      value: 3 planes; deviations: where they vary, as deviation16() has them, in luminance over that of the
///         reflectance; taken: the samples of value
/// in out  indirectNoisy (3 planes), deviation (as of lights)
#include "pass/addPathSamples.h"
#ifdef PASS_addPathSamples
__kernel void addPathSamples(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 has = loadIdBlock(taken, i) != 0u;
    const Vec3x16 k = reflectanceOf(p, component, reflectance, i);
    addTerm(p, component, k, has, value, i, indirectNoisy);
    if (HAS_deviations) {
        const float16 off = luminance16(k) * loadBlock(PLANE_deviations, i);
        addShorts(deviation, p.planeSize, i, has ? off : (float16)(0.0f));
    }
}
#endif

/// The samples of fractions (path_sampling.h) as they are, which know nothing of what would be seen if nothing were
/// hidden: so the fallback sees what that is off by.
/// in      specular: 3 planes; sums; parts: of the first part; taken
/// in out  noisy (3 planes), deviation (as of lights)
#include "pass/addLobeSamples.h"
#ifdef PASS_addLobeSamples
__kernel void addLobeSamples(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint16 count = loadIdBlock(taken, i);
    const int16 has = count != 0u;
    const float16 per = 1.0f / max16(convert_float16(count), (float16)(1.0f));
    Vec3x16 k = loadVecBlock(specular, p.planeSize, i);
    const Vec3x16 part = LOAD16_parts(p.planeSize, i);
    const float16 mean = per * luminance16(loadVecBlock(sums, p.planeSize, i));
    const float16 off = luminance16(k) * deviation16(mean, part.x, count, firstPass);
    addShorts(deviation, p.planeSize, i, has ? off : (float16)(0.0f));
    k.x *= per;
    k.y *= per;
    k.z *= per;
    addTerm(p, WEDGE_COMPONENT_ENVIRONMENT_GLOSSY, k, has, sums, i, noisy);
}
#endif

/// One term of indirect light, filtered.
/// in      value: 3 planes, and, where they vary, the variance of a pixel's samples; taken
/// in out  indirect (3 planes), variance (in the luminance that is shown, in 16 bits)
#include "pass/addIndirect.h"
#ifdef PASS_addIndirect
__kernel void addIndirect(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 has = loadIdBlock(taken, i) != 0u;
    const Vec3x16 k = reflectanceOf(p, component, reflectance, i);
    addTerm(p, component, k, has, value, i, indirect);
    if (varies != 0u) {
        const float16 l = luminance16(k), gathered = l * l * loadBlock(value + 3u * p.planeSize, i);
        addShorts(variance, p.planeSize, i, has ? gathered : (float16)(0.0f));
    }
}
#endif

/// What arrives of a term, as an image. Pixels without the term have no number there, which filters of images leave
/// out.
///
/// in   value: 3 planes; taken
/// out  arrives: 3 planes
#include "pass/arrivingAtPixels.h"
#ifdef PASS_arrivingAtPixels
__kernel void arrivingAtPixels(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 has = loadIdBlock(taken, i) != 0u;
    for (uint plane = 0u; plane < 3u; ++plane) {
        const int j = i + (int)(plane * p.planeSize);
        const float16 v = loadBlock(value, j);
        vstore16(numberIf16(has, component == WEDGE_COMPONENT_AMBIENT ? 1.0f - v : v), 0, arrives + j);
    }
}
#endif

/// What filters change of what arrives of a term, reflected, added to the change of all.
/// in      before, after: 3 planes; taken
/// in out  change: 3 planes
#include "pass/addTermChange.h"
#ifdef PASS_addTermChange
__kernel void addTermChange(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 has = loadIdBlock(taken, i) != 0u;
    const float16 zero = (float16)(0.0f);
    const Vec3x16 off = sub16(loadVecBlock(after, p.planeSize, i), loadVecBlock(before, p.planeSize, i));
    Vec3x16 more = mul16(reflectanceOf(p, component, reflectance, i), off);
    more.x = has ? more.x : zero;
    more.y = has ? more.y : zero;
    more.z = has ? more.z : zero;
    addBlock(change, p.planeSize, i, (float16)(1.0f), more);
}
#endif

/// Adds what a surface reflects, `light`, to what is there without, `below` (3 planes each). Where there are shares, of
/// ownShares(), light falls back to `noisy`; `change` is what filters of terms change of it. The outcome is kept in
/// `reflected` where somebody asks for it.
#include "pass/addReflected.h"
#ifdef PASS_addReflected
__kernel void addReflected(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const int16 surface = loadIdBlock(objectId, i) != 0u;
#if HAS_shares
    const float16 own = loadBlock(shares, i), ratio = loadBlock(shares + p.planeSize, i);
#endif
    for (uint plane = 0u; plane < 3u; ++plane) {
        const int j = i + (int)(plane * p.planeSize);
        float16 shown = loadBlock(light, j);
#if HAS_shares
        shown = fallenBack16(shown, loadBlock(noisy, j), own, ratio);
#endif
#if HAS_change
        shown = max16(shown + loadBlock(change, j), (float16)(0.0f));
#endif
#if HAS_reflected
        vstore16(shown, 0, reflected + j);
#endif
        vstore16(loadBlock(below, j) + (surface ? shown : (float16)(0.0f)), 0, sum + j);
    }
}
#endif
