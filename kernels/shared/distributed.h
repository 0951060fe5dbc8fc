// Parameters of the analysis of distributed frames: pixels that see the scene through a lens, a shutter or all of their
// square.
#ifndef WEDGE_SHARED_DISTRIBUTED_H
#define WEDGE_SHARED_DISTRIBUTED_H

#include "vec.h"

/// Primary samples that a pixel takes in one step of a progressive frame at most: a wave holds those of a tile.
#define WEDGE_MOST_NEW_SAMPLES 1024u

/// Radius of the median of flags, pixels (published.cl).
#define WEDGE_MEDIAN_RADIUS 2

/// Pixels that the kernel along a motion reaches at most.
#define WEDGE_MOTION_REACH 160

WEDGE_SHARED_BEGIN

typedef struct {
    uint x0, y0, x1, y1; ///< the pixels to produce, half open; x0 a multiple of WEDGE_BLOCK_PIXELS
    uint width, height, stride, planeSize;
    float factoringError; ///< largest |L - k E| of pixels whose irradiance is filtered, thesis (5.30)
    uint factoringRadius; ///< pixels: the error is the mean of the signed one over a square of this radius
    float blurWidth; ///< standard deviation of the image-space filter: blurWidth r (n r^2)^-blurExponent pixels, of
    float blurExponent; ///< the circle of confusion's radius r and n primary samples
    float shutterWidth; ///< likewise shutterWidth h (n h)^-shutterExponent of half the motion's length, h
    float shutterExponent;
    float leastRadius; ///< pixels: smaller circles of confusion and motions are not filtered
    float irradianceWidth; ///< of the irradiance's filter: its least standard deviation in radii of the circle of
                           ///< confusion
    float rays; ///< of one sample of the term
    uint values; ///< planes of what is filtered of the term: 1, a light's visibility; 3, radiance
    float oneVelocity; ///< largest difference of motions in a pixel that counts as one, as a fraction of the motion
    uint never; ///< 1: textures and irradiances are never taken apart
    float samples; ///< primary samples that a pixel is expected to have; 0: those that it has
    uint published; ///< 1: terms are kept as published, see accumulate.h
    float frames; ///< of which the image is the mean: each has as many samples
    uint alongMotion; ///< of demands: 1, of textures, which are filtered along the motion, too
} DistributedParams;

WEDGE_SHARED_END

#endif
