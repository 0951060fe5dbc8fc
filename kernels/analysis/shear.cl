// What the sheared filter of a light's term takes besides widths (gather_sheared.h, docs/soft-shadows.md): gradients,
// and widths that follow pixels' own counts and how wide shadows are.
#include "core/packed_planes.h"
#include "core/vector16.h"
#include "shared/filter_params.h"

#ifdef WEDGE_SPECULAR
#define WEDGE_CHANNELS 2u
#else
#define WEDGE_CHANNELS 1u
#endif

/// Of each channel and axis of the light how fast the part of it that is seen changes where the light, in its own
/// coordinates, moves: mean of (V - h) q over the samples, V their visibility, h its mean, q their scores (scoreOf()).
///
/// each: of a channel 2, or WEDGE_MOMENTS with derivatives of second order; first, second: what those of first and of
/// second order are multiplied by
///
/// in      sums (light_sampling.h)
/// in out  gradients: of 16 bits; what finishScores() or finishMoments() left, of which the means are made
#include "pass/shadowGradients.h"
#ifdef PASS_shadowGradients
__kernel void shadowGradients(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    for (uint channel = 0u; channel < WEDGE_CHANNELS; ++channel) {
        const float16 all = loadBlock(sums + 2u * channel * p.planeSize, i);
        const float16 perAll = all > 0.0f ? 1.0f / all : (float16)(0.0f);
        for (uint k = 0u; k < each; ++k) {
            const float16 factor = (k < 2u ? first : second) * perAll;
            const uint plane = channel * each + k;
            storeShortsBlock(
                gradients, p.planeSize, i, plane, factor * loadShortsBlock(gradients, p.planeSize, i, plane));
        }
    }
}
#endif

/// Widths are made for pixels that take the mean count, and for shadows of few pixels. Those that take more samples are
/// less noisy, and where shadows are wide more pixels are gathered: as wide filters would put more off than they
/// smooth. beta ~ (mean / count)^countPower, and where shadows blur over more pixels than wideBlur (a light's standard
/// deviation), ~ (wideBlur / blur)^blurPower. The blur is k mu times the width (filterWidth()), of both slopes that of
/// their mean; where a lobe has narrowed the width it counts as less, and nothing is narrowed twice.
///
/// in      taken: samples; pixelSize: metres
/// in out  beta: metres
/// out     slopeWidth: what it was, which goes with the occluders' slopes alone; of 16 bits
#include "pass/narrowSheared.h"
#ifdef PASS_narrowSheared
__kernel void narrowSheared(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float width = beta[i];
    storeShort(slopeWidth, 0u, i, 0u, width);
    if (width > 0.0f) {
        const float byCount = countPower * log2(mean / (float)max(taken[i], 1u));
        const float byBlur = blurPower * log2(wideBlur * pixelSize[i] / (p.k * p.mu * width));
        beta[i] = width * exp2(byCount + fmin(byBlur, 0.0f));
    }
}
#endif
