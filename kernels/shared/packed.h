// Numbers in fewer bits, for planes that a frame of one image keeps long.
#ifndef WEDGE_SHARED_PACKED_H
#define WEDGE_SHARED_PACKED_H

#include "vec.h"

WEDGE_SHARED_BEGIN

/// A colour in 47 bits: an exponent of 8 bits and 13 bits a channel, which are exact to 1/16384 of twice the largest.
typedef struct {
    uint low;  ///< red, green, and 6 bits of blue
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

/// The upper 16 bits of a float, rounded: 8 bits of precision and its whole range.
WEDGE_FN uint packShort(float x) { return (as_uint(x) + 0x7fffu + (as_uint(x) >> 16 & 1u)) >> 16; }

WEDGE_FN float unpackShort(uint packed) { return as_float(packed << 16); }

WEDGE_SHARED_END

#endif
