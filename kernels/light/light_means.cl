// What the sums of a light's samples are filtered as, where it is made when it is needed: by then parts and gradients
// of the samples have taken the memory that it would have kept since the first pass.
#include "light/light_values.h"
#include "shared/filter_params.h"

/// in   sums: of light_sampling.h; taken: samples
/// out  value: storeTermValues()
__kernel void lightMeans(AnalysisParams p, SampleParams sampling, __global const float* restrict sums,
    __global const uint* restrict taken, __global float* restrict value)
{
    const uint x = p.x0 + get_global_id(0);
    const uint y = p.y0 + get_global_id(1);
    if (x >= p.x1 || y >= p.y1) {
        return;
    }
    const uint i = pixelIndex(x, y, p.stride);
    float total[WEDGE_SUMS];
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        total[k] = sums[k * p.planeSize + i];
    }
    storeTermValues(sampling.shading, p.planeSize, i, total, taken[i], value);
}
