// Directions of an environment's map for given numbers, and what is seen in them.
#define WEDGE_ENVIRONMENT_MAP 1
#include "light/environment_map.h"

/// numbers: 2 each. out: direction, radiance and density of the sample, then radiance and density as seen in that
/// direction; 11 each.
__kernel void sampleDirections(
    WEDGE_BEYOND_PARAMETERS, __global const float* restrict numbers, uint count, __global float* restrict out)
{
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const BeyondData beyond = beyondData(environment, environmentTable, 1.0f);
    const BeyondSample chosen = sampleMap(beyond, vec2(numbers[2u * i], numbers[2u * i + 1u]));
    const BeyondSample seen = seenBeyond(beyond, chosen.direction);
    const float all[11] = { chosen.direction.x, chosen.direction.y, chosen.direction.z, chosen.radiance.x,
        chosen.radiance.y, chosen.radiance.z, chosen.pdf, seen.radiance.x, seen.radiance.y, seen.radiance.z, seen.pdf };
    for (uint k = 0u; k < 11u; ++k) {
        out[11u * i + k] = all[k];
    }
}
