// Hard shadows of point and directional lights, drawn in a style: what each pixel sees of the light, the edges of the
// shadow on surfaces, how far from them pixels are, that smoothed, and how much light is left.
// docs/stylized-shadows.md
#include "core/lists.h"
#include "core/vector16.h"
#include "light/delta_light.h"
#include "light/light_packet.h"
#include "shared/filter_params.h"
#include "shared/styled_shadows.h"
#include "trace/packet.h"

/// Planes of a format of normals before those of the normals without their maps.
#define WEDGE_PLANES_BEFORE_float3 0u
#define WEDGE_PLANES_BEFORE_normal192 3u
/// Those normals, of a pass's plane `normal`.
#define WEDGE_UNMAPPED(size) (normal + WEDGE_OF_FORMAT(WEDGE_PLANES_BEFORE, FORMAT_normal) * (size))

/// What each pixel sees of a light: one shadow ray each.
///
/// in      frame, BVH, receivers; lights, of which lightIndex is the one
/// in out  matte: WEDGE_MATTE_*, unknown before; rays
#include "pass/shadowMatte.h"
#ifdef PASS_shadowMatte
__kernel void shadowMatte(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    const DeltaLight light = lights[lightIndex];
    RayPacket packet;
    float cosine[WEDGE_PACKET_SIZE];
    uint occluded[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 start = vec3(receivers.originX[lane], receivers.originY[lane], receivers.originZ[lane]);
        const Vec3 n = vec3(receivers.normalX[lane], receivers.normalY[lane], receivers.normalZ[lane]);
        const Vec3 toLight = vectorToLight(light, sceneDiameter, start);
        cosine[lane] = vecDot(n, vecNormalize(toLight));
        setRay(&packet, lane, start, toLight, 0.0f, cosine[lane] > 0.0f ? WEDGE_SHADOW_RAY_END : 0.0f);
        setTime(&packet, lane, receiverTime(&receivers, lane));
    }
    anyHits(nodes, blocks, &packet, occluded);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL && cosine[lane] > 0.0f) {
            rays[i] += 1u;
            matte[i] = occluded[lane] != 0u ? WEDGE_MATTE_SHADOW : WEDGE_MATTE_LIT;
        }
    }
}
#endif

/// What is seen, and how it is lit: planes of pixels.
typedef struct {
    __global const float *position, *normal, *pixelSize, *matte;
    __global const uint* objectId;
    uint size; ///< of a plane
} SeenShadow;

#define WEDGE_SEEN_SHADOW(p)                                                                                           \
    seenShadow(position, WEDGE_UNMAPPED((p).planeSize), pixelSize, matte, objectId, (p).planeSize)

WEDGE_FN SeenShadow seenShadow(__global const float* position, __global const float* normal,
    __global const float* pixelSize, __global const float* matte, __global const uint* objectId, uint size)
{
    SeenShadow seen;
    seen.position = position;
    seen.normal = normal;
    seen.pixelSize = pixelSize;
    seen.matte = matte;
    seen.objectId = objectId;
    seen.size = size;
    return seen;
}

/// Whether two neighbours lie on one surface: of one object, with normals within 45 degrees, and each within a pixel of
/// the other's plane. So there is no edge between a thing and the floor behind it, whatever they have of the light.
WEDGE_FN bool onOneSurface(SeenShadow seen, uint i, uint j)
{
    const Vec3 n = loadVec(seen.normal, seen.size, i), m = loadVec(seen.normal, seen.size, j);
    const Vec3 d = vecSub(loadVec(seen.position, seen.size, j), loadVec(seen.position, seen.size, i));
    const float off = fmax(seen.pixelSize[i], seen.pixelSize[j]);
    return seen.objectId[i] == seen.objectId[j] && vecDot(n, m) > WEDGE_SURFACE_COSINE && fabs(vecDot(n, d)) <= off
        && fabs(vecDot(m, d)) <= off;
}

/// The pieces of edge in a cell, by marching squares. Corners go around it, and side k is between corners k and k + 1.
typedef struct {
    uint corner[4]; ///< pixels
    uint pieces; ///< 0 to 2
    uint side[4]; ///< two a piece: those that it joins
} EdgeCell;

/// Of the cell whose first corner is the pixel i.
WEDGE_FN void findEdges(SeenShadow seen, uint i, uint stride, EdgeCell* cell)
{
    cell->corner[0] = i;
    cell->corner[1] = i + 1u;
    cell->corner[2] = i + stride + 1u;
    cell->corner[3] = i + stride;
    cell->pieces = 0u;
    uint crossed = 0u;
    bool known = true;
    for (uint k = 0u; k < 4u; ++k) {
        const float here = seen.matte[cell->corner[k]], next = seen.matte[cell->corner[(k + 1u) & 3u]];
        known = known && here >= 0.0f;
        if (here != next) {
            cell->side[crossed] = k;
            ++crossed;
        }
    }
    if (!known || crossed == 0u) {
        return;
    }
    for (uint k = 0u; k < 4u; ++k) {
        known = known && onOneSurface(seen, cell->corner[k], cell->corner[(k + 1u) & 3u]);
    }
    cell->pieces = known ? crossed / 2u : 0u;
    if (crossed == 4u && seen.matte[cell->corner[1]] < 0.5f) {
        // Around the lit corners: shadows that touch are one. Corner k lies between sides k - 1 and k.
        cell->side[0] = 3u;
        cell->side[1] = 0u;
        cell->side[2] = 1u;
        cell->side[3] = 2u;
    }
}

/// The middle of a cell's side.
WEDGE_FN Vec3 middleOfSide(SeenShadow seen, const EdgeCell* cell, uint side)
{
    const Vec3 a = loadVec(seen.position, seen.size, cell->corner[side]);
    const Vec3 b = loadVec(seen.position, seen.size, cell->corner[(side + 1u) & 3u]);
    return vecScale(vecAdd(a, b), 0.5f);
}

/// The cells of a tile: their first corners from (x, y) up to and without (endX, endY).
#define WEDGE_TILE_OF_CELLS(tile)                                                                                      \
    const uint cellsX = p.width - 1u, across = max((cellsX + WEDGE_EDGE_TILE - 1u) / WEDGE_EDGE_TILE, 1u);             \
    const uint x0 = (tile) % across * WEDGE_EDGE_TILE, y0 = (tile) / across * WEDGE_EDGE_TILE;                         \
    const uint endX = min(x0 + WEDGE_EDGE_TILE, cellsX), endY = min(y0 + WEDGE_EDGE_TILE, p.height - 1u)

/// How many pieces of edge each tile has.
///
/// in   p, surfaces, matte; tiles
/// out  counts: of each
#include "pass/countEdges.h"
#ifdef PASS_countEdges
__kernel void countEdges(PARAMETERS)
{
    const uint tile = (uint)get_global_id(0);
    if (tile >= tiles) {
        return;
    }
    const SeenShadow seen = WEDGE_SEEN_SHADOW(p);
    WEDGE_TILE_OF_CELLS(tile);
    EdgeCell cell;
    uint sum = 0u;
    for (uint y = y0; y < endY; ++y) {
        for (uint x = x0; x < endX; ++x) {
            findEdges(seen, pixelIndex(x, y, p.stride), p.stride, &cell);
            sum += cell.pieces;
        }
    }
    counts[tile] = sum;
}
#endif

/// The pieces themselves, tile by tile and in each row by row: in one order, and so sums over them have the same bits.
///
/// in   p, surfaces, matte; tiles; first: of each tile's; capacity: of the list
/// out  edges: WEDGE_EDGE_FLOATS a piece
#include "pass/listEdges.h"
#ifdef PASS_listEdges
__kernel void listEdges(PARAMETERS)
{
    const uint tile = (uint)get_global_id(0);
    if (tile >= tiles) {
        return;
    }
    const SeenShadow seen = WEDGE_SEEN_SHADOW(p);
    WEDGE_TILE_OF_CELLS(tile);
    EdgeCell cell;
    uint at = first[tile];
    for (uint y = y0; y < endY; ++y) {
        for (uint x = x0; x < endX; ++x) {
            findEdges(seen, pixelIndex(x, y, p.stride), p.stride, &cell);
            Vec3 n = vec3(0.0f, 0.0f, 0.0f);
            for (uint k = 0u; cell.pieces > 0u && k < 4u; ++k) {
                n = vecAdd(n, loadVec(seen.normal, seen.size, cell.corner[k]));
            }
            for (uint k = 0u; k < cell.pieces && at < capacity; ++k, ++at) {
                const Vec3 a = middleOfSide(seen, &cell, cell.side[2u * k]);
                const Vec3 b = middleOfSide(seen, &cell, cell.side[2u * k + 1u]);
                const Vec3 middle = vecScale(vecAdd(a, b), 0.5f), m = vecNormalize(n);
                const float8 piece =
                    (float8)(middle.x, middle.y, middle.z, m.x, m.y, m.z, vecLength(vecSub(b, a)), 0.0f);
                vstore8(piece, at, edges);
            }
        }
    }
}
#endif

/// Boxes around consecutive pieces, so that far ones need not be looked at one by one.
///
/// in   edges; listed[0]: how many, at most `most`; room: boxes that there is room for
/// out  boxes: WEDGE_EDGE_BOX planes of as many numbers
#include "pass/boundEdges.h"
#ifdef PASS_boundEdges
__kernel void boundEdges(PARAMETERS)
{
    const uint chunk = (uint)get_global_id(0), begin = chunk * WEDGE_EDGE_CHUNK;
    const uint end = min(begin + WEDGE_EDGE_CHUNK, min(listed[0], most));
    if (begin >= end) {
        return;
    }
    float8 lo = vload8(begin, edges), hi = lo;
    for (uint k = begin + 1u; k < end; ++k) {
        const float8 piece = vload8(k, edges);
        lo = piece < lo ? piece : lo;
        hi = piece > hi ? piece : hi;
    }
    boxes[chunk] = lo.s0;
    boxes[room + chunk] = lo.s1;
    boxes[2u * room + chunk] = lo.s2;
    boxes[3u * room + chunk] = hi.s0;
    boxes[4u * room + chunk] = hi.s1;
    boxes[5u * room + chunk] = hi.s2;
}
#endif

/// Least squares that distances have to edges, over the square of their unit: the power below overflows at less.
#define WEDGE_LEAST_SQUARE 1e-9f

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

/// Adds the sum of len r^-8 over a chunk of edges within a reach of each lane, in units of 1 / perUnit metres, one by
/// one: what chunks they are in does not show in the sum's bits.
WEDGE_INLINE float16 addChunk(const EdgeBlock* b, uint chunk, float perUnit, float16 reachSquare, float16 sum)
{
    const uint begin = chunk * WEDGE_EDGE_CHUNK, end = min(begin + WEDGE_EDGE_CHUNK, b->count);
    for (uint k = begin; k < end; ++k) {
        const float8 piece = vload8(k, b->edges);
        const float16 square = squareTo(b, piece);
        const float16 inverse = 1.0f / max16(square * (perUnit * perUnit), (float16)(WEDGE_LEAST_SQUARE));
        const float16 squared = inverse * inverse;
        const int16 counts = facesAs(b, piece) & (square <= reachSquare);
        sum += counts ? piece.s6 * perUnit * (squared * squared) : (float16)(0.0f);
    }
    return sum;
}

/// That sum over all edges.
WEDGE_FN float16 edgeSum(const EdgeBlock* b, float perUnit, float16 reachSquare)
{
    const float most = largestOf(reachSquare);
    float16 sum = (float16)(0.0f);
    float squares[16];
    for (uint begin = 0u; begin < b->count; begin += 16u * WEDGE_EDGE_CHUNK) {
        const float16 all = boxSquares(b, begin / WEDGE_EDGE_CHUNK);
        if (!any(all <= most)) {
            continue;
        }
        vstore16(all, 0, squares);
        for (uint k = 0u; k < 16u; ++k) {
            if (squares[k] <= most) {
                sum = addChunk(b, begin / WEDGE_EDGE_CHUNK + k, perUnit, reachSquare, sum);
            }
        }
    }
    return sum;
}

/// The length of all edges that count for each lane, whatever their distance, in those units.
WEDGE_FN float16 edgeLength(const EdgeBlock* b, float perUnit)
{
    float16 sum = (float16)(0.0f);
    for (uint k = 0u; k < b->count; ++k) {
        const float8 piece = vload8(k, b->edges);
        sum += facesAs(b, piece) ? (float16)(piece.s6 * perUnit) : (float16)(0.0f);
    }
    return sum;
}

/// How far pixels are from the shadow's edge: the power mean of thesis (3.2) for p = 8, but of the distances to a
/// straight edge, so that it is a distance: D = (Phi / K)^(-1/7), Phi the sum of len r^-8. Edges count within so many
/// times the distance of the nearest one, or of the largest that is told apart. As published all of them count, and the
/// mean is over their length: D = (Phi / length)^(-1/8).
///
/// in   p, position, normal, matte; edges, boxes, listed[0], most: how many edges, room: for boxes; published: 1 or 0;
///      unit: metres, a power of 2; largest: metres, that is told apart
/// out  distance: metres, below 0 in shadow, 0 where the matte is unknown
#include "pass/shadowDistance.h"
#ifdef PASS_shadowDistance
__kernel void shadowDistance(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    EdgeBlock b;
    const float16 v = LOAD16_matte(p.planeSize, i);
    b.known = v >= 0.0f;
    if (!any(b.known)) {
        vstore16((float16)(0.0f), 0, distance + i);
        return;
    }
    b.at = loadVecBlock(position, p.planeSize, i);
    b.n = loadVecBlock(WEDGE_UNMAPPED(p.planeSize), p.planeSize, i);
    b.edges = edges;
    b.boxes = boxes;
    b.count = min(listed[0], most);
    b.room = room;
    boundBlock(&b);
    float16 d = (float16)(largest);
    if (published != 0u) {
        const float16 sum = edgeSum(&b, 1.0f / unit, (float16)(3e38f));
        const float16 mean = sum / max16(edgeLength(&b, 1.0f / unit), (float16)(1e-30f));
        d = min16(unit * exp2Block(log2Block(mean) * (-1.0f / 8.0f)), d);
    } else {
        // An edge all around is nearer in the mean than at its nearest, but not by half.
        const float square = largest * largest, beyond = 4.0f * square;
        const float16 nearest = nearestSquare(&b, beyond);
        const int16 near = b.known & (nearest < beyond);
        const float16 reach = WEDGE_EDGE_REACH * WEDGE_EDGE_REACH * min16(nearest, (float16)(square));
        const float16 sum = edgeSum(&b, 1.0f / unit, near ? reach : (float16)(-1.0f));
        const float16 power = log2Block(sum * (1.0f / WEDGE_EDGE_CONSTANT)) * (-1.0f / 7.0f);
        d = near ? min16(unit * exp2Block(power), d) : d;
    }
    vstore16(b.known ? (v > 0.5f ? d : -d) : (float16)(0.0f), 0, distance + i);
}
#endif

/// Sums of a blur.
typedef struct {
    float16 values, weights;
} SmoothSums;

/// A block of pixels, and planes that its neighbours are in.
typedef struct {
    Vec3x16 at, n;
    uint16 object;
    float16 perSize; ///< 1 over the side of what a pixel sees, metres
    float perSquare; ///< 1/m^2: weights are 2^(-perSquare r^2)
    float square; ///< m^2, as far as which neighbours count
    __global const float *position, *normal, *pixelSize, *distance;
    __global const uint* objectId;
    uint size;
} SmoothBlock;

/// Adds the neighbours at j to the lanes of `mine`: those on the same object whose normals are within 45 degrees, each
/// for what it sees of the surface.
WEDGE_INLINE void addNeighbours(const SmoothBlock* b, int16 mine, int j, SmoothSums* sums)
{
    const Vec3x16 d = sub16(loadVecBlock(b->position, b->size, j), b->at);
    const float16 square = dot16(d, d), facing = dot16(b->n, loadVecBlock(b->normal, b->size, j));
    const float16 value = loadBlock(b->distance, j), side = loadBlock(b->pixelSize, j) * b->perSize;
    const int16 counts = mine & (loadIdBlock(b->objectId, j) == b->object) & (facing > WEDGE_SURFACE_COSINE)
        & (square <= b->square) & (value != 0.0f);
    const float16 weight = exp2Block(square * -b->perSquare) * side * side;
    sums->weights += counts ? weight : (float16)(0.0f);
    sums->values += counts ? weight * value : (float16)(0.0f);
}

/// Whole pixels that `reach` metres of a surface span along an image step: the shadow of a disk of that normal.
/// Surfaces bend, so it is a quarter more, up to that of a disk that faces the camera.
WEDGE_INLINE float16 pixelsAlong(FrameParams frame, Vec3x16 n, Vec3 step, float16 depth, float reach)
{
    const float length = vecLength(step);
    const float16 along = dot16(n, splat3(step)) / length, away = dot16(n, splat3(frame.forward));
    const float16 side = min16(1.25f * sqrt(max16(1.0f - along * along, (float16)(0.0f))), (float16)(1.0f));
    // The nearer end of it is larger.
    const float16 least = depth - reach * sqrt(max16(1.0f - away * away, (float16)(0.0f)));
    const float16 pixels = reach * side / (length * max16(least, 0.2f * depth));
    return floor(min16(pixels, (float16)((float)max(frame.width, frame.height))));
}

/// The power of 2 that a stride along so many pixels has, so that there are few taps.
WEDGE_INLINE float16 strideOf(float16 pixels)
{
    float16 power = (float16)(0.0f);
    for (float most = WEDGE_STYLE_TAPS; most < 65536.0f; most *= 2.0f) {
        power += pixels > most ? (float16)(1.0f) : (float16)(0.0f);
    }
    return power;
}

/// Distances, smoothed along surfaces by a Gaussian. Wide ones take every second, fourth ... neighbour along either
/// axis: each pixel by its own width, so that nobody's depends on who is beside it. The largest distances stay: nothing
/// that is told apart is near.
///
/// in   frame, surfaces; distance: of shadowDistance(); deviation, largest: metres
/// out  smoothed: metres, 0 where the distance is
#include "pass/smoothDistance.h"
#ifdef PASS_smoothDistance
__kernel void smoothDistance(PARAMETERS)
{
    WEDGE_PIXEL(frame, x, y, i);
    SmoothBlock b;
    b.size = frame.planeSize;
    b.position = position;
    b.normal = WEDGE_UNMAPPED(frame.planeSize);
    b.pixelSize = pixelSize;
    b.distance = distance;
    b.objectId = objectId;
    b.at = loadVecBlock(position, b.size, i);
    b.n = loadVecBlock(b.normal, b.size, i);
    b.object = loadIdBlock(objectId, i);
    b.perSize = 1.0f / max16(loadBlock(pixelSize, i), (float16)(1e-30f));
    b.perSquare = 0.72134752f / fmax(deviation * deviation, 1e-30f);
    const float reach = WEDGE_STYLE_CUT * deviation;
    b.square = reach * reach;
    const float16 depth = max16(dot16(sub16(b.at, splat3(frame.eye)), splat3(frame.forward)), (float16)(1e-20f));
    const float16 across = pixelsAlong(frame, b.n, frame.right, depth, reach);
    const float16 down = pixelsAlong(frame, b.n, frame.down, depth, reach);
    const float16 kind = strideOf(across) + 32.0f * strideOf(down);
    float16 out = loadBlock(distance, i);
    int16 left = (out != 0.0f) & (fabs(out) < largest);
    while (any(left)) {
        const float first = largestOf(left ? kind : (float16)(-1.0f));
        const int16 mine = left & (kind == first);
        const int stepX = 1 << ((int)first % 32), stepY = 1 << ((int)first / 32);
        const int tapsX = (int)largestOf(mine ? across : (float16)(0.0f)) / stepX;
        const int tapsY = (int)largestOf(mine ? down : (float16)(0.0f)) / stepY;
        SmoothSums sums;
        sums.values = sums.weights = (float16)(0.0f);
        for (int v = -tapsY; v <= tapsY; ++v) {
            const int16 inRow = mine & (down >= fabs((float)(v * stepY)));
            for (int u = -tapsX; u <= tapsX; ++u) {
                const int row = (int)y + v * stepY, column = (int)x + u * stepX;
                if (row >= 0 && row < (int)frame.height && column > -16 && column < (int)frame.width) {
                    const int16 inReach = inRow & (across >= fabs((float)(u * stepX)));
                    addNeighbours(&b, inReach, i + v * stepY * (int)frame.stride + u * stepX, &sums);
                }
            }
        }
        out = mine ? sums.values / max16(sums.weights, (float16)(1e-30f)) : out;
        left = left & ~mine;
    }
    vstore16(out, 0, smoothed + i);
}
#endif

/// How much of what is seen lies at each distance, and how much in shadow, m^2: of stripes of rows.
///
/// in   p, of the whole image; distance: smoothed; matte, pixelSize; stripes; range: metres that are told apart to
///      either side of 0
/// out  areas: WEDGE_AREA_NUMBERS a stripe
#include "pass/countAreas.h"
#ifdef PASS_countAreas
__kernel void countAreas(PARAMETERS)
{
    const uint stripe = (uint)get_global_id(0);
    if (stripe >= stripes) {
        return;
    }
    __global float* own = areas + WEDGE_AREA_NUMBERS * stripe;
    for (uint k = 0u; k < WEDGE_AREA_NUMBERS; ++k) {
        own[k] = 0.0f;
    }
    const float perClass = 0.5f * (float)WEDGE_AREA_BINS / range;
    for (uint y = stripe; y < p.height; y += stripes) {
        for (uint x = 0u; x < p.width; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            const float v = matte[i], area = pixelSize[i] * pixelSize[i];
            if (v >= 0.0f) {
                const float at = clamp((distance[i] + range) * perClass, 0.0f, (float)WEDGE_AREA_BINS - 1.0f);
                own[(uint)at] += area;
                own[v < 0.5f ? WEDGE_AREA_BINS : WEDGE_AREA_BINS + 1u] += area;
            }
        }
    }
}
#endif

/// The distance below which as much lies as was in shadow.
///
/// in   areas, stripes, range: as of countAreas(); items: 1
/// out  zeros: that one number, metres; 0 where all or nothing is in shadow
#include "pass/keepArea.h"
#ifdef PASS_keepArea
__kernel void keepArea(PARAMETERS)
{
    if (get_global_id(0) >= items) {
        return;
    }
    float shadow = 0.0f, light = 0.0f;
    for (uint stripe = 0u; stripe < stripes; ++stripe) {
        shadow += areas[WEDGE_AREA_NUMBERS * stripe + WEDGE_AREA_BINS];
        light += areas[WEDGE_AREA_NUMBERS * stripe + WEDGE_AREA_BINS + 1u];
    }
    zeros[0] = 0.0f;
    float below = 0.0f;
    for (uint k = 0u; k < WEDGE_AREA_BINS && shadow > 0.0f && light > 0.0f; ++k) {
        float here = 0.0f;
        for (uint stripe = 0u; stripe < stripes; ++stripe) {
            here += areas[WEDGE_AREA_NUMBERS * stripe + k];
        }
        if (below + here >= shadow) {
            const float at = (float)k + (shadow - below) / here;
            zeros[0] = at * (2.0f * range / (float)WEDGE_AREA_BINS) - range;
            return;
        }
        below += here;
    }
}
#endif

/// Adds a style's share of light.
///
/// in      p; distance: metres, or the matte; offset: what of it is the edge; zeros: and a number more, where there is
///         one; inflation, softness: metres; red, green, blue: what is left in shadow; weight
/// in out  share: R G B, of the light
#include "pass/addStyle.h"
#ifdef PASS_addStyle
__kernel void addStyle(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float d = LOAD_distance(p.planeSize, i) - offset - LOAD_zeros(1u, 0u);
    // smoothstep() is undefined without a width.
    const float t = clamp((d - inflation) / fmax(softness, 1e-30f) + 0.5f, 0.0f, 1.0f);
    const float soft = t * t * (3.0f - 2.0f * t), hard = d > inflation ? 1.0f : 0.0f;
    const float f = softness > 0.0f ? soft : hard;
    const Vec3 left = vec3(red, green, blue), rest = vec3(1.0f - red, 1.0f - green, 1.0f - blue);
    const Vec3 light = vecMad(left, rest, f);
    STORE_share(p.planeSize, i, vecMad(LOAD_share(p.planeSize, i), light, weight));
}
#endif

/// The light of a light whose shadows have a style.
///
/// in      frame, receivers, diffuse, specular; lights, of which lightIndex is the one; matte; share: R G B, of it
/// in out  lit (3 planes, radiance)
#include "pass/styledLight.h"
#ifdef PASS_styledLight
__kernel void styledLight(PARAMETERS)
{
    WEDGE_PIXEL(frame, x, y, i);
    if (objectId[i] == 0u || LOAD_matte(frame.planeSize, i) < 0.0f) { // faces away, or was not come to
        return;
    }
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    const Receiver r = loadReceiver(frame, data, i);
    const DeltaLight light = lights[lightIndex];
    const Vec3 toLight = vectorToLight(light, sceneDiameter, r.origin);
    const float cosine = vecDot(r.normal, vecNormalize(toLight));
    if (!(cosine > 0.0f)) {
        return;
    }
    const Vec3 all = deltaLightAt(
        light, r, toLight, cosine, loadVec(diffuse, frame.planeSize, i), loadVec(specular, frame.planeSize, i));
    const Vec3 left = vecMul(all, LOAD_share(frame.planeSize, i));
    storeVec(lit, frame.planeSize, i, vecAdd(loadVec(lit, frame.planeSize, i), left));
}
#endif
