// Multiple axis-aligned filters of soft shadows: a light in its own coordinates. docs/maaf.md
#ifndef WEDGE_SHARED_COMPONENTS_H
#define WEDGE_SHARED_COMPONENTS_H

#include "light.h"

/// Numbers of a channel that filters of both slopes go by: derivatives of first order along u and v, of second along
/// u u, u v and v v.
#define WEDGE_MOMENTS 5u
/// Such a filter's weights as a polynomial of z, by how much the light is displaced: 1 - ORDER1 z + ORDER2 z^2. A
/// Gaussian of deviation beta over distance makes of waves that are Omega fast, with these two numbers,
/// 1 - (beta Omega)^6 / 48, and no others leave so little.
#define WEDGE_ORDER1 0.625f
#define WEDGE_ORDER2 0.125f

WEDGE_SHARED_BEGIN

/// Coordinates of a Gaussian light, in standard deviations of its profile along either axis.
typedef struct {
    Vec3 centre; ///< metres
    float bandwidth; ///< Omega_max of (6) and (7) times a standard deviation; the paper's is 2
    Vec3 alongU, alongV; ///< 1/m: coordinates are their products with what a point is off the centre
} LightAxes;

/// The scores of first and second order of a light's profile l: -l'/l, and l''/l, of which integrals over the light are
/// second derivatives of what the light does where it moves.
typedef struct {
    LightScore first;
    float curve, square; ///< curve (a^2 - square), a from -1 to 1: see momentsOf()
} LightMoments;

WEDGE_INLINE float secondScoreOf(LightMoments light, float a) { return light.curve * (a * a - light.square); }

WEDGE_SHARED_END

#endif
