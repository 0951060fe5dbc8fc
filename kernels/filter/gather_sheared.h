// The sheared filter: neighbours count for what they would see in the pixel's place, by half.
//
// What a pixel sees of a light is a function of x + s y, y on the light: h(x) = int f(x + s y) l(y) dy, whose gradient
// is 1/s int f q l, with the light's score q = -l' / l. So each pixel's own samples tell it. A Gaussian of deviation
// beta takes h for h + beta^2 h'' / 2 + ..., and the mean of h - d h' / 2 over neighbours at d has no such term. That
// is the first order of a Gaussian of d and y that is sheared along s. docs/soft-shadows.md
//
// Programs of WEDGE_GATHER_CURVED have the second order as well, and factors of both in what they read
// (analysis/shear.cl): the mean of h - 5/8 d h' + 1/8 d^2 h'' is off from the sixth derivative on. docs/maaf.md
//
// Included by filter.cl, between its types and its passes.
#ifndef WEDGE_GATHER_SHEARED_H
#define WEDGE_GATHER_SHEARED_H

/// What a neighbour's gradients along both of the light's axes count.
typedef struct {
    float16 u, v;
} Shear;

WEDGE_INLINE Shear shearOf(FilterParams p, GatherWidth width, Neighbours n)
{
    Shear shear;
    shear.u = width.perSlope * (n.offset.x * p.shearU.x + n.offset.y * p.shearU.y + n.offset.z * p.shearU.z);
    shear.v = width.perSlope * (n.offset.x * p.shearV.x + n.offset.y * p.shearV.y + n.offset.z * p.shearV.z);
    return shear;
}

#ifdef WEDGE_GATHER_CURVED
/// What the polynomial at element j is there: value + b.z + z.C z, z the displacement of the light that stands for the
/// way. The pass passes polynomials on: as seen from where they are gathered to, b + 2 C z and C.
WEDGE_INLINE float16 sheared(FilterParams p, __global const float* gradients, Shear shear, uint channel, int j,
    float16 w, float16 value, GatherSum* sum)
{
    float16 m[WEDGE_GRADIENTS_EACH];
    for (uint k = 0u; k < WEDGE_GRADIENTS_EACH; ++k) {
        m[k] = loadShortsBlock(gradients, p.planeSize, j, WEDGE_GRADIENTS_EACH * channel + k);
    }
    const float16 bendU = m[2] * shear.u + m[3] * shear.v, bendV = m[3] * shear.u + m[4] * shear.v;
    const float16 there = value + (shear.u * (m[0] + bendU) + shear.v * (m[1] + bendV));
    m[0] += 2.0f * bendU;
    m[1] += 2.0f * bendV;
    for (uint k = 0u; k < WEDGE_GRADIENTS_EACH; ++k) {
        // Not the weight alone: 0 times a NaN would let it in.
        sum->gradient[WEDGE_GRADIENTS_EACH * channel + k] += w > 0.0f ? w * m[k] : (float16)(0.0f);
    }
    return there;
}
#else
/// The value at element j, less half of what its gradient makes of the way; adds its gradients to the sums.
WEDGE_INLINE float16 sheared(FilterParams p, __global const float* gradients, Shear shear, uint channel, int j,
    float16 w, float16 value, GatherSum* sum)
{
    const float16 u = loadShortsBlock(gradients, p.planeSize, j, 2u * channel);
    const float16 v = loadShortsBlock(gradients, p.planeSize, j, 2u * channel + 1u);
    // Not the weight alone: 0 times a NaN would let it in.
    sum->gradient[2u * channel] += w > 0.0f ? w * u : (float16)(0.0f);
    sum->gradient[2u * channel + 1u] += w > 0.0f ? w * v : (float16)(0.0f);
    return value - (shear.u * u + shear.v * v);
}
#endif

WEDGE_INLINE void beginShear(FilterParams p, GatherPlanes in, int i, GatherWidth* width, GatherSum* sum)
{
    // Where filters were widened, slopes are not what makes them as wide.
    width->perSlope = 1.0f / max16(width->beta, loadShortBlock(in.slopeWidth, i));
    for (uint k = 0u; k < WEDGE_GRADIENTS; ++k) {
        sum->gradient[k] = loadShortsBlock(in.gradients, p.planeSize, i, k);
    }
}

/// Of pixels that gather nothing.
WEDGE_INLINE void keepGradients(FilterParams p, __global const float* gradients, int i, __global float* out)
{
    for (uint k = 0u; out != 0 && k < WEDGE_GRADIENTS; ++k) {
        storeShortsBlock(out, p.planeSize, i, k, loadShortsBlock(gradients, p.planeSize, i, k));
    }
}

/// Their means along the line, for the other pass.
WEDGE_INLINE void storeGradients(FilterParams p, __global const float* gradients, int i, int16 gathers,
    const GatherSum* sum, LineFit fit, __global float* out)
{
    for (uint k = 0u; out != 0 && k < WEDGE_GRADIENTS; ++k) {
        const float16 own = loadShortsBlock(gradients, p.planeSize, i, k);
        storeShortsBlock(out, p.planeSize, i, k, gathers ? sum->gradient[k] * fit.perWeight : own);
    }
}

#endif
