// What the samples of an area light add up to, and are filtered as.
#ifndef WEDGE_LIGHT_VALUES_H
#define WEDGE_LIGHT_VALUES_H

#include "light/light_sample.h"

/// Numbers of a sample: in the diffuse term what it weighs, and what of that arrives; then the same in the specular
/// one.
#ifdef WEDGE_SPECULAR
#define WEDGE_SUMS 4u
#define WEDGE_VALUES 2u ///< that are filtered: one a term
#else
#define WEDGE_SUMS 2u
#define WEDGE_VALUES 1u
#endif

/// What the sums of n samples are filtered as: a mean visibility in each term, or what is reflected.
WEDGE_INLINE void storeTermValues(uint shading, uint size, uint i, const float* sums, uint n, __global float* value)
{
    const float diffuse = termValue(shading, sums[0], sums[1], n);
    value[i] = diffuse;
#ifdef WEDGE_SPECULAR
    // A lobe that no sample reached says nothing: what is seen of the light at all stands for what it sees. 0 would
    // darken its highlight, and those of neighbours that gather it.
    const bool reached = sums[2] > 0.0f || shading == WEDGE_SHADING_INSIDE;
    value[size + i] = reached ? termValue(shading, sums[2], sums[3], n) : diffuse;
#else
    (void)size;
#endif
}

#endif
