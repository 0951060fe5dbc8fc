// What filters of samples leave of a pixel's stored samples (sinks/band_samples.h): the sums that its term would have
// without any filter, of the samples that are kept, each as far as it is; and what the pixel loses by it.
#ifndef WEDGE_FILTER_KEPT_H
#define WEDGE_FILTER_KEPT_H

#include "core/packed_planes.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/sample_filter.h"
#include "sinks/stored_samples.h"

/// Weights whose sum is less have all but nothing kept.
#define WEDGE_LEAST_KEPT 1e-3f

/// The pixel of an item of a pass over a band's, and the end of those beyond it and of those without samples, `count`.
#define WEDGE_KEPT_PIXEL(p, x, y, i, count)                                                                            \
    const uint item = (uint)get_global_id(0), across = (p).x1 - (p).x0;                                                \
    if (across == 0u || item / across >= (p).y1 - (p).y0) {                                                            \
        return;                                                                                                        \
    }                                                                                                                  \
    const uint x = (p).x0 + item % across, y = (p).y0 + item / across, i = pixelIndex(x, y, (p).stride);               \
    const uint count = drawn[i];                                                                                       \
    (void)x, (void)y;                                                                                                  \
    if (count == 0u) {                                                                                                 \
        return;                                                                                                        \
    }

/// A pixel's samples, while they are weighed one after the other.
typedef struct {
    float sum[4]; ///< R, G, B, squared luminance, times their weights
    float all[3]; ///< R, G, B without
    float part[3]; ///< of the first of two parts (firstPart()), times their weights
    float weight, partWeight; ///< their sums
    uint count, partCount; ///< samples; those that are no numbers are left out
} Kept;

WEDGE_FN Kept nothingKept(void)
{
    Kept kept;
    for (uint k = 0u; k < 4u; ++k) {
        kept.sum[k] = 0.0f;
    }
    for (uint k = 0u; k < 3u; ++k) {
        kept.all[k] = kept.part[k] = 0.0f;
    }
    kept.weight = kept.partWeight = 0.0f;
    kept.count = kept.partCount = 0u;
    return kept;
}

/// Adds a sample, which counts `weight`. Of weights of 1 the sums are those of no filter, to the bit.
WEDGE_INLINE void keepSample(Kept* kept, Vec3 radiance, float weight, bool ofPart)
{
    if (!finiteVec(radiance)) {
        return;
    }
    const float l = luminance(radiance);
    kept->sum[0] += weight * radiance.x;
    kept->sum[1] += weight * radiance.y;
    kept->sum[2] += weight * radiance.z;
    kept->sum[3] += weight * (l * l);
    kept->all[0] += radiance.x;
    kept->all[1] += radiance.y;
    kept->all[2] += radiance.z;
    kept->weight += weight;
    kept->count += 1u;
    if (ofPart) {
        kept->part[0] += weight * radiance.x;
        kept->part[1] += weight * radiance.y;
        kept->part[2] += weight * radiance.z;
        kept->partWeight += weight;
        kept->partCount += 1u;
    }
}

/// The sample alone, of a pixel whose others are left out.
WEDGE_FN void keepOnly(Kept* kept, Vec3 radiance)
{
    const float l = luminance(radiance);
    kept->sum[0] = kept->part[0] = radiance.x;
    kept->sum[1] = kept->part[1] = radiance.y;
    kept->sum[2] = kept->part[2] = radiance.z;
    kept->sum[3] = l * l;
    kept->weight = kept->partWeight = 1.0f;
}

/// Stores what is kept as if it were all of a pixel's samples.
/// out  sums: R, G, B, squared luminance, of as many samples as were taken; excess: what their mean loses
///      (3 planes); parts: the mean of the first part (colours in 48 bits); null: none
WEDGE_INLINE void storeKept(const Kept* kept, uint size, uint i, uint taken, __global float* sums,
    __global float* excess, __global float* parts)
{
    const float n = (float)taken;
    const bool whole = kept->weight == n;
    const float scale = whole ? 1.0f : kept->weight > 0.0f ? n / kept->weight : 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        sums[k * size + i] = kept->sum[k] * scale;
    }
    const float perSample = kept->count > 0u ? 1.0f / (float)kept->count : 0.0f, perTaken = 1.0f / n;
    for (uint k = 0u; k < 3u; ++k) {
        // Of weights of 1 exactly nothing.
        excess[k * size + i] = whole ? (kept->all[k] - kept->sum[k]) * perTaken
                                     : kept->all[k] * perSample - kept->sum[k] * scale * perTaken;
    }
    if (parts != 0) {
        // Of a part of which nothing is left nothing is known: it is taken for the mean.
        const bool known = kept->partWeight > WEDGE_LEAST_KEPT;
        const float ofPart = known ? 1.0f / kept->partWeight : 0.0f;
        Vec3 mean = vec3(kept->sum[0], kept->sum[1], kept->sum[2]);
        mean = vecScale(mean, scale * perTaken);
        const Vec3 first = vec3(kept->part[0] * ofPart, kept->part[1] * ofPart, kept->part[2] * ofPart);
        storeColour(parts, size, i, vecChoose(known, first, mean));
    }
}

#endif
