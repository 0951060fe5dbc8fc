// What a pixel's new receivers add to what it keeps of surfaces, group by group of planes (accumulate.cl). Those that
// hit nothing have no surface.
#ifndef WEDGE_SURFACE_SUMS_H
#define WEDGE_SURFACE_SUMS_H

#include "shared/camera.h"
#include "shared/defocus.h"
#include "waves/accumulate.h"

WEDGE_FN uint sumOfCounts(WavePixel p, __global const uint* counts)
{
    uint sum = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        sum += counts[r];
    }
    return sum;
}

/// Sums over surfaces.
WEDGE_FN float sumOfFloats(WavePixel p, __global const uint* objectId, __global const float* plane)
{
    float sum = 0.0f;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        sum += objectId[r] != 0u ? plane[r] : 0.0f;
    }
    return sum;
}

WEDGE_FN Vec3 sumOfVecs(WavePixel p, __global const uint* objectId, __global const float* planes, uint size)
{
    Vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    for (uint r = p.first; r < p.first + p.count; ++r) {
        if (objectId[r] != 0u) {
            sum = vecAdd(sum, loadVec(planes, size, r));
        }
    }
    return sum;
}

/// How many surfaces there are. object: whose they are, and those before; 0: there was none
WEDGE_FN uint surfacesOf(WavePixel p, __global const uint* objectId, uint* object)
{
    uint hit = 0u;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        if (objectId[r] != 0u) {
            *object = *object == 0u || *object == objectId[r] ? objectId[r] : WEDGE_MIXED;
            ++hit;
        }
    }
    return hit;
}

/// The mean exponent of those receivers that have a lobe, as of the first one's kind.
WEDGE_FN Gloss meanGloss(WavePixel p, __global const uint* objectId, __global const uint* gloss)
{
    uint kind = WEDGE_LAMBERT;
    float sum = 0.0f, count = 0.0f;
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const Gloss g = unpackGloss(gloss[r]);
        if (objectId[r] == 0u || g.kind == WEDGE_LAMBERT) {
            continue;
        }
        kind = count > 0.0f ? kind : g.kind;
        sum += exponentAs(g, kind);
        count += 1.0f;
    }
    return makeGloss(sum / fmax(count, 1.0f), kind);
}

/// Least and largest signed radius of the circles of confusion, pixels, misses' too. range: before
WEDGE_FN float2 confusionWith(float2 range, WavePixel p, CameraParams camera, __global const float* depth,
    __global const uint* objectId, __global const uint* gloss)
{
    for (uint r = p.first; r < p.first + p.count; ++r) {
        float radius = camera.apertureRadius > 0.0f
            ? circleOfConfusion(camera.apertureRadius, camera.focusDistance, depth[r], camera.pixelStep)
            : 0.0f;
#ifdef WEDGE_MIRRORS
        // What a mirror shows lies elsewhere, and may be in focus.
        radius = objectId[r] != 0u && WEDGE_IS_MIRROR(gloss[r]) ? 0.0f : radius;
#else
        (void)objectId;
        (void)gloss;
#endif
        range.x = fmin(range.x, radius);
        range.y = fmax(range.y, radius);
    }
    return range;
}

/// The largest difference of motions in the image from their mean; spread: before.
WEDGE_FN float spreadWith(float spread, WavePixel p, __global const uint* objectId, __global const float* motion,
    uint size, float meanX, float meanY)
{
    for (uint r = p.first; r < p.first + p.count; ++r) {
        const float dx = motion[r] - meanX, dy = motion[size + r] - meanY;
        spread = objectId[r] != 0u ? fmax(spread, sqrt(dx * dx + dy * dy)) : spread;
    }
    return spread;
}

#endif
