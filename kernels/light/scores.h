// The sink of scores: where on the light it is that samples see, weighted by how fast the light falls off there. The
// gradients of shadows follow from it (analysis/shear.cl).
#ifndef WEDGE_SCORES_H
#define WEDGE_SCORES_H

#include "light/light_sampling.h"
#include "sinks/lanes.h"

/// Numbers kept of a receiver: of each number of its samples the sums of its products with the scores of both axes.
#define WEDGE_SCORES (2u * WEDGE_SUMS)

typedef struct {
    float sum[WEDGE_SCORES][WEDGE_PACKET_SIZE];
} Scores;

/// in out  scores: WEDGE_SCORES planes
WEDGE_INLINE void beginScores(const Sampling* at, Scores* state, __global const float* scores)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = at->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? at->pixel[lane] : 0u;
        for (uint k = 0u; k < WEDGE_SCORES; ++k) {
            state->sum[k][lane] = shaded ? scores[k * at->size + i] : 0.0f;
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
    for (uint k = 0u; k < WEDGE_SCORES; ++k) {
        float product[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            product[lane] = score[k % 2u][lane] * s->value[k / 2u][lane];
        }
        addLanes(at, product, state->sum[k]);
    }
}

WEDGE_INLINE void finishScores(const Sampling* at, const Scores* state, __global float* scores)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        for (uint k = 0u; k < WEDGE_SCORES && hasTaken(at, lane); ++k) {
            scores[k * at->size + at->pixel[lane]] = state->sum[k][lane];
        }
    }
}

#endif
