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
#include "pass/environmentOfPixels.h"
#ifdef PASS_environmentOfPixels
__kernel void environmentOfPixels(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    storeUnshadowed(
        p.planeSize, (int)pixelIndex(x, y, p.stride), environment, environmentTable, normal, diffuse, unshadowed);
}
#endif

#ifdef WEDGE_SPECULAR
/// The same of what lobes reflect, of whose samples fractions are made.
/// in   rings: of unshadowedLobe(); position, normal, specular: 3 planes each; gloss
/// out  unshadowed: 3 planes; whole: the luminance of what it multiplies specular by
#include "pass/lobesOfPixels.h"
#ifdef PASS_lobesOfPixels
__kernel void lobesOfPixels(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 reflectance = loadVec(specular, p.planeSize, i);
    Vec3 light = vec3(0.0f, 0.0f, 0.0f);
    bool reflects = luminance(reflectance) > 0.0f;
#ifdef WEDGE_MIRRORS
    reflects &= !WEDGE_IS_MIRROR(gloss[i]);
#endif
    if (reflects) {
        const Vec3 n = loadVec(normal, p.planeSize, i);
        const Vec3 v = vecNormalize(vecSub(frame.eye, loadVec(position, p.planeSize, i)));
        light = unshadowedLobe(environment[0], environmentTable, n, v, unpackGloss(gloss[i]), rings, 0.0f);
    }
    storeVec(unshadowed, p.planeSize, i, vecMul(light, reflectance));
    whole[i] = luminance(light);
}
#endif

/// What unshadowedLobe() is to be multiplied by: samples know what is seen if nothing hides it, too, and in the mean.
/// whole, samples: luminances of both; whole[i]: above 0
WEDGE_FN float correctionOf(AnalysisParams p, uint x, uint y, __global const float* samples, __global const uint* taken,
    __global const uint* objectId, __global const float* whole)
{
    const uint i = pixelIndex(x, y, p.stride);
    // Over the pixel's own, so that nothing depends on how bright maps are.
    const float scale = 1.0f / whole[i];
    float found = 0.0f, expected = 0.0f, ofFound = 0.0f, ofBoth = 0.0f, ofExpected = 0.0f, count = 0.0f;
    const int reach = WEDGE_LOBE_REACH;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -min((int)x, reach); dx <= min((int)(p.width - 1u - x), reach); ++dx) {
            const uint j = (uint)((int)i + dy * (int)p.stride + dx);
            const bool counts = objectId[j] == objectId[i] && taken[j] > 0u;
            const float a = counts ? scale * samples[j] / (float)taken[j] : 0.0f, b = counts ? scale * whole[j] : 0.0f;
            found += a;
            expected += b;
            ofFound += a * a;
            ofBoth += a * b;
            ofExpected += b * b;
            count += counts ? 1.0f : 0.0f;
        }
    }
    if (count < 2.0f || !(expected > 0.0f) || !(found < INFINITY)) {
        return 1.0f;
    }
    // By what the pixels around are off together, as far as that is more than three deviations of the noise, of which
    // found - ratio expected is, and by what the pixel alone is, as far as its samples know it better.
    const float ratio = found / expected, off = ratio - 1.0f;
    const float squares = fmax(ofFound - 2.0f * ratio * ofBoth + ratio * ratio * ofExpected, 0.0f);
    const float common = off * fmax(0.0f, 1.0f - 9.0f * squares / fmax(expected * expected * off * off, 1e-20f));
    const float own = scale * samples[i] / (float)taken[i] - 1.0f, error = WEDGE_LOBE_ERROR * WEDGE_LOBE_ERROR;
    return fmax(1.0f + common + (own - common) * error / (error + squares / (count - 1.0f)), 0.0f);
}

/// Corrects what lobes would see by samples: how bright it is, and the colour, which is that of all of it and not of
/// what is seen, the more of it is hidden and the more samples there are.
///
/// in      specular: 3 planes; sums: of fractions (path_sampling.h); taken: samples; whole: of lobesOfPixels()
/// in out  unshadowed
#include "pass/correctLobes.h"
#ifdef PASS_correctLobes
__kernel void correctLobes(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float n = (float)taken[i], all = sums[3u * p.planeSize + i];
    if (taken[i] == 0u || !(all > 0.0f)) {
        return;
    }
    const Vec3 seen = loadVec(sums, p.planeSize, i), reflectance = loadVec(specular, p.planeSize, i);
    const float brightness = luminance(seen), perBrightness = brightness > 0.0f ? 1.0f / brightness : 0.0f;
    const Vec3 coloured = vecMul(vecScale(seen, perBrightness), reflectance);
    if (!(whole[i] > 0.0f)) { // all directions looked at black, and samples found something
        storeVec(unshadowed, p.planeSize, i, vecScale(coloured, all / n));
        return;
    }
    Vec3 light = loadVec(unshadowed, p.planeSize, i);
    if (brightness > 0.0f) {
        // Of what is hidden, 1 - V, colours are taken to be off by that much, and those of n V samples by their root.
        const float fraction = fmin(brightness / all, 1.0f), bias = (1.0f - fraction) * (1.0f - fraction);
        const float share = bias / (bias + 1.0f / fmax(n * fraction, 1e-6f));
        light = vecMad(vecScale(light, 1.0f - share), coloured, share * whole[i]);
    }
    const float factor = correctionOf(p, x, y, sums + 3u * p.planeSize, taken, objectId, whole);
    storeVec(unshadowed, p.planeSize, i, vecScale(light, factor));
}
#endif
#endif

/// The same of a wave's receivers.
#include "pass/environmentOfReceivers.h"
#ifdef PASS_environmentOfReceivers
__kernel void environmentOfReceivers(PARAMETERS)
{
    const uint first = get_global_id(0) * WEDGE_BLOCK_PIXELS;
    if (frame.tileCount > 0u && first < wave.receivers) {
        storeUnshadowed(wave.planeSize, (int)first, environment, environmentTable, normal, diffuse, unshadowed);
    }
}
#endif
