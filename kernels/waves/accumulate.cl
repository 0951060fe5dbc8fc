// From a wave's receivers to its pixels. Planes of pixels hold means over the primary samples taken so far; each kernel
// here adds a pixel's new receivers, which lie together in the wave. Samples that hit nothing count as black in
// radiance and in textures, and not at all in irradiances, positions and normals. What a pixel keeps of a term:
// accumulate.h.
#include "shared/camera.h"
#include "shared/defocus.h"
#include "shared/indirect.h"
#include "waves/accumulate.h"

#ifdef WEDGE_MOTION
/// What the first samples of a light tell of its shadows' motions: sums of x, y, squared lengths and ones.
WEDGE_FN void storeShadows(WaveParams wave, WavePixel p, uint pixels, __global float* extremes, const float* sums)
{
    if (wave.packed == 0u) {
        for (uint k = 0u; k < 4u; ++k) {
            extremes[(2u + k) * pixels + p.i] += sums[k];
        }
        return;
    }
    const float count = fmax(sums[3], 1.0f), x = sums[0] / count, y = sums[1] / count;
    storeOneMotion(wave, pixels, p.i, extremes, x, y, sqrt(fmax(sums[2] / count - x * x - y * y, 0.0f)));
}
#endif

/// One area light.
/// in      wave's planes: receivers, diffuse, specular, sums (see light_sampling.h), slopes
///         exact: 1: unshadowed has the receivers' shading (wave_light.cl); 0: it is that of their samples
///         hits: the pixels' primary samples with a surface, before the wave
///         termTaken, termWanted: the pixels' samples of the light before and after the wave
/// in out  of pixels: texture (3), value (visibility, 3), plain (its luminance, unweighted), squares and textureSquares
///         (mean squared luminance of a primary sample's radiance, and of its texture), termRadiance (3, as published),
///         extremes (slopes, and shadows' motions), deviation, samples (of all terms), termTaken
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
    const TermPlanes planes = WEDGE_TERM_ARGUMENTS(true);
    const uint total = newTermSamples(wave, p.i, termTaken, termWanted);
    const bool measures = (wave.omits & WEDGE_OMITS_ANALYSIS) == 0u, all = (wave.omits & WEDGE_OMITS_EXTREMES) == 0u;
    // Packed, there is none before.
    float sMin = measures && wave.packed == 0u && extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY;
    float sMax = measures && all ? extremes[pixels + p.i] : 0.0f;
    float weight = 0.0f, specularWeight = 0.0f;
    const bool weighed = total < p.count && wave.published == 0u
        && meanWeights(wave, p, total, objectId, diffuse, specular, sums, &weight, &specularWeight);
#ifdef WEDGE_MOTION
    float shadows[4] = { 0.0f, 0.0f, 0.0f, 0.0f };
#endif
    bool known = true;
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
            const float whole = exact != 0u ? unshadowed[r] : -1.0f;
            known = known && (n > 0u || weighed || whole >= 0.0f);
            t = whole >= 0.0f || n == 0u ? vecScale(kd, WEDGE_INV_PI * (whole >= 0.0f ? whole : weight)) : sampled;
            l = vecScale(kd, WEDGE_INV_PI * scale * sums[size + r]);
#ifdef WEDGE_SPECULAR
            const float mirrored = exact != 0u ? unshadowed[size + r] : -1.0f;
            known = known && (n > 0u || weighed || mirrored >= 0.0f);
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
        for (uint plane = 0u; measures && plane < 4u; ++plane) {
            shadows[plane] += slopes[(2u + plane) * size + r];
        }
#endif
        const bool early = 2u * sharedSamples(k, p.count, total) < total;
        if (wave.published != 0u) {
            addSamples(&sum, l, seen, vec3(seen, seen, seen), vec3(1.0f, 1.0f, 1.0f), early);
        } else {
            addSamples(&sum, exact != 0u ? vecScale(t, seen) : l, seen, vecScale(l, (float)n),
                vecScale(sampled, (float)n), early);
        }
    }
    if (!known) {
        sum.texture = vec3(0.0f, 0.0f, 0.0f);
        sum.textureSquared = sum.textures = 0.0f;
    }
    const float plainWeight = (float)loadHits(hits, p.i, wave.packed);
    const Vec3 weights = wave.published != 0u
        ? vec3(plainWeight, plainWeight, plainWeight)
        : vecScale(loadColour(texture, pixels, p.i, planes.textureBits), (float)termTaken[p.i]);
    storeTermSums(
        wave, p, pixels, planes, termTaken[p.i], total, (float)loadHits(hits, p.i, wave.packed), weights, &sum);
    storeExtreme(wave, p, pixels, plain, extremes, sMin < INFINITY ? sMin : 0.0f);
    if (measures && all) {
        extremes[pixels + p.i] = sMax;
    }
#ifdef WEDGE_MOTION
    if (measures) {
        storeShadows(wave, p, pixels, extremes, shadows);
    }
#endif
    if ((wave.omits & WEDGE_OMITS_LAYERS) == 0u) {
        samples[p.i] += total;
    }
    countTaken(wave, p.i, total, (__global uint*)termTaken);
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
    storeMean(delta, frame.planeSize, p.i, (float)p.before, radiance, (float)p.count);
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
    const TermPlanes planes = WEDGE_TERM_ARGUMENTS(false);
    const uint total = newTermSamples(wave, p.i, termTaken, termWanted);
    const bool measures = (wave.omits & WEDGE_OMITS_ANALYSIS) == 0u, all = (wave.omits & WEDGE_OMITS_EXTREMES) == 0u;
    float nearest = measures && all && extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY;
    float farthest = measures && all ? extremes[pixels + p.i] : 0.0f;
    float inverse = measures && all     ? extremes[2u * pixels + p.i]
        : measures && wave.packed == 0u ? extremes[p.i]
                                        : 0.0f;
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
    const float counted = wave.published != 0u ? (float)loadHits(hits, p.i, wave.packed)
        : p.before > 0u ? (float)loadHits(hits, p.i, wave.packed) / (float)p.before * (float)termTaken[p.i]
                        : 0.0f;
    const Vec3 before = loadColour(texture, pixels, p.i, planes.textureBits);
    const Vec3 known = vecMad(vecScale(floors, counted), before, own * (float)termTaken[p.i]);
    storeTermSums(wave, p, pixels, planes, termTaken[p.i], total, (float)loadHits(hits, p.i, wave.packed), known, &sum);
    // Of one number for both, a mean that is as near as its fraction and the nearest distance say.
    const float closest = nearest < INFINITY ? WEDGE_NEAREST_FRACTION * (float)total / fmax(nearest, 1e-20f) : 0.0f;
    storeExtreme(
        wave, p, pixels, plain, extremes, all ? (nearest < INFINITY ? nearest : 0.0f) : fmax(inverse, closest));
    if (measures && all) {
        extremes[pixels + p.i] = farthest;
        extremes[2u * pixels + p.i] = inverse;
    }
    if ((wave.omits & WEDGE_OMITS_LAYERS) == 0u) {
        samples[p.i] += total;
        indirectSamples[p.i] += (wave.omits & WEDGE_OMITS_INDIRECT) == 0u ? total : 0u;
    }
    countTaken(wave, p.i, total, (__global uint*)termTaken);
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
/// in out  of pixels: means of position, normal, pixelSize, distance, gloss (of the first wave that saw a lobe),
/// diffuse,
///         specular, emission, emissionSquares (squared luminance); objectId (0:
///         no surface, WEDGE_MIXED: several objects); hits; confusion (planes: least and largest signed radius of
///         the circle of confusion, pixels); motion (planes: mean x, mean y, largest difference from the mean; packed:
///         see accumulate.h);
///         rays, pathRays; taken
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
    const bool has = p.before > 0u && wave.packed == 0u;
    float low = has ? confusionOf[p.i] : INFINITY, high = has ? confusionOf[pixels + p.i] : -INFINITY;
    uint object = objectOf[p.i], traced = 0u, paths = 0u;
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
        unmapped = vecAdd(unmapped, loadVec(normal + unmappedNormals(size, 0u), size, r));
#endif
        kd = vecAdd(kd, loadVec(diffuse, size, r));
        ks = vecAdd(ks, loadVec(specular, size, r));
        addGloss(&lobes, unpackGloss(gloss[r]));
        edge += pixelSize[r];
        moveX += motion[r];
        moveY += motion[size + r];
    }
    const float before = (float)p.before, count = (float)p.count, hits = (float)loadHits(hitsOf, p.i, wave.packed);
    storeMean(emissionOf, pixels, p.i, before, emitted, count);
    const bool measures = (wave.omits & WEDGE_OMITS_ANALYSIS) == 0u, layers = (wave.omits & WEDGE_OMITS_LAYERS) == 0u;
    if (measures) {
        emissionSquaresOf[p.i] = meanWith(emissionSquaresOf[p.i], before, squared, count);
    }
    if (layers) {
        storeMean(diffuseOf, pixels, p.i, before, kd, count);
        storeMean(specularOf, pixels, p.i, before, ks, count);
    }
    taken[p.i] = p.before + p.count;
    if (wave.packed != 0u) {
        // The signed radius nearest to 0, or 0 where it changes its sign.
        const float least = low > 0.0f ? low : high < 0.0f ? high : 0.0f;
        const float had = p.before > 0u ? loadShort(confusionOf, pixels, p.i, 0u) : least;
        const float nearest = fabs(had) < fabs(least) ? had : least;
        storeShort(confusionOf, pixels, p.i, 0u,
            (had > 0.0f) == (least > 0.0f) && (had < 0.0f) == (least < 0.0f) ? nearest : 0.0f);
    } else {
        confusionOf[p.i] = low;
        confusionOf[pixels + p.i] = high;
    }
    raysOf[layers ? p.i : p.slot] += traced;
    pathRaysOf[layers ? p.i : p.slot] += paths;
    if (hit == 0.0f) {
        if (layers) {
            // Misses, or a light that is seen.
            distanceOf[p.i] = hits > 0.0f ? distanceOf[p.i] : depth[p.first];
        }
        return;
    }
    storeHits(hitsOf, p.i, wave.packed, (uint)hits + (uint)hit);
    objectOf[p.i] = object;
    storeMean(positionOf, pixels, p.i, hits, at, hit);
    const Vec3 faced = loadNormal(normalOf, pixels, p.i, wave.packed);
    storeNormal(normalOf, pixels, p.i, wave.packed, vecNormalize(vecMad(facing, faced, hits)));
#ifdef WEDGE_NORMAL_MAPS
    __global float* unmappedOf = normalOf + unmappedNormals(pixels, wave.packed);
    const Vec3 had = loadNormal(unmappedOf, pixels, p.i, wave.packed);
    storeNormal(unmappedOf, pixels, p.i, wave.packed, vecNormalize(vecMad(unmapped, had, hits)));
#endif
    if (measures && wave.packed != 0u) {
        storeShort(pixelSizeOf, pixels, p.i, 0u, edge / hit);
    } else if (measures) {
        pixelSizeOf[p.i] = meanWith(pixelSizeOf[p.i], hits, edge, hit);
    }
    if (measures) {
        // Of the first wave that has a lobe: how many of the receivers before another did is not known.
        const bool known = hits > 0.0f && loadGloss(glossOf, p.i, wave.packed).kind != WEDGE_LAMBERT;
        const Gloss mean = makeGloss(lobes.sum.exponent / fmax(lobes.count, 1.0f), lobes.sum.kind);
        if (!known) {
            storeGloss(glossOf, p.i, wave.packed, mean);
        }
    }
    if (layers) {
        distanceOf[p.i] = vecLength(vecSub(loadVec(positionOf, pixels, p.i), frame.eye));
    }
    if ((wave.omits & WEDGE_OMITS_MOTION) != 0u) {
        return;
    }
    const bool packed = wave.packed != 0u;
    const float hadX = packed ? loadShort(motionOf, pixels, p.i, 0u) : motionOf[p.i];
    const float hadY = packed ? loadShort(motionOf, pixels, p.i, 1u) : motionOf[pixels + p.i];
    if (packed && hadX == INFINITY) {
        return;
    }
    const float meanX = meanWith(hadX, hits, moveX, hit), meanY = meanWith(hadY, hits, moveY, hit);
    float spread = packed ? 0.0f : motionOf[2u * pixels + p.i];
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const float dx = motion[r] - meanX, dy = motion[size + r] - meanY;
        spread = objectId[r] != 0u ? fmax(spread, sqrt(dx * dx + dy * dy)) : spread;
    }
    if (packed) {
        storeOneMotion(wave, pixels, p.i, motionOf, meanX, meanY, spread);
        return;
    }
    motionOf[p.i] = meanX;
    motionOf[pixels + p.i] = meanY;
    motionOf[2u * pixels + p.i] = spread;
}
#endif
