// Shadow rays to one area light: the first pass finds the nearest occluder along each ray and measures slopes, the
// second only asks whether there is one.
//
// in      frame, BVH, the light, G-buffer (position, normal, origin, objectId, gloss)
// in out  sums (planes: diffuse weights, diffuse weights of visible samples, and the same for specular),
//         taken (samples so far), rays (rays traced for the pixel, all lights)
// out     value (planes: diffuse, specular): what is filtered; slopes (planes: s_min, s_max; 0 where no ray was
//         occluded)
#include "light_sample.h"
#include "shared/wedge.h"
#include "traverse.h"

WEDGE_FN void storeTerm(SampleParams params, uint size, uint i, float4 sum, uint taken, __global float* sums,
                        __global uint* takenPlane, __global float* value)
{
    sums[i] = sum.x;
    sums[size + i] = sum.y;
    value[i] = termValue(params.shading, sum.x, sum.y, taken);
#ifdef WEDGE_SPECULAR
    sums[2u * size + i] = sum.z;
    sums[3u * size + i] = sum.w;
    // A lobe that no sample reached says nothing; 0 would darken the highlights of neighbours that gather it.
    const bool reached = sum.z > 0.0f || params.shading == WEDGE_SHADING_INSIDE;
    value[size + i] = reached ? termValue(params.shading, sum.z, sum.w, taken) : value[i];
#endif
    takenPlane[i] = taken;
}

__kernel void firstPass(FrameParams frame, SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
                        __global const TriangleBlock* restrict blocks, __global const float* restrict position,
                        __global const float* restrict normal, __global const float* restrict origin,
                        __global const uint* restrict objectId, __global const float* restrict gloss,
                        __global float* restrict sums, __global uint* restrict taken, __global float* restrict value,
                        __global float* restrict slopes, __global uint* restrict rays, uint firstGroup)
{
    uint x, y;
    if (!tilePixel(frame, firstGroup, &x, &y)) {
        return;
    }
    const uint i = pixelIndex(x, y, frame.stride);
    float4 sum = (float4)(0.0f);
    float sMin = WEDGE_SLOPE_MAX * 2.0f;
    float sMax = 0.0f;
    uint traced = 0u;
    if (objectId[i] != 0u) {
        const Receiver r = loadReceiver(frame, params.light, x, y, i, position, normal, origin, gloss);
        for (uint k = 0u; k < WEDGE_FIRST_PASS_RAYS; ++k) {
            const LightSample s = sampleLight(params, light, r, k, WEDGE_FIRST_PASS_RAYS);
            if (!(s.diffuse > 0.0f)) {
                continue;
            }
            sum.x += s.diffuse;
            sum.z += s.specular;
            ++traced;
            const Hit hit = closestHit(nodes, blocks, r.origin, s.ray, 0.0f, WEDGE_SHADOW_RAY_END);
            if (hit.triangle == WEDGE_NO_TRIANGLE) {
                sum.y += s.diffuse;
                sum.w += s.specular;
            } else {
                const float slope = slopeOfHit(hit.t);
                sMin = fmin(sMin, slope);
                sMax = fmax(sMax, slope);
            }
        }
    }
    storeTerm(params, frame.planeSize, i, sum, objectId[i] != 0u ? WEDGE_FIRST_PASS_RAYS : 0u, sums, taken, value);
    slopes[i] = sMax > 0.0f ? sMin : 0.0f;
    slopes[frame.planeSize + i] = sMax;
    rays[i] += traced;
}

__kernel void secondPass(FrameParams frame, SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
                         __global const TriangleBlock* restrict blocks, __global const float* restrict position,
                         __global const float* restrict normal, __global const float* restrict origin,
                         __global const uint* restrict objectId, __global const float* restrict gloss,
                         __global const uint* restrict wanted, uint lastSample, __global float* restrict sums,
                         __global uint* restrict taken, __global float* restrict value, __global uint* restrict rays,
                         uint firstGroup)
{
    uint x, y;
    if (!tilePixel(frame, firstGroup, &x, &y)) {
        return;
    }
    const uint i = pixelIndex(x, y, frame.stride);
    const uint size = frame.planeSize;
    const uint first = taken[i];
    const uint last = min(wanted[i], lastSample);
    if (objectId[i] == 0u || first >= last) {
        return;
    }
    const Receiver r = loadReceiver(frame, params.light, x, y, i, position, normal, origin, gloss);
    float4 sum = (float4)(sums[i], sums[size + i], 0.0f, 0.0f);
#ifdef WEDGE_SPECULAR
    sum.z = sums[2u * size + i];
    sum.w = sums[3u * size + i];
#endif
    uint traced = 0u;
    for (uint k = first; k < last; ++k) {
        const LightSample s = sampleLight(params, light, r, k, wanted[i]);
        if (!(s.diffuse > 0.0f)) {
            continue;
        }
        sum.x += s.diffuse;
        sum.z += s.specular;
        ++traced;
        if (!anyHit(nodes, blocks, r.origin, s.ray, 0.0f, WEDGE_SHADOW_RAY_END)) {
            sum.y += s.diffuse;
            sum.w += s.specular;
        }
    }
    storeTerm(params, size, i, sum, last, sums, taken, value);
    rays[i] += traced;
}
