// Planes of numbers in fewer bits (shared/packed.h).
#ifndef WEDGE_PACKED_PLANES_H
#define WEDGE_PACKED_PLANES_H

#include "core/pixel.h"
#include "core/vector16.h"
#include "shared/material.h"
#include "shared/packed.h"

/// Colours in 48 bits: 32 in a plane, and 16 in half a plane behind it.
WEDGE_FN Vec3 loadColour(__global const float* planes, uint planeSize, uint i)
{
    PackedColour c;
    c.low = ((__global const uint*)planes)[i];
    c.high = ((__global const ushort*)(planes + planeSize))[i];
    return unpackColour(c);
}

WEDGE_FN void storeColour(__global float* planes, uint planeSize, uint i, Vec3 colour)
{
    const PackedColour c = packColour(colour);
    ((__global uint*)planes)[i] = c.low;
    ((__global ushort*)(planes + planeSize))[i] = (ushort)c.high;
}

/// Sixteen colours in 48 bits.
WEDGE_FN Vec3x16 loadColours16(__global const float* planes, uint planeSize, int i)
{
    float x[16], y[16], z[16];
    for (int k = 0; k < 16; ++k) {
        const Vec3 c = loadColour(planes, planeSize, (uint)(i + k));
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
