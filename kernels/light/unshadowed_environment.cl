// Reflectance times what would light a surface from beyond the scene if nothing hid it. Of the diffuse term of an
// environment that is what the image is lit by but for what is hidden: samples are divided by it, filters share what
// remains, which depends little on where a surface faces, and the composite multiplies by it again.
#include "core/pixel.h"
#include "light/unshadowed_environment.h"
#include "shared/filter_params.h"
#include "shared/frame.h"
#include "shared/wave.h"

WEDGE_INLINE void storeUnshadowed(uint size, int i, WEDGE_BEYOND_PARAMETERS, __global const float* restrict normal,
    __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const Vec3x16 light = unshadowedLight(environment, environmentTable, loadVecBlock(normal, size, i));
    const Vec3x16 k = mul16(loadVecBlock(diffuse, size, i), light);
    vstore16(k.x, 0, unshadowed + i);
    vstore16(k.y, 0, unshadowed + size + i);
    vstore16(k.z, 0, unshadowed + 2u * size + i);
}

/// in   normal, diffuse: 3 planes each, of pixels
/// out  unshadowed: 3 planes
__kernel void environmentOfPixels(AnalysisParams p, WEDGE_BEYOND_PARAMETERS, __global const float* restrict normal,
    __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        storeUnshadowed(
            p.planeSize, (int)pixelIndex(x, y, p.stride), environment, environmentTable, normal, diffuse, unshadowed);
    }
}

#ifdef WEDGE_SPECULAR
/// The same of what lobes reflect, of whose samples fractions are made.
/// in   rings: of unshadowedLobe(); position, normal, specular: 3 planes each; gloss
/// out  unshadowed: 3 planes; whole: its luminance over that of specular
__kernel void lobesOfPixels(AnalysisParams p, FrameParams frame, uint rings, WEDGE_BEYOND_PARAMETERS,
    __global const float* restrict position, __global const float* restrict normal, __global const uint* restrict gloss,
    __global const float* restrict specular, __global float* restrict unshadowed, __global float* restrict whole)
{
    const uint x = p.x0 + get_global_id(0);
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint i = pixelIndex(x, y, p.stride);
    const Vec3 reflectance = loadVec(specular, p.planeSize, i);
    Vec3 light = vec3(0.0f, 0.0f, 0.0f);
    if (luminance(reflectance) > 0.0f) {
        const Vec3 n = loadVec(normal, p.planeSize, i);
        const Vec3 v = vecNormalize(vecSub(frame.eye, loadVec(position, p.planeSize, i)));
        light = unshadowedLobe(environment[0], environmentTable, n, v, unpackGloss(gloss[i]), rings);
    }
    storeVec(unshadowed, p.planeSize, i, vecMul(light, reflectance));
    whole[i] = luminance(light);
}

/// What unshadowedLobe() is to be multiplied by: samples know what is seen if nothing hides it, too, and in the mean.
/// whole, samples: luminances of both
WEDGE_FN float correctionOf(AnalysisParams p, uint x, uint y, __global const float* samples, __global const uint* taken,
    __global const uint* objectId, __global const float* whole)
{
    const uint i = pixelIndex(x, y, p.stride);
    float a = 0.0f, b = 0.0f, aa = 0.0f, ab = 0.0f, bb = 0.0f, count = 0.0f;
    const int reach = WEDGE_LOBE_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -min((int)x, reach); dx <= min((int)(p.width - 1u - x), reach); ++dx) {
            const uint j = (uint)((int)i + dy * (int)p.stride + dx);
            const bool known = objectId[j] == objectId[i] && taken[j] > 0u;
            const float mean = known ? samples[j] / (float)taken[j] : 0.0f, expected = known ? whole[j] : 0.0f;
            a += mean;
            b += expected;
            aa += mean * mean;
            ab += mean * expected;
            bb += expected * expected;
            count += known ? 1.0f : 0.0f;
        }
    }
    if (count < 2.0f || !(b > 0.0f) || !(whole[i] > 0.0f)) {
        return 1.0f;
    }
    // By what the pixels around are off together, as far as that is more than three deviations of noise, of a - ratio
    // b, and by what the pixel alone is, as far as its samples know it better than directions do.
    const float ratio = a / b, off = ratio - 1.0f;
    const float squares = fmax(aa - 2.0f * ratio * ab + ratio * ratio * bb, 0.0f);
    const float common = off * fmax(0.0f, 1.0f - 9.0f * squares / fmax(b * b * off * off, 1e-20f));
    const float own = samples[i] / ((float)taken[i] * whole[i]) - 1.0f;
    const float error = WEDGE_LOBE_ERROR * whole[i], known = error * error;
    return fmax(1.0f + common + (own - common) * known / (known + squares / (count - 1.0f)), 0.0f);
}

/// Corrects what lobes would see by samples: how bright it is, and, the more there are, the colour, which is that of
/// all of it and not of what is seen. in      specular: 3 planes; sums: of fractions (path_sampling.h); taken: samples;
/// whole: of lobesOfPixels() in out  unshadowed
__kernel void correctLobes(AnalysisParams p, __global const float* restrict specular,
    __global const float* restrict sums, __global const uint* restrict taken, __global const uint* restrict objectId,
    __global const float* restrict whole, __global float* restrict unshadowed)
{
    const uint x = p.x0 + get_global_id(0);
    const uint y = p.y0 + get_global_id(1);
    const uint i = pixelIndex(x, y, p.stride);
    if (x >= p.x1 || y >= p.y1 || taken[i] == 0u || !(whole[i] > 0.0f)) {
        return;
    }
    const float factor = correctionOf(p, x, y, sums + 3u * p.planeSize, taken, objectId, whole);
    const Vec3 seen = loadVec(sums, p.planeSize, i), light = loadVec(unshadowed, p.planeSize, i);
    const float brightness = luminance(seen);
    Vec3 corrected = light;
    if (brightness > 0.0f) {
        const Vec3 coloured = vecMul(vecScale(seen, whole[i] / brightness), loadVec(specular, p.planeSize, i));
        // Of what is hidden, 1 - V, colours are taken to be off by that much, and those of n V samples by their root.
        const float fraction = fmin(brightness / fmax(sums[3u * p.planeSize + i], 1e-30f), 1.0f);
        const float bias = (1.0f - fraction) * (1.0f - fraction);
        const float share = bias / (bias + 1.0f / fmax((float)taken[i] * fraction, 1e-6f));
        corrected = vecMad(vecScale(light, 1.0f - share), coloured, share);
    }
    storeVec(unshadowed, p.planeSize, i, vecScale(corrected, factor));
}
#endif

/// The same of a wave's receivers.
__kernel void environmentOfReceivers(FrameParams frame, WaveParams wave, WEDGE_BEYOND_PARAMETERS,
    __global const float* restrict normal, __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const uint first = get_global_id(0) * WEDGE_BLOCK_PIXELS;
    if (frame.tileCount > 0u && first < wave.receivers) {
        storeUnshadowed(wave.planeSize, (int)first, environment, environmentTable, normal, diffuse, unshadowed);
    }
}
