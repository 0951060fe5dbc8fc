// The sink of components: where on the light it is that samples see, as weighted by each product of the basis functions
// of both axes that stand in the place of the light's profile (Wu et al. 2017, (13), (19)):
//
//     B_0 = G,  B_(2p-1) = G cos(C_p y),  B_2p = G sin(C_p y),     G = exp(-(Omega y / N)^2 / 2),  C_p = 2 p Omega / N
//
// y in standard deviations of the light, Omega its bandwidth in their reciprocals, (6), N = WEDGE_COMPONENTS of them.
// Samples are distributed as the profile l, and so weighted by B / l. None of this goes by slopes: what does is the
// filter's (filter/components.cl), so that one pass may sample before they are known.
#ifndef WEDGE_LIGHT_COMPONENTS_H
#define WEDGE_LIGHT_COMPONENTS_H

#include "light/products.h"
#include "shared/components.h"

#define WEDGE_PRODUCTS (WEDGE_COMPONENTS * WEDGE_COMPONENTS)

/// Of each number of its samples a receiver's sums of its products with B_i(u) B_j(v) / (l(u) l(v)), j running fastest.
typedef struct {
    float sum[WEDGE_SUMS * WEDGE_PRODUCTS][WEDGE_PACKET_SIZE];
} Components;

/// A launch's own alone: finishComponents() adds them up.
WEDGE_INLINE void beginComponents(const Sampling* at, Components* state)
{
    (void)at;
    clearProducts(WEDGE_PRODUCTS, state->sum);
}

/// B / l of one axis at the lanes' coordinates.
WEDGE_INLINE void basisOf(float bandwidth, const float* y, float (*basis)[WEDGE_PACKET_SIZE])
{
    const float extent = bandwidth / (float)WEDGE_COMPONENTS;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        basis[0][lane] = exp2Bounded(0.721347520f * (1.0f - extent * extent) * y[lane] * y[lane]);
    }
    for (uint p = 1u; 2u * p < WEDGE_COMPONENTS; ++p) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            // Not the library's: its last digits are others where a loop is compiled otherwise.
            const float turn = 0.159154943f * 2.0f * (float)p * extent * y[lane];
            float sine, cosine;
            sinCosTurn(turn - floor(turn), &sine, &cosine);
            basis[2u * p - 1u][lane] = basis[0][lane] * cosine;
            basis[2u * p][lane] = basis[0][lane] * sine;
        }
    }
}

WEDGE_INLINE void takeComponents(const Sampling* at, const Samples* s, Components* state, LightAxes light)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE], traced[WEDGE_PACKET_SIZE]; // what is not counts nothing
    pointsAlong(s, light.centre, light.alongU, light.alongV, u, v, traced);
    float ofU[WEDGE_COMPONENTS][WEDGE_PACKET_SIZE], ofV[WEDGE_COMPONENTS][WEDGE_PACKET_SIZE];
    basisOf(light.bandwidth, u, ofU);
    basisOf(light.bandwidth, v, ofV);
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        for (uint product = 0u; product < WEDGE_PRODUCTS; ++product) {
            const float* a = ofU[product / WEDGE_COMPONENTS];
            const float* b = ofV[product % WEDGE_COMPONENTS];
            float weighted[WEDGE_PACKET_SIZE];
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                weighted[lane] = s->points[k][lane] * a[lane] * b[lane];
            }
            addLanes(at, weighted, state->sum[k * WEDGE_PRODUCTS + product]);
        }
    }
}

/// in out  components: of each number the products, in 16 bits (packed_planes.h)
WEDGE_INLINE void finishComponents(const Sampling* at, const Components* state, __global float* components)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        const uint i = at->pixel[lane];
        for (uint k = 0u; k < WEDGE_SUMS * WEDGE_PRODUCTS; ++k) {
            storeShort(components, at->size, i, k, loadShort(components, at->size, i, k) + state->sum[k][lane]);
        }
    }
}

#endif
