// Numbers in fewer bits, for planes that a frame of one image keeps long.
#ifndef WEDGE_SHARED_PACKED_H
#define WEDGE_SHARED_PACKED_H

#include "vec.h"

WEDGE_SHARED_BEGIN

/// A colour in 47 bits: an exponent of 8 bits and 13 bits a channel, which are exact to 1/16384 of twice the largest.
typedef struct {
    uint low; ///< red, green, and 6 bits of blue
    uint high; ///< 7 bits of blue, exponent
} PackedColour;

/// Channels below 0 and what is no number count as 0, colours below 1e-34 as black.
WEDGE_FN PackedColour packColour(Vec3 c)
{
    PackedColour out;
    const float largest = fmin(fmax(fmax(c.x, c.y), fmax(c.z, 0.0f)), 3e38f);
    const uint exponent = as_uint(largest) >> 23;
    out.low = out.high = 0u;
    if (exponent < 13u) {
        return out;
    }
    // largest times this is in [4096, 8192).
    const float scale = as_float((266u - exponent) << 23);
    const uint r = min((uint)(fmin(fmax(c.x, 0.0f), largest) * scale + 0.5f), 8191u);
    const uint g = min((uint)(fmin(fmax(c.y, 0.0f), largest) * scale + 0.5f), 8191u);
    const uint b = min((uint)(fmin(fmax(c.z, 0.0f), largest) * scale + 0.5f), 8191u);
    out.low = r | g << 13 | b << 26;
    out.high = b >> 6 | exponent << 7;
    return out;
}

WEDGE_FN Vec3 unpackColour(PackedColour packed)
{
    const uint exponent = packed.high >> 7;
    const float scale = exponent < 13u ? 0.0f : as_float((exponent - 12u) << 23);
    const uint b = packed.low >> 26 | (packed.high & 127u) << 6;
    return vec3(scale * (float)(packed.low & 8191u), scale * (float)(packed.low >> 13 & 8191u), scale * (float)b);
}

/// A colour in 32 bits: an exponent of 5 bits and 9 bits a channel, which are exact to 1/1024 of twice the largest, or
/// to 1e-7. From 0 to 65408: for reflectances and fractions. Channels below 0 and what is no number count as 0.
WEDGE_FN uint packFraction(Vec3 c)
{
    const float largest = fmin(fmax(fmax(c.x, c.y), fmax(c.z, 0.0f)), 65408.0f);
    // Half a unit of the last place more, so that no channel rounds up to 512 units.
    const uint exponent = max(as_uint(largest * (1.0f + 0x1p-10f)) >> 23, 111u) - 111u;
    // largest times this is in [256, 512), or less where the exponent is the least.
    const float scale = as_float((151u - exponent) << 23);
    const uint r = min((uint)(fmin(fmax(c.x, 0.0f), largest) * scale + 0.5f), 511u);
    const uint g = min((uint)(fmin(fmax(c.y, 0.0f), largest) * scale + 0.5f), 511u);
    const uint b = min((uint)(fmin(fmax(c.z, 0.0f), largest) * scale + 0.5f), 511u);
    return r | g << 9 | b << 18 | exponent << 27;
}

WEDGE_FN Vec3 unpackFraction(uint packed)
{
    const float scale = as_float(((packed >> 27) + 103u) << 23);
    return vec3(
        scale * (float)(packed & 511u), scale * (float)(packed >> 9 & 511u), scale * (float)(packed >> 18 & 511u));
}

/// Units of packNormal().
#define WEDGE_NORMAL_UNITS 511.0f

/// A vector whose parts are in [-1, 1], in 10 bits a part: exact to 1/1022. No bits are the vector 0.
WEDGE_FN uint packNormal(Vec3 v)
{
    const int x = (int)floor(v.x * WEDGE_NORMAL_UNITS + 0.5f), y = (int)floor(v.y * WEDGE_NORMAL_UNITS + 0.5f);
    const int z = (int)floor(v.z * WEDGE_NORMAL_UNITS + 0.5f);
    return ((uint)x & 1023u) | ((uint)y & 1023u) << 10 | ((uint)z & 1023u) << 20;
}

WEDGE_FN Vec3 unpackNormal(uint packed)
{
    const float scale = 1.0f / WEDGE_NORMAL_UNITS;
    return vec3(scale * (float)((int)(packed << 22) >> 22), scale * (float)((int)(packed << 12) >> 22),
        scale * (float)((int)(packed << 2) >> 22));
}

/// The upper 16 bits of a float, rounded: 8 bits of precision and its whole range.
WEDGE_FN uint packShort(float x) { return (as_uint(x) + 0x7fffu + (as_uint(x) >> 16 & 1u)) >> 16; }

WEDGE_FN float unpackShort(uint packed) { return as_float(packed << 16); }

WEDGE_SHARED_END

#endif
