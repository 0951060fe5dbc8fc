// Light from beyond the scene by direction, a picture of the whole sphere, as the kernels look it up and choose among
// its directions.
#ifndef WEDGE_SHARED_ENVIRONMENT_H
#define WEDGE_SHARED_ENVIRONMENT_H

#include "maths.h"
#include "rng.h"
#include "vec.h"

WEDGE_SHARED_BEGIN

/// A map's columns are angles around `up`, evenly, its rows such from there. Its table has, one after the other, for
/// `texels` = width * height:
///   3 texels  radiance, R G B, W/(sr m^2), rows from above
///   height    numbers below it, and not below that of the row above, choose this row
///   texels    likewise of the columns of each row
///   height    bits of a whole number: of row i of n, the row that i/n chooses (as Emitter::guide)
///   texels    likewise of columns
///   height+1  cosines of the angles from `up` at which rows begin and end
///   27        of red, green and blue each the coefficients of unshadowedLight()
///   averages  radiance, R G B of each texel, of coarseLevels() maps
///   1         that stands behind the last texel, of which four numbers are read at once
///   3 texels  where suns were taken out: radiance with them; and again one more
typedef struct {
    uint width, height; ///< texels; 0: there is no map
    Vec3 right, up, back; ///< unit, in the world: what 3/4 of the width shows in the middle of the height, the upper
                          ///< edge, and both ends of the width there
    float dark; ///< luminance below which what hides a direction does not count, W/(sr m^2)
    uint seen; ///< 1: the camera sees it
    uint shown; ///< where in the table radiance is as the camera sees it, with suns; 0: as at its beginning
} EnvironmentMap;

/// Pre-computed samples: one in each cell of the square that sampleMap() spreads over the directions, so many a side,
/// row by row, of so many floats each: unit direction, radiance, density (1/sr), and one that nobody reads.
#define WEDGE_ENVIRONMENT_CELLS 64u
#define WEDGE_ENVIRONMENT_SAMPLE_FLOATS 8u

/// Pixels around one, either way, whose samples tell by how much unshadowedLobe() is off.
#define WEDGE_LOBE_REACH 4
/// The deviation that is assumed of it where they do not, over itself.
#define WEDGE_LOBE_ERROR 0.001f

/// Spherical harmonics of a channel.
#define WEDGE_HARMONICS 9u

/// Averages of the map, for what sees more of it than a texel: the first has so many columns and half as many rows,
/// each other one twice as many, up to the map's own or to the last.
#define WEDGE_COARSE_COLUMNS 16u
#define WEDGE_MOST_COARSE_LEVELS 6u

WEDGE_INLINE uint coarseLevels(uint width)
{
    uint levels = 1u;
    while (levels < WEDGE_MOST_COARSE_LEVELS && (WEDGE_COARSE_COLUMNS << (levels - 1u)) < width) {
        ++levels;
    }
    return levels;
}

/// How many floats the averages before a level have.
WEDGE_INLINE uint coarseLevelAt(uint level)
{
    return WEDGE_COARSE_COLUMNS * WEDGE_COARSE_COLUMNS / 2u * ((1u << (2u * level)) - 1u);
}

/// Where the coefficients of unshadowedLight() begin in the table.
WEDGE_INLINE uint environmentHarmonics(uint width, uint height) { return 5u * width * height + 3u * height + 1u; }

/// Where the averages do.
WEDGE_INLINE uint environmentAverages(uint width, uint height)
{
    return environmentHarmonics(width, height) + 3u * WEDGE_HARMONICS;
}

/// Floats of the table, without what the camera sees.
WEDGE_INLINE uint environmentTableSize(uint width, uint height)
{
    return environmentAverages(width, height) + coarseLevelAt(coarseLevels(width)) + 1u;
}

/// Where the map shows a direction, in widths and heights from its upper left corner.
WEDGE_FN Vec2 environmentCoordinates(EnvironmentMap m, Vec3 direction)
{
    const float x = vecDot(m.right, direction), y = vecDot(m.up, direction), z = vecDot(m.back, direction);
    return vec2(0.5f + turnOf(x, -z), 2.0f * turnOf(sqrt(x * x + z * z), y));
}

/// The unit direction at u widths, 0 to 1, `cosine` that of the angle from `up`.
WEDGE_FN Vec3 environmentDirection(EnvironmentMap m, float u, float cosine)
{
    const float sine = sqrt(fmax(0.0f, 1.0f - cosine * cosine));
    float across, along; // of the angle from the left edge, which is half a turn from the middle
    sinCosTurn(u, &across, &along);
    return vecMad(vecMad(vecScale(m.up, cosine), m.right, -sine * across), m.back, sine * along);
}

WEDGE_SHARED_END

#endif
