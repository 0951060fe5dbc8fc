// Sums of products of samples with what goes by where on the light they are: what the sinks Scores, Moments and
// Components keep. Of each number of the samples there are `each` sums, one after the other. Only points on the light
// count: where a reflected direction meets it, if it does, is elsewhere.
#ifndef WEDGE_PRODUCTS_H
#define WEDGE_PRODUCTS_H

#include "light/light_sampling.h"
#include "sinks/lanes.h"

WEDGE_INLINE void clearProducts(uint each, float (*sum)[WEDGE_PACKET_SIZE])
{
    for (uint k = 0u; k < each * WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            sum[k][lane] = 0.0f;
        }
    }
}

/// What the lanes' points on the light, less its centre, are along two axes; 0 where no ray was traced.
WEDGE_INLINE void pointsAlong(
    const Samples* s, Vec3 centre, Vec3 alongU, Vec3 alongV, float* u, float* v, float* traced)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 from = vec3(s->rays->originX[lane], s->rays->originY[lane], s->rays->originZ[lane]);
        const Vec3 ray = vec3(s->rays->directionX[lane], s->rays->directionY[lane], s->rays->directionZ[lane]);
        const Vec3 point = vecSub(vecAdd(from, ray), centre);
        const bool is = s->rays->tMax[lane] > 0.0f;
        traced[lane] = is ? 1.0f : 0.0f;
        u[lane] = is ? vecDot(alongU, point) : 0.0f;
        v[lane] = is ? vecDot(alongV, point) : 0.0f;
    }
}

/// Adds the products with `each` factors of the lanes.
WEDGE_INLINE void addProducts(const Sampling* at, const Samples* s, uint each,
    const float (*factors)[WEDGE_PACKET_SIZE], float (*sum)[WEDGE_PACKET_SIZE])
{
    for (uint k = 0u; k < each * WEDGE_SUMS; ++k) {
        float product[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            product[lane] = factors[k % each][lane] * s->points[k / each][lane];
        }
        addLanes(at, product, sum[k]);
    }
}

/// Adds sums of (V - h) w q: V the samples' visibility, w what they weigh, q the factors, and h the mean that is known
/// by now. Less the mean, so that where all is seen, or nothing, it is 0 whatever the samples; and not of the samples
/// that come later, since what is missing to those has the mean 0. (Those of the first launch are part of their mean,
/// which takes a ninth of nine samples' sum.)
///
/// in      sums: as finishSums() leaves them
/// in out  planes: of each channel of sums `each`, of 16 bits (packed_planes.h)
WEDGE_INLINE void addCentredProducts(const Sampling* at, uint each, const float (*sum)[WEDGE_PACKET_SIZE],
    __global const float* sums, __global float* planes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (!hasTaken(at, lane)) {
            continue;
        }
        const uint i = at->pixel[lane];
        for (uint all = 0u; all < WEDGE_SUMS; all += 2u) { // of a channel's weights, and then of what is seen of them
            const float weights = sums[all * at->size + i];
            const float mean = weights > 0.0f ? sums[(all + 1u) * at->size + i] / weights : 0.0f;
            for (uint k = 0u; k < each; ++k) {
                const float ofAll = sum[all * each + k][lane], ofSeen = sum[(all + 1u) * each + k][lane];
                const uint plane = (all / 2u) * each + k;
                storeShort(planes, at->size, i, plane, loadShort(planes, at->size, i, plane) + (ofSeen - mean * ofAll));
            }
        }
    }
}

#endif
