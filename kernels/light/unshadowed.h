// What a light would send to receivers if nothing were between: by quadrature, sixteen receivers at once. The one place
// for it: frames of pixels (composite.cl) and of waves (wave_light.cl) take the same rules.
//
// Means over the light of the geometry term, or of it times a lobe, by the rule that is exact enough for each receiver:
//   few     3 x 3 nodes of the profile's own Gauss rule: far from the light
//   coarse  5 x 5 nodes
//   medium  8 x 8: near the light, or for lobes narrower than it
//   fine    12 x 12: for lobes narrower still
//   clipped 8 x 8 over the part of the light above the receiver's horizon: where that crosses the light
//   fitted  16 x 16 in coordinates fitted to the receiver: at the light, and across horizons that the clipped rule does
//   not serve sampled directions of the lobe: where it is far narrower than the light, or narrower at all where the
//   fitted rule would do
#ifndef WEDGE_UNSHADOWED_H
#define WEDGE_UNSHADOWED_H

#include "light/light_rules.h"

/// The medium rule serves receivers nearer to the light's centre than this many of its largest half extents.
#define WEDGE_NEAR_LIGHT 3.0f
/// That of few nodes serves receivers farther than this many of them.
#define WEDGE_FAR_LIGHT 4.0f
/// The fitted rule serves receivers nearer to a point of the light than this many of them.
#define WEDGE_AT_LIGHT 1.0f

/// The clipped rule serves receivers farther from the light's centre than this many of its largest half extents, and
/// profiles cut at this many standard deviations at most.
#define WEDGE_CLIPPED_LIGHT 2.0f
#define WEDGE_CLIPPED_CUT 3.0f
/// And Blinn-Phong lobes whose view makes a cosine of at least this with the light's direction.
#define WEDGE_CLIPPED_TURN -0.875f

/// The coarse one serves lobes whose squared width is at least the light's squared angular half extent over this.
#define WEDGE_COARSE_LOBE 4.0f
/// Those of few nodes, far from the light, at least over this.
#define WEDGE_FEW_LOBE 1.5f
/// The medium one at least over this. Of a lobe like exp(-across x^2 / 2) on [-1, 1] it errs by 2e-4 of its peak there,
/// by the fine one 4e-7, and 3e-4 where lobes are sharp. The clipped one has the profile among what it integrates: of a
/// Gaussian cut at c standard deviations as much as c^2 across.
#define WEDGE_MEDIUM_LOBE 14.0f
/// Lobes sharper than this, in the same measure, fall between the fine rule's nodes.
#define WEDGE_SHARP_LOBE 40.0f
/// The same of the fitted rule's, which are dense where the light is near and not where the lobe is.
#define WEDGE_SHARP_FITTED_LOBE 10.0f

/// Square of the light's larger half extent, m^2.
WEDGE_FN float squaredExtent(AreaLight light)
{
    return fmax(vecDot(light.halfU, light.halfU), vecDot(light.halfV, light.halfV));
}

/// Squared angular half extent of the light over the squared width of the lobe, which at exponent m is about 1/sqrt(m):
/// of the half vector, and so of Blinn-Phong |l + v| times as much of l, far less where both graze.
WEDGE_FN float16 lobesAcross16(AreaLight light, Vec3x16 toLight, Receivers16 r)
{
    const float16 squared = dot16(toLight, toLight);
    const float16 widening = max16(2.0f + 2.0f * dot16(r.view, toLight) * rsqrt(squared), (float16)(1e-6f));
    const float16 across = squaredExtent(light) * max16(r.exponent, (float16)(1.0f)) / squared;
#ifdef WEDGE_GGX
    if (any(r.microfacets)) {
        // Aside of its peak the lobe falls off far slower: as one of alpha^2 + tan^2, at the place of the light where
        // the half vector is nearest to the normal.
        const Vec3x16 l = unit16(toLight);
        Vec3x16 h;
        h.x = r.view.x + l.x;
        h.y = r.view.y + l.y;
        h.z = r.view.z + l.z;
        h = unit16(h);
        const float16 nh = dot16(r.normal, h);
        const Vec3x16 off = mad16(h, r.normal, -nh);
        const float16 reach = sqrt(2.0f * squaredExtent(light) / (squared * widening));
        const float16 aside = max16(sqrt(dot16(off, off)) - reach, (float16)(0.0f));
        const float16 slower = 1.0f / (1.0f + 0.25f * max16(r.exponent, (float16)(4.0f)) * aside * aside);
        return (r.phong ? across : across / widening) * (r.microfacets ? slower : (float16)(1.0f));
    }
#endif
    return r.phong ? across : across / widening;
}

/// Lanes whose horizon goes through the light.
WEDGE_FN int16 horizonAcross(AreaLight light, Vec3x16 toLight, Vec3x16 normal)
{
    const float16 reach = fabs(dot16(normal, splat3(light.halfU))) + fabs(dot16(normal, splat3(light.halfV)));
    return fabs(dot16(normal, toLight)) <= reach;
}

/// Squared distance to the light's nearest point; of a parallelogram about that.
WEDGE_FN float16 squaredDistanceTo(AreaLight light, Vec3x16 toLight)
{
    const Vec3x16 u = splat3(light.halfU), v = splat3(light.halfV);
    const float16 one = (float16)(1.0f);
    const float16 a = min16(max16(-dot16(toLight, u) / dot16(u, u), -one), one);
    const float16 b = min16(max16(-dot16(toLight, v) / dot16(v, v), -one), one);
    const Vec3x16 d = mad16(mad16(toLight, u, a), v, b);
    return dot16(d, d);
}

/// Profile-weighted mean over the light of the geometry term, 1/m^2, of lanes `wanted`; lobes: of lobe times geometry
/// term, 1/(sr m^2), without the lobe's normalization, and nothing in lanes of *sampled, whose lobes are too sharp for
/// a rule.
WEDGE_FN float16 unshadowedMean(
    AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted, bool lobes, int16* sampled)
{
    const Vec3x16 toLight = sub16(splat3(light.centre), r.position);
    const float16 squared = dot16(toLight, toLight);
    const float extent = squaredExtent(light);
    const float16 across = lobes ? lobesAcross16(light, toLight, r) : (float16)(0.0f);
    const int16 horizon = horizonAcross(light, toLight, r.normal);
    const int16 at = squaredDistanceTo(light, toLight) < extent * WEDGE_AT_LIGHT * WEDGE_AT_LIGHT;
    const float profile = light.profile == WEDGE_PROFILE_GAUSSIAN ? light.cut * light.cut : 0.0f;
    const bool smooth = profile <= WEDGE_CLIPPED_CUT * WEDGE_CLIPPED_CUT;
    // Towards the mirrored view a half vector turns far faster in some places of the light than at its centre.
    const int16 steady = lobes ? r.phong | (dot16(r.view, toLight) > WEDGE_CLIPPED_TURN * sqrt(squared)) : (int16)(-1);
    const int16 clipped = horizon & !at & steady & (across + profile < WEDGE_MEDIUM_LOBE)
        & (squared >= (smooth ? extent * WEDGE_CLIPPED_LIGHT * WEDGE_CLIPPED_LIGHT : INFINITY));
    const int16 fitted = (horizon & !clipped) | at;
    const int16 few =
        !(horizon | at) & (across < WEDGE_FEW_LOBE) & (squared >= extent * WEDGE_FAR_LIGHT * WEDGE_FAR_LIGHT);
    const int16 fine = !(horizon | at) & (across >= WEDGE_MEDIUM_LOBE);
    const int16 medium = !(horizon | at | fine)
        & ((across >= WEDGE_COARSE_LOBE) | (squared < extent * WEDGE_NEAR_LIGHT * WEDGE_NEAR_LIGHT));
    *sampled = (across > WEDGE_SHARP_LOBE) | (fitted & (across > WEDGE_SHARP_FITTED_LOBE));
    // The surface that the light is in does not light itself: isInLight().
    const int16 apart = fabs(dot16(toLight, splat3(light.normal))) >= light.lift;
    *sampled &= apart;
    const int16 ruled = wanted & apart & !*sampled;
    float16 mean = (float16)(0.0f);
    if (any(ruled & few)) {
        mean = meanOverNodes(light, r, nodes + WEDGE_FEW_OFFSET, WEDGE_FEW_NODES, lobes);
    }
    if (any(ruled & !few & !medium & !fine & !clipped & !fitted)) {
        const float16 coarse = meanOverNodes(light, r, nodes, WEDGE_COARSE_NODES, lobes);
        mean = few ? mean : coarse;
    }
    if (any(ruled & medium)) {
        const float16 other = meanOverNodes(light, r, nodes + WEDGE_MEDIUM_OFFSET, WEDGE_MEDIUM_NODES, lobes);
        mean = medium ? other : mean;
    }
    if (any(ruled & fine)) {
        const float16 other = meanOverNodes(light, r, nodes + WEDGE_FINE_OFFSET, WEDGE_FINE_NODES, lobes);
        mean = fine ? other : mean;
    }
    if (any(ruled & clipped)) {
        const float16 other = meanClipped(light, r, nodes + WEDGE_CLIPPED_OFFSET, lobes);
        mean = clipped ? other : mean;
    }
    if (any(ruled & fitted)) {
        const float16 other = meanFitted(light, r, nodes + WEDGE_FITTED_OFFSET, lobes);
        mean = fitted ? other : mean;
    }
    return ruled ? mean : (float16)(0.0f);
}

WEDGE_FN float16 unshadowedDiffuse(AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted)
{
    int16 none;
    return unshadowedMean(light, r, nodes, wanted, false, &none);
}

/// Sixteen receivers as arrays, for loops over lanes.
typedef struct {
    float positionX[WEDGE_BLOCK_PIXELS], positionY[WEDGE_BLOCK_PIXELS], positionZ[WEDGE_BLOCK_PIXELS];
    float normalX[WEDGE_BLOCK_PIXELS], normalY[WEDGE_BLOCK_PIXELS], normalZ[WEDGE_BLOCK_PIXELS];
    float viewX[WEDGE_BLOCK_PIXELS], viewY[WEDGE_BLOCK_PIXELS], viewZ[WEDGE_BLOCK_PIXELS];
    float exponent[WEDGE_BLOCK_PIXELS], normalization[WEDGE_BLOCK_PIXELS];
    uint kind[WEDGE_BLOCK_PIXELS];
} ReceiverLanes;

WEDGE_FN ReceiverLanes lanesOf(Receivers16 r)
{
    ReceiverLanes lanes;
    vstore16(r.position.x, 0, lanes.positionX);
    vstore16(r.position.y, 0, lanes.positionY);
    vstore16(r.position.z, 0, lanes.positionZ);
    vstore16(r.normal.x, 0, lanes.normalX);
    vstore16(r.normal.y, 0, lanes.normalY);
    vstore16(r.normal.z, 0, lanes.normalZ);
    vstore16(r.view.x, 0, lanes.viewX);
    vstore16(r.view.y, 0, lanes.viewY);
    vstore16(r.view.z, 0, lanes.viewZ);
    vstore16(r.exponent, 0, lanes.exponent);
    vstore16(normalization16(r), 0, lanes.normalization);
    const uint16 kind = r.phong ? (uint16)(WEDGE_PHONG) : (uint16)(WEDGE_BLINN_PHONG);
#ifdef WEDGE_GGX
    vstore16(r.microfacets ? r.rise : normalization16(r), 0, lanes.normalization);
    vstore16(r.microfacets ? (uint16)(WEDGE_MICROFACETS) : kind, 0, lanes.kind);
#else
    vstore16(kind, 0, lanes.kind);
#endif
    return lanes;
}

/// What one direction of a lane's lobe brings, for the numbers u.
WEDGE_INLINE float broughtByLobe(AreaLight light, const ReceiverLanes* r, uint lane, Vec2 u)
{
    const Vec3 p = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const Vec3 v = vec3(r->viewX[lane], r->viewY[lane], r->viewZ[lane]);
    Lobe lobe;
    lobe.exponent = r->exponent[lane];
    lobe.kind = r->kind[lane];
    lobe.normalization = r->normalization[lane];
    lobe.leastCosine = 0.0f;
    const Vec3 l = sampleLobe(lobe, n, v, u);
    const LightMeeting m = meetLight(light, p, l);
    const float cosine = vecDot(n, l);
    const float value = lobeOverPdf(lobe, n, v, l) * cosine * metProfile(light, m);
    return m.t < INFINITY && cosine > 0.0f ? value : 0.0f;
}

/// Which directions of their lobes receivers take: of a pixel's sequence `count` from `first` on.
typedef struct {
    uint16 pixel; ///< x in the lower 16 bits, y in the upper
    uint16 first;
    uint count;
    uint seed; ///< of the frame
} LobeDirections;

/// Roberts' additive sequence R2, in units of 2^-32.
#define WEDGE_R2_FIRST 3242174889u
#define WEDGE_R2_SECOND 2447445414u

/// The mean of lobe times geometry term by directions of the lobe: nothing is in the way, so that they need no rays.
/// Each pixel has a sequence of its own, which its receivers share out: however many see the same point, their mean
/// becomes the integral.
WEDGE_FN float16 unshadowedByLobe(AreaLight light, Receivers16 receivers, LobeDirections directions)
{
    const ReceiverLanes r = lanesOf(receivers);
    float sum[WEDGE_BLOCK_PIXELS];
    uint u[WEDGE_BLOCK_PIXELS], v[WEDGE_BLOCK_PIXELS], first[WEDGE_BLOCK_PIXELS];
    vstore16(directions.pixel, 0, u);
    vstore16(directions.first, 0, first);
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const uint shift = hashCombine(directions.seed, u[lane]);
        u[lane] = shift + first[lane] * WEDGE_R2_FIRST;
        v[lane] = hashUint(shift) + first[lane] * WEDGE_R2_SECOND;
        sum[lane] = 0.0f;
    }
    for (uint k = 0u; k < directions.count; ++k) {
        for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
            sum[lane] += broughtByLobe(light, &r, lane, vec2(toUnitFloat(u[lane]), toUnitFloat(v[lane])));
            u[lane] += WEDGE_R2_FIRST;
            v[lane] += WEDGE_R2_SECOND;
        }
    }
    return vload16(0, sum) / ((float)directions.count * light.profileArea);
}

/// Mean of lobe times geometry term over the light, 1/(sr m^2), of lanes `wanted`, 0 elsewhere. directions: of each
/// lobe that is too sharp for a rule.
WEDGE_FN float16 unshadowedSpecular(
    AreaLight light, Receivers16 r, __global const float* nodes, int16 wanted, LobeDirections directions)
{
    int16 sharp;
    float16 mean = unshadowedMean(light, r, nodes, wanted, true, &sharp) * normalization16(r);
    if (any(wanted & sharp)) {
        mean = (wanted & sharp) ? unshadowedByLobe(light, r, directions) : mean;
    }
    return wanted ? mean : (float16)(0.0f);
}

#endif
