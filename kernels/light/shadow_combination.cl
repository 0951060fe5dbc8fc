// What the sums of lights that stand for a map make of its whole light.
#include "core/pixel.h"
#include "light/unshadowed_environment.h"
#include "shared/filter_params.h"
#include "shared/shadow_lights.h"

/// Below it the share of what is hidden is not known of what lights bring: where there are none, nothing is.
#define WEDGE_LEAST_LIT 1e-30f

/// What sums of wider lobes count for beside those of own ones: they speak where own lobes meet hardly a light. Chosen
/// under two probes (docs/shadow-lights.md).
#define WEDGE_WIDE_SHARE 0.1f

/// A channel of the map's whole light with the shadows of the lights: less what they lose, or times the share that is
/// left of them; or what they bring alone. unlit: what counts of the whole light where no light is that hides.
WEDGE_INLINE float withShadows(uint shadows, float complete, float shadowed, float unshadowed, float wideShadowed,
    float wideUnshadowed, float unlit)
{
    const float all = unshadowed + WEDGE_WIDE_SHARE * wideUnshadowed;
    const bool reached = all > WEDGE_LEAST_LIT;
    const float known = reached ? complete : unlit * complete;
    const float share = reached ? (shadowed + WEDGE_WIDE_SHARE * wideShadowed) / all : 1.0f;
    const float less = known - (unshadowed - shadowed);
    const float kept = shadows == WEDGE_SHADOWS_SUBTRACTIVE ? less : known * share;
    return shadows == WEDGE_SHADOWS_ADDITIVE ? shadowed : kept;
}

/// The same of all channels. sums: six planes of own lobes, and behind them, if widened, six of wider ones.
WEDGE_FN Vec3 allWithShadows(
    uint shadows, Vec3 complete, __global const float* sums, uint size, uint i, bool widened, float unlit)
{
    const Vec3 shadowed = loadVec(sums, size, i), unshadowed = loadVec(sums + 3u * size, size, i);
    const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
    const Vec3 a = widened ? loadVec(sums + 6u * size, size, i) : none;
    const Vec3 u = widened ? loadVec(sums + 9u * size, size, i) : none;
    return vec3(withShadows(shadows, complete.x, shadowed.x, unshadowed.x, a.x, u.x, unlit),
        withShadows(shadows, complete.y, shadowed.y, unshadowed.y, a.y, u.y, unlit),
        withShadows(shadows, complete.z, shadowed.z, unshadowed.z, a.z, u.z, unlit));
}

/// v, none of whose channels is below 0 if they are to be clamped; `below` then says whether one was.
WEDGE_INLINE Vec3 clampedLight(Vec3 v, uint clamps, bool* below)
{
    const bool any = clamps != 0u && fmin(v.x, fmin(v.y, v.z)) < 0.0f;
    *below = *below || any;
    const Vec3 least = vec3(fmax(v.x, 0.0f), fmax(v.y, 0.0f), fmax(v.z, 0.0f));
    return vecChoose(any, least, v);
}

/// What surfaces reflect of the map's light.
///
/// in      shadows: WEDGE_SHADOWS_*; complete: WEDGE_COMPLETE_*, the map's whole light: of all lights, of
///         `whole` (3 planes, of lobes) and what harmonics say, or of `wholeMatt` (3 planes) and `whole`;
///         clamps: 1: it is not below 0; wide: 1: lobeSums have wider lobes; mostRed, mostGreen, mostBlue: what
///         unshadowedFrom() is a part of, W/m^2; the map, the G-buffer, sums
/// in out  lit (3 planes, radiance)
/// out     clamped: 1 in pixels where something was
#include "pass/combineShadowLights.h"
#ifdef PASS_combineShadowLights
__kernel void combineShadowLights(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    clamped[i] = 0u;
    if (taken[i] == 0u) {
        return;
    }
    const uint size = p.planeSize;
    const Vec3 n = loadVec(normal, size, i);
    bool below = false;
    Vec3 matt = loadVec(mattSums + 3u * size, size, i);
#if HAS_wholeMatt
    matt = vecChoose(complete == WEDGE_COMPLETE_MAP, loadVec(wholeMatt, size, i), matt);
#endif
    if (complete == WEDGE_COMPLETE_PREFILTERED) {
        const Vec3x16 light = unshadowedFrom(environment, environmentTable, splat3(n), 0.0f);
        const Vec3 most = vecScale(vec3(mostRed, mostGreen, mostBlue), WEDGE_INV_PI);
        matt = vecMul(most, vec3(light.x.s0, light.y.s0, light.z.s0));
    }
    // Harmonics bring light from where there is none.
    const float unlit = complete == WEDGE_COMPLETE_PREFILTERED ? 0.0f : 1.0f;
    matt = clampedLight(allWithShadows(shadows, matt, mattSums, size, i, false, unlit), clamps, &below);
    const Vec3 k = loadVec(diffuse, size, i);
    Vec3 sum = vecMul(matt, k);
    below = below && luminance(k) > 0.0f;
#ifdef WEDGE_SPECULAR
    const Vec3 reflectance = loadVec(specular, size, i);
    if (luminance(reflectance) > 0.0f) {
        Vec3 lobe = loadVec(lobeSums + 3u * size, size, i);
#if HAS_whole
        lobe = vecChoose(complete != WEDGE_COMPLETE_LIGHTS, loadVec(whole, size, i), lobe);
#endif
        lobe = clampedLight(allWithShadows(shadows, lobe, lobeSums, size, i, wide != 0u, 1.0f), clamps, &below);
        sum = vecAdd(sum, vecMul(lobe, reflectance));
    }
#else
    (void)specular;
    (void)wide;
#endif
    clamped[i] = below ? 1u : 0u;
    storeVec(lit, size, i, vecAdd(loadVec(lit, size, i), sum));
}
#endif
