// The sink of moments: where on the light it is that samples see, weighted by the light's scores of first and second
// order (shared/components.h). How shadows bend follows from it (analysis/two_slopes.cl).
#ifndef WEDGE_MOMENTS_H
#define WEDGE_MOMENTS_H

#include "light/light_sampling.h"
#include "shared/components.h"
#include "sinks/lanes.h"

/// Of each number of samples: first order along u and v, second order along u u, u v, v v.
#define WEDGE_MOMENTS 5u

typedef struct {
    float sum[WEDGE_MOMENTS * WEDGE_SUMS][WEDGE_PACKET_SIZE];
} Moments;

/// A launch's own alone: finishMoments() adds them up.
WEDGE_INLINE void beginMoments(const Sampling* at, Moments* state)
{
    (void)at;
    for (uint k = 0u; k < WEDGE_MOMENTS * WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            state->sum[k][lane] = 0.0f;
        }
    }
}

WEDGE_INLINE void takeMoments(const Sampling* at, const Samples* s, Moments* state, LightMoments light)
{
    float score[WEDGE_MOMENTS][WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 from = vec3(s->rays->originX[lane], s->rays->originY[lane], s->rays->originZ[lane]);
        const Vec3 ray = vec3(s->rays->directionX[lane], s->rays->directionY[lane], s->rays->directionZ[lane]);
        const Vec3 point = vecSub(vecAdd(from, ray), light.first.centre);
        const float a = vecDot(light.first.alongU, point), b = vecDot(light.first.alongV, point);
        const float traced = s->rays->tMax[lane] > 0.0f ? 1.0f : 0.0f;
        const float ofA = traced * scoreOf(light.first, a), ofB = traced * scoreOf(light.first, b);
        score[0][lane] = ofA;
        score[1][lane] = ofB;
        score[2][lane] = traced * secondScoreOf(light, a);
        score[3][lane] = ofA * ofB;
        score[4][lane] = traced * secondScoreOf(light, b);
    }
    for (uint k = 0u; k < WEDGE_MOMENTS * WEDGE_SUMS; ++k) {
        float product[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            product[lane] = score[k % WEDGE_MOMENTS][lane] * s->value[k / WEDGE_MOMENTS][lane];
        }
        addLanes(at, product, state->sum[k]);
    }
}

/// Adds sums of (V - h) w q, as finishScores() does: V the samples' visibility, w what they weigh, q their scores, h
/// the mean that is known by now.
///
/// in      sums: as finishSums() leaves them
/// in out  moments: of each channel of sums, of 16 bits (packed_planes.h)
WEDGE_INLINE void finishMoments(
    const Sampling* at, const Moments* state, __global const float* sums, __global float* moments)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        const uint i = at->pixel[lane];
        for (uint channel = 0u; 2u * channel < WEDGE_SUMS; ++channel) {
            const float weights = sums[2u * channel * at->size + i];
            const float mean = weights > 0.0f ? sums[(2u * channel + 1u) * at->size + i] / weights : 0.0f;
            for (uint k = 0u; k < WEDGE_MOMENTS; ++k) {
                const float ofAll = state->sum[2u * channel * WEDGE_MOMENTS + k][lane];
                const float ofSeen = state->sum[(2u * channel + 1u) * WEDGE_MOMENTS + k][lane];
                const uint plane = channel * WEDGE_MOMENTS + k;
                storeShort(
                    moments, at->size, i, plane, loadShort(moments, at->size, i, plane) + (ofSeen - mean * ofAll));
            }
        }
    }
}

#endif
