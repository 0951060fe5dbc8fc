// From a wave's receivers to its pixels. Planes of pixels hold means over the primary samples taken so far; each kernel
// here adds a pixel's new receivers, which lie together in the wave. Samples that hit nothing count as black in
// radiance and in textures, and not at all in irradiances, positions and normals. What a pixel keeps of a term:
// accumulate.h; what receivers add to it: light_receivers.h; and to surfaces: surface_sums.h.
#include "shared/indirect.h"
#include "sinks/sample_bins.h"
#include "waves/accumulate.h"
#include "waves/light_receivers.h"
#include "waves/surface_sums.h"

/// One area light.
/// in      wave's planes: receivers, diffuse, specular, sums (see light_sampling.h), slopes
///         unshadowed: the receivers' shading (wave_light.cl); absent: it is that of their samples
///         hits: the pixels' primary samples with a surface, before the wave
///         wanted: the pixels' samples of the light after the wave
/// in out  of pixels: term (TermMeans): texture, value (visibility), plain (its luminance, unweighted), squares and
///         textureSquares (mean squared luminance of a primary sample's radiance, and of its texture), radiance (as
///         published), deviation, error, spreads; extremes: slopes; shadowSums: of shadows' motions x, y, their squared
///         lengths and ones; of lean frames extreme: the least slope, shadowMotion: the mean of all that moves alike;
///         samples (of all terms); termTaken: samples of the light, where they are not the primary ones
#include "pass/accumulateLight.h"
#ifdef PASS_accumulateLight
__kernel void accumulateLight(PARAMETERS)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    FrameParams receivers = frame;
    receivers.planeSize = wave.planeSize;
    receivers.receivers = wave.receivers;
    const uint size = wave.planeSize, pixels = frame.planeSize;
    const uint before = HAS_termTaken ? LOAD_termTaken(pixels, p.i) : taken[p.i];
    const uint total = newTermSamples(wave, before, LOAD_wanted(pixels, p.i));
    const bool published = wave.published != 0u;
    const float2 others = total < p.count && !published ? meanWeights(p, total, size, objectId, diffuse, specular, sums)
                                                        : (float2)(-1.0f);
    bool textured = true;
    TermSums sum = noTermSums((float)p.count);
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k, n = samplesOfReceiver(p, k, total);
        if (objectId[r] == 0u) {
            continue;
        }
        const Vec3 kd = loadVec(diffuse, size, r), ks = loadVec(specular, size, r);
        if (published) {
            const float visible = n > 0u ? sums[size + r] * (1.0f / (float)n) : 0.0f;
            addReceiver(&sum, p, k, total, publishedReceiver(receivers, data, light, r, kd, ks, visible));
            continue;
        }
        float2 shading = HAS_unshadowed ? LOAD_unshadowed(size, r) : (float2)(-1.0f);
        textured = (n > 0u || completeShading(&shading, others)) && textured;
        ReceiverTerm t = sampledReceiver(light, r, kd, ks, n, sums, size, shading);
        // What the samples see, of shading without noise.
        t.radiance = HAS_unshadowed ? vecScale(t.texture, t.irradiance) : t.radiance;
        addReceiver(&sum, p, k, total, t);
    }
    if (!textured) {
        dropTexture(&sum);
    }
    const float hit = (float)LOAD_hits(pixels, p.i);
    TermMeans means;
    LOAD_term(pixels, p.i, &means);
#if HAS_term_spreads
    recallSquares(&means);
#endif
    const Vec3 weights = published ? vec3(hit, hit, hit) : vecScale(means.texture, (float)before);
    addTermSums(&means, p, before, total, hit, weights, &sum);
    STORE_term(pixels, p.i, &means);
    const float2 known = LOAD_extremes(pixels, p.i);
    const float least = HAS_extreme ? LOAD_extreme(pixels, p.i) : known.x;
    const float2 range = slopesWith((float2)(least, known.y), p, total, objectId, slopes, size);
    STORE_extremes(pixels, p.i, range);
    STORE_extreme(pixels, p.i, range.x);
#if HAS_shadowSums
    const float4 motions = shadowSumsOf(p, total, objectId, slopes + 2u * size, size);
    shadowSums[p.i] += motions.x;
    shadowSums[pixels + p.i] += motions.y;
    shadowSums[2u * pixels + p.i] += motions.z;
    shadowSums[3u * pixels + p.i] += motions.w;
#endif
#if HAS_shadowMotion
    STORE_shadowMotion(pixels, p.i, meanShadowMotion(wave, shadowSumsOf(p, total, objectId, slopes + 2u * size, size)));
#endif
    STORE_samples(pixels, p.i, LOAD_samples(pixels, p.i) + total);
    STORE_termTaken(pixels, p.i, before + total);
}
#endif

/// Point and directional lights: `lit`, the receivers' radiance from them. deltaSquares: mean squared luminance of a
/// primary sample's.
#include "pass/accumulateDelta.h"
#ifdef PASS_accumulateDelta
__kernel void accumulateDelta(PARAMETERS)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    RadianceSums sums = noRadiance();
    for (uint r = p.first; r < p.first + p.count; ++r) {
        addRadiance(&sums, objectId[r] != 0u ? loadVec(lit, wave.planeSize, r) : vec3(0.0f, 0.0f, 0.0f));
    }
    const uint pixels = frame.planeSize;
    const float before = (float)p.before, count = (float)p.count;
    STORE_delta(pixels, p.i, meanVec(LOAD_delta(pixels, p.i), before, sums.radiance, count));
    deltaSquares[p.i] = meanWith(deltaSquares[p.i], before, sums.squared, count);
}
#endif

/// One component of indirect light.
/// in      ambient: 1 for ambient occlusion: the irradiance is what is open of the hemisphere, the texture white
///         wave's planes: objectId, reflectance (3), sums (path_sampling.h), reflectors (distances.h); hits, as
///         of a light; exposure: what bins of samples are of
/// in out  as of a light; extremes: reflectors of pixels, like those of receivers; indirectSamples; bins: samples by
///         their brightness (sinks/sample_bins.h): all of a receiver count as one; notFinite: samples in no bin, all of
///         a receiver
#include "pass/accumulatePaths.h"
#ifdef PASS_accumulatePaths
__kernel void accumulatePaths(PARAMETERS)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const uint size = wave.planeSize, pixels = frame.planeSize;
    const uint had = HAS_termTaken ? LOAD_termTaken(pixels, p.i) : taken[p.i];
    const uint total = newTermSamples(wave, had, LOAD_wanted(pixels, p.i));
    const Vec3 known = LOAD_extremes(pixels, p.i);
    float nearest = known.x > 0.0f ? known.x : INFINITY, farthest = known.y, inverse = known.z;
    const float floor = wave.published != 0u ? 1.0f : WEDGE_LEAST_TEXTURE, own = wave.published != 0u ? 0.0f : 1.0f;
    const Vec3 floors = vec3(floor, floor, floor), white = vec3(1.0f, 1.0f, 1.0f);
    TermSums sum = noTermSums((float)p.count);
#if HAS_bins
    OpenBins open;
    open.touched = 0u;
    uint lost = 0u;
#endif
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k, n = samplesOfReceiver(p, k, total);
        if (objectId[r] == 0u) {
            continue;
        }
        const Vec3 mean = vecScale(loadVec(sums, size, r), n > 0u ? 1.0f / (float)n : 0.0f);
        const Vec3 e = ambient != 0u ? vecSub(white, mean) : mean;
        ReceiverTerm t;
        t.texture = ambient != 0u ? white : loadVec(reflectance, size, r);
        t.weights = vecScale(vecMad(floors, t.texture, own), wave.published != 0u ? 1.0f : (float)n);
#if HAS_bins
        if (!finiteVec(e)) {
            addTexture(&sum, t.texture); // and nothing else: what is no number is left out
            lost += n;
            continue;
        }
        if (n > 0u) {
            binSample(bins, pixels, p.i, exposure, e, luminance(t.weights), &open);
        }
#endif
        t.radiance = vecMul(t.texture, e);
        t.irradiance = luminance(e);
        t.weighted = vecMul(t.weights, e);
        addReceiver(&sum, p, k, total, t);
        if (n == 0u) {
            continue;
        }
        nearest = reflectors[r] > 0.0f ? fmin(nearest, reflectors[r]) : nearest;
        farthest = fmax(farthest, reflectors[size + r]);
        inverse += reflectors[2u * size + r];
    }
#if HAS_bins
    closeBins(bins, pixels, p.i, &open);
    notFinite[p.i] += lost;
#endif
    const float hit = (float)LOAD_hits(pixels, p.i);
    const float counted = wave.published != 0u ? hit : p.before > 0u ? hit / (float)p.before * (float)had : 0.0f;
    TermMeans means;
    LOAD_term(pixels, p.i, &means);
#if HAS_term_spreads
    recallSquares(&means);
#endif
    const Vec3 weights = vecMad(vecScale(floors, counted), means.texture, own * (float)had);
    addTermSums(&means, p, had, total, hit, weights, &sum);
    STORE_term(pixels, p.i, &means);
    // Of one number for all three, a mean that is as near as its fraction and the nearest distance say.
    const float closest = nearest < INFINITY ? WEDGE_NEAREST_FRACTION * (float)total / fmax(nearest, 1e-20f) : 0.0f;
    STORE_extreme(pixels, p.i, fmax(inverse, closest));
    STORE_extremes(pixels, p.i, vec3(nearest < INFINITY ? nearest : 0.0f, farthest, inverse));
    STORE_samples(pixels, p.i, LOAD_samples(pixels, p.i) + total);
    STORE_indirectSamples(pixels, p.i, LOAD_indirectSamples(pixels, p.i) + total);
    STORE_termTaken(pixels, p.i, had + total);
}
#endif

/// What samples of probes find, for the exposure (filter/exposure.cl), which is of their mean.
/// in      wave's planes: objectId, sums (3 of them, of one sample); rays, pathRays
/// in out  of pixels: found: their sum; seen: surfaces; kept_rays, kept_pathRays: as of surfaces, where they count
#include "pass/accumulateProbes.h"
#ifdef PASS_accumulateProbes
__kernel void accumulateProbes(PARAMETERS)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    Vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    uint count = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        if (objectId[r] != 0u) {
            sum = vecAdd(sum, loadVec(sums, wave.planeSize, r));
            ++count;
        }
    }
    storeVec(found, frame.planeSize, p.i, vecAdd(loadVec(found, frame.planeSize, p.i), sum));
    seen[p.i] += count;
#if HAS_rays
    const uint counted = raysOfImage != 0u ? p.i : p.slot;
    kept_rays[counted] += sumOfCounts(p, rays);
    kept_pathRays[counted] += sumOfCounts(p, pathRays);
#else
    (void)raysOfImage;
#endif
}
#endif

/// Where and what the receivers are, and what they emit; closes the wave.
/// in      wave's planes: as wave_primary.cl fills them, rays, pathRays
/// in out  of pixels, kept_*: means of position, normal, pixelSize (of the first wave), distance, gloss (of the first
///         wave that saw a lobe), diffuse, specular, emission, emissionSquares (squared luminance), motion; objectId
///         (0: no surface, WEDGE_MIXED: several objects); hits; confusion: least and largest signed radius of the
///         circle of confusion, pixels; motionSpread: largest difference of motions from the mean; where there is none,
///         the mean motion of pixels whose motions differ is infinite; rays, pathRays: of the image's pixels where
///         raysOfImage is 1, else of the wave's; taken
#include "pass/accumulateSurfaces.h"
#ifdef PASS_accumulateSurfaces
__kernel void accumulateSurfaces(PARAMETERS)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const uint size = wave.planeSize, pixels = frame.planeSize;
    RadianceSums emitted = noRadiance();
    for (uint r = p.first; r < p.first + p.count; ++r) {
        addRadiance(&emitted, loadVec(emission, size, r));
    }
    const float before = (float)p.before, count = (float)p.count, hits = (float)LOAD_kept_hits(pixels, p.i);
    const Vec3 kd = sumOfVecs(p, objectId, diffuse, size), ks = sumOfVecs(p, objectId, specular, size);
    const float2 range = p.before > 0u ? LOAD_kept_confusion(pixels, p.i) : (float2)(INFINITY, -INFINITY);
    STORE_kept_emission(pixels, p.i, meanVec(LOAD_kept_emission(pixels, p.i), before, emitted.radiance, count));
    STORE_kept_emissionSquares(
        pixels, p.i, meanWith(LOAD_kept_emissionSquares(pixels, p.i), before, emitted.squared, count));
    STORE_kept_diffuse(pixels, p.i, meanVec(LOAD_kept_diffuse(pixels, p.i), before, kd, count));
    STORE_kept_specular(pixels, p.i, meanVec(LOAD_kept_specular(pixels, p.i), before, ks, count));
    STORE_kept_confusion(pixels, p.i, confusionWith(range, p, camera, depth, objectId, gloss));
    taken[p.i] = p.before + p.count;
    const uint counted = raysOfImage != 0u ? p.i : p.slot;
    kept_rays[counted] += sumOfCounts(p, rays);
    kept_pathRays[counted] += sumOfCounts(p, pathRays);
    uint object = LOAD_kept_objectId(pixels, p.i);
    const float hit = (float)surfacesOf(p, objectId, &object);
    if (hit == 0.0f) {
        // Misses, or a light that is seen.
        STORE_kept_distance(pixels, p.i, hits > 0.0f ? LOAD_kept_distance(pixels, p.i) : depth[p.first]);
        return;
    }
    STORE_kept_hits(pixels, p.i, (uint)hits + (uint)hit);
    STORE_kept_objectId(pixels, p.i, object);
    const Vec3 middle = meanVec(LOAD_kept_position(pixels, p.i), hits, sumOfVecs(p, objectId, position, size), hit);
    STORE_kept_position(pixels, p.i, middle);
    STORE_kept_distance(pixels, p.i, vecLength(vecSub(middle, frame.eye)));
    const Vec3 facing = sumOfVecs(p, objectId, normal, size);
    STORE_kept_normal(pixels, p.i, vecNormalize(vecMad(facing, LOAD_kept_normal(pixels, p.i), hits)));
#ifdef WEDGE_NORMAL_MAPS
    const Vec3 unmapped = sumOfVecs(p, objectId, normal + 3u * size, size);
    const Vec3 had = WEDGE_OF_FORMAT(load_unmapped, FORMAT_kept_normal)(kept_normal, pixels, p.i);
    WEDGE_OF_FORMAT(store_unmapped, FORMAT_kept_normal)
    (kept_normal, pixels, p.i, vecNormalize(vecMad(unmapped, had, hits)));
#endif
    const float edge = sumOfFloats(p, objectId, pixelSize);
    STORE_kept_pixelSize(pixels, p.i, meanWith(LOAD_kept_pixelSize(pixels, p.i), hits, edge, hit));
    // Of the first wave that has a lobe: how many of the receivers before another did is not known.
    if (!(hits > 0.0f && LOAD_kept_gloss(pixels, p.i).kind != WEDGE_LAMBERT)) {
        STORE_kept_gloss(pixels, p.i, meanGloss(p, objectId, gloss));
    }
    const float2 moved = LOAD_kept_motion(pixels, p.i);
    if (HAS_kept_motion && moved.x != INFINITY) {
        const float x = meanWith(moved.x, hits, sumOfFloats(p, objectId, motion), hit);
        const float y = meanWith(moved.y, hits, sumOfFloats(p, objectId, motion + size), hit);
        const float spread = spreadWith(LOAD_kept_motionSpread(pixels, p.i), p, objectId, motion, size, x, y);
        STORE_kept_motion(pixels, p.i, HAS_kept_motionSpread ? (float2)(x, y) : oneMotion(wave, x, y, spread));
        STORE_kept_motionSpread(pixels, p.i, spread);
    }
}
#endif
