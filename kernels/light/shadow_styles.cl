// Hard shadows in a style: what of a surface lies how far from their edges, how much of the light is left there, and
// what it brings. docs/stylized-shadows.md
#include "core/float_order.h"
#include "core/formats.h"
#include "light/delta_light.h"
#include "light/style_knob.h"
#include "shared/filter_params.h"
#include "shared/styled_shadows.h"

/// Classes of distances are those of the first bits of orderOf(); and within one of them those of the next bits.
#define WEDGE_AREA_SHIFT (32u - WEDGE_AREA_BITS)
#define WEDGE_AREA_REST (WEDGE_AREA_SHIFT - WEDGE_AREA_BITS)

/// How much of what is seen lies at each distance, and how much in shadow, m^2: of stripes of rows. In classes whose
/// width is a share of the distance, whatever the size of the scene is.
///
/// in   p, of all that is shown; distance: smoothed; matte, pixelSize; stripes; found: of keepArea(), the class that is
///      told apart; absent: all distances are
/// out  areas: WEDGE_AREA_NUMBERS a stripe
#include "pass/countAreas.h"
#ifdef PASS_countAreas
__kernel void countAreas(PARAMETERS)
{
    const uint stripe = (uint)get_global_id(0);
    if (stripe >= stripes) {
        return;
    }
    __global float* own = areas + WEDGE_AREA_NUMBERS * stripe;
    for (uint k = 0u; k < WEDGE_AREA_NUMBERS; ++k) {
        own[k] = 0.0f;
    }
    for (uint y = p.y0 + stripe; y < p.y1; y += stripes) {
        for (uint x = p.x0; x < p.x1; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            const float v = matte[i], area = pixelSize[i] * pixelSize[i];
            if (v >= 0.0f) {
                const uint order = orderOf(distance[i]);
#if HAS_found
                if ((int)(order >> WEDGE_AREA_SHIFT) == (int)found[0]) {
                    own[(order >> WEDGE_AREA_REST) % WEDGE_AREA_BINS] += area;
                }
#else
                own[order >> WEDGE_AREA_SHIFT] += area;
#endif
                own[!(v > 0.5f) ? WEDGE_AREA_BINS : WEDGE_AREA_BINS + 1u] += area;
            }
        }
    }
}
#endif

/// The areas of all stripes together.
///
/// in   areas, stripes: as of countAreas(); numbers: WEDGE_AREA_NUMBERS
/// out  sums: as many
#include "pass/sumAreas.h"
#ifdef PASS_sumAreas
__kernel void sumAreas(PARAMETERS)
{
    const uint k = (uint)get_global_id(0);
    if (k >= numbers) {
        return;
    }
    float sum = 0.0f;
    for (uint stripe = 0u; stripe < stripes; ++stripe) {
        sum += areas[WEDGE_AREA_NUMBERS * stripe + k];
    }
    sums[k] = sum;
}
#endif

/// The distance below which as much lies as was in shadow: first the class that it is in, then itself.
///
/// in   sums: of sumAreas(); found: what it found first; absent: nothing yet; items: 1
/// out  zeros: two numbers: the distance, metres, 0 where all or nothing is in shadow; first its class, -1 there; and
///      the area below the class, m^2
#include "pass/keepArea.h"
#ifdef PASS_keepArea
__kernel void keepArea(PARAMETERS)
{
    if (get_global_id(0) >= items) {
        return;
    }
    const float shadow = sums[WEDGE_AREA_BINS], light = sums[WEDGE_AREA_BINS + 1u];
    float below = 0.0f;
#if HAS_found
    below = found[1];
#endif
    // Sums round: where none reaches what is in shadow it is the last class that has anything.
    uint at = WEDGE_AREA_BINS;
    float start = below;
    for (uint k = 0u; k < WEDGE_AREA_BINS && light > 0.0f && below < shadow; ++k) {
        if (sums[k] > 0.0f) {
            at = k;
            start = below;
            below += sums[k];
        }
    }
    const bool some = at < WEDGE_AREA_BINS;
    zeros[1] = start;
#if HAS_found
    zeros[0] = 0.0f;
    if (some && found[0] >= 0.0f) {
        const float part = clamp((shadow - start) / sums[at], 0.0f, 1.0f);
        const uint width = 1u << WEDGE_AREA_REST, first = (uint)found[0] << WEDGE_AREA_SHIFT;
        zeros[0] = valueAt(first + at * width + (uint)(part * (float)(width - 1u)));
    }
#else
    zeros[0] = some ? (float)at : -1.0f;
#endif
}
#endif

/// Adds a style's share of light.
///
/// in      p; distance: metres, or the matte; offset: what of it is the edge; zeros: and a number more, where there is
///         one; away: metres to what hides the light, where knobs go by that; inflation, softness: metres; red, green,
///         blue: what is left in shadow; weight; others: the matte of what is none of the style's casters;
///         matte, objectId, receivers: 1 or 0 for each id below `objects`, where there is not the style's but the
///         plain shadow
/// in out  share: R G B, of the light
#include "pass/addStyle.h"
#ifdef PASS_addStyle
__kernel void addStyle(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float d = LOAD_distance(p.planeSize, i) - offset - LOAD_zeros(1u, 0u);
    const float from = LOAD_away(p.planeSize, i), edge = knobAt(inflation, from), width = knobAt(softness, from);
    // smoothstep() is undefined without a width.
    const float t = clamp((d - edge) / fmax(width, 1e-30f) + 0.5f, 0.0f, 1.0f);
    const float soft = t * t * (3.0f - 2.0f * t), hard = d > edge ? 1.0f : 0.0f;
    const float f = width > 0.0f ? soft : hard;
    const Vec3 left = vec3(knobAt(red, from), knobAt(green, from), knobAt(blue, from));
    const Vec3 rest = vec3(1.0f - left.x, 1.0f - left.y, 1.0f - left.z);
    Vec3 light = vecMad(left, rest, f);
#if HAS_receivers
    const uint object = objectId[i];
    if (object >= objects || receivers[object] == 0u) {
        const float plain = LOAD_matte(p.planeSize, i) > 0.5f ? 1.0f : 0.0f;
        light = vec3(plain, plain, plain);
    }
#endif
#if HAS_others
    light = vecScale(light, LOAD_others(p.planeSize, i) > 0.5f ? 1.0f : 0.0f);
#endif
    STORE_share(p.planeSize, i, vecMad(LOAD_share(p.planeSize, i), light, weight));
}
#endif

/// What is left of a light by two shadows.
///
/// in      p; other: R G B, of the light
/// in out  share: likewise
#include "pass/timesShare.h"
#ifdef PASS_timesShare
__kernel void timesShare(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    STORE_share(p.planeSize, i, vecMul(LOAD_share(p.planeSize, i), LOAD_other(p.planeSize, i)));
}
#endif

/// The light of a light whose shadows have a style.
///
/// in      frame, receivers, diffuse, specular; lights, of which lightIndex is the one; matte; share: R G B, of it
/// in out  lit (3 planes, radiance)
#include "pass/styledLight.h"
#ifdef PASS_styledLight
__kernel void styledLight(PARAMETERS)
{
    WEDGE_PIXEL(frame, x, y, i);
    if (objectId[i] == 0u || LOAD_matte(frame.planeSize, i) < 0.0f) { // faces away, or was not come to
        return;
    }
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    const Receiver r = loadReceiver(frame, data, i);
    const DeltaLight light = lights[lightIndex];
    const Vec3 toLight = vectorToLight(light, sceneDiameter, r.origin);
    const float cosine = vecDot(r.normal, vecNormalize(toLight));
    if (!(cosine > 0.0f)) {
        return;
    }
    const Vec3 all = deltaLightAt(
        light, r, toLight, cosine, loadVec(diffuse, frame.planeSize, i), loadVec(specular, frame.planeSize, i));
    const Vec3 left = vecMul(all, LOAD_share(frame.planeSize, i));
    storeVec(lit, frame.planeSize, i, vecAdd(loadVec(lit, frame.planeSize, i), left));
}
#endif
