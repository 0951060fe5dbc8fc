// What a pixel keeps of a term, and how a wave's receivers are added to it (accumulate.cl).
//
// Of each term a pixel keeps the mean texture k (reflectance; of lights times the unshadowed shading) of all receivers,
// and of those that took samples of the term the mean irradiance E (of lights: visibility), each channel weighted by
// the texture and by the samples, so that their product is the radiance of the term, and neither holds what belongs to
// the other; besides, the plain mean of E's luminance, by which thesis (5.30) judges whether texture and irradiance may
// be taken apart. As published (wave.published) E is the plain mean, that of lights holds the light's form factor
// (5.14), k the lobe towards its centre (5.20), and the term's radiance L is kept apart.
//
// Compact frames keep it in fewer bits (core/formats.h), and the standard deviations of a primary sample's radiance and
// of its texture in place of mean squares, whose differences would be lost in these. Lean frames, those of one image,
// keep nothing that only further steps would ask for: their first wave alone measures, they have the factoring error
// (errorOfFactoring()) in place of the plain mean, and a mean motion is infinite where the pixel's motions differ.
#ifndef WEDGE_ACCUMULATE_H
#define WEDGE_ACCUMULATE_H

#include "core/formats.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/wave.h"

/// Least texture with which an irradiance counts: black surfaces have one, too.
#define WEDGE_LEAST_TEXTURE 1e-6f

/// A pixel and its receivers in the wave.
typedef struct {
    uint i; ///< in planes of pixels
    uint slot; ///< in planes of the wave's pixels
    uint first, count; ///< receivers
    uint before; ///< primary samples that its means hold already
} WavePixel;

WEDGE_FN bool wavePixel(FrameParams frame, WaveParams wave, __global const uint* pixelFirst,
    __global const uint* pixelCount, __global const uint* taken, WavePixel* p)
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

WEDGE_FN Vec3 meanVec(Vec3 mean, float before, Vec3 sum, float count)
{
    return vec3(meanWith(mean.x, before, sum.x, count), meanWith(mean.y, before, sum.y, count),
        meanWith(mean.z, before, sum.z, count));
}

/// Radiances, and their squared luminances.
typedef struct {
    Vec3 radiance;
    float squared;
} RadianceSums;

WEDGE_FN RadianceSums noRadiance(void)
{
    RadianceSums s;
    s.radiance = vec3(0.0f, 0.0f, 0.0f);
    s.squared = 0.0f;
    return s;
}

WEDGE_FN void addRadiance(RadianceSums* s, Vec3 l)
{
    s->radiance = vecAdd(s->radiance, l);
    s->squared += luminance(l) * luminance(l);
}

/// What a pixel's new receivers add to one term.
typedef struct {
    Vec3 texture;
    float textureSquared, textures; ///< textures: receivers whose texture is known, misses included
    Vec3 radiance;
    Vec3 weighted, weights; ///< irradiance times its weight, and the weights
    float plain, counted; ///< luminances of irradiances, and how many
    float squared;
    float early, earlyWeights; ///< luminances of weighted and weights, of the first half of the samples
    float lateWeights; ///< of the others
} TermSums;

WEDGE_FN TermSums noTermSums(float textures)
{
    TermSums s;
    s.radiance = s.texture = s.weighted = s.weights = vec3(0.0f, 0.0f, 0.0f);
    s.plain = s.counted = s.squared = s.textureSquared = s.early = s.earlyWeights = s.lateWeights = 0.0f;
    s.textures = textures;
    return s;
}

/// What a receiver has of a term: its texture, and what its samples found, if it took some.
typedef struct {
    Vec3 texture;
    Vec3 radiance; ///< irradiance times texture
    float irradiance; ///< luminance
    Vec3 weighted, weights; ///< irradiance times its weight, and the weight
} ReceiverTerm;

/// Samples of a term that a pixel's receiver number k takes, of `total` in the wave.
WEDGE_FN uint samplesOfReceiver(WavePixel p, uint k, uint total)
{
    return sharedSamples(k + 1u, p.count, total) - sharedSamples(k, p.count, total);
}

WEDGE_FN void addTexture(TermSums* s, Vec3 texture)
{
    s->texture = vecAdd(s->texture, texture);
    s->textureSquared += luminance(texture) * luminance(texture);
}

/// Adds a pixel's receiver number k. total: the pixel's samples in the wave
WEDGE_FN void addReceiver(TermSums* s, WavePixel p, uint k, uint total, ReceiverTerm t)
{
    addTexture(s, t.texture);
    if (samplesOfReceiver(p, k, total) == 0u) {
        return;
    }
    const bool early = 2u * sharedSamples(k, p.count, total) < total;
    s->early += early ? luminance(t.weighted) : 0.0f;
    s->earlyWeights += early ? luminance(t.weights) : 0.0f;
    s->lateWeights += early ? 0.0f : luminance(t.weights);
    s->radiance = vecAdd(s->radiance, t.radiance);
    s->weighted = vecAdd(s->weighted, t.weighted);
    s->weights = vecAdd(s->weights, t.weights);
    s->plain += t.irradiance;
    s->counted += 1.0f;
    s->squared += luminance(t.radiance) * luminance(t.radiance);
}

/// Texture that some receivers do not know counts for none.
WEDGE_FN void dropTexture(TermSums* s)
{
    s->texture = vec3(0.0f, 0.0f, 0.0f);
    s->textureSquared = s->textures = 0.0f;
}

/// What pixels keep of a term, by the names of its planes; those that there are none of are of no use.
typedef struct {
    Vec3 texture, value;
    Vec3 radiance; ///< of the term alone, as published
    float deviation;
    float plain, squares, textureSquares;
    float error; ///< of lean frames
    float2 spreads; ///< standard deviations of the radiance and of the texture, of compact frames
} TermMeans;

WEDGE_FN float weightedMean(float mean, float known, float weighted, float weights)
{
    return known + weights > 0.0f ? (mean * known + weighted) / (known + weights) : 0.0f;
}

/// What compact frames keep of measures, and back.
WEDGE_FN void recallSquares(TermMeans* m)
{
    const float mean = luminance(vecMul(m->texture, m->value)), texture = luminance(m->texture);
    m->squares = m->spreads.x * m->spreads.x + mean * mean;
    m->textureSquares = m->spreads.y * m->spreads.y + texture * texture;
}

WEDGE_FN void compactMeasures(TermMeans* m)
{
    const float mean = luminance(vecMul(m->texture, m->value)), texture = luminance(m->texture);
    m->spreads =
        (float2)(sqrt(fmax(m->squares - mean * mean, 0.0f)), sqrt(fmax(m->textureSquares - texture * texture, 0.0f)));
}

/// The signed luminance of L - k E with plain means k and E (thesis 5.30).
WEDGE_FN float errorOfFactoring(Vec3 texture, Vec3 value, float plain)
{
    return luminance(vecMul(texture, value)) - luminance(texture) * plain;
}

/// A number whose square is, in the mean, the variance of a pixel's mean value, in luminance, as deviation16() of
/// deviation.h has it for pixels of one receiver: the sum of all waves' differences between the first half of their
/// samples and the second, over the weights of all. Each wave's mean is taken out, so that halves of different weights
/// do not count for noise. Of a wave that has but one half, a single sample, the difference from what is known already:
/// were it left out, a rare bright path there would count for none of the noise that it makes.
/// deviation: before the wave. known, before: weights and mean value then, luminances
WEDGE_FN float deviationWith(float deviation, float known, float before, const TermSums* s)
{
    const float weights = luminance(s->weights), all = luminance(s->weighted);
    const float mean = weights > 0.0f ? all / weights : 0.0f;
    const bool whole = s->earlyWeights == 0.0f || s->lateWeights == 0.0f;
    const float apart = whole ? sqrt(known / fmax(known + weights, 1e-30f)) * (all - weights * before)
                              : 2.0f * (s->early - mean * s->earlyWeights);
    return weightedMean(deviation, known, apart, weights);
}

/// Adds a wave's receivers to what is kept. taken: samples of the term before the wave, total: in it; hits: receivers
/// with a surface before; known: what the mean value weighs so far.
WEDGE_FN void addTermSums(TermMeans* m, WavePixel p, uint taken, uint total, float hits, Vec3 known, const TermSums* s)
{
    const float before = (float)p.before;
    // Receivers that took samples, misses included: samples are shared evenly.
    const float had = (float)min(taken, p.before), have = (float)min(total, p.count);
    const float weight = luminance(known);
    m->deviation =
        deviationWith(m->deviation, weight, weight > 0.0f ? luminance(vecMul(m->value, known)) / weight : 0.0f, s);
    m->value = vec3(weightedMean(m->value.x, known.x, s->weighted.x, s->weights.x),
        weightedMean(m->value.y, known.y, s->weighted.y, s->weights.y),
        weightedMean(m->value.z, known.z, s->weighted.z, s->weights.z));
    m->texture = meanVec(m->texture, before, s->texture, s->textures);
    m->textureSquares = meanWith(m->textureSquares, before, s->textureSquared, s->textures);
    m->plain = meanWith(m->plain, p.before > 0u ? hits * had / before : 0.0f, s->plain, s->counted);
    m->squares = meanWith(m->squares, had, s->squared, have);
    m->radiance = meanVec(m->radiance, had, s->radiance, have);
    m->error = errorOfFactoring(m->texture, m->value, m->plain);
    compactMeasures(m);
}

/// Samples of a term that the wave takes for a pixel that has `before` and wants `wanted` of them.
WEDGE_FN uint newTermSamples(WaveParams wave, uint before, uint wanted)
{
    return max(wantedSamples(wave, wanted), before) - before;
}

/// A mean motion as lean frames keep it. differing: length of a difference between the mean and what it is made of.
WEDGE_FN float2 oneMotion(WaveParams wave, float x, float y, float differing)
{
    const bool one = differing <= wave.oneVelocity * sqrt(x * x + y * y);
    return (float2)(one ? x : INFINITY, one ? y : 0.0f);
}

#endif
