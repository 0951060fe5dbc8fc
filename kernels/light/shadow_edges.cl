// Hard shadows of point and directional lights, to be drawn in a style: what each pixel sees of the light, and the
// edges of the shadow on surfaces. docs/stylized-shadows.md
#include "core/lists.h"
#include "light/delta_light.h"
#include "light/unmapped_normals.h"
#include "shared/filter_params.h"
#include "shared/styled_shadows.h"

/// What each pixel sees of a light: one shadow ray each. Where styles go by how far away what hides it is, the ray
/// finds the nearest thing, else any.
///
/// in      frame, BVH, receivers; lights, of which lightIndex is the one; farthest: metres, that things are told apart
/// in out  matte: WEDGE_MATTE_*, unknown before; occluder: metres along the ray to what hides the light, 0 before; rays
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
    deltaShadowRays(light, sceneDiameter, &receivers, &packet, cosine);
#if HAS_occluder
    PacketHits hits;
    closestHits(nodes, blocks, &packet, &hits);
#else
    uint occluded[WEDGE_PACKET_SIZE];
    anyHits(nodes, blocks, &packet, occluded);
    (void)farthest;
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL && cosine[lane] > 0.0f) {
            rays[i] += 1u;
#if HAS_occluder
            const bool hidden = hits.triangle[lane] != WEDGE_NO_TRIANGLE;
            const float away = hits.t[lane] * vecLength(rayDirection(&packet, lane));
            occluder[i] = hidden ? fmin(away, farthest) : 0.0f;
#else
            const bool hidden = occluded[lane] != 0u;
#endif
            matte[i] = hidden ? WEDGE_MATTE_SHADOW : WEDGE_MATTE_LIT;
        }
    }
}
#endif

/// Surfaces that a ray goes on behind, at most.
#define WEDGE_MOST_SURFACES 4096u

/// The same of some casters and of all other things, each as if they were alone: a ray goes on until both are known, or
/// counts as hidden by both behind WEDGE_MOST_SURFACES.
///
/// in      as of shadowMatte(); objectIds: of triangles; casters: WEDGE_CASTS, or 0, for each id below `objects`;
///         those with WEDGE_CASTS_ELSEWHERE hide nothing here
/// in out  matte, occluder, rays: as of shadowMatte(), of the casters; others: WEDGE_MATTE_*, unknown before
#include "pass/shadowOfCasters.h"
#ifdef PASS_shadowOfCasters
__kernel void shadowOfCasters(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    const DeltaLight light = lights[lightIndex];
    RayPacket packet;
    float cosine[WEDGE_PACKET_SIZE], met[WEDGE_PACKET_SIZE];
    bool byCasters[WEDGE_PACKET_SIZE], byOthers[WEDGE_PACKET_SIZE];
    deltaShadowRays(light, sceneDiameter, &receivers, &packet, cosine);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        met[lane] = 0.0f;
        byCasters[lane] = byOthers[lane] = false;
    }
    bool more = true;
    for (uint turn = 0u; more && turn < WEDGE_MOST_SURFACES; ++turn) {
        PacketHits hits;
        closestHits(nodes, blocks, &packet, &hits);
        more = false;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool hit = hits.triangle[lane] != WEDGE_NO_TRIANGLE;
            const uint object = hit ? objectIds[hits.triangle[lane]] : 0u;
            const uint casts = object < objects ? casters[object] : 0u;
            if (hit && casts == WEDGE_CASTS) {
                met[lane] = byCasters[lane] ? met[lane] : hits.t[lane];
                byCasters[lane] = true;
            } else if (hit && casts == 0u) {
                byOthers[lane] = true;
            }
            const bool goesOn = hit && !(byCasters[lane] && byOthers[lane]);
            packet.tMin[lane] = goesOn ? hits.t[lane] : 0.0f;
            packet.tMax[lane] = goesOn ? packet.tMax[lane] : 0.0f;
            more = more || goesOn;
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (more && packet.tMax[lane] > 0.0f) { // went on
            met[lane] = byCasters[lane] ? met[lane] : packet.tMin[lane];
            byCasters[lane] = byOthers[lane] = true;
        }
        if (i != WEDGE_NO_PIXEL && cosine[lane] > 0.0f) {
            rays[i] += 1u;
            matte[i] = byCasters[lane] ? WEDGE_MATTE_SHADOW : WEDGE_MATTE_LIT;
            others[i] = byOthers[lane] ? WEDGE_MATTE_SHADOW : WEDGE_MATTE_LIT;
#if HAS_occluder
            occluder[i] = byCasters[lane] ? fmin(met[lane] * vecLength(rayDirection(&packet, lane)), farthest) : 0.0f;
#endif
        }
    }
    (void)farthest;
}
#endif

/// What is seen, and how it is lit: planes of pixels.
typedef struct {
    __global const float *position, *normal, *pixelSize, *matte;
    __global const float* occluder; ///< metres; null: nothing goes by it
    __global const uint* objectId;
    uint size; ///< of a plane
} SeenShadow;

#define WEDGE_SEEN_SHADOW(p, occluder)                                                                                 \
    seenShadow(position, WEDGE_UNMAPPED((p).planeSize), pixelSize, matte, occluder, objectId, (p).planeSize)

WEDGE_FN SeenShadow seenShadow(__global const float* position, __global const float* normal,
    __global const float* pixelSize, __global const float* matte, __global const float* occluder,
    __global const uint* objectId, uint size)
{
    SeenShadow seen;
    seen.position = position;
    seen.normal = normal;
    seen.pixelSize = pixelSize;
    seen.matte = matte;
    seen.occluder = occluder;
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
        if ((here > 0.5f) != (next > 0.5f)) {
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
    if (crossed == 4u && !(seen.matte[cell->corner[1]] > 0.5f)) {
        // Around the lit corners: shadows that touch are one. Corner k lies between sides k - 1 and k.
        cell->side[0] = 3u;
        cell->side[1] = 0u;
        cell->side[2] = 1u;
        cell->side[3] = 2u;
    }
}

/// Where the matte is 0.5 on a cell's side, along which it is linear: of a hard one in the middle.
WEDGE_FN Vec3 crossingOfSide(SeenShadow seen, const EdgeCell* cell, uint side)
{
    const uint i = cell->corner[side], j = cell->corner[(side + 1u) & 3u];
    const float here = seen.matte[i], next = seen.matte[j];
    const float t = clamp((0.5f - here) / (next - here), 0.0f, 1.0f);
    return vecMad(vecScale(loadVec(seen.position, seen.size, i), 1.0f - t), loadVec(seen.position, seen.size, j), t);
}

/// How far away what hides the light is, metres: the mean over a cell's corners in shadow, of which there is one.
WEDGE_FN float occluderOf(SeenShadow seen, const EdgeCell* cell)
{
    float sum = 0.0f, corners = 0.0f;
    for (uint k = 0u; k < 4u; ++k) {
        const bool hidden = !(seen.matte[cell->corner[k]] > 0.5f);
        sum += hidden ? seen.occluder[cell->corner[k]] : 0.0f;
        corners += hidden ? 1.0f : 0.0f;
    }
    return sum / corners;
}

/// The cells of a tile: their first corners from (x, y) up to and without (endX, endY).
#define WEDGE_TILE_OF_CELLS(tile)                                                                                      \
    const uint cellsX = p.width - 1u, across = max((cellsX + WEDGE_EDGE_TILE - 1u) / WEDGE_EDGE_TILE, 1u);             \
    const uint x0 = (tile) % across * WEDGE_EDGE_TILE, y0 = (tile) / across * WEDGE_EDGE_TILE;                         \
    const uint endX = min(x0 + WEDGE_EDGE_TILE, cellsX), endY = min(y0 + WEDGE_EDGE_TILE, p.height - 1u)

/// The pieces of edge of a tile, row by row: how many they are and those before `at`. They are written from there on,
/// as far as there is room.
WEDGE_FN uint edgesOfTile(SeenShadow seen, AnalysisParams p, uint tile, uint at, uint capacity, __global float* edges)
{
    WEDGE_TILE_OF_CELLS(tile);
    EdgeCell cell;
    for (uint y = y0; y < endY; ++y) {
        for (uint x = x0; x < endX; ++x) {
            findEdges(seen, pixelIndex(x, y, p.stride), p.stride, &cell);
            if (cell.pieces == 0u || at >= capacity) {
                at += cell.pieces;
                continue;
            }
            Vec3 n = vec3(0.0f, 0.0f, 0.0f);
            for (uint k = 0u; k < 4u; ++k) {
                n = vecAdd(n, loadVec(seen.normal, seen.size, cell.corner[k]));
            }
            const float away = seen.occluder != 0 ? occluderOf(seen, &cell) : 0.0f;
            for (uint k = 0u; k < cell.pieces; ++k, ++at) {
                const Vec3 a = crossingOfSide(seen, &cell, cell.side[2u * k]);
                const Vec3 b = crossingOfSide(seen, &cell, cell.side[2u * k + 1u]);
                const Vec3 middle = vecScale(vecAdd(a, b), 0.5f), m = vecNormalize(n);
                const float8 piece =
                    (float8)(middle.x, middle.y, middle.z, m.x, m.y, m.z, vecLength(vecSub(b, a)), away);
                if (at < capacity) {
                    vstore8(piece, at, edges);
                }
            }
        }
    }
    return at;
}

/// How many pieces of edge each tile has.
///
/// in   p, surfaces, matte; tiles
/// out  counts: of each
#include "pass/countEdges.h"
#ifdef PASS_countEdges
__kernel void countEdges(PARAMETERS)
{
    const uint tile = (uint)get_global_id(0);
    if (tile < tiles) {
        counts[tile] = edgesOfTile(WEDGE_SEEN_SHADOW(p, 0), p, tile, 0u, 0u, 0);
    }
}
#endif

/// The pieces themselves, tile by tile and in each row by row: in one order, and so sums over them have the same bits.
///
/// in   p, surfaces, matte, occluder; tiles; first: of each tile's; capacity: of the list
/// out  edges: WEDGE_EDGE_FLOATS a piece
#include "pass/listEdges.h"
#ifdef PASS_listEdges
__kernel void listEdges(PARAMETERS)
{
    const uint tile = (uint)get_global_id(0);
    if (tile < tiles) {
        edgesOfTile(WEDGE_SEEN_SHADOW(p, PLANE_occluder), p, tile, first[tile], capacity, edges);
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
