// Vectors of 16: the lanes where something holds, and what is least or greatest among them. As in intersect.h, masks
// take vectors apart into integers and expect a little-endian device.
#ifndef WEDGE_PACKET_LANES_H
#define WEDGE_PACKET_LANES_H

#include "trace/intersect.h"

#ifndef __ENDIAN_LITTLE__
#error "Masks of lanes expect a little-endian device"
#endif

WEDGE_FN float smallestOf16(float16 x) { return smallestLane(WEDGE_MIN(x.lo, x.hi)); }
WEDGE_FN float largestOf16(float16 x)
{
    const float8 eight = WEDGE_MAX(x.lo, x.hi);
    const float4 four = WEDGE_MAX(eight.lo, eight.hi);
    const float2 two = WEDGE_MAX(four.lo, four.hi);
    return WEDGE_MAX(two.x, two.y);
}

/// A set of lanes of a vector of 16: byte i stands for lanes i (its top bit) and i + 8 (its lowest).
typedef ulong LaneMask16;

WEDGE_FN LaneMask16 laneMask16(int16 comparison)
{
    const ulong2 bytes = as_ulong2(convert_char16(comparison));
    return (bytes.x & 0x8080808080808080ul) | (bytes.y & 0x0101010101010101ul);
}
WEDGE_FN uint firstLane16(LaneMask16 lanes)
{
    const uint bit = (uint)popcount(~lanes & (lanes - 1));
    return (bit >> 3) + ((bit & 7) == 0 ? 8 : 0);
}

/// All bits set in the lanes of a set, none in the others.
WEDGE_FN int16 lanesOf(LaneMask16 lanes) { return convert_int16(as_char16((ulong2)(lanes, lanes << 7))) < 0; }

/// Whether the comparison holds in any lane.
WEDGE_FN bool anyLane(int16 comparison)
{
    const ulong2 bytes = as_ulong2(convert_char16(comparison));
    return (bytes.x | bytes.y) != 0;
}

// Each of these takes the smaller of neighbouring halves of the parts of x and y, and puts what is left side by side.
WEDGE_FN float16 mergeHalves(float16 x, float16 y)
{
    const float16 first = (float16)(x.lo, y.lo), second = (float16)(x.hi, y.hi);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeQuarters(float16 x, float16 y)
{
    const float16 first = (float16)(x.s0123, x.s89ab, y.s0123, y.s89ab);
    const float16 second = (float16)(x.s4567, x.scdef, y.s4567, y.scdef);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeEighths(float16 x, float16 y)
{
    const float16 first = (float16)(x.s01, x.s45, x.s89, x.scd, y.s01, y.s45, y.s89, y.scd);
    const float16 second = (float16)(x.s23, x.s67, x.sab, x.sef, y.s23, y.s67, y.sab, y.sef);
    return WEDGE_MIN(first, second);
}
WEDGE_FN float16 mergeSixteenths(float16 x, float16 y)
{
    const float16 first = (float16)(x.s02468ace, y.s02468ace), second = (float16)(x.s13579bdf, y.s13579bdf);
    return WEDGE_MIN(first, second);
}

#endif
