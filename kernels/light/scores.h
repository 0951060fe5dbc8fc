// The sink of scores: where on the light it is that samples see, weighted by how fast the light falls off there. The
// gradients of shadows follow from it (analysis/shear.cl).
#ifndef WEDGE_SCORES_H
#define WEDGE_SCORES_H

#include "light/light_sampling.h"
#include "sinks/lanes.h"

/// Of each number of its samples a receiver's sum of its products with the scores of both axes.
typedef struct {
    float sum[2u * WEDGE_SUMS][WEDGE_PACKET_SIZE];
} Scores;

/// A launch's own alone: finishScores() adds them up.
WEDGE_INLINE void beginScores(const Sampling* at, Scores* state)
{
    (void)at;
    for (uint k = 0u; k < 2u * WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            state->sum[k][lane] = 0.0f;
        }
    }
}

WEDGE_INLINE void takeScores(const Sampling* at, const Samples* s, Scores* state, LightScore light)
{
    float score[2][WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 from = vec3(s->rays->originX[lane], s->rays->originY[lane], s->rays->originZ[lane]);
        const Vec3 ray = vec3(s->rays->directionX[lane], s->rays->directionY[lane], s->rays->directionZ[lane]);
        const Vec3 point = vecSub(vecAdd(from, ray), light.centre);
        const bool traced = s->rays->tMax[lane] > 0.0f;
        score[0][lane] = traced ? scoreOf(light, vecDot(light.alongU, point)) : 0.0f;
        score[1][lane] = traced ? scoreOf(light, vecDot(light.alongV, point)) : 0.0f;
    }
    for (uint k = 0u; k < 2u * WEDGE_SUMS; ++k) {
        float product[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            product[lane] = score[k % 2u][lane] * s->value[k / 2u][lane];
        }
        addLanes(at, product, state->sum[k]);
    }
}

/// Adds sums of (V - h) w q: V the samples' visibility, w what they weigh, q their scores, and h the mean that is known
/// by now. Less the mean, so that where all is seen, or nothing, it is 0 whatever the samples; and not of the samples
/// that come later, since what is missing to those has the mean 0. (Those of the first launch are part of their mean,
/// which takes a ninth of nine samples' sum.)
///
/// in      sums: as finishSums() leaves them
/// in out  gradients: of each channel of sums along both axes, of 16 bits (packed_planes.h)
WEDGE_INLINE void finishScores(
    const Sampling* at, const Scores* state, __global const float* sums, __global float* gradients)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        const uint i = at->pixel[lane];
        for (uint k = 0u; k < WEDGE_SUMS; ++k) {
            const uint all = k & ~1u, axis = k & 1u; // sums are of a channel's weights, and of what is seen of them
            const float weights = sums[all * at->size + i];
            const float mean = weights > 0.0f ? sums[(all + 1u) * at->size + i] / weights : 0.0f;
            const float ofAll = state->sum[2u * all + axis][lane], ofSeen = state->sum[2u * all + 2u + axis][lane];
            storeShort(gradients, at->size, i, k, loadShort(gradients, at->size, i, k) + (ofSeen - mean * ofAll));
        }
    }
}

#endif
