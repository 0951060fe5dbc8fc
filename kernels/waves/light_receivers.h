// What a pixel's new receivers add to what it keeps of one area light (accumulate.cl).
#ifndef WEDGE_LIGHT_RECEIVERS_H
#define WEDGE_LIGHT_RECEIVERS_H

#include "light/light_sample.h"
#include "waves/accumulate.h"

/// Of a receiver as published. visible: of its samples, the fraction that sees the light.
WEDGE_FN ReceiverTerm publishedReceiver(
    FrameParams frame, ReceiverData data, AreaLight light, uint r, Vec3 kd, Vec3 ks, float visible)
{
    const Receiver at = loadReceiver(frame, data, r);
    const Vec3 d = vecSub(light.centre, at.position);
    const Vec3 lobe = vecScale(ks, lobeValue(at.lobe, at.normal, at.view, vecNormalize(d)));
    ReceiverTerm t;
    t.texture = vecMul(vecMad(lobe, kd, WEDGE_INV_PI), light.power);
    t.irradiance = visible * geometryTerm(at.normal, d, light.normal, light.twoSided);
    t.radiance = vecScale(t.texture, t.irradiance);
    t.weighted = vec3(t.irradiance, t.irradiance, t.irradiance);
    t.weights = vec3(1.0f, 1.0f, 1.0f);
    return t;
}

/// Mean unshadowed weights of a light's samples, diffuse and specular, over the receivers that took some, each as much
/// as it reflects: what textures of the others are made with. Negative if none of them is known.
WEDGE_FN float2 meanWeights(WavePixel p, uint total, uint size, __global const uint* objectId,
    __global const float* diffuse, __global const float* specular, __global const float* sums)
{
    float reflected = 0.0f, mirrored = 0.0f, known = 0.0f;
    float2 weights = (float2)(0.0f);
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k, n = samplesOfReceiver(p, k, total);
        if (objectId[r] == 0u || n == 0u) {
            continue;
        }
        const float scale = 1.0f / (float)n, kd = luminance(loadVec(diffuse, size, r));
        known += 1.0f;
        reflected += kd;
        weights.x += kd * scale * sums[r];
#ifdef WEDGE_SPECULAR
        const float ks = luminance(loadVec(specular, size, r));
        mirrored += ks;
        weights.y += ks * scale * sums[2u * size + r];
#else
        (void)specular;
#endif
    }
    weights.x = reflected > 0.0f ? weights.x / reflected : 0.0f;
    weights.y = mirrored > 0.0f ? weights.y / mirrored : 0.0f;
    return known > 0.0f ? weights : (float2)(-1.0f);
}

/// The unshadowed weights of a receiver without samples of its own: where they are not known, those of others. Returns
/// false if these are not known, either.
WEDGE_FN bool completeShading(float2* shading, float2 others)
{
    shading->x = shading->x >= 0.0f ? shading->x : others.x;
    shading->y = shading->y >= 0.0f ? shading->y : others.y;
#ifdef WEDGE_SPECULAR
    return shading->x >= 0.0f && shading->y >= 0.0f;
#else
    return shading->x >= 0.0f;
#endif
}

/// Of a receiver that took n samples of a light, whose sums are given. shading: its unshadowed weights; negative: they
/// are those of its samples, and of no use without.
WEDGE_FN ReceiverTerm sampledReceiver(
    AreaLight light, uint r, Vec3 kd, Vec3 ks, uint n, __global const float* sums, uint size, float2 shading)
{
    const float scale = n > 0u ? 1.0f / (float)n : 0.0f;
    Vec3 sampled = vecScale(kd, WEDGE_INV_PI * scale * sums[r]);
    ReceiverTerm t;
    t.texture = shading.x >= 0.0f ? vecScale(kd, WEDGE_INV_PI * shading.x) : sampled;
    t.radiance = vecScale(kd, WEDGE_INV_PI * scale * sums[size + r]);
#ifdef WEDGE_SPECULAR
    const float mirrored = scale * sums[2u * size + r];
    t.texture = vecMad(t.texture, ks, shading.y >= 0.0f ? shading.y : mirrored);
    sampled = vecMad(sampled, ks, mirrored);
    t.radiance = vecMad(t.radiance, ks, scale * sums[3u * size + r]);
#else
    (void)ks;
#endif
    t.texture = vecMul(t.texture, light.power);
    t.radiance = vecMul(t.radiance, light.power);
    sampled = vecMul(sampled, light.power);
    t.irradiance = luminance(sampled) > 0.0f ? luminance(t.radiance) / luminance(sampled) : 0.0f;
    t.weighted = vecScale(t.radiance, (float)n);
    t.weights = vecScale(sampled, (float)n);
    return t;
}

/// Least and largest slope, `known` before; the least is 0 where there is none.
WEDGE_FN float2 slopesWith(
    float2 known, WavePixel p, uint total, __global const uint* objectId, __global const float* slopes, uint size)
{
    float least = known.x > 0.0f ? known.x : INFINITY, largest = known.y;
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        if (objectId[r] != 0u && samplesOfReceiver(p, k, total) > 0u) {
            least = slopes[r] > 0.0f ? fmin(least, slopes[r]) : least;
            largest = fmax(largest, slopes[size + r]);
        }
    }
    return (float2)(least < INFINITY ? least : 0.0f, largest);
}

/// Sums of shadows' motions x, y, their squared lengths and ones (shadow_motions.h), of the planes that hold these.
WEDGE_FN float4 shadowSumsOf(
    WavePixel p, uint total, __global const uint* objectId, __global const float* motions, uint size)
{
    float4 sums = (float4)(0.0f);
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        if (objectId[r] != 0u && samplesOfReceiver(p, k, total) > 0u) {
            sums += (float4)(motions[r], motions[size + r], motions[2u * size + r], motions[3u * size + r]);
        }
    }
    return sums;
}

/// The mean motion of shadows as lean frames keep it.
WEDGE_FN float2 meanShadowMotion(WaveParams wave, float4 sums)
{
    const float count = fmax(sums.w, 1.0f), x = sums.x / count, y = sums.y / count;
    return oneMotion(wave, x, y, sqrt(fmax(sums.z / count - x * x - y * y, 0.0f)));
}

#endif
