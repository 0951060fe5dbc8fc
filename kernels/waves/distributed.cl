// The analysis of distributed frames (thesis 5.7, 5.8): where texture and irradiance may be taken apart, how wide the
// irradiance's filter is then, which samples are worth most, and what becomes of the filtered term.
#include "core/blur.h"
#include "core/distributed_pixel.h"
#include "core/fallen_back.h"
#include "core/finite.h"
#include "core/formats.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/distributed.h"
#include "shared/filter_params.h"
#include "waves/accumulate.h"

/// The signed luminance of L - k E (accumulate.h). Lean frames have measured it.
#include "pass/factoringError.h"
#ifdef PASS_factoringError
__kernel void factoringError(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    error[i] = errorOfFactoring(LOAD_texture(p.planeSize, i), LOAD_value(p.planeSize, i), plain[i]);
}
#endif

/// Narrows nothing and widens beta, metres, to what the lens has blurred already (5.18), (5.22); takes pixels out whose
/// error is too large (beta = -1: they keep their own, and are nobody's neighbours). in   error
#include "pass/factoredWidths.h"
#ifdef PASS_factoredWidths
__kernel void factoredWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    float sum = 0.0f, count = 0.0f;
    const int reach = (int)p.factoringRadius;
    for (int dy = -min((int)y, reach); dy <= min((int)(p.height - 1u - y), reach); ++dy) {
        for (int dx = -min((int)x, reach); dx <= min((int)(p.width - 1u - x), reach); ++dx) {
            const int j = (int)i + dy * (int)p.stride + dx;
            const bool same = objectId[j] == objectId[i];
            sum += same ? LOAD_error(p.planeSize, (uint)j) : 0.0f;
            count += same ? 1.0f : 0.0f;
        }
    }
    const bool apart = p.never == 0u && fabs(sum) <= p.factoringError * count;
    const float r = leastConfusion(LOAD_confusion(p.planeSize, i));
    const float blurred = r >= p.leastRadius ? p.irradianceWidth * r * LOAD_pixelSize(p.planeSize, i) : 0.0f;
    beta[i] = apart && beta[i] >= 0.0f ? fmax(beta[i], blurred) : -1.0f;
}
#endif

/// A term's variance a primary sample, in two: what the texture makes, which every pixel has to average by itself, and
/// the rest, which the irradiance's filter averages. in   squares and textureSquares, means, or, of compact frames,
/// spreads, standard deviations. out  ofTexture, ofIrradiance
#include "pass/splitVariance.h"
#ifdef PASS_splitVariance
__kernel void splitVariance(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 k = LOAD_texture(p.planeSize, i);
    const float mean = luminance(vecMul(k, LOAD_value(p.planeSize, i))), t = luminance(k);
    const float n = (float)taken[i];
    const float unbiased = n > 1.0f ? n / (n - 1.0f) : 0.0f;
#if HAS_spreads
    const float2 d = LOAD_spreads(p.planeSize, i);
    const float all = d.x * d.x * unbiased, spread = d.y * d.y * unbiased;
#else
    const float all = fmax(squares[i] - mean * mean, 0.0f) * unbiased;
    const float spread = fmax(textureSquares[i] - t * t, 0.0f) * unbiased;
#endif
    const float irradiance = t > 0.0f ? mean / t : 0.0f;
    const float texturePart = fmin(spread * irradiance * irradiance, all);
    ofTexture[i] = texturePart;
    ofIrradiance[i] = all - texturePart;
}
#endif

/// The variance of what is seen to emit, a primary sample.
#include "pass/emissionVariance.h"
#ifdef PASS_emissionVariance
__kernel void emissionVariance(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float n = (float)taken[i], mean = luminance(loadVec(emission, p.planeSize, i));
    variance[i] = n > 1.0f ? fmax(squares[i] - mean * mean, 0.0f) * n / (n - 1.0f) : 0.0f;
}
#endif

/// Equal samples that Gaussians one after the other amount to: that of the irradiance alone gathers so many, the
/// image's have the standard deviations lens, and, along one direction, along (pixels). Their covariances add up.
WEDGE_FN float gatheredBy(float irradiance, float lens, float along)
{
    const float across = irradiance / (4.0f * 3.14159265f) + lens * lens;
    return fmax(4.0f * 3.14159265f * sqrt(across * (across + along * along)), 1.0f);
}

/// Uncertainty (demand.cl) of a term's samples for their rays: v / K / rays, of the whole image. variance: v;
/// effective: pixels that the irradiance's filter gathers; lens, along: standard deviations of the image-space filters,
/// pixels.
#include "pass/uncertaintyOfRays.h"
#ifdef PASS_uncertaintyOfRays
__kernel void uncertaintyOfRays(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float irradiance = beta[i] > 0.0f ? fmax(effective[i], 1.0f) : 1.0f;
    const float gathered = gatheredBy(irradiance, lens[i], p.alongMotion != 0u ? LOAD_along(p.planeSize, i) : 0.0f);
    uncertainty[i] = variance[i] / (gathered * p.rays);
}
#endif

/// sum += part.
#include "pass/addPlane.h"
#ifdef PASS_addPlane
__kernel void addPlane(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    sum[i] += part[i];
}
#endif

/// At least as many samples of one kind as of another, times apart where texture and irradiance are taken apart (beta
/// >= 0), times together elsewhere.
#include "pass/atLeast.h"
#ifdef PASS_atLeast
__kernel void atLeast(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    demand[i] = fmax(demand[i], (beta[i] >= 0.0f ? apart : together) * least[i]);
}
#endif

/// A term's value in three planes.
#include "pass/unpackImage.h"
#ifdef PASS_unpackImage
__kernel void unpackImage(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    STORE_out(p.planeSize, i, LOAD_in(p.planeSize, i));
}
#endif

/// Counts of a term's samples after the last wave of a lean frame: pixels without new primary samples took none of the
/// term. in out  counts: wanted; taken
#include "pass/settleCounts.h"
#ifdef PASS_settleCounts
__kernel void settleCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    counts[i] = primaryTaken[i] > first ? counts[i] : primaryTaken[i];
}
#endif

/// No more new primary samples than a wave has room for.
#include "pass/limitStep.h"
#ifdef PASS_limitStep
__kernel void limitStep(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    wanted[i] = min(wanted[i], taken[i] + WEDGE_MOST_NEW_SAMPLES);
}
#endif

/// The filter along a motion of n samples, where all that a pixel shows has it (one): a unit vector, and the standard
/// deviation along it, pixels.
typedef struct {
    float along, x, y;
} Blur;

WEDGE_FN Blur blurAlong(DistributedParams p, bool one, float2 motion, float length, float n)
{
    const float h = 0.5f * length;
    Blur b;
    b.along = one ? p.shutterWidth * h * pow(n * h, -p.shutterExponent) : 0.0f;
    b.x = one ? motion.x / length : 1.0f;
    b.y = one ? motion.y / length : 0.0f;
    return b;
}

/// Standard deviations in pixels of the image-space filters: of the blur that all of a pixel has, else 0.
/// in   motion, motionSpread: as accumulateSurfaces keeps them
/// out  lens; where something moves, along (the motion), directions of that (unit vectors), or, of lean frames, both in
///      one: vectors, whose length is the standard deviation
#include "pass/blurs.h"
#ifdef PASS_blurs
__kernel void blurs(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float n = p.frames * (p.samples > 0.0f ? p.samples : fmax((float)taken[i], 1.0f));
    const float r = leastConfusion(LOAD_confusion(p.planeSize, i));
    lens[i] = r >= p.leastRadius ? p.blurWidth * r * pow(n * r * r, -p.blurExponent) : 0.0f;
#if HAS_motion
    const float2 m = LOAD_motion(p.planeSize, i);
    const float length = sqrt(m.x * m.x + m.y * m.y);
    const bool alike =
        HAS_motionSpread ? LOAD_motionSpread(p.planeSize, i) <= p.oneVelocity * length : length < INFINITY;
    const Blur b = blurAlong(p, alike && length >= p.leastRadius, m, length, n);
    STORE_along(p.planeSize, i, b.along);
    STORE_directions(p.planeSize, i, (float2)(b.x, b.y));
    STORE_vectors(p.planeSize, i, (float2)(b.along * b.x, b.along * b.y));
#endif
}
#endif

/// Standard deviations in pixels of the filter of a light's irradiance along its shadows' motion (B.2): where all that
/// move move alike, else 0. in   shadowSums: sums of motions (shadow_motions.h), or, of lean frames, shadowMotion:
/// their mean; taken: the light's samples out  along, directions, vectors as blurs() has them
#include "pass/shadowBlurs.h"
#ifdef PASS_shadowBlurs
__kernel void shadowBlurs(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const float samples = p.frames * (p.samples > 0.0f ? p.samples : fmax((float)taken[i], 1.0f));
#if HAS_shadowMotion
    const float2 m = LOAD_shadowMotion(n, i);
    const float length = sqrt(m.x * m.x + m.y * m.y);
    const bool alike = length < INFINITY;
#else
    const float count = fmax(shadowSums[3u * n + i], 1.0f);
    const float2 m = (float2)(shadowSums[i] / count, shadowSums[n + i] / count);
    const float squared = m.x * m.x + m.y * m.y, length = sqrt(squared);
    const bool alike = sqrt(fmax(shadowSums[2u * n + i] / count - squared, 0.0f)) <= p.oneVelocity * length;
#endif
    const Blur b = blurAlong(p, alike && length >= p.leastRadius && beta[i] >= 0.0f, m, length, samples);
    STORE_along(n, i, b.along);
    STORE_directions(n, i, (float2)(b.x, b.y));
    STORE_vectors(n, i, (float2)(b.along * b.x, b.along * b.y));
}
#endif

/// The luminance of a texture: what widths() of analysis.cl takes for the sums of a light's unshadowed samples, and
/// what a pixel's irradiance is worth in the image.
#include "pass/luminanceOf.h"
#ifdef PASS_luminanceOf
__kernel void luminanceOf(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    out[i] = luminance(LOAD_image(p.planeSize, i));
}
#endif

/// A number of fewer bits in 32.
#include "pass/unpackNumber.h"
#ifdef PASS_unpackNumber
__kernel void unpackNumber(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    out[i] = LOAD_in(p.planeSize, i);
}
#endif

/// A term's value in one plane: of a light, whose filter averages it, what is seen. As published it is in the first one
/// already.
#include "pass/visibilityOf.h"
#ifdef PASS_visibilityOf
__kernel void visibilityOf(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 k = LOAD_texture(p.planeSize, i), v = LOAD_value(p.planeSize, i);
    const float t = luminance(k);
    visibility[i] = p.published != 0u ? v.x : t > 0.0f ? luminance(vecMul(k, v)) / t : 0.0f;
}
#endif

/// Along the motion: of a term its texture, or a value of one number. along, directions, or vectors: of blurs() or
/// shadowBlurs()
#include "pass/blurMotion.h"
#ifdef PASS_blurMotion
#define MOTION_BLUR(n, i)                                                                                              \
    (HAS_vectors ? blurOfVector(LOAD_vectors(n, i)) : blurAlongUnit(LOAD_along(n, i), LOAD_directions(n, i)))
#define BLURRED(n, i) (HAS_texture ? LOAD_texture(n, i) : vec3(LOAD_value(n, i), 0.0f, 0.0f))
__kernel void blurMotion(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const MotionBlur here = MOTION_BLUR(n, i);
    const int reach = min((int)(WEDGE_BLUR_CUT * here.sigma), WEDGE_MOTION_REACH);
    Vec3 sum = BLURRED(n, i);
    float weights = 1.0f;
    for (int k = -reach; k <= reach; ++k) {
        const uint j = pixelAlong(p, x, y, i, here.x, here.y, k);
        const float w = j != i ? motionWeight(here, MOTION_BLUR(n, j), k) : 0.0f;
        if (w > 0.0f) {
            weights += w;
            sum = vecMad(sum, BLURRED(n, j), w);
        }
    }
#if HAS_texture
    storeVec(out, n, i, vec3(sum.x / weights, sum.y / weights, sum.z / weights));
#else
    out[i] = sum.x / weights;
#endif
}
#endif

/// A term's own radiance, k E; as published L, termRadiance.
#define OWN_RADIANCE(n, i) (HAS_termRadiance ? LOAD_termRadiance(n, i) : vecMul(LOAD_texture(n, i), LOAD_value(n, i)))

/// What a light's own radiance k V has of colour that its luminance times k has not: textures of several colours that
/// see the light differently. It has no luminance, and is 0 where all that a pixel shows has one colour.
WEDGE_FN Vec3 ownColour(Vec3 texture, Vec3 value)
{
    const Vec3 own = vecMul(texture, value);
    const float t = luminance(texture);
    return t > 0.0f ? vecSub(own, vecScale(texture, luminance(own) / t)) : vec3(0.0f, 0.0f, 0.0f);
}

/// How much of a difference can be added to a number >= 0 that is to stay so: 1, or the part that makes it 0.
WEDGE_FN float keptOf(float number, float difference)
{
    return number + difference < 0.0f ? -number / difference : 1.0f;
}

/// radiance += a term: where it is taken apart filteredTexture filtered (p.values planes), which where there are shares
/// falls back to the term's own; elsewhere its own. Of lights visibilities are filtered, in which colours have no part:
/// each pixel keeps its own.
#include "pass/addFilteredTerm.h"
#ifdef PASS_addFilteredTerm
__kernel void addFilteredTerm(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    Vec3 term;
    if (beta[i] >= 0.0f) {
        Vec3 e = p.values == 3u ? loadVec(filtered, n, i) : vec3(filtered[i], filtered[i], filtered[i]);
#if HAS_shares
        const float2 share = LOAD_shares(n, i);
        if (share.x > 0.0f || share.y != 0.0f) {
            Vec3 u = LOAD_value(n, i);
            if (p.values == 1u) {
                const Vec3 k = LOAD_texture(n, i);
                u.x = u.y = u.z = luminance(vecMul(k, u)) / fmax(luminance(k), 1e-30f);
            }
            e = fallenBackVec(e, u, share);
        }
#endif
        term = vecMul(LOAD_filteredTexture(n, i), e);
        if (p.values == 1u && p.published == 0u) {
            const Vec3 colour = ownColour(LOAD_texture(n, i), LOAD_value(n, i));
            const float kept = fmin(keptOf(term.x, colour.x), fmin(keptOf(term.y, colour.y), keptOf(term.z, colour.z)));
            term = vecMad(term, colour, kept);
        }
    } else {
        term = OWN_RADIANCE(n, i);
    }
    storeVec(radiance, n, i, vecAdd(loadVec(radiance, n, i), term));
}
#endif

/// radiance += a term without any filter.
#include "pass/addTerm.h"
#ifdef PASS_addTerm
__kernel void addTerm(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const Vec3 term = OWN_RADIANCE(p.planeSize, i);
    storeVec(radiance, p.planeSize, i, vecAdd(loadVec(radiance, p.planeSize, i), term));
}
#endif

/// What arrives, as it is shown: where it is taken apart filtered, falling back to the term's own; elsewhere its own.
/// Pixels that reflect none of it have no number there, which filters of images leave out.
#include "pass/arrivingAtWaves.h"
#ifdef PASS_arrivingAtWaves
__kernel void arrivingAtWaves(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    Vec3 e = LOAD_value(n, i);
#if HAS_filtered
    if (beta[i] >= 0.0f) {
        const float2 share = LOAD_shares(n, i);
        const Vec3 found = loadVec(filtered, n, i);
        e = share.x > 0.0f || share.y != 0.0f ? fallenBackVec(found, e, share) : found;
    }
#endif
    storeVec(arrives, n, i, vecIf(luminance(LOAD_texture(n, i)) > 0.0f, e));
}
#endif

/// radiance += what filters change of what arrives, reflected: where texture and value are taken apart (beta) by the
/// filtered texture.
#include "pass/addChange.h"
#ifdef PASS_addChange
__kernel void addChange(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 own = LOAD_texture(n, i);
    if (luminance(own) > 0.0f) {
#if HAS_filteredTexture
        const Vec3 k = beta[i] >= 0.0f ? LOAD_filteredTexture(n, i) : own;
#else
        const Vec3 k = own;
#endif
        const Vec3 more = vecMul(k, vecSub(loadVec(after, n, i), loadVec(before, n, i)));
        const Vec3 sum = vecAdd(loadVec(radiance, n, i), more);
        storeVec(radiance, n, i, vec3(fmax(sum.x, 0.0f), fmax(sum.y, 0.0f), fmax(sum.z, 0.0f)));
    }
}
#endif

/// sum += image (3 planes each).
#include "pass/addImage.h"
#ifdef PASS_addImage
__kernel void addImage(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    storeVec(sum, p.planeSize, i, vecAdd(loadVec(sum, p.planeSize, i), loadVec(image, p.planeSize, i)));
}
#endif
