// What the sums of a light's samples are filtered as, where it is made when it is needed: by then parts and gradients
// of the samples have taken the memory that it would have kept since the first pass.
#include "light/light_values.h"
#include "shared/filter_params.h"

/// in   sums: of light_sampling.h; taken: samples
/// out  value: storeTermValues()
#include "pass/lightMeans.h"
#ifdef PASS_lightMeans
__kernel void lightMeans(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    float total[WEDGE_SUMS];
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        total[k] = sums[k * p.planeSize + i];
    }
    storeTermValues(params.shading, p.planeSize, i, total, taken[i], value);
}
#endif
