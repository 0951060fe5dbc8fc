// The sink of scores: where on the light it is that samples see, weighted by how fast the light falls off there. The
// gradients of shadows follow from it (analysis/shear.cl).
#ifndef WEDGE_SCORES_H
#define WEDGE_SCORES_H

#include "light/products.h"

/// Of each number of samples products with the scores of both axes.
typedef struct {
    float sum[2u * WEDGE_SUMS][WEDGE_PACKET_SIZE];
} Scores;

/// A launch's own alone: finishScores() adds them up.
WEDGE_INLINE void beginScores(const Sampling* at, Scores* state)
{
    (void)at;
    clearProducts(2u, state->sum);
}

WEDGE_INLINE void takeScores(const Sampling* at, const Samples* s, Scores* state, LightScore light)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE], traced[WEDGE_PACKET_SIZE], score[2][WEDGE_PACKET_SIZE];
    pointsAlong(s, light.centre, light.alongU, light.alongV, u, v, traced);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        score[0][lane] = traced[lane] * scoreOf(light, u[lane]);
        score[1][lane] = traced[lane] * scoreOf(light, v[lane]);
    }
    addProducts(at, s, 2u, (const float(*)[WEDGE_PACKET_SIZE])score, state->sum);
}

/// in      sums: as finishSums() leaves them
/// in out  gradients: of each channel of sums along both axes, see addCentredProducts()
WEDGE_INLINE void finishScores(
    const Sampling* at, const Scores* state, __global const float* sums, __global float* gradients)
{
    addCentredProducts(at, 2u, state->sum, sums, gradients);
}

#endif
