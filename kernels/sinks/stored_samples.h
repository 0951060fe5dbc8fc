// How stored samples lie in memory. Pixels have slots in the order of the planes' elements, as many as there is memory
// for, and then the first again: so a band of rows that moves down an image always has room for its next rows.
#ifndef WEDGE_STORED_SAMPLES_H
#define WEDGE_STORED_SAMPLES_H

#include "core/finite.h"
#include "shared/sample_filter.h"
#include "shared/vec.h"

/// Radiance: of each slot all samples' red, then green, then blue. Colours: likewise L*, a*, b* in pixels
/// (WEDGE_LAB_PIXEL), or red, green, blue (WEDGE_RGB_PIXELS), in 16 bits (packShort()). Ranges: least and largest of
/// their first number, of each slot. Drawn: of pixels, samples.
typedef struct {
    __global const float* radiance;
    __global const ushort* colours;
    __global const float* ranges;
    __global const uint* drawn;
    uint slots, perPixel;
} StoredSamples;

/// Where a pixel's first sample lies.
WEDGE_FN size_t firstStored(uint pixel, uint slots, uint perPixel) { return (size_t)(pixel % slots) * 3u * perPixel; }

WEDGE_FN Vec3 storedRadiance(const StoredSamples* s, uint pixel, uint index)
{
    __global const float* first = s->radiance + firstStored(pixel, s->slots, s->perPixel) + index;
    return vec3(first[0], first[s->perPixel], first[2u * s->perPixel]);
}

#endif
