// From filtered terms to radiance: each light's value times its unshadowed shading and the surface's reflectance,
// added up over lights, then with what surfaces and background emit.
#include "light_sample.h"
#include "shared/filter_params.h"
#include "shared/path.h"
#include "unshadowed.h"

/// The same mean of lobe times geometry term, one receiver.
WEDGE_FN float unshadowedSpecular(AreaLight light, Receiver r, __global const float* nodes, uint count)
{
    float sum = 0.0f;
    for (uint a = 0u; a < count; ++a) {
        for (uint b = 0u; b < count; ++b) {
            const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, nodes[2u * a], nodes[2u * b]);
            const Vec3 d = vecSub(point, r.position);
            const float g = geometryTerm(r.normal, d, light.normal, light.twoSided);
            if (g > 0.0f) {
                sum += nodes[2u * a + 1u] * nodes[2u * b + 1u] * specularWeight(r, d, g);
            }
        }
    }
    return sum;
}

/// Adds light's value times `shading` (already times the reflectance) to planes of radiance.
WEDGE_FN void addBlock(__global float* planes, uint size, int i, float16 value, Vec3x16 shading)
{
    vstore16(loadBlock(planes, i) + value * shading.x, 0, planes + i);
    vstore16(loadBlock(planes + size, i) + value * shading.y, 0, planes + size + i);
    vstore16(loadBlock(planes + 2u * size, i) + value * shading.z, 0, planes + 2u * size + i);
}

/// One light's diffuse reflection.
/// in      value: filtered; noisy: not filtered; nodes: the coarse quadrature's (coordinate, weight) pairs, then the
///         fine one's
///         taken: the samples of value
/// in out  direct, directNoisy (3 planes each), samples (of all lights)
__kernel void addDiffuse(AnalysisParams p, SampleParams params, AreaLight light,
                       __global const float* restrict nodes, __global const float* restrict position,
                       __global const float* restrict normal, __global const uint* restrict objectId,
                       __global const float* restrict diffuse, __global const float* restrict value,
                       __global const float* restrict noisy, __global const uint* restrict taken,
                       __global float* restrict direct, __global float* restrict directNoisy,
                       __global uint* restrict samples)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint size = p.planeSize;
    const int i = (int)pixelIndex(x, y, p.stride);
    const int16 surface = loadIdBlock(objectId, i) != 0u;
    if (!any(surface)) {
        return;
    }
    vstore16(loadIdBlock(samples, i) + loadIdBlock(taken, i), 0, samples + i);
    const Vec3x16 at = loadVecBlock(position, size, i);
    const Vec3x16 facing = loadVecBlock(normal, size, i);
    float16 shading = (float16)(1.0f);
    if (params.shading == WEDGE_SHADING_SEPARATE) {
        shading = geometryTerm16(facing, sub16(splat3(light.centre), at), light.normal, light.twoSided);
    } else if (params.shading == WEDGE_SHADING_RATIO) {
        shading = unshadowedWhere(light, at, facing, nodes, surface);
    }
    shading = surface ? shading * WEDGE_INV_PI : (float16)(0.0f);
    const Vec3x16 kd = loadVecBlock(diffuse, size, i);
    Vec3x16 reflected;
    reflected.x = shading * kd.x * light.power.x;
    reflected.y = shading * kd.y * light.power.y;
    reflected.z = shading * kd.z * light.power.z;
    addBlock(direct, size, i, loadBlock(value, i), reflected);
    addBlock(directNoisy, size, i, loadBlock(noisy, i), reflected);
}

/// One receiver's unshadowed specular shading in the way of the term.
/// sampled: the mean weight of the samples taken, which is what such a lobe falls back on.
WEDGE_FN float specularShading(SampleParams params, AreaLight light, Receiver r, __global const float* nodes, float sampled)
{
    if (params.shading == WEDGE_SHADING_INSIDE) {
        return 1.0f;
    }
    if (params.shading == WEDGE_SHADING_RATIO) {
        const Vec3 toLight = vecSub(light.centre, r.position);
        const float lobes = lobesAcross(light, toLight, r.view, r.lobe.exponent, r.lobe.model == WEDGE_SPECULAR_PHONG);
        if (lobes > WEDGE_SHARP_LOBE) {
            return sampled;
        }
        return lobes < WEDGE_COARSE_LOBE ? unshadowedSpecular(light, r, nodes, WEDGE_COARSE_NODES)
                    : unshadowedSpecular(light, r, nodes + WEDGE_FINE_OFFSET, WEDGE_FINE_NODES);
    }
    const Vec3 d = vecSub(light.centre, r.position);
    const float g = geometryTerm(r.normal, d, light.normal, light.twoSided);
    return g > 0.0f ? specularWeight(r, d, g) : 0.0f;
}

/// One light's specular reflection; value and noisy hold the specular term in their second plane,
/// sums its weights in the third.
__kernel void addSpecular(AnalysisParams p, SampleParams params, AreaLight light, FrameParams frame,
                          __global const float* restrict nodes, __global const float* restrict position,
                          __global const float* restrict normal, __global const uint* restrict objectId,
                          __global const float* restrict gloss, __global const float* restrict specular,
                          __global const float* restrict value, __global const float* restrict noisy,
                          __global const float* restrict sums, __global const uint* restrict taken,
                          __global float* restrict direct, __global float* restrict directNoisy)
{
    const uint x = p.x0 + get_global_id(0);
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint size = p.planeSize;
    const uint i = pixelIndex(x, y, p.stride);
    const Vec3 ks = loadVec(specular, size, i);
    if (objectId[i] == 0u || !(ks.x + ks.y + ks.z > 0.0f)) {
        return;
    }
    Receiver r;
    r.position = loadVec(position, size, i);
    r.normal = loadVec(normal, size, i);
    r.view = vecNormalize(vecSub(frame.eye, r.position));
    r.lobe = glossLobe(gloss[i]);
    const float sampled = taken[i] > 0u ? sums[2u * size + i] / (float)taken[i] : 0.0f;
    const Vec3 reflected = vecScale(vecMul(ks, light.power), specularShading(params, light, r, nodes, sampled));
    storeVec(direct, size, i, vecMad(loadVec(direct, size, i), reflected, value[size + i]));
    storeVec(directNoisy, size, i, vecMad(loadVec(directNoisy, size, i), reflected, noisy[size + i]));
}

/// One term of indirect light.
/// in      reflectance: 3 planes; value, noisy: 3 planes each, filtered and not; taken: the samples of value
///         component: WEDGE_COMPONENT_*; of ambient occlusion the open part of the hemisphere is shown, on white
/// in out  indirect, indirectNoisy (3 planes each), samples (of all terms), indirectSamples
__kernel void addIndirect(AnalysisParams p, uint component, __global const float* restrict reflectance,
                          __global const float* restrict value, __global const float* restrict noisy,
                          __global const uint* restrict taken, __global float* restrict indirect,
                          __global float* restrict indirectNoisy, __global uint* restrict samples,
                          __global uint* restrict indirectSamples)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const uint16 count = loadIdBlock(taken, i);
    const int16 has = count != 0u;
    vstore16(loadIdBlock(samples, i) + count, 0, samples + i);
    vstore16(loadIdBlock(indirectSamples, i) + count, 0, indirectSamples + i);
    const bool ambient = component == WEDGE_COMPONENT_AMBIENT;
    for (uint plane = 0u; plane < 3u; ++plane) {
        const int j = i + (int)(plane * p.planeSize);
        const float16 filtered = loadBlock(value, j);
        const float16 unfiltered = loadBlock(noisy, j);
        const float16 k = ambient ? (float16)(1.0f) : loadBlock(reflectance, j);
        const float16 shown = has ? k * (ambient ? 1.0f - filtered : filtered) : (float16)(0.0f);
        const float16 shownNoisy = has ? k * (ambient ? 1.0f - unfiltered : unfiltered) : (float16)(0.0f);
        vstore16(loadBlock(indirect, j) + shown, 0, indirect + j);
        vstore16(loadBlock(indirectNoisy, j) + shownNoisy, 0, indirectNoisy + j);
    }
}

/// beauty = emission + direct + indirect, at misses emission alone (3 planes each).
__kernel void addEmission(AnalysisParams p, __global const float* restrict emission, __global const float* restrict direct,
                          __global const float* restrict indirect, __global const uint* restrict objectId,
                          __global float* restrict beauty)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    const int16 surface = loadIdBlock(objectId, i) != 0u;
    for (uint plane = 0u; plane < 3u; ++plane) {
        const int j = i + (int)(plane * p.planeSize);
        const float16 reflected = surface ? loadBlock(direct, j) + loadBlock(indirect, j) : (float16)(0.0f);
        vstore16(loadBlock(emission, j) + reflected, 0, beauty + j);
    }
}
