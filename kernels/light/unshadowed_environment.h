// What would light a surface from beyond the scene if nothing hid it, by the surface's direction.
#ifndef WEDGE_UNSHADOWED_ENVIRONMENT_H
#define WEDGE_UNSHADOWED_ENVIRONMENT_H

#include "core/vector16.h"
#include "light/environment_map.h"
#include "shared/bsdf.h"
#include "shared/material.h"

/// Least of what samples are divided by: harmonics of a small sun go below 0.
#define WEDGE_LEAST_UNSHADOWED 0.0625f

WEDGE_INLINE float16 ofHarmonics(__global const float* c, Vec3x16 n, float least)
{
    const float16 value = c[0] + c[1] * n.x + c[2] * n.y + c[3] * n.z + c[4] * n.x * n.y + c[5] * n.y * n.z
        + c[6] * n.z * n.x + c[7] * (3.0f * n.z * n.z - 1.0f) + c[8] * (n.x * n.x - n.y * n.y);
    return min16(max16(value, (float16)(least)), (float16)(1.0f));
}

/// Irradiance of surfaces of unit normals n over the largest that any normal has, red, green and blue: from
/// `least` to 1, smooth, by spherical harmonics of up to the second order (Ramamoorthi and Hanrahan, An
/// Efficient Representation for Irradiance Environment Maps, 2001).
WEDGE_INLINE Vec3x16 unshadowedFrom(
    __global const EnvironmentMap* environment, __global const float* table, Vec3x16 n, float least)
{
    __global const float* c = table + environmentHarmonics(environment[0].width, environment[0].height);
    Vec3x16 light;
    light.x = ofHarmonics(c, n, least);
    light.y = ofHarmonics(c + WEDGE_HARMONICS, n, least);
    light.z = ofHarmonics(c + 2u * WEDGE_HARMONICS, n, least);
    return light;
}

/// The same of samples that are divided by it, from WEDGE_LEAST_UNSHADOWED.
WEDGE_INLINE Vec3x16 unshadowedLight(__global const EnvironmentMap* environment, __global const float* table, Vec3x16 n)
{
    return unshadowedFrom(environment, table, n, WEDGE_LEAST_UNSHADOWED);
}

#ifdef WEDGE_SPECULAR
/// Directions of a lobe, and what each of them stands for.
typedef struct {
    float x[16], y[16], z[16]; ///< unit
    float weight[16], pdf[16];
} LobeStrata;

/// Strata `first` and on of rings * spokes of them.
WEDGE_INLINE void lobeStrata(Lobe lobe, Vec3 n, Vec3 v, uint first, uint rings, uint spokes, LobeStrata* out)
{
    const float perRings = 1.0f / (float)rings, perSpokes = 1.0f / (float)spokes;
    for (uint lane = 0u; lane < 16u; ++lane) {
        const uint k = first + lane, ring = min(k / spokes, rings - 1u);
        const float turn = 0.25f + 0.5f * (float)(ring & 1u);
        const Vec3 l = sampleLobe(
            lobe, n, v, vec2(((float)ring + 0.5f) * perRings, ((float)(k - ring * spokes) + turn) * perSpokes));
        const LobeAt at = lobeAt(lobe, n, v, l);
        const float cosine = vecDot(n, l);
        const bool taken = k < rings * spokes && cosine > 0.0f && at.pdf > 0.0f;
        out->x[lane] = l.x;
        out->y[lane] = l.y;
        out->z[lane] = l.z;
        out->pdf[lane] = at.pdf;
        out->weight[lane] = taken ? at.value * cosine / fmax(at.pdf, 1e-20f) : 0.0f;
    }
}

/// What a surface's lobe reflects of what is beyond the scene if nothing hides it, over its specular reflectance:
/// 2 rings^2 directions of the lobe, each of which sees the mean over as much as they are apart (Krivanek and Colbert,
/// Real-Time Shading with Filtered Importance Sampling, 2008). coarser: levels of averages, 0 or
/// more, each of which is of twice that each way: small lamps do not show which directions there are.
WEDGE_FN Vec3 unshadowedLobe(
    EnvironmentMap map, __global const float* table, Vec3 n, Vec3 v, Gloss gloss, uint rings, float coarser)
{
    const Lobe lobe = lobeOf(gloss);
    const uint spokes = 2u * rings, count = rings * spokes, last = coarseLevels(map.width) - 1u;
    __global const float* averages = table + environmentAverages(map.width, map.height);
    Vec3 seen = vec3(0.0f, 0.0f, 0.0f);
    for (uint first = 0u; first < count; first += 16u) {
        LobeStrata d;
        lobeStrata(lobe, n, v, first, rings, spokes, &d);
        // Between texels' middles an average deviates by half of a texel's side: 1/12 of its square are of the texel,
        // 1/6 of the interpolation. Directions deviate by sqrt(1 / (2 pi count pdf)).
        const float widest = 3.14159265f / (float)WEDGE_COARSE_COLUMNS;
        const float16 squared = 6.28318531f * widest * widest * (float)count * vload16(0, d.pdf);
        float level[16];
        const float16 fine = 0.5f * log2(max16(squared, (float16)(1.0f))) + (0.5f - coarser);
        vstore16(max16(fine, (float16)(0.0f)), 0, level);
        int above[2][16], below[2][16]; // of TexelsAround, from where averages begin
        float across[16], down[16];
        for (uint lane = 0u; lane < 16u; ++lane) {
            const uint chosen = min((uint)level[lane], last);
            const int columns = (int)(WEDGE_COARSE_COLUMNS << chosen), from = (int)coarseLevelAt(chosen);
            const TexelsAround a =
                texelsAround(columns, columns / 2, environmentCoordinates(map, vec3(d.x[lane], d.y[lane], d.z[lane])));
            above[0][lane] = from + a.above[0];
            above[1][lane] = from + a.above[1];
            below[0][lane] = from + a.below[0];
            below[1][lane] = from + a.below[1];
            across[lane] = a.across;
            down[lane] = a.down;
        }
        for (uint lane = 0u; lane < 16u; ++lane) {
            if (d.weight[lane] > 0.0f) {
                const TexelsAround a = { { above[0][lane], above[1][lane] }, { below[0][lane], below[1][lane] },
                    across[lane], down[lane] };
                seen = vecMad(seen, radianceBetween(averages, a), d.weight[lane]);
            }
        }
    }
    return vecScale(seen, 1.0f / (float)count);
}
#endif

#endif
