// From a wave's receivers to its pixels. Planes of pixels hold means over the primary samples taken so far; each kernel
// here adds a pixel's new receivers, which lie together in the wave. Samples that hit nothing count as black in
// radiance and in textures, and not at all in irradiances, positions and normals. What a pixel keeps of a term:
// accumulate.h.
#include "shared/camera.h"
#include "shared/defocus.h"
#include "shared/indirect.h"
#include "waves/accumulate.h"

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
    const float2 known = LOAD_extremes(pixels, p.i);
    const float least = HAS_extreme ? LOAD_extreme(pixels, p.i) : known.x;
    float sMin = least > 0.0f ? least : INFINITY, sMax = known.y;
    float weight = 0.0f, specularWeight = 0.0f;
    const bool weighed = total < p.count && wave.published == 0u
        && meanWeights(wave, p, total, objectId, diffuse, specular, sums, &weight, &specularWeight);
#ifdef WEDGE_MOTION
    float shadows[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
#endif
    bool textured = true;
    TermSums sum = noTermSums((float)p.count);
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        const uint n = sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
        if (objectId[r] == 0u) {
            continue;
        }
        const float scale = n > 0u ? 1.0f / (float)n : 0.0f;
        const Vec3 kd = loadVec(diffuse, size, r), ks = loadVec(specular, size, r);
        Vec3 t, l, sampled;
        float seen;
        if (wave.published != 0u) {
            publishedReceiver(receivers, data, light, r, kd, ks, sums[size + r] * scale, &t, &seen);
            l = vecScale(t, seen);
        } else {
            sampled = vecScale(kd, WEDGE_INV_PI * scale * sums[r]);
            const float2 shading = HAS_unshadowed ? LOAD_unshadowed(size, r) : (float2)(-1.0f);
            const float whole = shading.x;
            textured = textured && (n > 0u || weighed || whole >= 0.0f);
            t = whole >= 0.0f || n == 0u ? vecScale(kd, WEDGE_INV_PI * (whole >= 0.0f ? whole : weight)) : sampled;
            l = vecScale(kd, WEDGE_INV_PI * scale * sums[size + r]);
#ifdef WEDGE_SPECULAR
            const float mirrored = shading.y;
            textured = textured && (n > 0u || weighed || mirrored >= 0.0f);
            t = vecMad(t, ks, mirrored >= 0.0f ? mirrored : n > 0u ? scale * sums[2u * size + r] : specularWeight);
            sampled = vecMad(sampled, ks, scale * sums[2u * size + r]);
            l = vecMad(l, ks, scale * sums[3u * size + r]);
#endif
            t = vecMul(t, light.power);
            l = vecMul(l, light.power);
            sampled = vecMul(sampled, light.power);
            seen = luminance(sampled) > 0.0f ? luminance(l) / luminance(sampled) : 0.0f;
        }
        addTexture(&sum, t);
        if (n == 0u) {
            continue;
        }
        sMin = slopes[r] > 0.0f ? fmin(sMin, slopes[r]) : sMin;
        sMax = fmax(sMax, slopes[size + r]);
#ifdef WEDGE_MOTION
        for (uint plane = 0u; (HAS_shadowSums || HAS_shadowMotion) && plane < 4u; ++plane) {
            shadows[plane] += slopes[(2u + plane) * size + r];
        }
#endif
        const bool early = 2u * sharedSamples(k, p.count, total) < total;
        if (wave.published != 0u) {
            addSamples(&sum, l, seen, vec3(seen, seen, seen), vec3(1.0f, 1.0f, 1.0f), early);
        } else {
            addSamples(&sum, HAS_unshadowed ? vecScale(t, seen) : l, seen, vecScale(l, (float)n),
                vecScale(sampled, (float)n), early);
        }
    }
    if (!textured) {
        sum.texture = vec3(0.0f, 0.0f, 0.0f);
        sum.textureSquared = sum.textures = 0.0f;
    }
    const float hit = (float)LOAD_hits(pixels, p.i);
    TermMeans means;
    LOAD_term(pixels, p.i, &means);
#if HAS_term_spreads
    recallSquares(&means);
#endif
    const Vec3 weights = wave.published != 0u ? vec3(hit, hit, hit) : vecScale(means.texture, (float)before);
    addTermSums(&means, p, before, total, hit, weights, &sum);
    STORE_term(pixels, p.i, &means);
    sMin = sMin < INFINITY ? sMin : 0.0f;
    STORE_extremes(pixels, p.i, (float2)(sMin, sMax));
    STORE_extreme(pixels, p.i, sMin);
#if HAS_shadowSums
    for (uint k = 0u; k < 4u; ++k) {
        shadowSums[k * pixels + p.i] += shadows[k];
    }
#endif
#if HAS_shadowMotion
    const float count = fmax(shadows[3], 1.0f), moveX = shadows[0] / count, moveY = shadows[1] / count;
    const float spread = sqrt(fmax(shadows[2] / count - moveX * moveX - moveY * moveY, 0.0f));
    STORE_shadowMotion(pixels, p.i, oneMotion(wave, moveX, moveY, spread));
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
    Vec3 radiance = vec3(0.0f, 0.0f, 0.0f);
    float squared = 0.0f;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const Vec3 l = objectId[r] != 0u ? loadVec(lit, wave.planeSize, r) : vec3(0.0f, 0.0f, 0.0f);
        radiance = vecAdd(radiance, l);
        squared += luminance(l) * luminance(l);
    }
    const uint pixels = frame.planeSize;
    STORE_delta(pixels, p.i, meanVec(LOAD_delta(pixels, p.i), (float)p.before, radiance, (float)p.count));
    deltaSquares[p.i] = meanWith(deltaSquares[p.i], (float)p.before, squared, (float)p.count);
}
#endif

/// One component of indirect light.
/// in      ambient: 1 for ambient occlusion: the irradiance is what is open of the hemisphere, the texture white
///         wave's planes: objectId, reflectance (3), sums (path_sampling.h), reflectors (distances.h); hits, as
///         of a light
/// in out  as of a light; extremes: reflectors of pixels, like those of receivers; indirectSamples
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
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        const uint n = sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
        if (objectId[r] == 0u) {
            continue;
        }
        const Vec3 t = ambient != 0u ? white : loadVec(reflectance, size, r);
        addTexture(&sum, t);
        if (n == 0u) {
            continue;
        }
        const Vec3 mean = vecScale(loadVec(sums, size, r), 1.0f / (float)n);
        const Vec3 e = ambient != 0u ? vecSub(white, mean) : mean;
        const Vec3 weights = vecScale(vecMad(floors, t, own), wave.published != 0u ? 1.0f : (float)n);
        const bool early = 2u * sharedSamples(k, p.count, total) < total;
        addSamples(&sum, vecMul(t, e), luminance(e), vecMul(weights, e), weights, early);
        nearest = reflectors[r] > 0.0f ? fmin(nearest, reflectors[r]) : nearest;
        farthest = fmax(farthest, reflectors[size + r]);
        inverse += reflectors[2u * size + r];
    }
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

/// Exponents of those receivers of a pixel that have a lobe, as of the first one's kind; 0 at first.
typedef struct {
    Gloss sum;
    float count;
} GlossSum;

WEDGE_FN void addGloss(GlossSum* s, Gloss g)
{
    if (g.kind == WEDGE_LAMBERT) {
        return;
    }
    s->sum.kind = s->count > 0.0f ? s->sum.kind : g.kind;
    s->sum.exponent += exponentAs(g, s->sum.kind);
    s->count += 1.0f;
}

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
    const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
    Vec3 at = none, facing = none, kd = none, ks = none, emitted = none;
#ifdef WEDGE_NORMAL_MAPS
    Vec3 unmapped = none;
#endif
    GlossSum lobes = { { 0.0f, WEDGE_LAMBERT, 0.0f }, 0.0f };
    float hit = 0.0f, edge = 0.0f, moveX = 0.0f, moveY = 0.0f, squared = 0.0f;
    const float2 range = p.before > 0u ? LOAD_kept_confusion(pixels, p.i) : (float2)(INFINITY, -INFINITY);
    float low = range.x, high = range.y;
    uint object = LOAD_kept_objectId(pixels, p.i), traced = 0u, paths = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const Vec3 e = loadVec(emission, size, r);
        emitted = vecAdd(emitted, e);
        squared += luminance(e) * luminance(e);
        float radius = camera.apertureRadius > 0.0f
            ? circleOfConfusion(camera.apertureRadius, camera.focusDistance, depth[r], camera.pixelStep)
            : 0.0f;
#ifdef WEDGE_MIRRORS
        // What a mirror shows lies elsewhere, and may be in focus.
        radius = objectId[r] != 0u && WEDGE_IS_MIRROR(gloss[r]) ? 0.0f : radius;
#endif
        low = fmin(low, radius);
        high = fmax(high, radius);
        traced += rays[r];
        paths += pathRays[r];
        if (objectId[r] == 0u) {
            continue;
        }
        object = object == 0u || object == objectId[r] ? objectId[r] : WEDGE_MIXED;
        hit += 1.0f;
        at = vecAdd(at, loadVec(position, size, r));
        facing = vecAdd(facing, loadVec(normal, size, r));
#ifdef WEDGE_NORMAL_MAPS
        unmapped = vecAdd(unmapped, WEDGE_OF_FORMAT(load_unmapped, FORMAT_normal)(normal, size, r));
#endif
        kd = vecAdd(kd, loadVec(diffuse, size, r));
        ks = vecAdd(ks, loadVec(specular, size, r));
        addGloss(&lobes, unpackGloss(gloss[r]));
        edge += pixelSize[r];
        moveX += motion[r];
        moveY += motion[size + r];
    }
    const float before = (float)p.before, count = (float)p.count, hits = (float)LOAD_kept_hits(pixels, p.i);
    STORE_kept_emission(pixels, p.i, meanVec(LOAD_kept_emission(pixels, p.i), before, emitted, count));
    STORE_kept_emissionSquares(pixels, p.i, meanWith(LOAD_kept_emissionSquares(pixels, p.i), before, squared, count));
    STORE_kept_diffuse(pixels, p.i, meanVec(LOAD_kept_diffuse(pixels, p.i), before, kd, count));
    STORE_kept_specular(pixels, p.i, meanVec(LOAD_kept_specular(pixels, p.i), before, ks, count));
    STORE_kept_confusion(pixels, p.i, (float2)(low, high));
    taken[p.i] = p.before + p.count;
    const uint counted = raysOfImage != 0u ? p.i : p.slot;
    kept_rays[counted] += traced;
    kept_pathRays[counted] += paths;
    if (hit == 0.0f) {
        // Misses, or a light that is seen.
        STORE_kept_distance(pixels, p.i, hits > 0.0f ? LOAD_kept_distance(pixels, p.i) : depth[p.first]);
        return;
    }
    STORE_kept_hits(pixels, p.i, (uint)hits + (uint)hit);
    STORE_kept_objectId(pixels, p.i, object);
    const Vec3 middle = meanVec(LOAD_kept_position(pixels, p.i), hits, at, hit);
    STORE_kept_position(pixels, p.i, middle);
    STORE_kept_normal(pixels, p.i, vecNormalize(vecMad(facing, LOAD_kept_normal(pixels, p.i), hits)));
#ifdef WEDGE_NORMAL_MAPS
    const Vec3 had = WEDGE_OF_FORMAT(load_unmapped, FORMAT_kept_normal)(kept_normal, pixels, p.i);
    WEDGE_OF_FORMAT(store_unmapped, FORMAT_kept_normal)
    (kept_normal, pixels, p.i, vecNormalize(vecMad(unmapped, had, hits)));
#endif
    STORE_kept_pixelSize(pixels, p.i, meanWith(LOAD_kept_pixelSize(pixels, p.i), hits, edge, hit));
    // Of the first wave that has a lobe: how many of the receivers before another did is not known.
    if (!(hits > 0.0f && LOAD_kept_gloss(pixels, p.i).kind != WEDGE_LAMBERT)) {
        STORE_kept_gloss(pixels, p.i, makeGloss(lobes.sum.exponent / fmax(lobes.count, 1.0f), lobes.sum.kind));
    }
    STORE_kept_distance(pixels, p.i, vecLength(vecSub(middle, frame.eye)));
#if HAS_kept_motion
    const float2 moved = LOAD_kept_motion(pixels, p.i);
    if (moved.x == INFINITY) {
        return;
    }
    const float meanX = meanWith(moved.x, hits, moveX, hit), meanY = meanWith(moved.y, hits, moveY, hit);
    float spread = LOAD_kept_motionSpread(pixels, p.i);
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const float dx = motion[r] - meanX, dy = motion[size + r] - meanY;
        spread = objectId[r] != 0u ? fmax(spread, sqrt(dx * dx + dy * dy)) : spread;
    }
    STORE_kept_motion(
        pixels, p.i, HAS_kept_motionSpread ? (float2)(meanX, meanY) : oneMotion(wave, meanX, meanY, spread));
    STORE_kept_motionSpread(pixels, p.i, spread);
#else
    (void)moveX;
    (void)moveY;
#endif
}
#endif
