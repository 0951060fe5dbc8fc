// Pre-computed samples of the environment's map: in each cell of the square that sampleMap() spreads over the
// directions one at random, which all samples in that cell then share.
#include "light/environment_map.h"

#define WEDGE_ENVIRONMENT_SEED 0x656e7673u

/// One row of cells. Each seed makes other samples, of which any one is anywhere in its cell with the same probability:
/// so the mean over seeds is that of sampleMap(). rows: 0 in rehearsals
#include "pass/precomputeDirections.h"
#ifdef PASS_precomputeDirections
__kernel void precomputeDirections(PARAMETERS)
{
    const uint row = (uint)get_global_id(0);
    if (row >= rows) {
        return;
    }
    const BeyondData beyond = beyondData(environment, environmentTable, 1.0f);
    const uint own = hashCombine(seed, WEDGE_ENVIRONMENT_SEED);
    Strata cells;
    cells.columns = cells.rows = WEDGE_ENVIRONMENT_CELLS;
    for (uint column = 0u; column < WEDGE_ENVIRONMENT_CELLS; ++column) {
        const uint cell = row * WEDGE_ENVIRONMENT_CELLS + column;
        const BeyondSample s = sampleMap(beyond, stratumPoint(cells, cell, hashCombine(own, cell)));
        const float8 all = (float8)(s.direction.x, s.direction.y, s.direction.z, s.radiance.x, s.radiance.y,
            s.radiance.z, s.pdf, 0.0f);
        vstore8(all, cell, samples);
    }
}
#endif
