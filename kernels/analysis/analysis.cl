// From the first pass's slopes to filter widths.
//
// Published (thesis section 3.6): an unoccluded pixel takes the mean distances of the occluded pixels within 5
// pixels. Default: s_min is eroded over 3x3 pixels of the same object (but for components, docs/maaf.md), smoothed in
// the logarithm, and spread to unoccluded pixels with Gaussian weights, so that the widths have no border of their own.
#include "analysis/smooth_slopes.h"
#include "core/formats.h"
#include "core/vector16.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/wedge.h"

/// Weight of spread slopes below which a pixel counts as far from any shadow.
#define WEDGE_LEAST_SPREAD 1e-4f

/// 3x3 minimum of s_min over occluded pixels of the same object; 0 where there is none.
#include "pass/erodeSlopes.h"
#ifdef PASS_erodeSlopes
__kernel void erodeSlopes(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint16 object = loadIdBlock(objectId, i);
    float16 least = (float16)(2.0f * WEDGE_SLOPE_MAX);
    for (int dy = y > 0u ? -1 : 0; dy <= (y + 1u < p.height ? 1 : 0); ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const int j = i + dy * (int)p.stride + dx;
            const float16 slope = loadBlock(slopes, j);
            const int16 taken = (slope > 0.0f) & (loadIdBlock(objectId, j) == object) & (object != 0u);
            least = taken ? min16(least, slope) : least;
        }
    }
    vstore16(least <= WEDGE_SLOPE_MAX ? least : (float16)(0.0f), 0, eroded + i);
}
#endif

/// Mean of log2 s over the pixels of the same object that have a slope, no more than `radius` (at most
/// WEDGE_BLOCK_PIXELS) away along both axes. out planes: log2 of the slope, weight (1 where there is one, else 0).
#include "pass/smoothSlopes.h"
#ifdef PASS_smoothSlopes
__kernel void smoothSlopes(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint16 object = loadIdBlock(objectId, i);
    const int16 has = (loadBlock(eroded, i) > 0.0f) & (object != 0u);
    float16 mean = (float16)(0.0f);
    if (any(has)) {
        const SlopesAround around = slopesAround(p, radius, y, i, object, eroded, objectId);
        mean = has ? around.sum / around.count : (float16)(0.0f);
    }
    vstore16(mean, 0, logSlopes + i);
    vstore16(has ? (float16)(1.0f) : (float16)(0.0f), 0, logSlopes + p.planeSize + i);
}
#endif

/// Distances of the published fallback: planes d1 w, d2_max w, d2_min w, w with w = 1 at occluded pixels, else 0;
/// d1 = receiver to the light's centre in metres, d2 = d1 / (1 + s) (3.4).
#include "pass/publishedDistances.h"
#ifdef PASS_publishedDistances
__kernel void publishedDistances(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float16 sMin = loadBlock(slopes, i);
    const float16 sMax = loadBlock(slopes + p.planeSize, i);
    const Vec3x16 toLight = sub16(splat3(p.lightCentre), loadVecBlock(position, p.planeSize, i));
    const int16 occluded = (sMin > 0.0f) & (loadIdBlock(objectId, i) != 0u);
    const float16 w = occluded ? (float16)(1.0f) : (float16)(0.0f);
    const float16 d1 = occluded ? sqrt(dot16(toLight, toLight)) : (float16)(0.0f);
    vstore16(d1, 0, distances + i);
    vstore16(d1 / (1.0f + sMin), 0, distances + p.planeSize + i);
    vstore16(d1 / (1.0f + sMax), 0, distances + 2u * p.planeSize + i);
    vstore16(w, 0, distances + 3u * p.planeSize + i);
}
#endif

/// One direction of a separable weighted sum over `planes` planes whose last is the weight (values arrive multiplied
/// by their weights). element: 1 for rows, the stride for columns.
WEDGE_FN void spreadLine(AnalysisParams p, uint x, uint y, int element, int before, int after, uint planes,
    __global const float* in, __global float* out)
{
    const int i = (int)pixelIndex(x, y, p.stride);
    const int radius = (int)p.fillRadius;
    const float first = exp2(p.fillScale);
    const float ratio = first * first;
    for (uint plane = 0u; plane < planes; ++plane) {
        __global const float* source = in + plane * p.planeSize;
        float16 sum = loadBlock(source, i);
        // exp2(k^2 s) for k = 1, 2, ... by its two ratios: each weight is the one before times step, step shrinks.
        float w = 1.0f;
        float step = first;
        for (int k = 1; k <= radius; ++k) {
            w *= step;
            step *= ratio;
            sum += k <= before ? w * loadBlock(source, i - k * element) : (float16)(0.0f);
            sum += k <= after ? w * loadBlock(source, i + k * element) : (float16)(0.0f);
        }
        vstore16(sum, 0, out + plane * p.planeSize + i);
    }
}

#include "pass/spreadRows.h"
#ifdef PASS_spreadRows
__kernel void spreadRows(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    spreadLine(p, x, y, 1, (int)p.fillRadius, (int)p.fillRadius, planes, in, out);
}
#endif

#include "pass/spreadColumns.h"
#ifdef PASS_spreadColumns
__kernel void spreadColumns(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    spreadLine(p, x, y, (int)p.stride, (int)y, (int)(p.height - 1u - y), planes, in, out);
}
#endif

/// Widths of the default setting, metres: from the pixel's own smoothed slope, else from what spread to it, else 0
/// (nothing near is in shadow). -1 where the pixel sees nothing of the light. fixedWidth replaces the analysis.
#include "pass/widths.h"
#ifdef PASS_widths
__kernel void widths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float size = LOAD_pixelSize(p.planeSize, i);
    const float own = logSlopes[p.planeSize + i];
    const float near = spread[p.planeSize + i];
    const bool has = own > 0.0f || near > WEDGE_LEAST_SPREAD;
    const float logSlope = own > 0.0f ? logSlopes[i] : spread[i] / fmax(near, WEDGE_LEAST_SPREAD);
    const float slope = exp(0.69314718f * logSlope);
    const float analysed = has ? filterWidth(slope, p.sigma, size, p.k, p.mu, p.alpha) : 0.0f;
    const float wide = p.fixedWidth > 0.0f ? p.fixedWidth * size : analysed;
    beta[i] = objectId[i] != 0u && sums[i] > 0.0f ? wide : -1.0f;
}
#endif

/// Narrows a width to what a highlight allows, by its share of what arrives. A lobe that is narrower than the light has
/// sharper shadows, and moves over the light as the receiver moves: an edge at distance o of the receiver, seen in a
/// lobe of standard deviation a from distance e, is a / (1 / o + 1 / e) wide, as a reflected image is. 1 / beta^2 =
/// 1 / beta_diffuse^2 + share / beta_lobe^2. wide: beta_diffuse > 0, metres
WEDGE_FN float narrowed(AnalysisParams p, Vec3 toLight, Vec3 toEye, Gloss lobe, float share, float wide)
{
    const float light = vecLength(toLight), eye = vecLength(toEye);
    // Of Blinn-Phong the half vector has that deviation, and the direction |l + v| times as much.
    const float spread = vecLength(vecAdd(vecScale(toLight, 1.0f / light), vecScale(toEye, 1.0f / eye)));
    const float deviation = (lobe.kind == WEDGE_PHONG ? 1.0f : spread) * rsqrt(fmax(lobe.exponent, 1.0f));
    const float slope = wide * p.k * p.mu / p.sigma;
    const float occluder = light * slope / (1.0f + slope);
    const float ofLobe = deviation / ((1.0f / occluder + 1.0f / eye) * p.k * p.mu);
    return rsqrt(1.0f / (wide * wide) + share / (ofLobe * ofLobe));
}

/// narrowed(), by the part of what a pixel reflects of the light that is lobes'.
/// in      sums: of the light's samples, see light_sampling.h, with the specular ones; or, of pixels that keep what
///         they reflect of the light as one, texture
/// in out  beta
#include "pass/narrowForLobes.h"
#ifdef PASS_narrowForLobes
__kernel void narrowForLobes(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const float wide = beta[i];
    if (!(wide > 0.0f) || objectId[i] == 0u) {
        return;
    }
    const Vec3 at = loadVec(position, n, i), toLight = vecSub(p.lightCentre, at);
#if HAS_sums
    const float lobes = luminance(LOAD_specular(n, i)) * PLANE_sums[2u * n + i];
    const float matt = luminance(LOAD_diffuse(n, i)) * WEDGE_INV_PI * PLANE_sums[i];
    const float share = lobes > 0.0f ? lobes / (lobes + matt) : 0.0f;
#else
    // At least what a white matt surface that faced all of the light, as near as its nearest corner may be, would not
    // reflect.
    const float reach = vecLength(light.halfU) + vecLength(light.halfV);
    const float nearest = fmax(vecLength(toLight) - reach, 0.0f);
    const float white = WEDGE_INV_PI * luminance(light.power) / fmax(nearest * nearest, 1e-20f);
    const float reflected = luminance(LOAD_texture(n, i));
    const float share = reflected > white ? 1.0f - white / reflected : 0.0f;
#endif
    if (share > 0.0f) {
        beta[i] = narrowed(p, toLight, vecSub(frame.eye, at), LOAD_gloss(n, i), share, wide);
    }
}
#endif

/// Widths (3.13) and sample counts (3.21) of the published setting; distances: the sums of publishedDistances over
/// the window. A pixel with no occluded one near keeps the first pass's samples and is not filtered. countMu: counts'
/// own, since p.mu is as wide as filters are.
#include "pass/publishedWidths.h"
#ifdef PASS_publishedWidths
__kernel void publishedWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const bool lit = objectId[i] != 0u && sums[i] > 0.0f;
    const bool occluded = slopes[i] > 0.0f;
    const bool near = distances[3u * size + i] > 0.0f;
    const float farthest = fmax(distances[size + i], 1e-20f);
    const float nearest = fmax(distances[2u * size + i], 1e-20f);
    const float spreadMin = clamp(distances[i] / farthest - 1.0f, WEDGE_SLOPE_MIN, WEDGE_SLOPE_MAX);
    const float spreadMax = clamp(distances[i] / nearest - 1.0f, WEDGE_SLOPE_MIN, WEDGE_SLOPE_MAX);
    const float sMin = occluded ? slopes[i] : spreadMin;
    const float sMax = occluded ? slopes[size + i] : spreadMax;
    const bool filtered = occluded || near;
    const float analysed = filtered ? filterWidth(sMin, p.sigma, pixelSize[i], p.k, p.mu, p.alpha) : 0.0f;
    const float wide = p.fixedWidth > 0.0f ? p.fixedWidth * pixelSize[i] : analysed;
    beta[i] = lit ? wide : -1.0f;
    const float count = filtered && lit ? sampleCount(sMin, sMax, pixelSize[i], p.lightSize, countMu, p.alpha) : 0.0f;
    const float bounded = fmin(fmax(count, (float)WEDGE_FIRST_PASS_RAYS), (float)p.countCap);
    wanted[i] = objectId[i] != 0u ? (uint)(bounded + 0.5f) : 0u;
}
#endif
