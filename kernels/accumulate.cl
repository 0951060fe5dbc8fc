// From a wave's receivers to its pixels. Planes of pixels hold means over the primary samples taken so far; each kernel
// here adds a pixel's new receivers, which lie together in the wave. Samples that hit nothing count as black in radiance
// and in textures, and not at all in irradiances, positions and normals.
//
// Of each term a pixel keeps the mean texture k (reflectance; of lights times the unshadowed shading) and the mean
// irradiance E (of lights: visibility) weighted by the texture, so that their product is the radiance of the term, and
// neither holds what belongs to the other; besides, the plain mean of E's luminance, by which thesis (5.30) judges
// whether texture and irradiance may be taken apart. As published (wave.published) E is the plain mean, that of lights holds
// the light's form factor (5.14), k the lobe towards its centre (5.20), and the term's radiance L is kept apart.
#include "light_sample.h"
#include "shared/bsdf.h"
#include "shared/camera.h"
#include "shared/defocus.h"
#include "shared/wave.h"

/// Least texture with which an irradiance counts: black surfaces have one, too.
#define WEDGE_LEAST_TEXTURE 1e-3f

/// A pixel and its receivers in the wave.
typedef struct {
    uint i;            ///< in planes of pixels
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

/// Adds a term's radiance to the mean of all of its kind. starts: it is the first term, and the mean is that of the samples
/// before.
WEDGE_FN void storeRadiance(__global float* planes, uint size, WavePixel p, Vec3 sum, uint starts)
{
    const float total = (float)(p.before + p.count);
    const float kept = starts != 0u ? (float)p.before / total : 1.0f;
    storeVec(planes, size, p.i, vecMad(vecScale(loadVec(planes, size, p.i), kept), sum, 1.0f / total));
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
    Vec3 radiance, texture;
    Vec3 weighted, weights; ///< irradiance times its weight, and the weights
    float plain, counted;   ///< luminances of irradiances, and how many
    float squared, textureSquared;
} TermSums;

WEDGE_FN TermSums noTermSums()
{
    TermSums s;
    s.radiance = s.texture = s.weighted = s.weights = vec3(0.0f, 0.0f, 0.0f);
    s.plain = s.counted = s.squared = s.textureSquared = 0.0f;
    return s;
}

/// Adds a receiver of texture t, irradiance e of weight w, and radiance l.
WEDGE_FN void addReceiver(TermSums* s, Vec3 t, Vec3 e, Vec3 w, Vec3 l)
{
    s->radiance = vecAdd(s->radiance, l);
    s->texture = vecAdd(s->texture, t);
    s->weighted = vecAdd(s->weighted, vecMul(w, e));
    s->weights = vecAdd(s->weights, w);
    s->plain += luminance(e);
    s->counted += 1.0f;
    s->squared += luminance(l) * luminance(l);
    s->textureSquared += luminance(t) * luminance(t);
}

/// The planes of pixels that terms keep.
typedef struct {
    __global float *texture, *value, *plain, *squares, *textureSquares;
    __global float* radiance; ///< of the term alone, as published
} TermPlanes;

/// known: what the mean value weighs so far; hits: receivers with irradiance so far; values: planes of value, 1 or 3.
WEDGE_FN void storeTermSums(WaveParams wave, WavePixel p, uint pixels, TermPlanes planes, uint values, Vec3 known, float hits,
                            const TermSums* s)
{
    const float before = (float)p.before, count = (float)p.count;
    const Vec3 weights = vecAdd(known, s->weights);
    planes.value[p.i] = weights.x > 0.0f ? (planes.value[p.i] * known.x + s->weighted.x) / weights.x : 0.0f;
    if (values == 3u) {
        const uint g = pixels + p.i, b = 2u * pixels + p.i;
        planes.value[g] = weights.y > 0.0f ? (planes.value[g] * known.y + s->weighted.y) / weights.y : 0.0f;
        planes.value[b] = weights.z > 0.0f ? (planes.value[b] * known.z + s->weighted.z) / weights.z : 0.0f;
    }
    storeMean(planes.texture, pixels, p.i, before, s->texture, count);
    planes.plain[p.i] = s->counted > 0.0f ? meanWith(planes.plain[p.i], hits, s->plain, s->counted) : planes.plain[p.i];
    planes.squares[p.i] = meanWith(planes.squares[p.i], before, s->squared, count);
    planes.textureSquares[p.i] = meanWith(planes.textureSquares[p.i], before, s->textureSquared, count);
    if (wave.published != 0u) {
        storeMean(planes.radiance, pixels, p.i, before, s->radiance, count);
    }
}

/// Samples of a term that the wave takes for a pixel.
WEDGE_FN uint newTermSamples(WaveParams wave, uint taken, uint wanted) { return max(min(wanted, wave.lastSample), taken) - taken; }

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

/// One area light.
/// in      wave's planes: receivers, diffuse, specular, sums (as area_light.cl has them), slopes
///         hits: the pixels' primary samples with a surface, before the wave
///         termTaken, termWanted: the pixels' samples of the light before and after the wave
/// in out  of pixels: direct (radiance, 3), texture (3), value (visibility), plain (the same, unweighted), squares and
///         textureSquares (mean squared luminance of a primary sample's radiance, and of its texture), termRadiance (3, as
///         published), extremes (slopes, and shadows' motions), weightOf (mean luminance of the texture), samples (of all terms), termTaken
__kernel void accumulateLight(FrameParams frame, WaveParams wave, AreaLight light, uint starts,
                              __global const uint* restrict pixelFirst, __global const uint* restrict pixelCount,
                              __global const uint* restrict taken, __global const uint* restrict hits,
                              WEDGE_RECEIVER_PARAMETERS, __global const float* restrict diffuse,
                              __global const float* restrict specular, __global const float* restrict sums,
                              __global const float* restrict slopes, WEDGE_TERM_PARAMETERS,
                              __global float* restrict weightOf, __global float* restrict direct,
                              __global uint* restrict samples)
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
    float sMin = extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY, sMax = extremes[pixels + p.i];
    TermSums sum = noTermSums();
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        const uint n = sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
        if (objectId[r] == 0u || n == 0u) {
            continue;
        }
        const float scale = 1.0f / (float)n;
        const Vec3 kd = loadVec(diffuse, size, r), ks = loadVec(specular, size, r);
        sMin = slopes[r] > 0.0f ? fmin(sMin, slopes[r]) : sMin;
        sMax = fmax(sMax, slopes[size + r]);
#ifdef WEDGE_MOTION
        for (uint plane = 2u; plane < 6u; ++plane) {
            extremes[plane * pixels + p.i] += slopes[plane * size + r];
        }
#endif
        Vec3 t, w = vec3(1.0f, 1.0f, 1.0f);
        float seen;
        if (wave.published != 0u) {
            publishedReceiver(receivers, data, light, r, kd, ks, sums[size + r] * scale, &t, &seen);
            addReceiver(&sum, t, vec3(seen, seen, seen), w, vecScale(t, seen));
            continue;
        }
        t = vecScale(kd, WEDGE_INV_PI * scale * sums[r]);
        Vec3 l = vecScale(kd, WEDGE_INV_PI * scale * sums[size + r]);
#ifdef WEDGE_SPECULAR
        t = vecMad(t, ks, scale * sums[2u * size + r]);
        l = vecMad(l, ks, scale * sums[3u * size + r]);
#endif
        t = vecMul(t, light.power);
        l = vecMul(l, light.power);
        const float weight = luminance(t);
        seen = weight > 0.0f ? luminance(l) / weight : 0.0f;
        addReceiver(&sum, t, vec3(seen, seen, seen), vec3(weight, weight, weight), l);
    }
    const float known = wave.published != 0u ? (float)hits[p.i] : luminance(loadVec(texture, pixels, p.i)) * (float)p.before;
    storeTermSums(wave, p, pixels, WEDGE_TERM_ARGUMENTS, 1u, vec3(known, known, known), (float)hits[p.i], &sum);
    storeRadiance(direct, pixels, p, sum.radiance, starts);
    weightOf[p.i] = luminance(loadVec(texture, pixels, p.i));
    extremes[p.i] = sMin < INFINITY ? sMin : 0.0f;
    extremes[pixels + p.i] = sMax;
    samples[p.i] += total;
    termTaken[p.i] += total;
}

/// Point and directional lights: `lit`, the receivers' radiance from them.
__kernel void accumulateDelta(FrameParams frame, WaveParams wave, uint starts, __global const uint* restrict pixelFirst,
                              __global const uint* restrict pixelCount, __global const uint* restrict taken,
                              __global const uint* restrict objectId, __global const float* restrict lit,
                              __global float* restrict direct)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    Vec3 radiance = vec3(0.0f, 0.0f, 0.0f);
    for (uint r = p.first; r < p.first + p.count; ++r) {
        radiance = objectId[r] != 0u ? vecAdd(radiance, loadVec(lit, wave.planeSize, r)) : radiance;
    }
    storeRadiance(direct, frame.planeSize, p, radiance, starts);
}

/// One component of indirect light.
/// in      ambient: 1 for ambient occlusion: the irradiance is what is open of the hemisphere, the texture white
///         wave's planes: objectId, reflectance (3), sums, reflectors (as indirect.cl has them); hits, as of a light
/// in out  as of a light: value has 3 planes; extremes: reflectors of pixels, like those of receivers; indirectSamples
__kernel void accumulatePaths(FrameParams frame, WaveParams wave, uint starts, uint ambient, __global const uint* restrict pixelFirst,
                              __global const uint* restrict pixelCount, __global const uint* restrict taken,
                              __global const uint* restrict hits, __global const uint* restrict objectId,
                              __global const float* restrict reflectance, __global const float* restrict sums,
                              __global const float* restrict reflectors, WEDGE_TERM_PARAMETERS,
                              __global float* restrict indirect, __global uint* restrict samples,
                              __global uint* restrict indirectSamples)
{
    WavePixel p;
    if (!wavePixel(frame, wave, pixelFirst, pixelCount, taken, &p)) {
        return;
    }
    const uint size = wave.planeSize, pixels = frame.planeSize;
    const uint total = newTermSamples(wave, termTaken[p.i], termWanted[p.i]);
    float nearest = extremes[p.i] > 0.0f ? extremes[p.i] : INFINITY, farthest = extremes[pixels + p.i];
    float inverse = extremes[2u * pixels + p.i];
    const float floor = wave.published != 0u ? 1.0f : WEDGE_LEAST_TEXTURE, own = wave.published != 0u ? 0.0f : 1.0f;
    const Vec3 floors = vec3(floor, floor, floor);
    TermSums sum = noTermSums();
    for (uint k = 0u; k < p.count; ++k) {
        const uint r = p.first + k;
        const uint n = sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
        if (objectId[r] == 0u || n == 0u) {
            continue;
        }
        const Vec3 mean = vecScale(loadVec(sums, size, r), 1.0f / (float)n), white = vec3(1.0f, 1.0f, 1.0f);
        const Vec3 e = ambient != 0u ? vecSub(white, mean) : mean;
        const Vec3 t = ambient != 0u ? white : loadVec(reflectance, size, r);
        addReceiver(&sum, t, e, vecMad(floors, t, own), vecMul(t, e));
        nearest = reflectors[r] > 0.0f ? fmin(nearest, reflectors[r]) : nearest;
        farthest = fmax(farthest, reflectors[size + r]);
        inverse += reflectors[2u * size + r];
    }
    const float counted = (float)hits[p.i];
    const Vec3 known = vecMad(vecScale(floors, counted), loadVec(texture, pixels, p.i), own * (float)p.before);
    storeTermSums(wave, p, pixels, WEDGE_TERM_ARGUMENTS, 3u, known, counted, &sum);
    storeRadiance(indirect, pixels, p, sum.radiance, starts);
    extremes[p.i] = nearest < INFINITY ? nearest : 0.0f;
    extremes[pixels + p.i] = farthest;
    extremes[2u * pixels + p.i] = inverse;
    samples[p.i] += total;
    indirectSamples[p.i] += total;
    termTaken[p.i] += total;
}

/// Where and what the receivers are, and what they emit; closes the wave.
/// in      wave's planes: as wave_primary.cl fills them, rays, pathRays
/// in out  of pixels: means of position, normal, pixelSize, distance, gloss, diffuse, specular, emission; objectId (0:
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
                                 __global float* restrict emissionOf, __global float* restrict pixelSizeOf,
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
    float hit = 0.0f, exponent = 0.0f, edge = 0.0f, moveX = 0.0f, moveY = 0.0f;
    float low = p.before > 0u ? confusionOf[p.i] : INFINITY, high = p.before > 0u ? confusionOf[pixels + p.i] : -INFINITY;
    uint object = objectOf[p.i], traced = 0u, paths = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        emitted = vecAdd(emitted, loadVec(emission, size, r));
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
    const float before = (float)p.before, count = (float)p.count, hits = (float)hitsOf[p.i];
    storeMean(emissionOf, pixels, p.i, before, emitted, count);
    storeMean(diffuseOf, pixels, p.i, before, kd, count);
    storeMean(specularOf, pixels, p.i, before, ks, count);
    taken[p.i] = p.before + p.count;
    confusionOf[p.i] = low;
    confusionOf[pixels + p.i] = high;
    raysOf[p.i] += traced;
    pathRaysOf[p.i] += paths;
    if (hit == 0.0f) {
        // Misses, or a light that is seen.
        distanceOf[p.i] = hits > 0.0f ? distanceOf[p.i] : depth[p.first];
        return;
    }
    hitsOf[p.i] += (uint)hit;
    objectOf[p.i] = object;
    storeMean(positionOf, pixels, p.i, hits, at, hit);
    storeVec(normalOf, pixels, p.i, vecNormalize(vecMad(facing, loadVec(normalOf, pixels, p.i), hits)));
    glossOf[p.i] = meanWith(glossOf[p.i], hits, exponent, hit);
    pixelSizeOf[p.i] = meanWith(pixelSizeOf[p.i], hits, edge, hit);
    distanceOf[p.i] = vecLength(vecSub(loadVec(positionOf, pixels, p.i), frame.eye));
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
