// Directions to what is beyond the scene, chosen by how bright it is there, and what is seen in a direction.
#ifndef WEDGE_LIGHT_ENVIRONMENT_MAP_H
#define WEDGE_LIGHT_ENVIRONMENT_MAP_H

#include "light/sums.h"
#include "shared/environment.h"
#include "trace/environment.h"

/// 1: the scene has a map.
#ifndef WEDGE_ENVIRONMENT_MAP
#define WEDGE_ENVIRONMENT_MAP 0
#endif
/// 0: rays that leave the scene see nothing.
#define WEDGE_OPEN ((uint)WEDGE_ENVIRONMENT + (uint)WEDGE_ENVIRONMENT_MAP)

typedef struct {
    EnvironmentMap map;
    __global const float* table;
    float share; ///< probability that a path's vertex samples it and not other lights
    uint precomputed; ///< 1: directions are chosen among `samples`
    __global const float* samples; ///< pre-computed, see WEDGE_ENVIRONMENT_CELLS
} BeyondData;

/// The scene's map among a kernel's parameters.
#define WEDGE_BEYOND_PARAMETERS                                                                                        \
    __global const EnvironmentMap *restrict environment, __global const float *restrict environmentTable

WEDGE_FN BeyondData beyondData(
    __global const EnvironmentMap* environment, __global const float* environmentTable, float share)
{
    BeyondData beyond;
#if WEDGE_ENVIRONMENT_MAP
    beyond.map = environment[0];
#else
    (void)environment;
    beyond.map.width = beyond.map.height = 0u;
#endif
    beyond.table = environmentTable;
    beyond.share = share;
    beyond.precomputed = 0u;
    beyond.samples = environmentTable;
    return beyond;
}

/// A direction, unit.
typedef struct {
    Vec3 direction;
    Vec3 radiance;
    float pdf; ///< 1/sr
} BeyondSample;

/// The four texels around a place in a map, by where each begins among its numbers, and how far it is between them.
typedef struct {
    int above[2], below[2];
    float across, down;
} TexelsAround;

/// Of a map of w columns and h rows of R G B; the first column is beside the last one.
/// at: in widths and heights, from 0 to 1
WEDGE_INLINE TexelsAround texelsAround(int w, int h, Vec2 at)
{
    const float fx = at.x * (float)w - 0.5f, fy = at.y * (float)h - 0.5f;
    const int x = clamp((int)floor(fx), -1, w - 1), y = (int)floor(fy);
    const int left = 3 * (x < 0 ? x + w : x), right = 3 * (x + 1 < w ? x + 1 : x + 1 - w);
    const int top = 3 * w * clamp(y, 0, h - 1), bottom = 3 * w * clamp(y + 1, 0, h - 1);
    TexelsAround around;
    around.above[0] = top + left;
    around.above[1] = top + right;
    around.below[0] = bottom + left;
    around.below[1] = bottom + right;
    around.across = fx - (float)x;
    around.down = fy - (float)y;
    return around;
}

/// Of each texel four numbers are read at once, one more than there are: loads and sums of four are one instruction
/// each, and looking a sky up was a quarter of a frame.
WEDGE_INLINE Vec3 radianceBetween(__global const float* texels, TexelsAround a)
{
    const float4 above = vload4(0, texels + a.above[0]) * (1.0f - a.across) + vload4(0, texels + a.above[1]) * a.across;
    const float4 below = vload4(0, texels + a.below[0]) * (1.0f - a.across) + vload4(0, texels + a.below[1]) * a.across;
    const float4 mean = above * (1.0f - a.down) + below * a.down;
    return vec3(mean.x, mean.y, mean.z);
}

WEDGE_FN Vec3 mapRadiance(BeyondData beyond, Vec2 at)
{
    return radianceBetween(beyond.table, texelsAround((int)beyond.map.width, (int)beyond.map.height, at));
}

/// The first of `count` numbers in the table at `upTo` that reaches beyond `number`.
WEDGE_FN uint findNumber(__global const float* upTo, __global const float* guide, uint count, float number)
{
    const uint last = count - 1u, stripe = min((uint)(number * (float)count), last);
    const uint low = as_uint(guide[stripe]), high = stripe < last ? as_uint(guide[stripe + 1u]) : last;
    return findSum(upTo, low, high, number);
}

/// Where the parts of the table are.
typedef struct {
    __global const float *rows, *columns, *rowGuide, *columnGuide, *cosines;
} BeyondParts;

WEDGE_FN BeyondParts partsOf(BeyondData beyond)
{
    const uint w = beyond.map.width, h = beyond.map.height;
    BeyondParts parts;
    parts.rows = beyond.table + 3u * w * h;
    parts.columns = parts.rows + h;
    parts.rowGuide = parts.columns + w * h;
    parts.columnGuide = parts.rowGuide + h;
    parts.cosines = parts.columnGuide + w * h;
    return parts;
}

/// Probability of the entry i of sums.
WEDGE_FN float probabilityAt(__global const float* upTo, uint i) { return upTo[i] - (i > 0u ? upTo[i - 1u] : 0.0f); }

/// Density within a texel, 1/sr.
WEDGE_FN float texelPdf(BeyondData beyond, BeyondParts parts, uint x, uint y)
{
    const float chosen = probabilityAt(parts.rows, y) * probabilityAt(parts.columns + y * beyond.map.width, x);
    const float solidAngle = 6.28318531f / (float)beyond.map.width * (parts.cosines[y] - parts.cosines[y + 1u]);
    return chosen / fmax(solidAngle, 1e-30f);
}

/// How far a number is between where the entry i of sums begins and ends.
WEDGE_FN float placeWithin(__global const float* upTo, uint i, float number)
{
    const float from = i > 0u ? upTo[i - 1u] : 0.0f;
    return clamp((number - from) / fmax(upTo[i] - from, 1e-30f), 0.0f, 1.0f);
}

/// The direction of the numbers u, by its brightness: what is stratified over the square is so over rows and columns.
WEDGE_FN BeyondSample sampleMap(BeyondData beyond, Vec2 u)
{
    const BeyondParts parts = partsOf(beyond);
    const uint w = beyond.map.width;
    const uint y = findNumber(parts.rows, parts.rowGuide, beyond.map.height, u.y);
    __global const float* columns = parts.columns + y * w;
    const uint x = findNumber(columns, parts.columnGuide + y * w, w, u.x);
    const float across = ((float)x + placeWithin(columns, x, u.x)) / (float)w;
    const float top = parts.cosines[y], bottom = parts.cosines[y + 1u];
    const float cosine = top + (bottom - top) * placeWithin(parts.rows, y, u.y);
    BeyondSample sample;
    sample.direction = environmentDirection(beyond.map, across, cosine);
    sample.radiance =
        mapRadiance(beyond, vec2(across, 2.0f * turnOf(sqrt(fmax(0.0f, 1.0f - cosine * cosine)), cosine)));
    sample.pdf = texelPdf(beyond, parts, x, y);
    return sample;
}

/// The pre-computed sample of the cell that the numbers u are in.
WEDGE_FN BeyondSample precomputedSample(__global const float* samples, Vec2 u)
{
    const uint last = WEDGE_ENVIRONMENT_CELLS - 1u;
    const uint column = min((uint)(u.x * (float)WEDGE_ENVIRONMENT_CELLS), last);
    const uint row = min((uint)(u.y * (float)WEDGE_ENVIRONMENT_CELLS), last);
    const float8 s = vload8(row * WEDGE_ENVIRONMENT_CELLS + column, samples);
    BeyondSample sample;
    sample.direction = vec3(s.s0, s.s1, s.s2);
    sample.radiance = vec3(s.s3, s.s4, s.s5);
    sample.pdf = s.s6;
    return sample;
}

/// A direction by the numbers u: sampleMap(), or as it was pre-computed near u.
WEDGE_FN BeyondSample chooseBeyond(BeyondData beyond, Vec2 u)
{
    if (beyond.precomputed != 0u) {
        return precomputedSample(beyond.samples, u);
    }
    return sampleMap(beyond, u);
}

/// What is seen in a unit direction, and the density at which sampleMap() finds it.
WEDGE_FN BeyondSample seenBeyond(BeyondData beyond, Vec3 direction)
{
    const Vec2 at = environmentCoordinates(beyond.map, direction);
    const uint w = beyond.map.width, h = beyond.map.height;
    BeyondSample seen;
    seen.direction = direction;
    seen.radiance = mapRadiance(beyond, at);
    seen.pdf =
        texelPdf(beyond, partsOf(beyond), min((uint)(at.x * (float)w), w - 1u), min((uint)(at.y * (float)h), h - 1u));
    return seen;
}

/// What the camera sees in a unit direction that meets nothing.
WEDGE_FN Vec3 cameraBeyond(
    __global const EnvironmentMap* environment, __global const float* environmentTable, Vec3 direction)
{
    const Vec3 others = environmentRadiance(direction);
    if (WEDGE_ENVIRONMENT_MAP == 0 || environment[0].seen == 0u) {
        return others;
    }
    const BeyondData beyond = beyondData(environment, environmentTable + environment[0].shown, 0.0f);
    return vecAdd(others, mapRadiance(beyond, environmentCoordinates(beyond.map, direction)));
}

#endif
