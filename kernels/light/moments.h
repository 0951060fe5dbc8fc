// The sink of moments: where on the light it is that samples see, weighted by the light's scores of first and second
// order (shared/components.h). How shadows bend follows from it (analysis/shear.cl).
#ifndef WEDGE_LIGHT_MOMENTS_H
#define WEDGE_LIGHT_MOMENTS_H

#include "light/products.h"
#include "shared/components.h"

/// Of each number of samples products of first order along u and v, of second order along u u, u v, v v.
typedef struct {
    float sum[WEDGE_MOMENTS * WEDGE_SUMS][WEDGE_PACKET_SIZE];
} Moments;

/// A launch's own alone: finishMoments() adds them up.
WEDGE_INLINE void beginMoments(const Sampling* at, Moments* state)
{
    (void)at;
    clearProducts(WEDGE_MOMENTS, state->sum);
}

WEDGE_INLINE void takeMoments(const Sampling* at, const Samples* s, Moments* state, LightMoments light)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE], traced[WEDGE_PACKET_SIZE];
    float score[WEDGE_MOMENTS][WEDGE_PACKET_SIZE];
    pointsAlong(s, light.first.centre, light.first.alongU, light.first.alongV, u, v, traced);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float ofU = traced[lane] * scoreOf(light.first, u[lane]);
        const float ofV = traced[lane] * scoreOf(light.first, v[lane]);
        score[0][lane] = ofU;
        score[1][lane] = ofV;
        score[2][lane] = traced[lane] * secondScoreOf(light, u[lane]);
        score[3][lane] = ofU * ofV;
        score[4][lane] = traced[lane] * secondScoreOf(light, v[lane]);
    }
    addProducts(at, s, WEDGE_MOMENTS, (const float(*)[WEDGE_PACKET_SIZE])score, state->sum);
}

/// in      sums: as finishSums() leaves them
/// in out  moments: of each channel of sums, see addCentredProducts()
WEDGE_INLINE void finishMoments(
    const Sampling* at, const Moments* state, __global const float* sums, __global float* moments)
{
    addCentredProducts(at, WEDGE_MOMENTS, state->sum, sums, moments);
}

#endif
