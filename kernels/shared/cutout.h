// What rays pass through: triangles of materials whose opacity is below 1, or has a texture, and what lies behind
// lights in the plane of a triangle.
#ifndef WEDGE_SHARED_CUTOUT_H
#define WEDGE_SHARED_CUTOUT_H

#include "rng.h"

/// Where a triangle has no Cutout, or a Cutout no texture or nothing that covers it: no offset is 0.
#define WEDGE_NO_CUTOUT 0u
#define WEDGE_NO_ALPHAS 0u
#define WEDGE_NO_COVERS 0u

WEDGE_SHARED_BEGIN

/// The opacity of a triangle: a constant, or a constant times a texture's; 0 where it is covered.
///
/// The table of cut-outs is words: one a triangle of the scene, the offset of its Cutout in words from the table's
/// start or WEDGE_NO_CUTOUT; then the Cutouts; then textures, a byte a texel (255: opaque), row 0 is v = 0; then
/// covers.
///
/// Covers of a triangle are a grid over a part of its barycentrics (u, v), of `side` cells an axis: the side; the least
/// u and v; cells for each unit of u and of v; then, row by row, how many covers come before each cell, and how many
/// there are; then the covers, cell by cell, nine numbers each: (a, b, c) of three edges, inside of which
/// a u + b v + c > 0.
typedef struct {
    float u[3], v[3]; ///< texture coordinates of the corners
    float opacity; ///< 0 to 1
    uint alphas; ///< where the texture begins, in words from the table's start; WEDGE_NO_ALPHAS: there is none
    uint width, height; ///< of the texture
    uint covers; ///< where they begin, in words from the table's start; WEDGE_NO_COVERS: there are none
} Cutout;

#define WEDGE_CUTOUT_WORDS 11u
#define WEDGE_COVER_WORDS 9u
#define WEDGE_COVER_HEADER 5u ///< words before the counts

/// The number in [0, 1) that decides whether a ray sees a triangle: it does where the triangle's opacity is larger.
/// It depends on ray and triangle alone, so that every traversal decides alike, however often and in whatever order
/// it comes to the triangle, and rays through the same point decide independently: their mean is the opacity.
WEDGE_FN float cutoutNumber(uint triangle, float ox, float oy, float oz, float dx, float dy, float dz, float time)
{
    uint hash = hashCombine(as_uint(ox), as_uint(oy));
    hash = hashCombine(hash, as_uint(oz));
    hash = hashCombine(hash, as_uint(dx));
    hash = hashCombine(hash, as_uint(dy));
    hash = hashCombine(hash, as_uint(dz));
    hash = hashCombine(hash, as_uint(time));
    return toUnitFloat(hashCombine(hash, triangle));
}

WEDGE_SHARED_END

#endif
