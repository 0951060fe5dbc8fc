// Soft shadows in a style, by level sets of what is seen of the light: each level is a hard shadow with an edge and
// distances of its own (shadow_edges.cl, shadow_distance.cl). docs/stylized-shadows.md
#include "core/formats.h"
#include "core/pixel.h"
#include "light/unmapped_normals.h"
#include "shared/filter_params.h"
#include "shared/light.h"
#include "shared/styled_shadows.h"

/// Whether any of a light may be seen from a point of a surface: a corner lies above it, and the point is before the
/// light.
WEDGE_FN bool mayBeLit(AreaLight light, Vec3 at, Vec3 n)
{
    const Vec3 toCentre = vecSub(light.centre, at);
    const float up = fabs(vecDot(n, light.halfU)) + fabs(vecDot(n, light.halfV));
    return vecDot(n, toCentre) + up > 0.0f && (light.twoSided != 0u || vecDot(light.normal, toCentre) < 0.0f);
}

/// A shadow whose edge is where a level is seen of a light.
///
/// in   p, position, normal, objectId; light; value: what is seen of it, 0 to 1; level: likewise
/// out  matte: from WEDGE_MATTE_SHADOW to WEDGE_MATTE_LIT, in the middle of these at the level, and as steep as what is
///      seen; or WEDGE_MATTE_UNKNOWN
#include "pass/levelMatte.h"
#ifdef PASS_levelMatte
__kernel void levelMatte(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const bool known =
        objectId[i] != 0u && mayBeLit(light, loadVec(position, size, i), loadVec(WEDGE_UNMAPPED(size), size, i));
    const float above = clamp(value[i] - level + 0.5f, WEDGE_MATTE_SHADOW, WEDGE_MATTE_LIT);
    matte[i] = known ? above : WEDGE_MATTE_UNKNOWN;
}
#endif

/// The integral of a style's transfer function up to d metres from its edge: a step's, or a smoothstep's of that width.
WEDGE_FN float transferredUpTo(float d, float width)
{
    const float u = clamp(d / fmax(width, 1e-30f) + 0.5f, 0.0f, 1.0f);
    const float within = width * u * u * u * (1.0f - 0.5f * u);
    return fabs(d) < 0.5f * width ? within : fmax(d, 0.0f);
}

/// Its mean between two distances.
WEDGE_FN float transferredBetween(float a, float b, float width)
{
    const float d = 0.5f * (a + b), u = clamp(d / fmax(width, 1e-30f) + 0.5f, 0.0f, 1.0f);
    const float hard = d > 0.0f ? 1.0f : 0.0f, middle = width > 0.0f ? u * u * (3.0f - 2.0f * u) : hard;
    const bool apart = fabs(b - a) > 1e-3f * fmax(width, fmax(fabs(a), fabs(b)));
    const float mean = (transferredUpTo(b, width) - transferredUpTo(a, width)) / (apart ? b - a : 1.0f);
    return apart ? clamp(mean, 0.0f, 1.0f) : middle;
}

/// Distances at two levels, linear between them, and at the end of the light, `end` of their difference beyond the one:
/// shares of the light between both, and from one of them to the end.
typedef struct {
    float both, before, after;
} LevelShares;

/// What is seen of the light between these levels, of which the edge of each is at 0.
WEDGE_FN float seenBetween(float before, float now, LevelShares shares, float end, float width)
{
    const float step = end * (now - before);
    return shares.both * transferredBetween(before, now, width)
        + shares.before * transferredBetween(before - step, before, width)
        + shares.after * transferredBetween(now, now + step, width);
}

/// Adds what is seen of the light between one level and the one before, as it is and in a style.
///
/// in      p; distance, smoothed: metres, of this level, as they are and as the style goes by; zeros: and a number
///         more, where in the latter the edge is; previous, previousSmoothed, previousZeros: of the level before; where
///         there is but one level absent; inflation, softness: metres; both, beforeThem, afterThem, end: of
///         LevelShares; pairs: of levels that there are, 1 of a single one
/// in out  change: WEDGE_LEVEL_*
#include "pass/addLevel.h"
#ifdef PASS_addLevel
__kernel void addLevel(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const float now = LOAD_distance(size, i), styled = LOAD_smoothed(size, i) - LOAD_zeros(1u, 0u) - inflation;
    float before = now, styledBefore = styled;
#if HAS_previous
    before = LOAD_previous(size, i);
    styledBefore = LOAD_previousSmoothed(size, i) - LOAD_previousZeros(1u, 0u) - inflation;
#endif
    LevelShares shares;
    shares.both = both;
    shares.before = beforeThem;
    shares.after = afterThem;
    change[WEDGE_LEVEL_PLAIN * size + i] += seenBetween(before, now, shares, end, 0.0f);
    change[WEDGE_LEVEL_STYLED * size + i] += seenBetween(styledBefore, styled, shares, end, softness);
    const float moved = 0.5f * (fabs(styled - now) + fabs(styledBefore - before));
    change[WEDGE_LEVEL_MOVED * size + i] += moved / pairs;
    const float nearest = fmin(fabs(before), fabs(now)), known = change[WEDGE_LEVEL_NEAREST * size + i];
    change[WEDGE_LEVEL_NEAREST * size + i] = beforeThem > 0.0f ? nearest : fmin(known, nearest);
}
#endif

/// How much more is seen of a light in a style, of what levels say. They say it to a part of a level, and what is left,
/// seen - PLAIN, stays where it is as far as the style moves nothing. Where no edge of a level is near nothing changes.
///
/// pixel: metres; soft: half of the softness, metres; largest: metres, of distances
WEDGE_FN float styledChange(
    __global const float* change, uint size, uint i, float seen, float soft, float pixel, float largest)
{
    const float plain = change[WEDGE_LEVEL_PLAIN * size + i], styled = change[WEDGE_LEVEL_STYLED * size + i];
    const float moved = clamp((change[WEDGE_LEVEL_MOVED * size + i] + soft) / fmax(pixel, 1e-30f), 0.0f, 1.0f);
    const float near = clamp(2.0f - 2.0f * change[WEDGE_LEVEL_NEAREST * size + i] / largest, 0.0f, 1.0f);
    // What is seen may be a little more than all of the light, and stays so.
    const float all = seen + near * (styled - plain - moved * (seen - plain));
    return clamp(all, fmin(seen, 0.0f), fmax(seen, 1.0f)) - seen;
}

/// What a style makes of what is seen of a light, s = left + (1 - left) v', less what is seen, v.
///
/// in      p, position, normal, objectId; light; value: v, of matt surfaces and, where `channels` is 2, of lobes;
/// change: of addLevel(); absent:
///         none; pixelSize: metres; largest: metres, of distances; softness: metres; penumbra: 0 to 1, how wide it is
///         beside what it was; red, green, blue: left, in shadow; weight; receivers: 1 or 0 for each id below
///         `objects`, where there is not the style
/// in out  seen: R G B of weight (s - v), of each channel
#include "pass/softStyle.h"
#ifdef PASS_softStyle
__kernel void softStyle(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    // Normal maps may bring light to what faces away, and that is no shadow.
    bool styled = objectId[i] != 0u
        && mayBeLit(light, loadVec(position, p.planeSize, i), loadVec(WEDGE_UNMAPPED(p.planeSize), p.planeSize, i));
#if HAS_receivers
    styled = styled && objectId[i] < objects && receivers[objectId[i]] != 0u;
#endif
    if (!styled) {
        return;
    }
    const Vec3 left = vec3(red, green, blue), rest = vec3(1.0f - red, 1.0f - green, 1.0f - blue);
    for (uint channel = 0u; channel < channels; ++channel) {
        const float v = value[channel * p.planeSize + i];
        const float narrow = clamp((v - 0.5f) / fmax(penumbra, 1e-6f) + 0.5f, 0.0f, 1.0f);
        const float base = penumbra < 1.0f ? narrow : v;
#if HAS_change
        const float lit = base + styledChange(change, p.planeSize, i, base, 0.5f * softness, pixelSize[i], largest);
#else
        const float lit = base;
        (void)softness;
        (void)largest;
        (void)pixelSize;
#endif
        const Vec3 s = vecMad(left, rest, lit);
        const Vec3 more = vecScale(vec3(s.x - v, s.y - v, s.z - v), weight);
        __global float* of = seen + 3u * channel * p.planeSize;
        storeVec(of, p.planeSize, i, vecAdd(loadVec(of, p.planeSize, i), more));
    }
}
#endif
