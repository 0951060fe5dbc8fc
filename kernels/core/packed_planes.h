// Planes of pixels that may be packed (shared/packed.h): frames of one image have them.
#ifndef WEDGE_PACKED_PLANES_H
#define WEDGE_PACKED_PLANES_H

#include "core/pixel.h"
#include "core/vector16.h"
#include "shared/material.h"
#include "shared/packed.h"

/// A colour of three planes, of one and a half, or of one.
WEDGE_FN Vec3 loadColour(__global const float* planes, uint planeSize, uint i, uint bits)
{
    if (bits == WEDGE_PLAIN_BITS) {
        return loadVec(planes, planeSize, i);
    }
    if (bits == WEDGE_FRACTION_BITS) {
        return unpackFraction(((__global const uint*)planes)[i]);
    }
    PackedColour c;
    c.low = ((__global const uint*)planes)[i];
    c.high = ((__global const ushort*)(planes + planeSize))[i];
    return unpackColour(c);
}

WEDGE_FN void storeColour(__global float* planes, uint planeSize, uint i, uint bits, Vec3 colour)
{
    if (bits == WEDGE_PLAIN_BITS) {
        storeVec(planes, planeSize, i, colour);
        return;
    }
    if (bits == WEDGE_FRACTION_BITS) {
        ((__global uint*)planes)[i] = packFraction(colour);
        return;
    }
    const PackedColour c = packColour(colour);
    ((__global uint*)planes)[i] = c.low;
    ((__global ushort*)(planes + planeSize))[i] = (ushort)c.high;
}

/// A unit vector of three planes, or of one.
WEDGE_FN Vec3 loadNormal(__global const float* planes, uint planeSize, uint i, uint packed)
{
    return packed != 0u ? unpackNormal(((__global const uint*)planes)[i]) : loadVec(planes, planeSize, i);
}

/// Sixteen colours in 48 bits.
WEDGE_FN Vec3x16 loadColours16(__global const float* planes, uint planeSize, int i)
{
    float x[16], y[16], z[16];
    for (int k = 0; k < 16; ++k) {
        const Vec3 c = loadColour(planes, planeSize, (uint)(i + k), WEDGE_COLOUR_BITS);
        x[k] = c.x;
        y[k] = c.y;
        z[k] = c.z;
    }
    Vec3x16 v;
    v.x = vload16(0, x);
    v.y = vload16(0, y);
    v.z = vload16(0, z);
    return v;
}

/// Sixteen vectors of one plane.
WEDGE_FN Vec3x16 unpackNormals16(__global const float* plane, int i)
{
    const int16 packed = as_int16(vload16(0, (__global const uint*)plane + i));
    const float scale = 1.0f / WEDGE_NORMAL_UNITS;
    Vec3x16 v;
    v.x = convert_float16((packed << 22) >> 22) * scale;
    v.y = convert_float16((packed << 12) >> 22) * scale;
    v.z = convert_float16((packed << 2) >> 22) * scale;
    return v;
}

WEDGE_FN Vec3x16 loadNormals16(__global const float* planes, uint planeSize, int i, uint packed)
{
    return packed != 0u ? unpackNormals16(planes, i) : loadVecBlock(planes, planeSize, i);
}

/// Where among the planes of normals the ones without maps begin, which filters tell planes by: behind those with them.
/// Without maps there are none, and both are the same.
WEDGE_FN uint unmappedNormals(uint planeSize, uint packed)
{
#ifdef WEDGE_NORMAL_MAPS
    return packed != 0u ? planeSize : 3u * planeSize;
#else
    (void)planeSize;
    (void)packed;
    return 0u;
#endif
}

WEDGE_FN void storeNormal(__global float* planes, uint planeSize, uint i, uint packed, Vec3 normal)
{
    if (packed != 0u) {
        ((__global uint*)planes)[i] = packNormal(normal);
    } else {
        storeVec(planes, planeSize, i, normal);
    }
}

/// One of several numbers of 16 bits: the first (which: 0), the second and so on of all pixels. Components of filters
/// are up to 196 planes, which have more elements than 32 bits count from 22 million pixels on.
WEDGE_FN float loadShort(__global const float* plane, uint planeSize, uint i, uint which)
{
    return unpackShort(((__global const ushort*)plane)[(size_t)which * planeSize + i]);
}

/// Sixteen of them.
WEDGE_FN float16 loadShortsBlock(__global const float* plane, uint planeSize, int i, uint which)
{
    return as_float16(convert_uint16(vload16(0, (__global const ushort*)plane + (size_t)which * planeSize + i)) << 16);
}

WEDGE_FN float16 loadShortBlock(__global const float* plane, int i) { return loadShortsBlock(plane, 0u, i, 0u); }

/// packShort() of sixteen, where they are numbers.
WEDGE_FN void storeShortsBlock(__global float* plane, uint planeSize, int i, uint which, float16 value)
{
    const uint16 bits = as_uint16(value);
    vstore16(convert_ushort16((bits + 0x7fffu + (bits >> 16 & 1u)) >> 16), 0,
        (__global ushort*)plane + (size_t)which * planeSize + i);
}

/// Sixteen deviations, which have 16 bits where they are packed.
WEDGE_FN float16 loadDeviations16(__global const float* plane, int i, uint packed)
{
    return packed != 0u ? loadShortBlock(plane, i) : loadBlock(plane, i);
}

/// A number of a plane of its own or, packed, of one that it shares.
WEDGE_FN float loadNumber(__global const float* plane, uint planeSize, uint i, uint packed, uint which)
{
    return packed != 0u ? loadShort(plane, planeSize, i, which) : plane[i];
}

/// What packGloss() or, packed, packGlossShort() made.
WEDGE_FN Gloss loadGloss(__global const uint* plane, uint i, uint packed)
{
    return packed != 0u ? unpackGlossShort(((__global const ushort*)plane)[i]) : unpackGloss(plane[i]);
}

WEDGE_FN void storeGloss(__global uint* plane, uint i, uint packed, Gloss g)
{
    if (packed != 0u) {
        ((__global ushort*)plane)[i] = (ushort)packGlossShort(g);
    } else {
        plane[i] = packGloss(g);
    }
}

/// Primary samples with a surface: packed, these are whole numbers of 16 bits.
WEDGE_FN uint loadHits(__global const uint* hits, uint i, uint packed)
{
    return packed != 0u ? ((__global const ushort*)hits)[i] : hits[i];
}

WEDGE_FN void storeHits(__global uint* hits, uint i, uint packed, uint count)
{
    if (packed != 0u) {
        ((__global ushort*)hits)[i] = (ushort)count;
    } else {
        hits[i] = count;
    }
}

WEDGE_FN void storeShort(__global float* plane, uint planeSize, uint i, uint which, float x)
{
    ((__global ushort*)plane)[(size_t)which * planeSize + i] = (ushort)packShort(x);
}

/// A vector on the image in one plane of two numbers.
WEDGE_FN void storePair(__global float* plane, uint planeSize, uint i, float x, float y)
{
    storeShort(plane, planeSize, i, 0u, x);
    storeShort(plane, planeSize, i, 1u, y);
}

#endif
