// Shadows that are drawn in a style (kernels/light/shadow_edges.cl, shadow_distance.cl, shadow_styles.cl; soft ones
// also shadow_levels.cl).
#ifndef WEDGE_SHARED_STYLED_SHADOWS_H
#define WEDGE_SHARED_STYLED_SHADOWS_H

#include "vec.h"

/// What is known of a light at a pixel's surface.
#define WEDGE_MATTE_LIT 1.0f
#define WEDGE_MATTE_SHADOW 0.0f
#define WEDGE_MATTE_UNKNOWN (-1.0f) ///< it faces away from the light, or there is no surface

/// What an object has to do with a matte of casters: its shadow is there, or in another matte of the light. Others have
/// 0.
#define WEDGE_CASTS 1u
#define WEDGE_CASTS_ELSEWHERE 2u

/// Cells, squares between the middles of four pixels, along each side of a tile of which one work-item lists the edges.
#define WEDGE_EDGE_TILE 16u
/// Numbers of a piece of edge in their list: its middle (metres), its normal, its length (metres), and
/// where knobs go by it how far what hides the light is from the shadow beside it (metres), else 0.
#define WEDGE_EDGE_FLOATS 8u
/// Pieces that a box is around, and numbers of a box: its least and its largest corner.
#define WEDGE_EDGE_CHUNK 32u
#define WEDGE_EDGE_BOX 6u

/// Surfaces of normals within 45 degrees are one.
#define WEDGE_SURFACE_COSINE 0.70710678f
/// Of the mean distance of the power 8 to a straight edge: sqrt(pi) Gamma(7/2) / Gamma(4).
#define WEDGE_EDGE_CONSTANT 0.98174770f
/// Edges count that are within so many times the largest distance that is told apart.
#define WEDGE_EDGE_REACH 3.0f

/// Of a blur: deviations as far as which it reaches, and taps along an axis to either side, at most.
#define WEDGE_STYLE_CUT 3.0f
#define WEDGE_STYLE_TAPS 10

/// Levels of what is seen of a light that a soft shadow is drawn by.
#define WEDGE_SHADOW_LEVELS 8u
/// Planes of what they say: what is seen by them as it is, and in a style; by how much distances differ, metres, in the
/// mean; and the distance to the nearest of their edges, metres.
#define WEDGE_LEVEL_PLAIN 0u
#define WEDGE_LEVEL_STYLED 1u
#define WEDGE_LEVEL_MOVED 2u
#define WEDGE_LEVEL_NEAREST 3u
#define WEDGE_LEVEL_PLANES 4u

/// Classes of distances that shadows' areas are counted by, of so many bits, and of each as many; and stripes of rows
/// that are counted by themselves. Each has the classes, and behind them what is in shadow and what is lit.
#define WEDGE_AREA_BITS 10u
#define WEDGE_AREA_BINS 1024u
#define WEDGE_AREA_NUMBERS 1026u
#define WEDGE_AREA_STRIPES 64u

WEDGE_SHARED_BEGIN

/// A knob of a style: base + linear d + square d^2, within bounds, d metres from the point in shadow to what hides
/// the light.
typedef struct {
    float base, linear, square;
    float least, most; ///< both the base where that is all
} StyleKnob;

WEDGE_SHARED_END

#endif
