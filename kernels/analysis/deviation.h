// The noise of a pixel's samples, of two parts of them.
#ifndef WEDGE_DEVIATION_H
#define WEDGE_DEVIATION_H

#include "core/vector16.h"
#include "shared/wedge.h"

/// A number whose square is, in the mean, the variance of a mean of so many samples: the difference between it and the
/// mean of the first of two parts (firstPart()), times sqrt(h / (n - h)) of the h of n samples that are in that part. 0
/// without a first pass.
WEDGE_FN float16 deviation16(float16 mean, float16 ofPart, uint16 taken, uint firstPass)
{
    if (firstPass == 0u) {
        return (float16)(0.0f);
    }
    const float16 n = convert_float16(taken);
    const float16 h = n >= (float)(2u * firstPass) ? floor(0.5f * n) : (float16)((float)(firstPass / 2u));
    return n > h ? (ofPart - mean) * sqrt(h / max16(n - h, (float16)(1.0f))) : (float16)(0.0f);
}

/// A term of pixels that are the receivers in one number. weights: what it is multiplied by in the image; seen, ofPart:
/// the products, of all samples and of the first of two parts of them
WEDGE_FN void storeOne(float16 weights, float16 seen, float16 ofPart, uint16 taken, uint firstPass, int i,
    __global float* value, __global float* deviation, __global float* weight)
{
    const int16 counts = weights > 0.0f;
    const float16 over = counts ? 1.0f / weights : (float16)(0.0f);
    const float16 mean = counts ? seen * over : (float16)(0.0f), part = counts ? ofPart * over : (float16)(0.0f);
    vstore16(mean, 0, value + i);
    vstore16(deviation16(mean, part, taken, firstPass), 0, deviation + i);
    vstore16(counts ? weights : (float16)(0.0f), 0, weight + i);
}

#endif
