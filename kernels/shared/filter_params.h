// Parameters of the analysis and of the image-space filter of one light's term.
#ifndef WEDGE_SHARED_FILTER_PARAMS_H
#define WEDGE_SHARED_FILTER_PARAMS_H

#include "vec.h"

/// Scales of demands that are tried at once (counts.cl), how often, and stripes of rows that add up what each would
/// take. A stripe's sums: of each scale, and the pixels that take samples.
#define WEDGE_SCALES 16u
#define WEDGE_SCALE_ROUNDS 3
#define WEDGE_SCALE_STRIPES 128u
#define WEDGE_SCALE_SUMS 17u
/// What a list of scales holds after those that are tried: the one that was found, the first kind's mean count, and
/// how far those counts are to be even.
#define WEDGE_SCALE_FOUND 16u
#define WEDGE_SCALE_MEAN 17u
#define WEDGE_SCALE_EVEN 18u
#define WEDGE_SCALE_NUMBERS 19u
/// Shares of even counts that are tried, in a vector: quarters from 0 to 1, and 1 again.
#define WEDGE_EVEN_SHARES 8u

/// Sums that a plane of counts is added up to (tally.cl), each of so manieth rows.
#define WEDGE_TALLY_STRIPES 1024u

/// Pixels around one whose uncertainties make its demand, either way (demand.cl).
#define WEDGE_DEMAND_REACH 2

/// Pixels around one whose differences and noise say which of two estimates is to be trusted, either way.
#define WEDGE_SHRINK_REACH 3

WEDGE_SHARED_BEGIN

/// The gather of the separable Gaussian (thesis 3.10 to 3.12) around one light.
typedef struct {
    Vec3 eye; ///< metres
    Vec3 forward; ///< unit
    Vec3 right, down; ///< image-plane steps of one pixel at distance 1
    Vec3 lightCentre; ///< metres
    Vec3 lightNormal; ///< unit
    float normalCosine; ///< neighbours whose normal is farther off than this cosine are not gathered
    float cut; ///< kernel radius in standard deviations
    uint oblique; ///< 1: distance measured along the ray to the light's centre; 0: along its normal (3.12)
    uint narrower; ///< 1: the narrower of both pixels' kernels weights a pair; 0: the gathering pixel's
    uint maxRadius; ///< pixels, at most WEDGE_MAX_RADIUS
    uint width, stride, planeSize;
    uint x0, y0, x1, y1; ///< the pixels to produce, half open; x0 a multiple of WEDGE_BLOCK_PIXELS
    uint height;
    uint surface; ///< 1: neighbours weigh by the surface that they see, and those off the pixel's surface are left out
    uint fitted; ///< planes, the first ones of a value: of those a line's fit and not its mean comes out
    float most; ///< that a fit may be, where the mean is not more: 1 of shares of light
    Vec3 shearU, shearV; ///< of the sheared filter: what a neighbour's offset is multiplied by, over the pixel's
                         ///< slopeWidth, for what its gradients count
} FilterParams;

/// The analysis of one light: slopes to widths and counts.
typedef struct {
    uint x0, y0, x1, y1; ///< the pixels to produce, half open; x0 a multiple of WEDGE_BLOCK_PIXELS
    uint width, height, stride, planeSize;
    float sigma; ///< metres, the light's standard deviation
    float lightSize; ///< metres, sqrt(A_l) of (3.21)
    float k, mu, alpha; ///< of (3.13) and (3.21)
    uint fillRadius; ///< pixels that slopes spread to pixels without one, at most WEDGE_ROW_PADDING
    float fillScale; ///< -log2(e) / (2 s^2) of the spreading Gaussian of s pixels; 0: plain mean
    uint countCap; ///< most samples a pixel may take
    float fixedWidth; ///< pixels; more than 0: this width everywhere in place of the analysis
    float countExponent; ///< of the counts from variance: n ~ (v / K)^exponent
    float varianceFloor; ///< least variance where there are slopes
    float varianceSpread; ///< fraction of the 5x5 neighbours' largest v / K that a pixel takes at least
    Vec3 lightCentre; ///< metres
    uint leastCount; ///< samples that every pixel takes, at least those of the first pass
} AnalysisParams;

WEDGE_SHARED_END

#endif
