// Distances of a block of pixels to the pieces of a shadow's edge (kernels/light/shadow_edges.cl).
#ifndef WEDGE_NEAR_EDGES_H
#define WEDGE_NEAR_EDGES_H

#include "core/vec_lanes.h"
#include "core/vector16.h"
#include "shared/styled_shadows.h"

/// Least unit of distances to edges, metres: 2^-50. Squares of less come near to underflow.
#define WEDGE_LEAST_UNIT 8.8817842e-16f
/// Least squares that distances have to edges, over the square of their unit: but for rounding none is below 1.
#define WEDGE_LEAST_SQUARE 0.25f

/// A block of pixels, and the edges that they are near to.
typedef struct {
    Vec3x16 at, n;
    int16 known; ///< lanes whose matte is
    float3 lo, hi; ///< box around them, metres
    __global const float *edges, *boxes;
    uint count, room; ///< edges; boxes that there is room for
} EdgeBlock;

/// Squares of the distances to a piece of edge.
WEDGE_INLINE float16 squareTo(const EdgeBlock* b, float8 piece)
{
    const float16 x = piece.s0 - b->at.x, y = piece.s1 - b->at.y, z = piece.s2 - b->at.z;
    return x * x + y * y + z * z;
}

/// Lanes whose surface faces as that at a piece of edge does.
WEDGE_INLINE int16 facesAs(const EdgeBlock* b, float8 piece)
{
    return b->n.x * piece.s3 + b->n.y * piece.s4 + b->n.z * piece.s5 > WEDGE_SURFACE_COSINE;
}

/// The squares of the distances between a block's box and those of 16 chunks of edges, a little less by whatever
/// rounding; of chunks beyond the last one infinite.
WEDGE_INLINE float16 boxSquares(const EdgeBlock* b, uint chunk)
{
    __global const float *lo = b->boxes + chunk, *hi = lo + 3u * b->room;
    const float16 none = (float16)(0.0f);
    const float16 x = max16(max16(vload16(0, lo) - b->hi.x, b->lo.x - vload16(0, hi)), none);
    const float16 y = max16(max16(vload16(0, lo + b->room) - b->hi.y, b->lo.y - vload16(0, hi + b->room)), none);
    const float16 z =
        max16(max16(vload16(0, lo + 2u * b->room) - b->hi.z, b->lo.z - vload16(0, hi + 2u * b->room)), none);
    const int16 lane = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const int chunks = (int)((b->count + WEDGE_EDGE_CHUNK - 1u) / WEDGE_EDGE_CHUNK);
    return (int)chunk + lane < chunks ? 0.9999f * (x * x + y * y + z * z) : (float16)(INFINITY);
}

/// The least of the lanes.
WEDGE_INLINE float leastOf(float16 v) { return -largestOf(-v); }

WEDGE_FN void boundBlock(EdgeBlock* b)
{
    const float16 far = (float16)(3e38f);
    b->lo = (float3)(leastOf(b->known ? b->at.x : far), leastOf(b->known ? b->at.y : far),
        leastOf(b->known ? b->at.z : far));
    b->hi = (float3)(largestOf(b->known ? b->at.x : -far), largestOf(b->known ? b->at.y : -far),
        largestOf(b->known ? b->at.z : -far));
}

/// The squares of the distances to the nearest edges of 16 chunks, where they are less than `nearest`.
WEDGE_INLINE float16 nearestOfChunks(const EdgeBlock* b, uint chunk, float16 nearest)
{
    float squares[16];
    vstore16(boxSquares(b, chunk), 0, squares);
    for (uint k = 0u; k < 16u; ++k) {
        if (squares[k] > largestOf(nearest)) {
            continue;
        }
        const uint begin = (chunk + k) * WEDGE_EDGE_CHUNK, end = min(begin + WEDGE_EDGE_CHUNK, b->count);
        for (uint i = begin; i < end; ++i) {
            const float8 piece = vload8(i, b->edges);
            const float16 square = squareTo(b, piece);
            nearest = (facesAs(b, piece) & (square < nearest)) ? square : nearest;
        }
    }
    return nearest;
}

/// The same of all edges, up to `most`.
WEDGE_FN float16 nearestSquare(const EdgeBlock* b, float most)
{
    const uint step = 16u * WEDGE_EDGE_CHUNK;
    uint first = 0u;
    float least = most;
    for (uint begin = 0u; begin < b->count; begin += step) {
        const float square = leastOf(boxSquares(b, begin / WEDGE_EDGE_CHUNK));
        first = square < least ? begin : first;
        least = fmin(square, least);
    }
    float16 nearest = b->known ? (float16)(most) : (float16)(-1.0f);
    if (least >= most) {
        return nearest;
    }
    // With what is near there is little to be seen of the others.
    nearest = nearestOfChunks(b, first / WEDGE_EDGE_CHUNK, nearest);
    for (uint begin = 0u; begin < b->count; begin += step) {
        if (begin != first && leastOf(boxSquares(b, begin / WEDGE_EDGE_CHUNK)) <= largestOf(nearest)) {
            nearest = nearestOfChunks(b, begin / WEDGE_EDGE_CHUNK, nearest);
        }
    }
    return nearest;
}

/// 1 over the unit of each lane's distances to edges, 1/m: a power of 2, of which the nearest edge is 1 to 2 away. So
/// the power below has room, whatever the size of the scene is.
WEDGE_INLINE float16 perUnitOf(float16 nearestSquares)
{
    const float16 metres = sqrt(max16(nearestSquares, (float16)(WEDGE_LEAST_UNIT * WEDGE_LEAST_UNIT)));
    return 1.0f / as_float16(as_int16(metres) & 0x7f800000);
}

/// Sums over edges, one by one: what chunks they are in does not show in their bits.
typedef struct {
    float16 weights; ///< of len r^-8
    float16 away; ///< of that times how far what hides the light is away, in units of their own
} EdgeSums;

/// Adds a chunk of edges within a reach of each lane, in units of 1 / perUnit metres. perAway: 1 over the unit of what
/// is away, 1/m; 0 where nothing goes by it.
WEDGE_INLINE void addChunk(
    const EdgeBlock* b, uint chunk, float16 perUnit, float16 reachSquare, const float perAway, EdgeSums* sums)
{
    const uint begin = chunk * WEDGE_EDGE_CHUNK, end = min(begin + WEDGE_EDGE_CHUNK, b->count);
    for (uint k = begin; k < end; ++k) {
        const float8 piece = vload8(k, b->edges);
        const float16 square = squareTo(b, piece);
        const float16 inverse = 1.0f / max16(square * (perUnit * perUnit), (float16)(WEDGE_LEAST_SQUARE));
        const float16 squared = inverse * inverse;
        const int16 counts = facesAs(b, piece) & (square <= reachSquare);
        const float16 weight = counts ? piece.s6 * perUnit * (squared * squared) : (float16)(0.0f);
        sums->weights += weight;
        if (perAway > 0.0f) {
            sums->away += weight * (piece.s7 * perAway);
        }
    }
}

/// Those of all edges.
WEDGE_FN EdgeSums edgeSums(const EdgeBlock* b, float16 perUnit, float16 reachSquare, const float perAway)
{
    const float most = largestOf(reachSquare);
    EdgeSums sums;
    sums.weights = sums.away = (float16)(0.0f);
    float squares[16];
    for (uint begin = 0u; begin < b->count; begin += 16u * WEDGE_EDGE_CHUNK) {
        const float16 all = boxSquares(b, begin / WEDGE_EDGE_CHUNK);
        if (!any(all <= most)) {
            continue;
        }
        vstore16(all, 0, squares);
        for (uint k = 0u; k < 16u; ++k) {
            if (squares[k] <= most) {
                addChunk(b, begin / WEDGE_EDGE_CHUNK + k, perUnit, reachSquare, perAway, &sums);
            }
        }
    }
    return sums;
}

/// The length of all edges that count for each lane, whatever their distance, in those units.
WEDGE_FN float16 edgeLength(const EdgeBlock* b, float16 perUnit)
{
    float16 sum = (float16)(0.0f);
    for (uint k = 0u; k < b->count; ++k) {
        const float8 piece = vload8(k, b->edges);
        sum += facesAs(b, piece) ? piece.s6 * perUnit : (float16)(0.0f);
    }
    return sum;
}

#endif
