// Samples of a pixel by their brightness, for filters of samples where there is no memory for each: of each bin how
// many there are, their mean, and what one weighs in the pixel's mean. Memory is the same however many samples come,
// and in whatever steps.
#ifndef WEDGE_SAMPLE_BINS_H
#define WEDGE_SAMPLE_BINS_H

#include "shared/lab.h"
#include "shared/packed.h"
#include "shared/rng.h"
#include "shared/sample_filter.h"
#include "sinks/stored_samples.h"

/// Largest count that 16 bits hold. Of pixels with more, all bins have half of what they had.
#define WEDGE_MOST_IN_BIN 65535u

/// Ends of bins but the last, which has none: L* of exposed radiance in pixels (WEDGE_LAB_PIXEL). They grow wider,
/// since what is much brighter than all else is as far from it as can be (WEDGE_SAMPLE_REACH) wherever it is.
__constant float sampleBinEnds[WEDGE_SAMPLE_BINS - 1] = { 0.75f, 1.75f, 3.0f, 4.75f, 7.5f, 12.0f, 20.0f };

WEDGE_FN uint sampleBinOf(float lightness)
{
    uint bin = 0u;
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS - 1u; ++b) {
        bin += lightness >= sampleBinEnds[b] ? 1u : 0u;
    }
    return bin;
}

typedef struct {
    Vec3 mean; ///< radiance, weighted
    float weight; ///< of one sample, their mean
    uint count;
} SampleBin;

/// Weights in 16 bits, from 2^-20 to below 2^12, of 12 digits. up: from 0 to 1, what is added to the last of them
/// before the rest is cut off; 0.5 rounds.
WEDGE_FN uint packWeight(float weight, float up)
{
    return ((as_uint(clamp(weight, 0x1p-20f, 0x1.ffcp+11f)) + (uint)(up * 4095.0f)) >> 12) - (107u << 11);
}

WEDGE_FN float unpackWeight(uint packed) { return as_float((packed + (107u << 11)) << 12); }

/// A channel of a colour whose last digit (shared/packed.h) is worth `digit`, so that packColour() rounds it up as
/// often as it is above. up: from 0 to 1
WEDGE_FN float dithered(float channel, float digit, float up) { return channel + (up - 0.5f) * digit; }

/// A pixel's bin: in planes, the mean (PackedColour, in three parts), the weight and the count, one bin after the
/// other.
WEDGE_FN SampleBin loadSampleBin(__global const ushort* bins, uint size, uint i, uint bin)
{
    __global const ushort* first = bins + (size_t)bin * WEDGE_BIN_NUMBERS * size + i;
    PackedColour mean;
    mean.low = first[0] | (uint)first[size] << 16;
    mean.high = first[2u * (size_t)size];
    SampleBin b;
    b.mean = unpackColour(mean);
    b.weight = unpackWeight(first[3u * (size_t)size]);
    b.count = first[4u * (size_t)size];
    return b;
}

/// Means are made wave by wave. Were they rounded to the nearest number, the last steps of many would be lost, but for
/// those of the brightest samples: so they are rounded up or down by chance.
WEDGE_FN void storeSampleBin(__global ushort* bins, uint size, uint i, uint bin, SampleBin b)
{
    __global ushort* first = bins + (size_t)bin * WEDGE_BIN_NUMBERS * size + i;
    const uint hash = hashCombine(hashCombine(i, bin), b.count);
    const float largest = fmax(b.mean.x, fmax(b.mean.y, b.mean.z));
    const uint exponent = as_uint(largest) >> 23;
    const float digit = exponent > 12u ? as_float((exponent - 12u) << 23) : 0.0f;
    const PackedColour mean = packColour(vec3(dithered(b.mean.x, digit, toUnitFloat(hash)),
        dithered(b.mean.y, digit, toUnitFloat(hash * 3u)), dithered(b.mean.z, digit, toUnitFloat(hash * 5u))));
    first[0] = (ushort)mean.low;
    first[size] = (ushort)(mean.low >> 16);
    first[2u * (size_t)size] = (ushort)mean.high;
    first[3u * (size_t)size] = (ushort)packWeight(b.weight, toUnitFloat(hash * 7u));
    first[4u * (size_t)size] = (ushort)b.count;
}

/// Bins of a pixel while samples are added to them: those that have been touched, as numbers.
typedef struct {
    SampleBin bin[WEDGE_SAMPLE_BINS];
    uint touched; ///< a bit of each
} OpenBins;

/// Adds a sample, a number, to its pixel's bins. weight: above 0
WEDGE_FN void binSample(__global const ushort* bins, uint size, uint i, __global const float* exposure, Vec3 radiance,
    float weight, OpenBins* open)
{
    const float lightness = labOf(vecScale(radiance, exposure[0])).x * (1.0f / WEDGE_LAB_PIXEL);
    const uint which = sampleBinOf(lightness);
    SampleBin b = (open->touched >> which & 1u) != 0u ? open->bin[which] : loadSampleBin(bins, size, i, which);
    const float weights = b.weight * (float)b.count, all = weights + weight;
    b.mean = vecAdd(vecScale(b.mean, weights / all), vecScale(radiance, weight / all));
    b.count += 1u;
    b.weight = all / (float)b.count;
    open->bin[which] = b;
    open->touched |= 1u << which;
}

/// Stores what has been touched. Where a count has no room in 16 bits all bins have half of what they had, so that each
/// has the share of all that it had: odd numbers are rounded up or down by chance.
WEDGE_FN void closeBins(__global ushort* bins, uint size, uint i, OpenBins* open)
{
    uint most = 0u;
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        most = (open->touched >> b & 1u) != 0u ? max(most, open->bin[b].count) : most;
    }
    for (; most > WEDGE_MOST_IN_BIN; most = (most + 1u) / 2u) {
        for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
            if ((open->touched >> b & 1u) == 0u) {
                open->bin[b] = loadSampleBin(bins, size, i, b);
            }
            const uint hash = hashCombine(i, as_uint(open->bin[b].mean.x) & 0x7fffffu);
            open->bin[b].count = (open->bin[b].count + (hash & 1u)) / 2u;
        }
        open->touched = (1u << WEDGE_SAMPLE_BINS) - 1u;
    }
    for (uint b = 0u; b < WEDGE_SAMPLE_BINS; ++b) {
        if ((open->touched >> b & 1u) != 0u) {
            storeSampleBin(bins, size, i, b, open->bin[b]);
        }
    }
}

#endif
