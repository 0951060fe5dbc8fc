// The sink of shadows' motions in the image: how far each shadow at a receiver moves while the shutter is open.
#ifndef WEDGE_SHADOW_MOTIONS_H
#define WEDGE_SHADOW_MOTIONS_H

#include "light/light_sampling.h"
#include "shared/camera.h"
#include "sinks/lanes.h"
#include "trace/surface.h"

#define WEDGE_SINK_TAKES_HITS

/// Occluders count as at least this part of the shadow ray's length away from the light.
#define WEDGE_LEAST_LIGHT_DISTANCE 0.02f

/// Planes after those of slopes: sums of motions in pixels over the shutter, x and y, of their squares, and how many.
#define WEDGE_MOTION_SUMS 4u

typedef struct {
    float sum[WEDGE_MOTION_SUMS][WEDGE_PACKET_SIZE];
} ShadowMotions;

/// in out  slopes: planes of slopes, then those of motions
WEDGE_INLINE void beginShadowMotions(const Sampling* at, ShadowMotions* state, __global const float* slopes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = at->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? at->pixel[lane] : 0u;
        for (uint k = 0u; k < WEDGE_MOTION_SUMS; ++k) {
            state->sum[k][lane] = shaded ? slopes[(2u + k) * at->size + i] : 0.0f;
        }
    }
}

/// Adds the motion of the shadow that hit, `along` of the way to the light's point, throws at the lane's receiver: the
/// occluder's, seen from that point, on the receiver's plane.
WEDGE_INLINE void addShadowMotion(CameraParams camera, SurfaceData surfaces, Hit hit, const ReceiverPacket* r,
    uint lane, uint to, Vec3 ray, ShadowMotions* m)
{
    const Vec3 p = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const Vec3 cast = vecScale(hitMotion(surfaces, hit), 1.0f / fmax(1.0f - hit.t, WEDGE_LEAST_LIGHT_DISTANCE));
    const float facing = vecDot(n, ray);
    const Vec3 moved = vecMad(cast, ray, -vecDot(n, cast) / fmax(facing, 1e-20f));
    const Vec2 before = projectPoint(camera, vecMad(p, moved, -0.5f), 0.5f);
    const Vec2 after = projectPoint(camera, vecMad(p, moved, 0.5f), 0.5f);
    const float x = after.x - before.x, y = after.y - before.y;
    m->sum[0][to] += x;
    m->sum[1][to] += y;
    m->sum[2][to] += x * x + y * y;
    m->sum[3][to] += 1.0f;
}

WEDGE_INLINE void takeShadowMotions(
    const Sampling* at, const Samples* s, ShadowMotions* state, CameraParams camera, WEDGE_SURFACE_PARAMETERS)
{
    if (s->hits == 0) {
        return;
    }
    const SurfaceData surfaces = WEDGE_SURFACE_ARGUMENTS;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (s->hits->triangle[lane] != WEDGE_NO_TRIANGLE) {
            const Vec3 ray = vec3(s->rays->directionX[lane], s->rays->directionY[lane], s->rays->directionZ[lane]);
            addShadowMotion(
                camera, surfaces, packetHit(s->hits, lane), at->dealt, lane, at->deal->receiver[lane], ray, state);
        }
    }
}

WEDGE_INLINE void finishShadowMotions(const Sampling* at, const ShadowMotions* state, __global float* slopes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        for (uint k = 0u; k < WEDGE_MOTION_SUMS && hasTaken(at, lane); ++k) {
            slopes[(2u + k) * at->size + at->pixel[lane]] = state->sum[k][lane];
        }
    }
}

#endif
