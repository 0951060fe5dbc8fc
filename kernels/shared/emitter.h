// Triangles that emit, as the kernels choose among them.
#ifndef WEDGE_SHARED_EMITTER_H
#define WEDGE_SHARED_EMITTER_H

#include "rng.h"
#include "vec.h"

/// In the place of a triangle's probability: it emits, but is part of another term.
#define WEDGE_PICK_ELSEWHERE (-1.0f)

/// In the place of a triangle's probability, from 2 on: its bits are this number and where among the probabilities the
/// header of its texture begins, of WEDGE_HEADER_WORDS:
///   the probability of the entry that it is part of
///   bits: WEDGE_PAIR_* of that entry, WEDGE_HEADER_SECOND, and by WEDGE_HEADER_CORNERS which of the triangle's corners
///   is the first of the entry's triangle, and which the second
///   bits: where the table begins
/// A table divides the square that an entry is spread over into cells: bits of the numbers of columns and of rows; for
/// each row the number below which, and not below that of the row before, a number chooses it; likewise of the columns
/// of each row.
#define WEDGE_PICK_TABLE 0x40000000u
#define WEDGE_HEADER_WORDS 3u
#define WEDGE_HEADER_SECOND 8u
#define WEDGE_HEADER_CORNERS 4u ///< bits to shift, two for each of both corners

/// Whether a triangle and the next one are chosen together, and which corners of a quadrilateral a, b, c, d they have.
#define WEDGE_PAIR_NONE 0u
#define WEDGE_PAIR_FIRST 1u ///< a, b, c and a, c, d
#define WEDGE_PAIR_SECOND 2u ///< a, b, d and b, c, d
#define WEDGE_PAIR_QUAD 3u ///< no triangle, but the area light of that number
/// No triangle, but a mesh: the square of a sample's two numbers is divided into `header` x `header` cells, row by row
/// from the entry `triangle` on, which is behind the list. A cell has in `triangle` the part that all of its numbers
/// choose a part of, in `upTo` and `extent` what the first number is multiplied with for that and what is added to it,
/// and in the bits of `guide` and `header` likewise for the second. A part that is split has an entry: `upTo` of one of
/// the two numbers chooses the first of its parts; these are `triangle` and `guide`, and `extent` and the bits of
/// `header` one over the shares of the numbers that choose them.
#define WEDGE_PAIR_MESH 4u

/// A part of a mesh is what it is and, in the bits below, a number. WEDGE_PAIR_NONE, _FIRST and _SECOND: plain faces,
/// of which that triangle is the first.
#define WEDGE_PART_SHIFT 29u
#define WEDGE_PART_NUMBER ((1u << WEDGE_PART_SHIFT) - 1u)
#define WEDGE_PART_TABLED 4u ///< faces with a table, which have that entry
#define WEDGE_PART_SPLIT_X 5u ///< split by the first number, at that entry
#define WEDGE_PART_SPLIT_Y 6u ///< by the second

WEDGE_SHARED_BEGIN

/// One of the scene's emitting triangles, or two that have a side in common, or an area light, or a mesh of them, in a
/// list that is searched by a number in [0, 1). Parts of meshes are behind it.
typedef struct {
    float upTo; ///< numbers below it, and not below that of the one before, choose this one
    uint triangle; ///< the first; or the number of the light
    float extent; ///< metres: how far its object's light is from the middle of that, root of the mean square
    uint pair; ///< WEDGE_PAIR_*
    uint guide; ///< of entry i of n: the entry that i/n chooses (Chen and Asau, On Generating Random Variates, 1974)
    uint header; ///< of its texture, among the probabilities (WEDGE_PICK_TABLE); 0: points are even over it
} Emitter;

/// Barycentric weights of a triangle's second and third corner for the numbers u, uniform over its area and with little
/// distortion (Heitz, A Low-Distortion Map Between Triangle and Square, 2019): strata stay compact.
WEDGE_INLINE Vec2 squareToTriangle(Vec2 u)
{
    const bool above = u.y > u.x;
    const float x = above ? 0.5f * u.x : u.x - 0.5f * u.y;
    const float y = above ? u.y - 0.5f * u.x : 0.5f * u.y;
    return vec2(x, y);
}

/// Which numbers u give these weights.
WEDGE_INLINE Vec2 triangleToSquare(Vec2 weights)
{
    const bool above = weights.y > weights.x;
    const float sum = weights.x + weights.y;
    return vec2(above ? 2.0f * weights.x : sum, above ? sum : 2.0f * weights.y);
}

/// Where in a pair the numbers u are: 1 for the second triangle, and the weights there. Strata of a parallelogram are
/// those of the square.
WEDGE_INLINE Vec2 squareToPair(uint pair, Vec2 u, uint* second)
{
    // The quadrilateral's point a + u.x (b - a) + u.y (d - a).
    const bool first = pair == WEDGE_PAIR_FIRST;
    const bool beyond = first ? u.y > u.x : u.x + u.y > 1.0f;
    const Vec2 ofFirst = first ? vec2(u.x - u.y, u.y) : u;
    const Vec2 ofSecond = first ? vec2(u.x, u.y - u.x) : vec2(u.x + u.y - 1.0f, 1.0f - u.x);
    *second = beyond ? 1u : 0u;
    return beyond ? ofSecond : ofFirst;
}

/// Which numbers u give these weights in that triangle of a pair.
WEDGE_INLINE Vec2 pairToSquare(uint pair, uint second, Vec2 weights)
{
    if (pair == WEDGE_PAIR_FIRST) {
        const float sum = weights.x + weights.y;
        return second != 0u ? vec2(weights.x, sum) : vec2(sum, weights.y);
    }
    return second != 0u ? vec2(1.0f - weights.y, weights.x + weights.y) : weights;
}

WEDGE_SHARED_END

#endif
