// Triangles that emit, as the kernels choose among them.
#ifndef WEDGE_SHARED_EMITTER_H
#define WEDGE_SHARED_EMITTER_H

#include "rng.h"
#include "vec.h"

/// In the place of a triangle's probability: it emits, but is part of another term.
#define WEDGE_PICK_ELSEWHERE (-1.0f)

/// Whether a triangle and the next one are chosen together, and which corners of a quadrilateral a, b, c, d they have.
#define WEDGE_PAIR_NONE 0u
#define WEDGE_PAIR_FIRST 1u ///< a, b, c and a, c, d
#define WEDGE_PAIR_SECOND 2u ///< a, b, d and b, c, d
#define WEDGE_PAIR_QUAD 3u ///< no triangle, but the area light of that number

WEDGE_SHARED_BEGIN

/// One of the scene's emitting triangles, or two that have a side in common, or an area light, in a list that is
/// searched by a number in [0, 1).
typedef struct {
    float upTo; ///< numbers below it, and not below that of the one before, choose this one
    uint triangle; ///< the first; or the number of the light
    float extent; ///< metres: how far its object's light is from the middle of that, root of the mean square
    uint pair; ///< WEDGE_PAIR_*
    uint guide; ///< of entry i of n: the entry that i/n chooses (Chen and Asau, On Generating Random Variates, 1974)
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

WEDGE_SHARED_END

#endif
