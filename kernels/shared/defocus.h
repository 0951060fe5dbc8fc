// The frequency analysis of several effects in one frame (thesis chapter 5 and appendix B), and what it leaves open,
// lens and motion together: from blurs to bandlimits, from bandlimits to counts and kernels. docs/multiple-effects.md
// has the derivations and says which printed formulas are off.
//
// Frequencies are in 1/pixel. A *blur* is the extent in pixels over which one dimension of the integral (lens, light,
// incoming direction, time) spreads a point of the image: the inverse of the bandlimit that it alone would set.
#ifndef WEDGE_SHARED_DEFOCUS_H
#define WEDGE_SHARED_DEFOCUS_H

#include "compat.h"

/// Omega_pix_max: one sample a pixel (section 5.4).
#define WEDGE_PIXEL_BANDLIMIT 0.5f
/// Omega_u_max of a lens over u in [-1, 1] (section 5.4).
#define WEDGE_LENS_BANDLIMIT 1.0f
/// Omega_t_max for speeds in pixels a shutter: half of the shutter counts as a lens' radius does.
#define WEDGE_SHUTTER_BANDLIMIT 2.0f
/// The constant of the kernels (5.31) and (5.33), exp(-16 d^2 Omega^2): a standard deviation of 0.177 / Omega.
#define WEDGE_KERNEL_FACTOR 16.0f
/// Standard deviation of a kernel over the blur's half-extent, r or |v|/2: errors of an edge are 1.2 % RMS.
#define WEDGE_KERNEL_WIDTH 0.17677670f
/// Explicit bounds: pixels of any blur; metres of depths and of a pixel's size.
#define WEDGE_BLUR_MAX 1e4f
#define WEDGE_DEPTH_MIN 1e-6f
#define WEDGE_PIXEL_SIZE_MIN 1e-9f
/// Pixels that a kernel may spread sideways when velocities disagree, as a standard deviation; and the least across a
/// line-shaped kernel, so that it meets pixels at any angle.
#define WEDGE_KERNEL_SIDEWAYS 0.3f
/// Pixels^2; below it a kernel is its own pixel alone: neighbours weigh exp(-50).
#define WEDGE_KERNEL_VARIANCE_MIN 0.01f

WEDGE_SHARED_BEGIN

/// A blur within [0, WEDGE_BLUR_MAX]; what is not a number counts as none.
WEDGE_FN float boundedBlur(float blur) { return fmin(fmax(blur, 0.0f), WEDGE_BLUR_MAX); }

/// Signed radius in pixels of the circle of confusion, (5.2): r = (aW/S)(f/z - 1) = (a/p)(1/z - 1/f), as p = S/(Wf).
/// The ray of lens position u in the unit disc through pixel x meets what is at depth z where the pinhole's ray of
/// pixel x + r u does: r is positive before the plane in focus. apertureRadius: a; focusDistance, depth: metres along
/// the view axis, infinity allowed; pixelStep: p, length of FrameParams::right, above 0. Within +-WEDGE_BLUR_MAX.
WEDGE_FN float circleOfConfusion(float apertureRadius, float focusDistance, float depth, float pixelStep)
{
    const float r = apertureRadius / pixelStep
        * (1.0f / fmax(depth, WEDGE_DEPTH_MIN) - 1.0f / fmax(focusDistance, WEDGE_DEPTH_MIN));
    return fmin(fmax(r, -WEDGE_BLUR_MAX), WEDGE_BLUR_MAX);
}

/// Blur of the lens: |r| / Omega_u_max.
WEDGE_FN float lensBlur(float r) { return boundedBlur(fabs(r) * (1.0f / WEDGE_LENS_BANDLIMIT)); }

/// Blur of an area light behind an occluder: l_I s / l_p, with s = d1/d2 - 1 (5.17) and Omega_y_max = 1/l_I.
/// lightExtent: l_I; pixelSize: l_p, both metres.
WEDGE_FN float lightBlur(float slope, float lightExtent, float pixelSize)
{
    return boundedBlur(lightExtent * slope / fmax(pixelSize, WEDGE_PIXEL_SIZE_MIN));
}

/// Blur of incoming light from reflectors at that distance: z / (Omega_v_max l_p). transferBandlimit: Omega_v_max,
/// WEDGE_DIFFUSE_BANDLIMIT or glossyBandlimit().
WEDGE_FN float directionBlur(float distance, float transferBandlimit, float pixelSize)
{
    return boundedBlur(distance / (transferBandlimit * fmax(pixelSize, WEDGE_PIXEL_SIZE_MIN)));
}

/// Blur of the shutter: |v| / Omega_t_max. speed: image-space distance in pixels over the whole shutter, of a surface
/// or of a shadow.
WEDGE_FN float shutterBlur(float speed) { return boundedBlur(fabs(speed) * (1.0f / WEDGE_SHUTTER_BANDLIMIT)); }

/// Blur of two independent dimensions along one image axis: variances add, which is exact for Gaussian profiles. The
/// thesis takes the larger in (5.18) and (5.22), up to sqrt(2) less.
WEDGE_FN float combinedBlur(float first, float second) { return boundedBlur(sqrt(first * first + second * second)); }

/// min(Omega_pix_max, 1/blur), in (1/WEDGE_BLUR_MAX .. 0.5).
WEDGE_FN float bandlimitOfBlur(float blur) { return 1.0f / fmax(boundedBlur(blur), 1.0f / WEDGE_PIXEL_BANDLIMIT); }

/// Omega_x^d, (5.7). rMin: least |r| in the pixel, 0 where r changes its sign.
WEDGE_FN float defocusBandlimit(float rMin) { return bandlimitOfBlur(lensBlur(rMin)); }

/// Omega_x^s, (5.18), of irradiance from a light.
WEDGE_FN float shadowBandlimit(float sMin, float lightExtent, float pixelSize, float rMin)
{
    return bandlimitOfBlur(fmax(lightBlur(sMin, lightExtent, pixelSize), lensBlur(rMin)));
}

/// Omega_x^i, (5.22), of indirect irradiance. zMin: distance in metres of the nearest reflector.
WEDGE_FN float indirectBandlimit(float zMin, float transferBandlimit, float pixelSize, float rMin)
{
    return bandlimitOfBlur(fmax(directionBlur(zMin, transferBandlimit, pixelSize), lensBlur(rMin)));
}

/// Omega_x,p^m, (B.1), of texture along its velocity, and Omega_x,s^m, (B.2), of irradiance along a shadow's.
WEDGE_FN float motionBandlimit(float speed) { return bandlimitOfBlur(shutterBlur(speed)); }

/// min(Omega_pix_max, mu Omega), (5.29).
WEDGE_FN float scaledBandlimit(float bandlimit, float mu) { return fmin(WEDGE_PIXEL_BANDLIMIT, mu * bandlimit); }

/// Samples along one dimension beside the pixel's, 1 + blur Omega: spectrum and filter side by side (Fig. 5.6).
WEDGE_FN float packing(float blurMax, float bandlimit) { return 1.0f + boundedBlur(blurMax) * bandlimit; }

/// Samples of the image along one of its axes, Omega_pix_max + Omega.
WEDGE_FN float pixelPacking(float bandlimit) { return WEDGE_PIXEL_BANDLIMIT + bandlimit; }

/// n_p, (5.24), as a real number. bandlimit: Omega_x^d, with (5.29) scaled.
WEDGE_FN float primaryCount(float bandlimit, float rMax)
{
    const float oneAxis = pixelPacking(bandlimit) * packing(lensBlur(rMax), bandlimit);
    return oneAxis * oneAxis;
}

/// n_dir factored, (5.25), of bandlimit Omega_x^s; combined, (5.27), of bandlimit Omega_x^d.
WEDGE_FN float directCount(float bandlimit, float rMax, float sMax, float lightExtent, float pixelSize)
{
    const float light = packing(lightBlur(sMax, lightExtent, pixelSize), bandlimit);
    return primaryCount(bandlimit, rMax) * light * light;
}

/// n_ind factored, (5.26), of bandlimit Omega_x^i; combined, (5.28), of bandlimit Omega_x^d. Both divided by
/// Omega_v_max^2, as (5.25) is by Omega_y_max^2: the printed ones do not become n_p at contacts.
WEDGE_FN float indirectRayCount(float bandlimit, float rMax, float zMax, float transferBandlimit, float pixelSize)
{
    const float directions = packing(directionBlur(zMax, transferBandlimit, pixelSize), bandlimit);
    return primaryCount(bandlimit, rMax) * directions * directions;
}

/// n_p of motion, (B.3), as printed: with the squares of the two axes of a lens. jointCount() has time's one.
WEDGE_FN float motionCountPrinted(float bandlimit, float speed)
{
    const float oneAxis = pixelPacking(bandlimit) * packing(shutterBlur(speed), bandlimit);
    return oneAxis * oneAxis;
}

/// Bandlimit along the velocity under lens and motion: 1/Omega^2 = (r/Omega_u_max)^2 + (|v|/Omega_t_max)^2, at most
/// Omega_pix_max. Across the velocity it is defocusBandlimit(). Of the least |r| and |v| in the pixel.
WEDGE_FN float jointBandlimit(float rMin, float speedMin)
{
    return bandlimitOfBlur(combinedBlur(lensBlur(rMin), shutterBlur(speedMin)));
}

/// Primary rays under lens and motion, bandlimits along the velocity and across it; (5.24) where nothing moves, and for
/// a pinhole (B.3) without its squares.
WEDGE_FN float jointCount(float along, float across, float rMax, float speedMax)
{
    const float lens = packing(lensBlur(rMax), along) * packing(lensBlur(rMax), across);
    return pixelPacking(along) * pixelPacking(across) * lens * packing(shutterBlur(speedMax), along);
}

/// Pixels along the mean velocity that all velocities of a pixel share: the least speed, shortened until the parts
/// across the mean spread a kernel by at most WEDGE_KERNEL_SIDEWAYS. Opposite velocities share next to nothing, and
/// where something stands still it is 0. speedMin, meanSpeed: of |v|; speedOfMean: |mean of v|; pixels. shutterWidth:
/// the kernel's standard deviation as a part of |v|.
WEDGE_FN float commonSpeed(float speedMin, float meanSpeed, float speedOfMean, float shutterWidth)
{
    const float across = sqrt(fmax(meanSpeed * meanSpeed - speedOfMean * speedOfMean, 0.0f));
    const float sideways = shutterWidth * across;
    return boundedBlur(speedMin) * (sideways > WEDGE_KERNEL_SIDEWAYS ? WEDGE_KERNEL_SIDEWAYS / sideways : 1.0f);
}

/// Standard deviation in pixels of the kernel exp(-factor d^2 Omega^2), (5.31) and (5.33); times l_p for metres.
WEDGE_FN float kernelDeviation(float bandlimit, float factor) { return 1.0f / (sqrt(2.0f * factor) * bandlimit); }

/// A symmetric 2x2 matrix: pixels^2 as a covariance, 1/pixels^2 as an exponent.
typedef struct {
    float xx, xy, yy;
} Symmetric2;

/// Covariance of the kernel under lens and motion: (lensWidth r)^2 I + shutterWidth^2 v v^T. Widths are standard
/// deviations as parts of r and of |v|; r, (vx, vy): least circle and common velocity in the pixel.
WEDGE_FN Symmetric2 blurCovariance(float r, float vx, float vy, float lensWidth, float shutterWidth)
{
    const float lens = lensWidth * boundedBlur(fabs(r));
    const float x = shutterWidth * fmin(fmax(vx, -WEDGE_BLUR_MAX), WEDGE_BLUR_MAX);
    const float y = shutterWidth * fmin(fmax(vy, -WEDGE_BLUR_MAX), WEDGE_BLUR_MAX);
    Symmetric2 covariance;
    covariance.xx = lens * lens + x * x;
    covariance.xy = x * y;
    covariance.yy = lens * lens + y * y;
    return covariance;
}

/// Larger (sign = 1) or smaller (sign = -1) eigenvalue.
WEDGE_FN float eigenvalue(Symmetric2 m, float sign)
{
    const float difference = 0.5f * (m.xx - m.yy);
    return 0.5f * (m.xx + m.yy) + sign * sqrt(difference * difference + m.xy * m.xy);
}

/// The form Q for which exp(-d^T Q d) is the Gaussian of that covariance. A line-shaped covariance is widened across to
/// WEDGE_KERNEL_SIDEWAYS or to a round one, whichever is less, and any to WEDGE_KERNEL_VARIANCE_MIN.
WEDGE_FN Symmetric2 kernelExponent(Symmetric2 covariance)
{
    const float wide = fmax(eigenvalue(covariance, 1.0f), WEDGE_KERNEL_VARIANCE_MIN);
    const float thin = fmax(eigenvalue(covariance, -1.0f), 0.0f);
    const float across = fmax(thin, fmin(wide, WEDGE_KERNEL_SIDEWAYS * WEDGE_KERNEL_SIDEWAYS));
    // Cosine and sine of twice the angle of the long axis; of a round one any.
    const float length = wide - thin;
    const float cosine = length > 0.0f ? fmin(fmax((covariance.xx - covariance.yy) / length, -1.0f), 1.0f) : 1.0f;
    const float sine = length > 0.0f ? fmin(fmax(2.0f * covariance.xy / length, -1.0f), 1.0f) : 0.0f;
    const float along = 0.5f / wide, sideways = 0.5f / across;
    Symmetric2 exponent;
    exponent.xx = 0.5f * (along + sideways) + 0.5f * (along - sideways) * cosine;
    exponent.yy = 0.5f * (along + sideways) - 0.5f * (along - sideways) * cosine;
    exponent.xy = 0.5f * (along - sideways) * sine;
    return exponent;
}

/// d^T Q d.
WEDGE_FN float quadraticForm(Symmetric2 m, float x, float y) { return (m.xx * x + 2.0f * m.xy * y) * x + m.yy * y * y; }

/// Equal samples that the kernel of that covariance averages, (sum w)^2 / sum w^2: 2 sqrt(pi) standard deviations an
/// axis, at least one pixel each.
WEDGE_FN float gatheredPixels(Symmetric2 covariance)
{
    const float along = 3.5449077f * sqrt(fmax(eigenvalue(covariance, 1.0f), 0.0f));
    const float across = 3.5449077f * sqrt(fmax(eigenvalue(covariance, -1.0f), 0.0f));
    return fmax(along, 1.0f) * fmax(across, 1.0f);
}

WEDGE_SHARED_END

#endif
