// Sums of parts of an image.
#include "core/pixel.h"
#include "shared/distributed.h"
#include "shared/filter_params.h"
#include "shared/vec.h"
#include "shared/wedge.h"

/// Adds what surfaces reflect of light that is added as it is sampled to both images of direct light (3 planes each).
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

/// The same of light that may change when the frame is run again: into planes of their own, so that it can be added
/// anew.
///
/// in      p, radiance, direct, directNoisy
/// in out  sum, sumNoisy: 0 before
#include "pass/addChanging.h"
#ifdef PASS_addChanging
__kernel void addChanging(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    const Vec3 more = loadVec(radiance, n, i);
    storeVec(sum, n, i, vecAdd(loadVec(direct, n, i), more));
    storeVec(sumNoisy, n, i, vecAdd(loadVec(directNoisy, n, i), more));
}
#endif

/// beauty = emission + direct + indirect (3 planes each).
#include "pass/addAll.h"
#ifdef PASS_addAll
__kernel void addAll(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint n = p.planeSize;
    storeVec(beauty, n, i, vecAdd(vecAdd(loadVec(emission, n, i), loadVec(direct, n, i)), loadVec(indirect, n, i)));
}
#endif
