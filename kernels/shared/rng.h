// Random numbers as a pure function of (seed, pixel, light, sample, dimension): an image does not depend on
// tiles, crops, devices or the order of work.
#ifndef WEDGE_SHARED_RNG_H
#define WEDGE_SHARED_RNG_H

#include "compat.h"

WEDGE_SHARED_BEGIN

typedef struct {
    float x, y;
} Vec2;

WEDGE_INLINE Vec2 vec2(float x, float y)
{
    Vec2 v;
    v.x = x;
    v.y = y;
    return v;
}

/// A well-mixed 32-bit hash (two multiply-xorshift rounds; constants from a search for low bias by C. Wellons).
WEDGE_INLINE uint hashUint(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

WEDGE_INLINE uint hashCombine(uint seed, uint value)
{
    return hashUint(seed ^ (value + 0x9e3779b9u + (seed << 6) + (seed >> 2)));
}

/// The upper 24 bits as a float in [0, 1).
WEDGE_INLINE float toUnitFloat(uint x) { return (float)(x >> 8) * (1.0f / 16777216.0f); }

WEDGE_INLINE uint reverseBits(uint x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/// Owen's nested uniform scramble of the bits of x, hash-based (Burley, Practical Hash-based Owen Scrambling,
/// JCGT 2020; the permutation is Vegdahl's improvement of Laine and Karras's). x arrives with its bits reversed.
WEDGE_INLINE uint scrambleReversed(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Second Sobol dimension of index i as a 32-bit fraction. Its generator matrix is Pascal's triangle modulo 2,
/// a Kronecker power of [1 1; 0 1], so five butterfly steps multiply by it.
WEDGE_INLINE uint sobolSecond(uint i)
{
    uint x = reverseBits(i);
    x ^= (x << 1) & 0xaaaaaaaau;
    x ^= (x << 2) & 0xccccccccu;
    x ^= (x << 4) & 0xf0f0f0f0u;
    x ^= (x << 8) & 0xff00ff00u;
    x ^= (x << 16) & 0xffff0000u;
    return x;
}

/// Point i of an Owen-scrambled, shuffled Sobol sequence in [0,1)^2; each seed gives an independent randomisation.
/// Any prefix is well distributed, so a pixel may take any number of samples, and more later.
WEDGE_INLINE Vec2 sobolOwen(uint i, uint seed)
{
    const uint index = reverseBits(scrambleReversed(reverseBits(i), seed));
    // The first dimension of index i, bits reversed, is i itself.
    const uint x = reverseBits(scrambleReversed(index, hashUint(seed ^ 0x68bc21ebu)));
    const uint y = reverseBits(scrambleReversed(reverseBits(sobolSecond(index)), hashUint(seed ^ 0x02e5be93u)));
    return vec2(toUnitFloat(x), toUnitFloat(y));
}

/// Element i of a pseudo-random permutation of 0..length-1 (Kensler, Correlated Multi-Jittered Sampling, 2013),
/// length >= 1. Cycle-walks until the result is in range.
WEDGE_FN uint permuteIndex(uint i, uint length, uint seed)
{
    uint mask = length - 1u;
    mask |= mask >> 1;
    mask |= mask >> 2;
    mask |= mask >> 4;
    mask |= mask >> 8;
    mask |= mask >> 16;
    do {
        i ^= seed;
        i *= 0xe170893du;
        i ^= seed >> 16;
        i ^= (i & mask) >> 4;
        i ^= seed >> 8;
        i *= 0x0929eb3fu;
        i ^= seed >> 23;
        i ^= (i & mask) >> 1;
        i *= 1u | (seed >> 27);
        i *= 0x6935fa69u;
        i ^= (i & mask) >> 11;
        i *= 0x74dcb303u;
        i ^= (i & mask) >> 2;
        i *= 0x9e501cc3u;
        i ^= (i & mask) >> 2;
        i *= 0xc860a3dfu;
        i &= mask;
        i ^= i >> 5;
    } while (i >= length);
    // Reduced first: i + seed may wrap around, which would send two elements to one place.
    return (i + seed % length) % length;
}

/// How n jittered samples are laid out in [0,1)^2: a grid of columns x rows strata with columns = round(sqrt n) and
/// rows = floor(n / columns); what n leaves over is uniform.
typedef struct {
    uint columns, rows;
} Strata;

WEDGE_INLINE Strata strataOf(uint n)
{
    Strata s;
    s.columns = max(1u, (uint)(sqrt((float)n) + 0.5f));
    s.rows = max(1u, n / s.columns);
    return s;
}

/// A point in one of the strata, row by row, or anywhere for stratum >= columns rows; jitter: a seed of this sample.
WEDGE_INLINE Vec2 stratumPoint(Strata s, uint stratum, uint jitter)
{
    const float u = toUnitFloat(hashUint(jitter ^ 0x9c1b7a55u));
    const float v = toUnitFloat(hashUint(jitter ^ 0x3d6fb1e7u));
    const uint row = stratum / s.columns;
    const float x = (float)(stratum % s.columns), y = (float)row;
    const bool inside = stratum < s.columns * s.rows;
    return vec2(inside ? (x + u) / (float)s.columns : u, inside ? (y + v) / (float)s.rows : v);
}

/// Point i of n jittered samples, one a stratum in an order that `order` decides: unbiased for any n when all n are
/// taken. Pixels that share an order take the same stratum at the same time, which keeps their rays together.
WEDGE_FN Vec2 stratified(uint i, uint n, uint order, uint seed)
{
    return stratumPoint(strataOf(n), permuteIndex(i % n, n, order ^ (i / n)), hashCombine(seed, i));
}

WEDGE_SHARED_END

#endif
