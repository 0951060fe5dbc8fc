// Bandwidths of light from beyond the scene by curvature and occluders, (6.13), (6.17), (6.19); docs/environment.md.
#ifndef WEDGE_SHARED_CURVATURE_H
#define WEDGE_SHARED_CURVATURE_H

#include "material.h"
#include "maths.h"

/// The 99 % bandwidth of a Gaussian's energy, in standard deviations of its spectrum: erf(x) = 0.99.
#define WEDGE_GAUSSIAN_BANDWIDTH 1.82138637f

/// Pixels around one, either way, the nearest of whose occluders it takes, and over which the mean of those goes.
#define WEDGE_OCCLUDER_REACH 1
#define WEDGE_OCCLUDER_MEAN_REACH 3

WEDGE_SHARED_BEGIN

/// Curvatures and distances of occluders to the widths of filters along the image's axes. Bandwidths are
/// angular frequencies, per radian.
typedef struct {
    uint x0, y0, x1, y1; ///< the pixels to produce, half open; x0 a multiple of WEDGE_BLOCK_PIXELS
    uint height, stride, planeSize;
    uint component; ///< WEDGE_COMPONENT_ENVIRONMENT, or of lobes
    float curvedBand; ///< what curvature is multiplied by: B_f of the clamped cosine, or more
    float cosineBand; ///< B_f where something is hidden
    float hiddenLobes; ///< B_rho where something is hidden count so often
    float lightBand; ///< B_e, of the map
    uint isSigned; ///< 1: concave surfaces have negative curvatures; 0: they count as convex ones
    float leastPixels, mostPixels; ///< widths, in sides of the surface that the pixel sees
} CurvatureParams;

/// B_rho of a lobe: cos^n is a Gaussian of variance 1/n to within what is left of it beyond its width.
WEDGE_FN float lobeBandwidth(Gloss lobe)
{
    return WEDGE_GAUSSIAN_BANDWIDTH * sqrt(fmax(exponentAs(lobe, WEDGE_PHONG), 0.0f));
}

/// B_x of (6.13), and with a lobe's B_rho of (6.17) or, with other constants, (6.19), 1/m. curvature: 1/m, convex is
/// positive; occluded: the largest cos^2 theta / z of an occluder at height z, 1/m, 0 where nothing is hidden; lobe:
/// B_rho, 0 of diffuse reflection.
WEDGE_FN float curvatureBandwidth(CurvatureParams p, float curvature, float occluded, float lobe)
{
    const float bent = p.isSigned != 0u ? curvature : fabs(curvature);
    return bent * (p.curvedBand + 2.0f * lobe) + occluded * (p.cosineBand + p.hiddenLobes * lobe + p.lightBand);
}

WEDGE_SHARED_END

#endif
