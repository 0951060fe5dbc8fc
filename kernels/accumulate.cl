// From a wave's receivers to its pixels. Planes of pixels hold means over the primary samples taken so far; each kernel
// here adds a pixel's new receivers, which lie together in the wave. Samples that hit nothing count as black in radiance
// and in textures, and not at all in irradiances, positions and normals.
//
// Of each term a pixel keeps the mean texture k (reflectance; of lights times the unshadowed shading) of all receivers, and
// of those that took samples of the term the mean irradiance E (of lights: visibility), each channel weighted by the texture
// and by the samples, so that their product is the radiance of the term, and neither holds what belongs to the other;
// besides, the plain mean of E's luminance, by which thesis (5.30) judges whether texture and irradiance may be taken apart.
// As published (wave.published) E is the plain mean, that of lights holds the light's form factor (5.14), k the lobe
// towards its centre (5.20), and the term's radiance L is kept apart.
//
// Packed planes (wave.packed) hold k and E in 47 bits each (packed_planes.h), and what one wave alone measures in 16: in
// `plain` the factoring error (distributed.cl) and, after it, the one of the extremes that there is; in `squares` the
// standard deviations of a primary sample's radiance and of its texture. Likewise pixelSize holds the gloss, too, and hits, after
// these, the signed radius nearest to 0 of the circles of confusion.
#include "light_sample.h"
#include "packed_planes.h"
#include "shared/bsdf.h"
#include "shared/camera.h"
#include "shared/defocus.h"
#include "shared/wave.h"

/// Least texture with which an irradiance counts: black surfaces have one, too.
#define WEDGE_LEAST_TEXTURE 1e-6f

/// A pixel and its receivers in the wave.
typedef struct {
    uint i;            ///< in planes of pixels
    uint slot;         ///< in planes of the wave's pixels
    uint first, count; ///< receivers
    uint before;       ///< primary samples that its means hold already
} WavePixel;

WEDGE_FN bool wavePixel(FrameParams frame, WaveParams wave, __global const uint* pixelFirst, __global const uint* pixelCount,
                        __global const uint* taken, WavePixel* p)
{
    const uint slot = get_global_id(0);
    uint x, y;
    if (slot >= wave.tiles * WEDGE_TILE_PIXELS
        || !slotPixel(frame, wave.firstTile + slot / WEDGE_TILE_PIXELS, slot % WEDGE_TILE_PIXELS, &x, &y)) {
        return false;
    }
    p->i = pixelIndex(x, y, frame.stride);
    p->slot = slot;
    p->first = pixelFirst[slot];
    p->count = pixelCount[slot];
    p->before = taken[p->i];
    return p->count > 0u;
}

/// The mean of before + count numbers, of which `mean` is that of the first and sum that of the others.
WEDGE_FN float meanWith(float mean, float before, float sum, float count)
{
    return (mean * before + sum) / fmax(before + count, 1e-20f);
}

WEDGE_FN void storeMean(__global float* planes, uint size, uint i, float before, Vec3 sum, float count)
{
    const Vec3 mean = loadVec(planes, size, i);
    storeVec(planes, size, i, vec3(meanWith(mean.x, before, sum.x, count), meanWith(mean.y, before, sum.y, count),
                                   meanWith(mean.z, before, sum.z, count)));
}

/// Texture and irradiance of a receiver under one light as published; visible: of its samples, the fraction that sees it.
WEDGE_FN void publishedReceiver(FrameParams frame, ReceiverData data, AreaLight light, uint r, Vec3 kd, Vec3 ks, float visible,
                                Vec3* texture, float* irradiance)
{
    const Receiver at = loadReceiver(frame, data, r);
    const Vec3 d = vecSub(light.centre, at.position);
    const Vec3 lobe = vecScale(ks, lobeValue(at.lobe, at.normal, at.view, vecNormalize(d)));
    *texture = vecMul(vecMad(lobe, kd, WEDGE_INV_PI), light.power);
    *irradiance = visible * geometryTerm(at.normal, d, light.normal, light.twoSided);
}

/// What a pixel's new receivers add to one term.
typedef struct {
    Vec3 texture;
    float textureSquared, textures; ///< textures: receivers whose texture is known, misses included
    Vec3 radiance;
    Vec3 weighted, weights; ///< irradiance times its weight, and the weights
    float plain, counted;   ///< luminances of irradiances, and how many
    float squared;
} TermSums;

WEDGE_FN TermSums noTermSums(float textures)
{
    TermSums s;
    s.radiance = s.texture = s.weighted = s.weights = vec3(0.0f, 0.0f, 0.0f);
    s.plain = s.counted = s.squared = s.textureSquared = 0.0f;
    s.textures = textures;
    return s;
}

WEDGE_FN void addTexture(TermSums* s, Vec3 t)
{
    s->texture = vecAdd(s->texture, t);
    s->textureSquared += luminance(t) * luminance(t);
}

/// Adds what the samples of a receiver found: radiance l, that is irradiance times texture, weighted as given.
WEDGE_FN void addSamples(TermSums* s, Vec3 l, float irradiance, Vec3 weighted, Vec3 weights)
{
    s->radiance = vecAdd(s->radiance, l);
    s->weighted = vecAdd(s->weighted, weighted);
    s->weights = vecAdd(s->weights, weights);
    s->plain += irradiance;
    s->counted += 1.0f;
    s->squared += luminance(l) * luminance(l);
}

/// The planes of pixels that terms keep.
typedef struct {
    __global float *texture, *value, *plain, *squares, *textureSquares;
    __global float* radiance; ///< of the term alone, as published
} TermPlanes;

WEDGE_FN float weightedMean(float mean, float known, float weighted, float weights)
{
    return known + weights > 0.0f ? (mean * known + weighted) / (known + weights) : 0.0f;
}

/// What the analysis is made of, of the first wave of a pixel's; t, e: its mean texture and irradiance, of `have` receivers
/// with samples.
WEDGE_FN void storeMeasured(WavePixel p, uint pixels, TermPlanes planes, Vec3 t, Vec3 e, float have, const TermSums* s)
{
    const float mean = luminance(vecMul(t, e)), texture = luminance(t);
    const float squared = meanWith(0.0f, 0.0f, s->squared, have), plain = meanWith(0.0f, 0.0f, s->plain, s->counted);
    const float textureSquared = meanWith(0.0f, 0.0f, s->textureSquared, s->textures);
    storeShort(planes.plain, pixels, p.i, 0u, mean - texture * plain);
    storeShort(planes.squares, pixels, p.i, 0u, sqrt(fmax(squared - mean * mean, 0.0f)));
    storeShort(planes.squares, pixels, p.i, 1u, sqrt(fmax(textureSquared - texture * texture, 0.0f)));
}

/// taken: samples of the term before the wave, total: in it; hits: receivers with a surface before; known: what the mean
/// value weighs so far.
WEDGE_FN void storeTermSums(WaveParams wave, WavePixel p, uint pixels, TermPlanes planes, uint taken, uint total, float hits,
                            Vec3 known, const TermSums* s)
{
    const float before = (float)p.before;
    // Receivers that took samples, misses included: samples are shared evenly.
    const float had = (float)min(taken, p.before), have = (float)min(total, p.count);
    Vec3 e = loadColour(planes.value, pixels, p.i, wave.packed), t = loadColour(planes.texture, pixels, p.i, wave.packed);
    e = vec3(weightedMean(e.x, known.x, s->weighted.x, s->weights.x), weightedMean(e.y, known.y, s->weighted.y, s->weights.y),
             weightedMean(e.z, known.z, s->weighted.z, s->weights.z));
    t = vec3(meanWith(t.x, before, s->texture.x, s->textures), meanWith(t.y, before, s->texture.y, s->textures),
             meanWith(t.z, before, s->texture.z, s->textures));
    storeColour(planes.value, pixels, p.i, wave.packed, e);
    storeColour(planes.texture, pixels, p.i, wave.packed, t);
    if (wave.packed != 0u) {
        if ((wave.omits & WEDGE_OMITS_ANALYSIS) == 0u) {
            storeMeasured(p, pixels, planes, t, e, have, s);
        }
    } else if ((wave.omits & WEDGE_OMITS_ANALYSIS) == 0u) {
        planes.textureSquares[p.i] = meanWith(planes.textureSquares[p.i], before, s->textureSquared, s->textures);
        const float hadHits = p.before > 0u ? hits * had / before : 0.0f;
        planes.plain[p.i] = meanWith(planes.plain[p.i], hadHits, s->plain, s->counted);
        planes.squares[p.i] = meanWith(planes.squares[p.i], had, s->squared, have);
    }
    if (wave.published != 0u) {
        storeMean(planes.radiance, pixels, p.i, had, s->radiance, have);
    }
}

/// Samples of a term that the wave takes for a pixel.
WEDGE_FN uint newTermSamples(WaveParams wave, uint taken, uint wanted) { return max(wantedSamples(wave, wanted), taken) - taken; }

/// Parameters of the kernels that add to a term, and its planes made of them.
#define WEDGE_TERM_PARAMETERS                                                                                           \
    __global const uint *restrict termWanted, __global uint *restrict termTaken, __global float *restrict texture,      \
        __global float *restrict value, __global float *restrict plain, __global float *restrict squares,               \
        __global float *restrict textureSquares, __global float *restrict termRadiance, __global float *restrict extremes
#define WEDGE_TERM_ARGUMENTS termPlanes(texture, value, plain, squares, textureSquares, termRadiance)

WEDGE_FN TermPlanes termPlanes(__global float* texture, __global float* value, __global float* plain, __global float* squares,
                               __global float* textureSquares, __global float* radiance)
{
    TermPlanes planes;
    planes.texture = texture;
    planes.value = value;
    planes.plain = plain;
    planes.squares = squares;
    planes.textureSquares = textureSquares;
    planes.radiance = radiance;
    return planes;
}

/// Mean unshadowed weights of a light's samples, diffuse and specular, over the receivers that took some, each as much as it
/// reflects: what textures of the others are made with. Returns false if none of them is known.
WEDGE_FN bool meanWeights(WaveParams wave, WavePixel p, uint total, __global const uint* objectId,
                          __global const float* diffuse, __global const float* specular, __global const float* sums,
                          float* weight, float* specularWeight)
{
    const uint size = wave.planeSize;
    float reflected = 0.0f, mirrored = 0.0f, known = 0.0f;
    *weight = *specularWeight = 0.0f;
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        const uint n = sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
        if (objectId[r] == 0u || n == 0u) {
            continue;
        }
        const float scale = 1.0f / (float)n, kd = luminance(loadVec(diffuse, size, r));
        known += 1.0f;
        reflected += kd;
        *weight += kd * scale * sums[r];
#ifdef WEDGE_SPECULAR
        const float ks = luminance(loadVec(specular, size, r));
        mirrored += ks;
        *specularWeight += ks * scale * sums[2u * size + r];
#else
        (void)specular;
#endif
    }
    *weight = reflected > 0.0f ? *weight / reflected : 0.0f;
    *specularWeight = mirrored > 0.0f ? *specularWeight / mirrored : 0.0f;
    return known > 0.0f;
}

/// The one extreme that widths are made with.
WEDGE_FN void storeExtreme(WaveParams wave, WavePixel p, uint pixels, __global float* plain, __global float* extremes, float x)
{
    if ((wave.omits & WEDGE_OMITS_ANALYSIS) != 0u) {
        return;
    }
    if (wave.packed != 0u) {
        storeShort(plain, pixels, p.i, 1u, x);
    } else {
        extremes[p.i] = x;
    }
}

/// One area light.
/// in      wave's planes: receivers, diffuse, specular, sums (as area_light.cl has them), slopes
///         exact: 1: unshadowed has the receivers' shading (wave_light.cl); 0: it is that of their samples
///         hits: the pixels' primary samples with a surface, before the wave
///         termTaken, termWanted: the pixels' samples of the light before and after the wave
/// in out  of pixels: texture (3), value (visibility, 3), plain (its luminance, unweighted), squares and textureSquares (mean
///         squared luminance of a primary sample's radiance, and of its texture), termRadiance (3, as published), extremes
///         (slopes, and shadows' motions), weightOf (mean luminance of the texture), samples (of all terms), termTaken
__kernel void accumulateLight(FrameParams frame, WaveParams wave, AreaLight light, uint exact,
                              __global const uint* restrict pixelFirst,
                              __global const uint* restrict pixelCount, __global const uint* restrict taken,
                              __global const uint* restrict hits, WEDGE_RECEIVER_PARAMETERS,
                              __global const float* restrict diffuse, __global const float* restrict specular,
                              __global const float* restrict sums, __global const float* restrict unshadowed,
                              __global const float* restrict slopes, WEDGE_TERM_PARAMETERS, __global float* restrict weightOf, __global uint* restrict samples)
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
    const uint total = newTermSamples(wave, termTaken[p.i], termWanted[p.i]);
    const bool measures = (wave.omits & WEDGE_OMITS_ANALYSIS) == 0u, all = (wave.omits & WEDGE_OMITS_EXTREMES) == 0u;
    // Packed, there is none before.
    float sMin = measures && wave.packed == 0u && extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY;
    float sMax = measures && all ? extremes[pixels + p.i] : 0.0f;
    float weight = 0.0f, specularWeight = 0.0f;
    const bool weighed = total < p.count && wave.published == 0u
        && meanWeights(wave, p, total, objectId, diffuse, specular, sums, &weight, &specularWeight);
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
            known = known && (n > 0u || weighed || exact != 0u);
            t = exact != 0u || n == 0u ? vecScale(kd, WEDGE_INV_PI * (exact != 0u ? unshadowed[r] : weight)) : sampled;
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
        for (uint plane = 2u; measures && plane < 6u; ++plane) {
            extremes[plane * pixels + p.i] += slopes[plane * size + r];
        }
#endif
        if (wave.published != 0u) {
            addSamples(&sum, l, seen, vec3(seen, seen, seen), vec3(1.0f, 1.0f, 1.0f));
        } else {
            addSamples(&sum, exact != 0u ? vecScale(t, seen) : l, seen, vecScale(l, (float)n), vecScale(sampled, (float)n));
        }
    }
    if (!known) {
        sum.texture = vec3(0.0f, 0.0f, 0.0f);
        sum.textureSquared = sum.textures = 0.0f;
    }
    const float plainWeight = (float)loadHits(hits, p.i, wave.packed);
    const Vec3 weights = wave.published != 0u ? vec3(plainWeight, plainWeight, plainWeight)
                                              : vecScale(loadColour(texture, pixels, p.i, wave.packed), (float)termTaken[p.i]);
    storeTermSums(wave, p, pixels, WEDGE_TERM_ARGUMENTS, termTaken[p.i], total, (float)loadHits(hits, p.i, wave.packed), weights, &sum);
    storeExtreme(wave, p, pixels, plain, extremes, sMin < INFINITY ? sMin : 0.0f);
    if (measures && all) {
        extremes[pixels + p.i] = sMax;
    }
    if ((wave.omits & WEDGE_OMITS_LAYERS) == 0u) {
        weightOf[p.i] = luminance(loadColour(texture, pixels, p.i, wave.packed));
        samples[p.i] += total;
        termTaken[p.i] += total;
    }
}

/// Point and directional lights: `lit`, the receivers' radiance from them.
__kernel void accumulateDelta(FrameParams frame, WaveParams wave, __global const uint* restrict pixelFirst,
                              __global const uint* restrict pixelCount, __global const uint* restrict taken,
                              __global const uint* restrict objectId, __global const float* restrict lit,
                              __global float* restrict delta)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    Vec3 radiance = vec3(0.0f, 0.0f, 0.0f);
    for (uint r = p.first; r < p.first + p.count; ++r) {
        radiance = objectId[r] != 0u ? vecAdd(radiance, loadVec(lit, wave.planeSize, r)) : radiance;
    }
    storeMean(delta, frame.planeSize, p.i, (float)p.before, radiance, (float)p.count);
}

/// One component of indirect light.
/// in      ambient: 1 for ambient occlusion: the irradiance is what is open of the hemisphere, the texture white
///         wave's planes: objectId, reflectance (3), sums, reflectors (as indirect.cl has them); hits, as of a light
/// in out  as of a light; extremes: reflectors of pixels, like those of receivers; indirectSamples
__kernel void accumulatePaths(FrameParams frame, WaveParams wave, uint ambient, __global const uint* restrict pixelFirst,
                              __global const uint* restrict pixelCount, __global const uint* restrict taken,
                              __global const uint* restrict hits, __global const uint* restrict objectId,
                              __global const float* restrict reflectance, __global const float* restrict sums,
                              __global const float* restrict reflectors, WEDGE_TERM_PARAMETERS,
                              __global uint* restrict samples, __global uint* restrict indirectSamples)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const uint size = wave.planeSize, pixels = frame.planeSize;
    const uint total = newTermSamples(wave, termTaken[p.i], termWanted[p.i]);
    const bool measures = (wave.omits & WEDGE_OMITS_ANALYSIS) == 0u, all = (wave.omits & WEDGE_OMITS_EXTREMES) == 0u;
    float nearest = measures && all && extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY;
    float farthest = measures && all ? extremes[pixels + p.i] : 0.0f;
    float inverse = measures && all ? extremes[2u * pixels + p.i] : measures && wave.packed == 0u ? extremes[p.i] : 0.0f;
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
        addSamples(&sum, vecMul(t, e), luminance(e), vecMul(weights, e), weights);
        nearest = reflectors[r] > 0.0f ? fmin(nearest, reflectors[r]) : nearest;
        farthest = fmax(farthest, reflectors[size + r]);
        inverse += reflectors[2u * size + r];
    }
    const float counted = wave.published != 0u ? (float)loadHits(hits, p.i, wave.packed)
        : p.before > 0u                        ? (float)loadHits(hits, p.i, wave.packed) / (float)p.before * (float)termTaken[p.i]
                                               : 0.0f;
    const Vec3 known = vecMad(vecScale(floors, counted), loadColour(texture, pixels, p.i, wave.packed), own * (float)termTaken[p.i]);
    storeTermSums(wave, p, pixels, WEDGE_TERM_ARGUMENTS, termTaken[p.i], total, (float)loadHits(hits, p.i, wave.packed), known, &sum);
    storeExtreme(wave, p, pixels, plain, extremes, all ? (nearest < INFINITY ? nearest : 0.0f) : inverse);
    if (measures && all) {
        extremes[pixels + p.i] = farthest;
        extremes[2u * pixels + p.i] = inverse;
    }
    if ((wave.omits & WEDGE_OMITS_LAYERS) == 0u) {
        samples[p.i] += total;
        indirectSamples[p.i] += total;
        termTaken[p.i] += total;
    }
}

/// Where and what the receivers are, and what they emit; closes the wave.
/// in      wave's planes: as wave_primary.cl fills them, rays, pathRays
/// in out  of pixels: means of position, normal, pixelSize, distance, gloss, diffuse, specular, emission, emissionSquares
///         (squared luminance); objectId (0:
///         no surface, WEDGE_MIXED: several objects); hits; confusion (planes: least and largest signed radius of
///         the circle of confusion, pixels); motion (planes: mean x, mean y, largest difference from the mean's start);
///         rays, pathRays; taken
__kernel void accumulateSurfaces(FrameParams frame, WaveParams wave, CameraParams camera,
                                 __global const uint* restrict pixelFirst, __global const uint* restrict pixelCount,
                                 __global const uint* restrict objectId, __global const float* restrict position,
                                 __global const float* restrict normal, __global const float* restrict gloss,
                                 __global const float* restrict diffuse, __global const float* restrict specular,
                                 __global const float* restrict emission, __global const float* restrict pixelSize,
                                 __global const float* restrict depth, __global const float* restrict motion,
                                 __global const uint* restrict rays, __global const uint* restrict pathRays,
                                 __global uint* restrict taken, __global uint* restrict hitsOf,
                                 __global uint* restrict objectOf, __global float* restrict positionOf,
                                 __global float* restrict normalOf, __global float* restrict glossOf,
                                 __global float* restrict diffuseOf, __global float* restrict specularOf,
                                 __global float* restrict emissionOf, __global float* restrict emissionSquaresOf,
                                 __global float* restrict pixelSizeOf,
                                 __global float* restrict distanceOf, __global float* restrict confusionOf,
                                 __global float* restrict motionOf, __global uint* restrict raysOf,
                                 __global uint* restrict pathRaysOf)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const uint size = wave.planeSize, pixels = frame.planeSize;
    const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
    Vec3 at = none, facing = none, kd = none, ks = none, emitted = none;
    float hit = 0.0f, exponent = 0.0f, edge = 0.0f, moveX = 0.0f, moveY = 0.0f, squared = 0.0f;
    const bool has = p.before > 0u && wave.packed == 0u;
    float low = has ? confusionOf[p.i] : INFINITY, high = has ? confusionOf[pixels + p.i] : -INFINITY;
    uint object = objectOf[p.i], traced = 0u, paths = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const Vec3 e = loadVec(emission, size, r);
        emitted = vecAdd(emitted, e);
        squared += luminance(e) * luminance(e);
        const float radius = camera.apertureRadius > 0.0f
            ? circleOfConfusion(camera.apertureRadius, camera.focusDistance, depth[r], camera.pixelStep)
            : 0.0f;
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
        kd = vecAdd(kd, loadVec(diffuse, size, r));
        ks = vecAdd(ks, loadVec(specular, size, r));
        exponent += gloss[r];
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
        const float had = p.before > 0u ? loadShort(confusionOf, pixels, p.i, 1u) : least;
        const float nearest = fabs(had) < fabs(least) ? had : least;
        storeShort(confusionOf, pixels, p.i, 1u, (had > 0.0f) == (least > 0.0f) && (had < 0.0f) == (least < 0.0f) ? nearest : 0.0f);
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
    storeVec(normalOf, pixels, p.i, vecNormalize(vecMad(facing, loadVec(normalOf, pixels, p.i), hits)));
    if (measures && wave.packed != 0u) {
        storeShort(pixelSizeOf, pixels, p.i, 0u, edge / hit);
        storeShort(pixelSizeOf, pixels, p.i, 1u, exponent / hit);
    } else if (measures) {
        glossOf[p.i] = meanWith(glossOf[p.i], hits, exponent, hit);
        pixelSizeOf[p.i] = meanWith(pixelSizeOf[p.i], hits, edge, hit);
    }
    if (layers) {
        distanceOf[p.i] = vecLength(vecSub(loadVec(positionOf, pixels, p.i), frame.eye));
    }
    if ((wave.omits & WEDGE_OMITS_MOTION) != 0u) {
        return;
    }
    const float meanX = meanWith(motionOf[p.i], hits, moveX, hit), meanY = meanWith(motionOf[pixels + p.i], hits, moveY, hit);
    float spread = motionOf[2u * pixels + p.i];
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const float dx = motion[r] - meanX, dy = motion[size + r] - meanY;
        spread = objectId[r] != 0u ? fmax(spread, sqrt(dx * dx + dy * dy)) : spread;
    }
    motionOf[p.i] = meanX;
    motionOf[pixels + p.i] = meanY;
    motionOf[2u * pixels + p.i] = spread;
}
