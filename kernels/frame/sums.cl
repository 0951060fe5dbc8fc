// Light that is added as it is sampled, where the pixels are the receivers.
#include "core/pixel.h"
#include "shared/filter_params.h"
#include "shared/vec.h"
#include "shared/wedge.h"

/// Adds what surfaces reflect of it to both images of direct light (3 planes each).
#include "pass/addUnfiltered.h"
#ifdef PASS_addUnfiltered
__kernel void addUnfiltered(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 more = loadVec(radiance, n, i);
    storeVec(direct, n, i, vecAdd(loadVec(direct, n, i), more));
    storeVec(directNoisy, n, i, vecAdd(loadVec(directNoisy, n, i), more));
}
#endif
