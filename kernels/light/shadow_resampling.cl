// What lights that stand for a map bring to few of the pixels, and what that says of the others.
#include "light/light_sample.h"
#include "shared/filter_params.h"
#include "shared/pixel_grid.h"

/// The frame's pixel in the middle of a coarse one, and where the image ends before that, its last.
WEDGE_INLINE uint middlePixel(uint coarse, uint scale, uint size)
{
    return min(coarse * scale + scale / 2u, size - 1u);
}

WEDGE_INLINE void copyVec(__global const float* from, uint fromSize, uint i, __global float* to, uint toSize, uint k)
{
    storeVec(to, toSize, k, loadVec(from, fromSize, i));
}

/// Receivers of a coarse grid: what the camera sees through the pixels in the middle of its pixels.
/// in   full, coarse: grids; the frame's surfaces
/// out  the same of coarse pixels
#include "pass/coarseReceivers.h"
#ifdef PASS_coarseReceivers
__kernel void coarseReceivers(PARAMETERS)
{
    WEDGE_PIXEL(coarse, x, y, k);
    const uint i =
        pixelIndex(middlePixel(x, coarse.scale, full.width), middlePixel(y, coarse.scale, full.height), full.stride);
    copyVec(position, full.size, i, coarsePosition, coarse.size, k);
    copyVec(normal, full.size, i, coarseNormal, coarse.size, k);
    copyVec(origin, full.size, i, coarseOrigin, coarse.size, k);
    copyVec(diffuse, full.size, i, coarseDiffuse, coarse.size, k);
    copyVec(specular, full.size, i, coarseSpecular, coarse.size, k);
    coarseGeometric[k] = geometric[i];
    coarseObjectId[k] = objectId[i];
    coarseGloss[k] = gloss[i];
}
#endif

/// Exponents that are as many times each other's.
#define WEDGE_LIKE_GLOSS 1.25f

/// What a pixel takes of its neighbours among coarse ones: their indices and weights.
typedef struct {
    uint index[9];
    float weight[9];
    float sum;
} Neighbours;

/// Weights of a quadratic B-spline at t, from -1/2 to 1/2 from the middle one of three.
WEDGE_INLINE Vec3 splineWeights(float t)
{
    return vec3(0.5f * (0.5f - t) * (0.5f - t), 0.75f - t * t, 0.5f * (0.5f + t) * (0.5f + t));
}

/// Whether lobes of these values of the gloss plane reflect about as much of the same light.
WEDGE_FN bool likeGloss(uint a, uint b)
{
    const Lobe first = glossLobe(a), second = glossLobe(b);
    const float least = fmin(first.exponent, second.exponent), most = fmax(first.exponent, second.exponent);
    return a == b || (first.kind == second.kind && most <= WEDGE_LIKE_GLOSS * least);
}

/// Below so much of all weights a pixel's neighbours are not of its kind.
#define WEDGE_LEAST_NEIGHBOURS 0.1f
/// Coarse pixels' sizes that neighbours may lie off each other's planes.
#define WEDGE_NEIGHBOUR_DEPTH 0.5f

/// Light of pixels by that of coarse ones around, which the surface's plane, direction and gloss have to be like.
/// Pixels that have none such stay as they were, and are to be traced.
///
/// in      p; coarse: their grid; surfaces of pixels and of coarse ones; coarseTaken, coarseRays, coarseMattSums (6
///         planes), coarseLobeSums (`lobePlanes`): of kernels that trace lights
/// in out  taken, mattSums, lobeSums; rays: of the pixels in the middle of coarse ones
#include "pass/resampleShadows.h"
#ifdef PASS_resampleShadows
WEDGE_FN void mixSums(__global const float* from, uint fromSize, const Neighbours* n, uint planes, __global float* to,
    uint toSize, uint i)
{
    for (uint plane = 0u; plane < planes; ++plane) {
        float sum = 0.0f;
        for (uint k = 0u; k < 9u; ++k) {
            sum += n->weight[k] > 0.0f ? n->weight[k] * from[plane * fromSize + n->index[k]] : 0.0f;
        }
        to[plane * toSize + i] = sum / n->sum;
    }
}

__kernel void resampleShadows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize, cx = x / coarse.scale, cy = y / coarse.scale;
    const uint middleX = middlePixel(cx, coarse.scale, p.width), middleY = middlePixel(cy, coarse.scale, p.height);
    if (x == middleX && y == middleY) {
        rays[i] += coarseRays[pixelIndex(cx, cy, coarse.stride)];
    }
    if (objectId[i] == 0u) {
        return;
    }
    const Vec3 at = loadVec(position, size, i), n = loadVec(normal, size, i);
    const float side = (float)coarse.scale;
    const Vec3 across = splineWeights(((float)x - (float)middleX) / side);
    const Vec3 down = splineWeights(((float)y - (float)middleY) / side);
    const float wx[3] = { across.x, across.y, across.z }, wy[3] = { down.x, down.y, down.z };
    const float off = WEDGE_NEIGHBOUR_DEPTH * side * pixelSize[i];
    Neighbours near;
    near.sum = 0.0f;
    for (uint k = 0u; k < 9u; ++k) {
        const int kx = (int)cx + (int)(k % 3u) - 1, ky = (int)cy + (int)(k / 3u) - 1;
        const bool inside = kx >= 0 && ky >= 0 && kx < (int)coarse.width && ky < (int)coarse.height;
        const uint c = inside ? pixelIndex((uint)kx, (uint)ky, coarse.stride) : pixelIndex(cx, cy, coarse.stride);
        near.index[k] = c;
        const bool lit = inside && coarseTaken[c] > 0u && likeGloss(coarseGloss[c], gloss[i]);
        const Vec3 there = loadVec(coarseNormal, coarse.size, c);
        const Vec3 d = vecSub(loadVec(coarsePosition, coarse.size, c), at);
        const bool level = fmax(fabs(vecDot(n, d)), fabs(vecDot(there, d))) <= off;
        const float alike = fmax(vecDot(n, there), 0.0f);
        near.weight[k] = lit && level ? wx[k % 3u] * wy[k / 3u] * alike : 0.0f;
        near.sum += near.weight[k];
    }
    if (near.sum < WEDGE_LEAST_NEIGHBOURS) {
        return;
    }
    mixSums(coarseMattSums, coarse.size, &near, 6u, mattSums, size, i);
#ifdef WEDGE_SPECULAR
    mixSums(coarseLobeSums, coarse.size, &near, lobePlanes, lobeSums, size, i);
#else
    (void)lobePlanes;
#endif
    taken[i] = lights;
}
#endif
