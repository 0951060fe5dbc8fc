// How the elements of planes and lists are read and written, by the names of their formats (host/graph/format.h). Of a
// format X: load_X(plane, size, at) and store_X(plane, size, at, value), where size is the elements of the resource,
// and none_X(), what is read where there is no plane. Of those that kernels read in blocks of sixteen: load16_X(). A
// pass's interface names them for its planes: LOAD_position(size, at).
#ifndef WEDGE_FORMATS_H
#define WEDGE_FORMATS_H

#include "core/packed_planes.h"

/// A format X of elements of type V in memory of type S. load, store: what is done with `plane`, `size`, `at`, `value`.
#define WEDGE_FORMAT(X, S, V, none, load, store)                                                                       \
    WEDGE_FN V none_##X(void) { return none; }                                                                         \
    WEDGE_FN V load_##X(__global const S* plane, uint size, uint at)                                                   \
    {                                                                                                                  \
        (void)size;                                                                                                    \
        return load;                                                                                                   \
    }                                                                                                                  \
    WEDGE_FN void store_##X(__global S* plane, uint size, uint at, V value)                                            \
    {                                                                                                                  \
        (void)size;                                                                                                    \
        store;                                                                                                         \
    }
#define WEDGE_NO_VECTOR vec3(0.0f, 0.0f, 0.0f)

WEDGE_FORMAT(float1, float, float, 0.0f, plane[at], plane[at] = value)
WEDGE_FORMAT(uint1, uint, uint, 0u, plane[at], plane[at] = value)
WEDGE_FORMAT(short1, float, float, 0.0f, loadShort(plane, size, at, 0u), storeShort(plane, size, at, 0u, value))
WEDGE_FORMAT(ushort1, ushort, uint, 0u, plane[at], plane[at] = (ushort)value)
WEDGE_FORMAT(float2, float, float2, (float2)(0.0f), (float2)(plane[at], plane[size + at]),
    (plane[at] = value.x, plane[size + at] = value.y))
WEDGE_FORMAT(short2, float, float2, (float2)(0.0f),
    (float2)(loadShort(plane, size, at, 0u), loadShort(plane, size, at, 1u)),
    storePair(plane, size, at, value.x, value.y))
WEDGE_FORMAT(float3, float, Vec3, WEDGE_NO_VECTOR, loadVec(plane, size, at), storeVec(plane, size, at, value))
WEDGE_FORMAT(colour48, float, Vec3, WEDGE_NO_VECTOR, loadColour(plane, size, at), storeColour(plane, size, at, value))
WEDGE_FORMAT(fraction32, uint, Vec3, WEDGE_NO_VECTOR, unpackFraction(plane[at]), plane[at] = packFraction(value))
WEDGE_FORMAT(gloss32, uint, Gloss, makeGloss(0.0f, WEDGE_LAMBERT), unpackGloss(plane[at]), plane[at] = packGloss(value))
WEDGE_FORMAT(gloss16, ushort, Gloss, makeGloss(0.0f, WEDGE_LAMBERT), unpackGlossShort(plane[at]),
    plane[at] = (ushort)packGlossShort(value))
/// Least and largest of what is signed; in 16 bits the one nearest to 0, or 0 where the sign changes.
WEDGE_FORMAT(range16, float, float2, (float2)(0.0f), (float2)(loadShort(plane, size, at, 0u)),
    storeShort(plane, size, at, 0u,
        value.x > 0.0f       ? value.x
            : value.y < 0.0f ? value.y
                             : 0.0f))
/// Distances: the least, the largest, which 32 bits have no room for, and the sum of inverse ones.
WEDGE_FORMAT(reflectors32, float, Vec3, WEDGE_NO_VECTOR,
    vec3(loadShort(plane, size, at, 0u), 0.0f, loadShort(plane, size, at, 1u)),
    storePair(plane, size, at, value.x, value.z))

/// Unit vectors, alone or with another behind: the normal without its map, which filters tell planes by
/// (load_unmapped_X). Alone it is its own.
WEDGE_FORMAT(normal32, float, Vec3, WEDGE_NO_VECTOR, unpackNormal(((__global const uint*)plane)[at]),
    ((__global uint*)plane)[at] = packNormal(value))
WEDGE_FORMAT(
    normal64, float, Vec3, WEDGE_NO_VECTOR, load_normal32(plane, size, at), store_normal32(plane, size, at, value))
WEDGE_FORMAT(normal192, float, Vec3, WEDGE_NO_VECTOR, loadVec(plane, size, at), storeVec(plane, size, at, value))
WEDGE_FORMAT(
    unmapped_float3, float, Vec3, WEDGE_NO_VECTOR, load_float3(plane, size, at), store_float3(plane, size, at, value))
WEDGE_FORMAT(unmapped_normal32, float, Vec3, WEDGE_NO_VECTOR, load_normal32(plane, size, at),
    store_normal32(plane, size, at, value))
WEDGE_FORMAT(unmapped_normal64, float, Vec3, WEDGE_NO_VECTOR, load_normal32(plane + size, size, at),
    store_normal32(plane + size, size, at, value))
WEDGE_FORMAT(unmapped_normal192, float, Vec3, WEDGE_NO_VECTOR, load_float3(plane + 3u * size, size, at),
    store_float3(plane + 3u * size, size, at, value))

/// The same in blocks of sixteen.
#define WEDGE_BLOCK_FORMAT(X, S, V, load)                                                                              \
    WEDGE_FN V load16_##X(__global const S* plane, uint size, int at)                                                  \
    {                                                                                                                  \
        (void)size;                                                                                                    \
        return load;                                                                                                   \
    }
WEDGE_BLOCK_FORMAT(float1, float, float16, vload16(0, plane + at))
WEDGE_BLOCK_FORMAT(uint1, uint, uint16, vload16(0, plane + at))
WEDGE_BLOCK_FORMAT(short1, float, float16, loadShortBlock(plane, at))
WEDGE_BLOCK_FORMAT(float3, float, Vec3x16, loadVecBlock(plane, size, at))
WEDGE_BLOCK_FORMAT(colour48, float, Vec3x16, loadColours16(plane, size, at))
WEDGE_BLOCK_FORMAT(normal32, float, Vec3x16, unpackNormals16(plane, at))
WEDGE_BLOCK_FORMAT(normal64, float, Vec3x16, unpackNormals16(plane, at))
WEDGE_BLOCK_FORMAT(normal192, float, Vec3x16, loadVecBlock(plane, size, at))
WEDGE_BLOCK_FORMAT(unmapped_float3, float, Vec3x16, loadVecBlock(plane, size, at))
WEDGE_BLOCK_FORMAT(unmapped_normal32, float, Vec3x16, unpackNormals16(plane, at))
WEDGE_BLOCK_FORMAT(unmapped_normal64, float, Vec3x16, unpackNormals16(plane + size, at))
WEDGE_BLOCK_FORMAT(unmapped_normal192, float, Vec3x16, loadVecBlock(plane + 3u * size, size, at))

/// Of pairs of numbers.
WEDGE_FN void storePair16_float2(__global float* plane, uint size, int at, float16 first, float16 second)
{
    vstore16(first, 0, plane + at);
    vstore16(second, 0, plane + size + at);
}
WEDGE_FN void storePair16_short2(__global float* plane, uint size, int at, float16 first, float16 second)
{
    storeShortsBlock(plane, size, at, 0u, first);
    storeShortsBlock(plane, size, at, 1u, second);
}

/// A function of a format that a macro has the name of: WEDGE_OF_FORMAT(load16_unmapped, FORMAT_normal)(normal, size,
/// i).
#define WEDGE_OF_FORMAT(function, format) WEDGE_JOINED(function, format)
#define WEDGE_JOINED(function, format) function##_##format

#endif
