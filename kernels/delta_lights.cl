// Point and directional lights: one shadow ray each, nothing to filter.
//
// in      frame, BVH, the lights, G-buffer
// in out  direct, directNoisy (3 planes each, radiance), rays
#include "light_sample.h"
#include "traverse.h"

/// A directional light's shadow rays end this many scene diameters away.
#define WEDGE_FAR_DIAMETERS 4.0f

__kernel void deltaLights(FrameParams frame, __global const DeltaLight* restrict lights, uint lightCount,
                          float sceneDiameter, __global const TraversalNode* restrict nodes,
                          __global const TriangleBlock* restrict blocks, __global const float* restrict position,
                          __global const float* restrict normal, __global const float* restrict origin,
                          __global const uint* restrict objectId, __global const float* restrict gloss,
                          __global const float* restrict diffuse, __global const float* restrict specular,
                          __global float* restrict direct, __global float* restrict directNoisy,
                          __global uint* restrict rays, uint firstGroup)
{
    uint x, y;
    if (!tilePixel(frame, firstGroup, &x, &y)) {
        return;
    }
    const uint i = pixelIndex(x, y, frame.stride);
    if (objectId[i] == 0u) {
        return;
    }
    const Receiver r = loadReceiver(frame, 0u, x, y, i, position, normal, origin, gloss);
    const Vec3 kd = loadVec(diffuse, frame.planeSize, i);
    const Vec3 ks = loadVec(specular, frame.planeSize, i);
    Vec3 radiance = vec3(0.0f, 0.0f, 0.0f);
    for (uint k = 0u; k < lightCount; ++k) {
        const DeltaLight light = lights[k];
        const Vec3 toLight = light.directional != 0u ? vecScale(light.vector, WEDGE_FAR_DIAMETERS * sceneDiameter)
                                                     : vecSub(light.vector, r.origin);
        const Vec3 l = vecNormalize(toLight);
        const float cosine = vecDot(r.normal, l);
        if (!(cosine > 0.0f)) {
            continue;
        }
        rays[i] += 1u;
        if (anyHit(nodes, blocks, r.origin, toLight, 0.0f, WEDGE_SHADOW_RAY_END)) {
            continue;
        }
        const float falloff = light.directional != 0u ? cosine : cosine / vecDot(toLight, toLight);
        const Vec3 reflected = vecMad(vecScale(kd, WEDGE_INV_PI), ks, lobeValue(r.lobe, r.normal, r.view, l));
        radiance = vecMad(radiance, vecMul(reflected, light.colour), falloff);
    }
    storeVec(direct, frame.planeSize, i, vecAdd(loadVec(direct, frame.planeSize, i), radiance));
    storeVec(directNoisy, frame.planeSize, i, vecAdd(loadVec(directNoisy, frame.planeSize, i), radiance));
}
