// The frequency analysis of indirect light (thesis chapter 4 and appendix A): bandlimits of the transfer functions,
// from them and the reflectors' distances the width of the image filter and the number of samples.
#ifndef WEDGE_SHARED_INDIRECT_H
#define WEDGE_SHARED_INDIRECT_H

#include "bsdf.h"

/// Rays of the first pass, 4 x 4 strata (section 4.5).
#define WEDGE_INDIRECT_FIRST_RAYS 16u
/// Bandlimit of the diffuse transfer function (4.18), per unit of the plane at distance 1.
#define WEDGE_DIFFUSE_BANDLIMIT 2.8f
/// Scaling of counts for cosine-weighted samples (section 4.4.3).
#define WEDGE_DIFFUSE_GAMMA 0.4f

/// Of the harmonic mean of distances, what stands for the least one, if none is nearer; where planes have no room for
/// both the mean and the least, it is built into what they have.
#define WEDGE_NEAREST_FRACTION 0.3f

WEDGE_SHARED_BEGIN

/// Bandlimit of a specular lobe's transfer function (A.3), (A.5): fits to the exponents 4 to 50. Beyond them they go on
/// as lines, which errs to narrow filters for exponents below 4; negative exponents count as 0.
WEDGE_FN float glossyBandlimit(float exponent, uint kind)
{
    const float m = fmax(exponent, 0.0f);
    return kind == WEDGE_PHONG ? 4.27f + 0.15f * m : 3.6f + 0.084f * m;
}

/// Scaling of counts for samples of a lobe: the part of the quarter circle that holds 80 % of it (section 4.4.3).
WEDGE_FN float glossyGamma(float exponent)
{
    return acos(pow(0.70710678f, 1.0f / fmax(exponent, 1.0f))) * (2.0f * WEDGE_INV_PI);
}

/// Bandwidth of the filtered image in 1/m, (4.15): Omega_r = mu min(Omega_h / z_min, alpha / d).
/// zMin: distance of the nearest reflector, pixelSize: d, both metres and above 0; alpha 0: no bound from the pixel's.
WEDGE_FN float indirectBandwidth(float zMin, float bandlimit, float pixelSize, float mu, float alpha)
{
    const float transfer = bandlimit / zMin;
    return mu * (alpha > 0.0f ? fmin(transfer, alpha / pixelSize) : transfer);
}

/// Samples a pixel needs, (4.21), as a real number; pixelSize = sqrt(A_p).
WEDGE_FN float indirectCount(
    float zMin, float zMax, float bandlimit, float gamma, float pixelSize, float mu, float alpha)
{
    const float spatial = mu * bandlimit * pixelSize / zMin + alpha;
    const float angular = bandlimit * (1.0f + mu * zMax / zMin);
    return gamma * spatial * spatial * angular * angular;
}

WEDGE_SHARED_END

#endif
