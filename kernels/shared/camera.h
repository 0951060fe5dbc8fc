// The thin-lens camera with a shutter: from random numbers to rays, and where points appear in the image.
#ifndef WEDGE_SHARED_CAMERA_H
#define WEDGE_SHARED_CAMERA_H

#include "light.h"

/// Apertures and shutters that are Gaussian end at this many standard deviations.
#define WEDGE_APERTURE_CUT 2.0f
/// Parallel to forward, of a point that is projected, metres: what is nearer, or behind, is projected as if it were
/// here.
#define WEDGE_LEAST_DEPTH 1e-6f
#define WEDGE_TWO_PI 6.28318531f
/// Filters of pixels. None: rays go through the centre.
#define WEDGE_PIXEL_CENTRE 0u
#define WEDGE_PIXEL_BOX 1u
#define WEDGE_PIXEL_GAUSSIAN 2u
#define WEDGE_PIXEL_BLACKMAN_HARRIS 3u
/// How far from the centre the wide ones end, pixels, and the Gaussian's standard deviation.
#define WEDGE_PIXEL_REACH 1.5f
#define WEDGE_PIXEL_SIGMA 0.5f
#define WEDGE_PIXEL_ERF 0.9973002f ///< erf(WEDGE_PIXEL_REACH / WEDGE_PIXEL_SIGMA / sqrt 2)

WEDGE_SHARED_BEGIN

/// The camera at shutter time 0, and what is added to it by time 1. Vectors as those of FrameParams.
typedef struct {
    Vec3 eye;
    float apertureRadius; ///< metres; 0: pinhole
    Vec3 forward;
    float focusDistance; ///< metres along forward
    Vec3 right;
    uint gaussianAperture; ///< 1: the radius is WEDGE_APERTURE_CUT standard deviations; 0: uniform
    Vec3 down;
    uint gaussianShutter; ///< the same of half the time
    Vec3 eyeMotion;
    uint pixelFilter; ///< WEDGE_PIXEL_*: where in a pixel and around it its rays go through
    Vec3 forwardMotion;
    float erfCut; ///< erf(WEDGE_APERTURE_CUT / sqrt 2)
    Vec3 rightMotion;
    uint shutter; ///< 1: anything moves while it is open
    Vec3 downMotion;
    float pixelStep; ///< |right|
} CameraParams;

/// A primary ray: origin + t direction lies at depth t along the view axis.
typedef struct {
    Vec3 origin, direction;
    float time;
} CameraRay;

/// How far from a pixel's centre, pixels along one axis, its ray goes through, of a uniform number: distributed as the
/// filter weighs what is there.
WEDGE_FN float pixelOffset(uint filter, float u)
{
    const float x = 2.0f * u - 1.0f;
    if (filter == WEDGE_PIXEL_BOX) {
        return u - 0.5f;
    }
    if (filter == WEDGE_PIXEL_GAUSSIAN) {
        const float cut = WEDGE_PIXEL_REACH / WEDGE_PIXEL_SIGMA;
        return WEDGE_PIXEL_REACH * lightCoordinate(u, WEDGE_PROFILE_GAUSSIAN, cut, WEDGE_PIXEL_ERF);
    }
    // The window of four terms (F. J. Harris, 1978), which is nearly a Gaussian: its quantiles by a rational function
    // of the Gaussian's, 1e-3 pixels exact but for the last 1e-4, 4e-3 there.
    const float e = erfInverse(clamp(x, -0.9999999f, 0.9999999f)), s = e * e;
    const float t =
        e * (0.40481878f + s * (-0.04234933f + s * 9.932001e-4f)) / (1.0f + s * (-0.08358073f + s * 9.819796e-4f));
    return WEDGE_PIXEL_REACH * clamp(t, -1.0f, 1.0f);
}

/// A point of the unit disc that is the lens, distributed as it transmits, of two uniform numbers.
WEDGE_FN Vec2 aperturePoint(uint gaussian, Vec2 u)
{
    // A Gaussian's radius by inversion: what lies within r is 1 - exp(-r^2 / 2) of the plane.
    const float inside = 1.0f - exp(-0.5f * WEDGE_APERTURE_CUT * WEDGE_APERTURE_CUT);
    const float radius = gaussian != 0u ? sqrt(-2.0f * log(1.0f - u.x * inside)) / WEDGE_APERTURE_CUT : sqrt(u.x);
    const float angle = WEDGE_TWO_PI * u.y;
    return vec2(radius * cos(angle), radius * sin(angle));
}

/// Time in [0, 1] that the shutter lets through at, of a uniform number.
WEDGE_FN float shutterTime(CameraParams camera, float u)
{
    const float gaussian = 0.5f + 0.5f * lightCoordinate(u, WEDGE_PROFILE_GAUSSIAN, WEDGE_APERTURE_CUT, camera.erfCut);
    return camera.gaussianShutter != 0u ? clamp(gaussian, 0.0f, 1.0f) : u;
}

/// The ray through image position (x, y) in pixels of width x height, a point of the lens as of aperturePoint(), at a
/// time. Thesis (5.1): from the lens to the point of the plane in focus.
WEDGE_FN CameraRay cameraRay(CameraParams c, float width, float height, float x, float y, Vec2 lens, float time)
{
    CameraRay ray;
    const Vec3 forward = vecMad(c.forward, c.forwardMotion, time);
    const Vec3 right = vecMad(c.right, c.rightMotion, time);
    const Vec3 down = vecMad(c.down, c.downMotion, time);
    const float scale = c.apertureRadius / c.pixelStep;
    const Vec3 offset = vecMad(vecScale(right, scale * lens.x), down, scale * lens.y);
    const Vec3 through = vecMad(vecMad(forward, right, x - 0.5f * width), down, y - 0.5f * height);
    ray.origin = vecAdd(vecMad(c.eye, c.eyeMotion, time), offset);
    ray.direction = vecMad(through, offset, -1.0f / c.focusDistance);
    ray.time = time;
    return ray;
}

/// Where the lens' centre sees a point at a time, pixels from the middle of the image.
WEDGE_FN Vec2 projectPoint(CameraParams c, Vec3 point, float time)
{
    const Vec3 d = vecSub(point, vecMad(c.eye, c.eyeMotion, time));
    const Vec3 right = vecMad(c.right, c.rightMotion, time);
    const Vec3 down = vecMad(c.down, c.downMotion, time);
    const float depth = fmax(vecDot(d, vecMad(c.forward, c.forwardMotion, time)), WEDGE_LEAST_DEPTH);
    return vec2(vecDot(d, right) / (vecDot(right, right) * depth), vecDot(d, down) / (vecDot(down, down) * depth));
}

WEDGE_SHARED_END

#endif
