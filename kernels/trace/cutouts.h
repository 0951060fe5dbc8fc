// Holes: the part of a triangle that rays pass through, in programs with WEDGE_CUTOUTS. The table of them lies behind
// the blocks of triangles, from the block on that the root node names.
#ifndef WEDGE_CUTOUTS_H
#define WEDGE_CUTOUTS_H

#include "shared/cutout.h"
#include "shared/vec.h"
#include "trace/bilinear.h"

#ifdef WEDGE_CUTOUTS

/// The table of a hierarchy's root and blocks.
#define WEDGE_CUTOUT_TABLE(nodes, blocks) ((__global const uint*)((blocks) + (nodes)->cutouts))

/// Opacity, 0 to 255, of a texture at (u, v): bilinear, v up, repeated outside [0, 1). Coordinates that are no numbers
/// are opaque.
WEDGE_FN float sampleAlphas(__global const uchar* alphas, uint width, uint height, float u, float v)
{
    Bilinear b;
    if (!bilinearAt(width, height, u, v, &b)) {
        return 255.0f;
    }
    const float c00 = (float)alphas[b.y0 * width + b.x0], c10 = (float)alphas[b.y0 * width + b.x1];
    const float c01 = (float)alphas[b.y1 * width + b.x0], c11 = (float)alphas[b.y1 * width + b.x1];
    const float lower = c00 + (c10 - c00) * b.fx, upper = c01 + (c11 - c01) * b.fx;
    return lower + (upper - lower) * b.fy;
}

/// Opacity of a triangle at the barycentrics (u, v), 0 to 255.
WEDGE_FN float opacityAt(__global const uint* table, uint triangle, float u, float v)
{
    const uint at = table[triangle];
    if (at == WEDGE_NO_CUTOUT)
        return 255.0f;
    __global const Cutout* c = (__global const Cutout*)(table + at);
    if (c->alphas == WEDGE_NO_ALPHAS)
        return 255.0f * c->opacity;
    const float w = 1.0f - u - v;
    return c->opacity
        * sampleAlphas((__global const uchar*)(table + c->alphas), c->width, c->height,
            c->u[0] * w + c->u[1] * u + c->u[2] * v, c->v[0] * w + c->v[1] * u + c->v[2] * v);
}

/// Whether something in a triangle's plane covers it at the barycentrics (u, v).
WEDGE_FN bool isCovered(__global const uint* table, uint covers, float u, float v)
{
    __global const uint* grid = table + covers;
    const uint side = grid[0];
    const float x = (u - as_float(grid[1])) * as_float(grid[3]), y = (v - as_float(grid[2])) * as_float(grid[4]);
    const uint column = min((uint)fmax(x, 0.0f), side - 1u), row = min((uint)fmax(y, 0.0f), side - 1u);
    __global const uint* before = grid + WEDGE_COVER_HEADER + row * side + column;
    __global const float* edges = (__global const float*)(grid + WEDGE_COVER_HEADER + side * side + 1u);
    for (uint i = before[0]; i < before[1]; ++i) {
        __global const float* e = edges + WEDGE_COVER_WORDS * i;
        if (e[0] * u + e[1] * v + e[2] > 0.0f && e[3] * u + e[4] * v + e[5] > 0.0f && e[6] * u + e[7] * v + e[8] > 0.0f)
            return true;
    }
    return false;
}

/// Whether a ray that meets a triangle at the barycentrics (u, v) goes on through it. origin, direction: the ray's, in
/// the axes and units of its test.
WEDGE_FN bool isHole(
    __global const uint* table, uint triangle, float u, float v, Vec3 origin, Vec3 direction, float time)
{
    const uint at = table[triangle];
    if (at == WEDGE_NO_CUTOUT)
        return false;
    const uint covers = ((__global const Cutout*)(table + at))->covers;
    if (covers != WEDGE_NO_COVERS && isCovered(table, covers, u, v))
        return true;
    const float opacity = opacityAt(table, triangle, u, v);
    if (opacity >= 255.0f)
        return false;
    if (!(opacity > 0.0f))
        return true;
    return 255.0f * cutoutNumber(triangle, origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, time)
        >= opacity;
}

#endif

#endif
