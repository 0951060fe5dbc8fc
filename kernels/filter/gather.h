// The image-space filter: a Gaussian of world-space standard deviation beta(x), as two one-dimensional passes.
// Weights come from distances between the pixels' positions, so depth edges need no special case; neighbours of another
// object or with another normal are left out: with its map, since light is gathered by it; how the surface lies is told
// by the normal without its map. Distances are those in the plane parallel to a light, or, where the term
// is of no light, plain ones. Each pixel counts for the surface that it sees: the convolutions (3.10) and (4.16) are
// integrals over the surface, and pixels are not alike in what they see of it. Of the neighbours along a line comes,
// fitted, not their mean but what a straight line through them has at the pixel. Here is what neighbours weigh, and
// their sums; filter.cl has the passes. Each program that filters sets WEDGE_GATHER_CHANNELS, the planes of value.
// WEDGE_NORMAL_FORMAT and WEDGE_SIZE_FORMAT are the formats of the planes of normals and of pixels' sizes: floats, if
// they are not set.
// Those of WEDGE_GATHER_MEAN_SQUARE weigh a pair by the mean of both bandwidths' squares (6.23), whatever `narrower`
// says. They are programs of their own since a test of a parameter in each tap takes several times as long. And all is
// inlined by order: compilers leave calls, with vectors in memory, to functions of this size, and gathers took twice as
// long.
#ifndef WEDGE_GATHER_H
#define WEDGE_GATHER_H

#include "core/formats.h"
#include "core/vector16.h"
#include "shared/filter_params.h"

/// Least cosine between the ray to the light's centre and the light's normal in the oblique projection.
#define WEDGE_MIN_OBLIQUE_COSINE 0.05f
/// Least cosine between view ray and surface in the estimate of a pixel's step on the surface.
#define WEDGE_MIN_STEP_COSINE 0.05f
/// Largest sine between the way to a neighbour and a pixel's surface: what is farther from it is another surface, such
/// as the floor beyond a table's edge, also where the light's rays make both one (distance16).
#define WEDGE_MOST_RISE 0.3f
/// Most that a neighbour counts for what it sees of the surface, against the pixel: where surfaces turn away, samples
/// are few.
#define WEDGE_MOST_AREA 4.0f
/// pixels^2
#define WEDGE_FIT_RIDGE 0.3f
/// log2(e) / 2
#define WEDGE_HALF_LOG2E 0.72134752f
/// How much wider than a pixel's own kernel that of a pair may be: half of the square of its bandwidth is left where
/// the neighbour's is 0.
#ifdef WEDGE_GATHER_MEAN_SQUARE
#define WEDGE_WIDEST_PAIR 1.41421356f
#else
#define WEDGE_WIDEST_PAIR 1.0f
#endif

#ifndef WEDGE_NORMAL_FORMAT
#define WEDGE_NORMAL_FORMAT float3
#define WEDGE_SIZE_FORMAT float1
#endif

/// What a block of pixels needs to weigh its neighbours.
typedef struct {
    Vec3x16 position, normal, plane, slant; ///< plane: the normal without its map; slant: what a motion of 1 along the
                                            ///< light's normal adds, see distance16
    uint16 object;
    float16 perSize; ///< 1 over the side of the surface that the pixel sees, metres
} GatherBlock;

/// A kernel for each pixel of a block.
typedef struct {
    float16 beta; ///< metres; 1 where there is none
    float16 scale; ///< -log2(e) / (2 beta^2)
    float16 limit; ///< (cut beta)^2
    float16 radius; ///< pixels along the line, 0 where there is none
#ifdef WEDGE_GATHER_SHEARED
    float16 perSlope; ///< 1 over slopeWidth, or over beta where that is wider
#endif
} GatherWidth;

WEDGE_INLINE Vec3x16 loadNormalBlock(FilterParams p, __global const float* normal, int i)
{
    return WEDGE_OF_FORMAT(load16, WEDGE_NORMAL_FORMAT)(normal, p.planeSize, i);
}

/// The same without their maps.
WEDGE_INLINE Vec3x16 loadPlaneBlock(FilterParams p, __global const float* normal, int i)
{
    return WEDGE_OF_FORMAT(load16_unmapped, WEDGE_NORMAL_FORMAT)(normal, p.planeSize, i);
}

/// The offset d of a pixel's neighbour as far as the light's shadow is concerned: less its part along the light's
/// normal (3.12), or, oblique, slid along the ray to the light's centre onto the plane through the pixel parallel to
/// the light. Without a light, whose normal is then 0, it is d.
WEDGE_INLINE Vec3x16 offset16(FilterParams p, Vec3x16 slant, Vec3x16 d)
{
    const float16 along = d.x * p.lightNormal.x + d.y * p.lightNormal.y + d.z * p.lightNormal.z;
    return mad16(d, slant, -along);
}

/// Its square.
WEDGE_INLINE float16 distance16(FilterParams p, Vec3x16 slant, Vec3x16 d)
{
    const Vec3x16 e = offset16(p, slant, d);
    return dot16(e, e);
}

/// Sides of the surface that pixels see, metres (projectedPixel()).
WEDGE_INLINE float16 loadSizeBlock(__global const float* pixelSize, int i)
{
    return WEDGE_OF_FORMAT(load16, WEDGE_SIZE_FORMAT)(pixelSize, 0u, i);
}

WEDGE_INLINE Vec3x16 slantOf(FilterParams p, Vec3x16 position)
{
    if (p.oblique == 0u) {
        return splat3(p.lightNormal);
    }
    Vec3x16 l = sub16(splat3(p.lightCentre), position);
    const float16 inverse = rsqrt(max16(dot16(l, l), (float16)(1e-20f)));
    const float16 cosine = (l.x * p.lightNormal.x + l.y * p.lightNormal.y + l.z * p.lightNormal.z) * inverse;
    const float16 least = (float16)(WEDGE_MIN_OBLIQUE_COSINE);
    const float16 bounded = fabs(cosine) < least ? copysign(least, cosine) : cosine;
    const float16 scale = inverse / bounded;
    l.x *= scale;
    l.y *= scale;
    l.z *= scale;
    return l;
}

/// Pixels that a kernel of radius `reach` metres spans on the surface's tangent plane, along image step `step`.
WEDGE_INLINE float16 radiusInPixels(FilterParams p, GatherBlock b, Vec3 step, float16 reach)
{
    const Vec3x16 fromEye = sub16(b.position, splat3(p.eye));
    const float16 z = fromEye.x * p.forward.x + fromEye.y * p.forward.y + fromEye.z * p.forward.z;
    const float16 facing = dot16(b.plane, fromEye);
    const float16 least = WEDGE_MIN_STEP_COSINE * sqrt(dot16(fromEye, fromEye));
    const float16 bounded = fabs(facing) < least ? copysign(least, facing) : facing;
    const float16 turn = (b.plane.x * step.x + b.plane.y * step.y + b.plane.z * step.z) * z / bounded;
    Vec3x16 moved;
    moved.x = z * step.x - fromEye.x * turn;
    moved.y = z * step.y - fromEye.y * turn;
    moved.z = z * step.z - fromEye.z * turn;
    const float16 metres = sqrt(distance16(p, b.slant, moved));
    const float16 pixels = ceil(reach / max16(metres, (float16)(1e-20f)));
    return min16(max16(pixels, (float16)(1.0f)), (float16)((float)p.maxRadius));
}

WEDGE_INLINE GatherBlock gatherBlock(FilterParams p, int i, uint16 object, __global const float* position,
    __global const float* normal, __global const float* pixelSize)
{
    GatherBlock b;
    b.object = object;
    b.position = loadVecBlock(position, p.planeSize, i);
    b.normal = loadNormalBlock(p, normal, i);
    b.plane = loadPlaneBlock(p, normal, i);
    b.slant = slantOf(p, b.position);
    b.perSize = p.surface != 0u ? 1.0f / max16(loadSizeBlock(pixelSize, i), (float16)(1e-30f)) : (float16)(1.0f);
    return b;
}

/// The kernels of pixels `gathers`, of standard deviation beta, along image step `step`.
WEDGE_INLINE GatherWidth gatherWidth(FilterParams p, GatherBlock b, Vec3 step, int16 gathers, float16 beta)
{
    GatherWidth w;
    w.beta = gathers ? beta : (float16)(1.0f);
    w.scale = -WEDGE_HALF_LOG2E / (w.beta * w.beta);
    w.limit = p.cut * p.cut * w.beta * w.beta;
    w.radius = gathers ? radiusInPixels(p, b, step, WEDGE_WIDEST_PAIR * p.cut * w.beta) : (float16)(0.0f);
    return w;
}

/// Neighbours of a block of pixels, however wide the kernels are.
typedef struct {
    int16 known; ///< of the same surface
    Vec3x16 offset; ///< offset16(), metres
    float16 squared; ///< distance
    float16 area; ///< over the pixel's own
} Neighbours;

/// betaThere: negative where there is no value to take
WEDGE_INLINE Neighbours neighboursAt(FilterParams p, GatherBlock b, int j, float16 betaThere,
    __global const float* position, __global const float* normal, __global const float* pixelSize,
    __global const uint* objectId)
{
    const uint16 object = loadIdBlock(objectId, j);
    const Vec3x16 normalThere = loadNormalBlock(p, normal, j);
    const Vec3x16 d = sub16(loadVecBlock(position, p.planeSize, j), b.position);
    Neighbours n;
    n.offset = offset16(p, b.slant, d);
    n.squared = dot16(n.offset, n.offset);
    n.known = (object == b.object) & (betaThere >= 0.0f) & (dot16(b.normal, normalThere) >= p.normalCosine);
    n.area = (float16)(1.0f);
    if (p.surface != 0u) {
        const float16 rise = dot16(b.plane, d);
        n.known &= rise * rise <= WEDGE_MOST_RISE * WEDGE_MOST_RISE * dot16(d, d);
        const float16 size = loadSizeBlock(pixelSize, j) * b.perSize;
        n.area = min16(size * size, (float16)(WEDGE_MOST_AREA));
    }
    return n;
}

/// What neighbours `steps` pixels away weigh, whose own kernels are betaThere wide: 0 where they are not in reach.
WEDGE_INLINE float16 neighbourWeights(FilterParams p, GatherWidth width, Neighbours n, float16 betaThere, float steps)
{
#ifdef WEDGE_GATHER_MEAN_SQUARE
    // Bandwidths are 1 / (2 beta). A pixel with no kernel of its own (beta 0) counts as if it had the gathering one's.
    const float16 there = betaThere > 0.0f ? -WEDGE_HALF_LOG2E / (betaThere * betaThere) : width.scale;
    const float16 exponent = n.squared * (0.5f * (width.scale + there));
    const int16 taken = n.known & (exponent >= -WEDGE_HALF_LOG2E * p.cut * p.cut) & (steps <= width.radius);
    return taken ? n.area * exp2Block(exponent) : (float16)(0.0f);
#else
    const int16 taken = n.known & (n.squared <= width.limit) & (steps <= width.radius);
    float16 scale = width.scale;
    if (p.narrower != 0u) {
        // A pixel with no kernel of its own (beta 0) does not narrow its neighbours'.
        const float16 own = betaThere > 0.0f ? min16(width.beta, betaThere) : width.beta;
        scale = -WEDGE_HALF_LOG2E / (own * own);
    }
    return taken ? n.area * exp2Block(n.squared * scale) : (float16)(0.0f);
#endif
}

/// Sums over a line of pixels that weigh w, d pixels from the one that gathers, which is one of them and weighs 1.
typedef struct {
    float16 weight, along, spread; ///< of w, w d, w d^2
    float16 squared, squaredAlong, squaredSpread; ///< of w^2, w^2 d, w^2 d^2
} LineWeights;

WEDGE_INLINE LineWeights ownWeight(void)
{
    LineWeights sum;
    sum.weight = sum.squared = (float16)(1.0f);
    sum.along = sum.spread = sum.squaredAlong = sum.squaredSpread = (float16)(0.0f);
    return sum;
}

/// steps: d
WEDGE_INLINE void addWeight(LineWeights* sum, float16 w, float steps)
{
    const float16 along = w * steps;
    sum->weight += w;
    sum->along += along;
    sum->spread += along * steps;
    sum->squared += w * w;
    sum->squaredAlong += w * along;
    sum->squaredSpread += along * along;
}

/// How a line's sums become the value that a straight line through them has at the pixel, d = 0: the mean less the
/// slope times the mean d (local linear regression; Fan and Gijbels, 1996). The slope is that of least squares with
/// WEDGE_FIT_RIDGE in the denominator, for neighbours that are few. Where they lie evenly around the pixel that is the
/// mean; at edges, and where kernels narrow to one side, a gradient puts the mean off, and not the line.
typedef struct {
    float16 perWeight, middle, lever; ///< lever: the slope's factor is d's mean, the rest of both is in here
} LineFit;

WEDGE_INLINE LineFit fitOf(LineWeights sum)
{
    LineFit fit;
    fit.perWeight = 1.0f / sum.weight;
    fit.middle = sum.along * fit.perWeight;
    const float16 spread = max16(sum.spread - sum.along * fit.middle, (float16)(0.0f));
    fit.lever = fit.middle / (spread + WEDGE_FIT_RIDGE * sum.weight);
    return fit;
}

/// The equal samples that a line amounts to: 1 over the sum of squares of what its pixels count for where it is
/// believed.
WEDGE_INLINE float16 countOfLine(LineWeights sum, bool fitted)
{
    if (!fitted) {
        return sum.weight * sum.weight / sum.squared;
    }
    const LineFit fit = fitOf(sum);
    const float16 across = sum.squaredAlong - fit.middle * sum.squared;
    const float16 wide = sum.squaredSpread - fit.middle * (sum.squaredAlong + across);
    return 1.0f
        / (fit.perWeight * (fit.perWeight * sum.squared - 2.0f * fit.lever * across) + fit.lever * fit.lever * wide);
}

#ifdef WEDGE_GATHER_CHANNELS
/// Planes of gradients: of each channel along two axes, and of programs of WEDGE_GATHER_CURVED three second
/// derivatives.
#ifdef WEDGE_GATHER_CURVED
#define WEDGE_GRADIENTS_EACH 5u
#else
#define WEDGE_GRADIENTS_EACH 2u
#endif
#define WEDGE_GRADIENTS (WEDGE_GRADIENTS_EACH * WEDGE_GATHER_CHANNELS)

typedef struct {
    LineWeights weights;
    float16 channel[WEDGE_GATHER_CHANNELS], moment[WEDGE_GATHER_CHANNELS]; ///< of w f, w d f
#ifdef WEDGE_GATHER_SHEARED
    float16 gradient[WEDGE_GRADIENTS]; ///< of w times those of neighbours
#endif
} GatherSum;

/// Not the weight alone: 0 times a NaN would let it in.
WEDGE_INLINE void addValue(GatherSum* sum, uint channel, float16 w, float steps, float16 value)
{
    const float16 weighted = w > 0.0f ? w * value : (float16)(0.0f);
    sum->channel[channel] += weighted;
    sum->moment[channel] += steps * weighted;
}

/// A channel's mean or, fitted, the line's value at the pixel, from 0 to p.most. A line is not believed where it is far
/// from the mean: what is bright in the middle of a wide kernel is not a straight line, and whoever draws one to the
/// ends loses light (a lamp that few paths meet lost a quarter). So it counts in full where it is off by up to a fifth
/// of the mean, and not at all from two fifths on. What is not finite stays so.
WEDGE_INLINE float16 valueOfLine(FilterParams p, const GatherSum* sum, LineFit fit, uint channel)
{
    const float16 mean = sum->channel[channel] * fit.perWeight;
    if (channel >= p.fitted) {
        return mean;
    }
    const float16 off = fit.lever * (sum->moment[channel] - fit.middle * sum->channel[channel]);
    const float16 trust = 2.0f - 5.0f * fabs(off) / max16(fabs(mean), (float16)(1e-30f));
    const float16 line = mean - off * min16(max16(trust, (float16)(0.0f)), (float16)(1.0f));
    const float16 bounded = min16(max16(line, (float16)(0.0f)), max16(mean, (float16)(p.most)));
    return fabs(off) < INFINITY ? bounded : mean;
}
#endif

#endif
