// What a frame counts.
#include "core/formats.h"
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/frame.h"

/// Adds up a plane's numbers within the rectangle, of pixels whose mask is not 0.
/// in      counts: a plane; mask
/// in out  tally: one sum of each work-item, which takes every so manieth row
#include "pass/addToTally.h"
#ifdef PASS_addToTally
__kernel void addToTally(PARAMETERS)
{
    const uint item = get_global_id(0);
    if (item >= WEDGE_TALLY_STRIPES) {
        return;
    }
    ulong sum = 0u;
    for (uint y = p.y0 + item; y < p.y1; y += WEDGE_TALLY_STRIPES) {
        for (uint x = p.x0; x < p.x1; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            sum += !HAS_mask || LOAD_mask(p.planeSize, i) != 0u ? counts[i] : 0u;
        }
    }
    tally[item] += sum;
}
#endif

/// The same of a list of so many numbers.
#include "pass/addListToTally.h"
#ifdef PASS_addListToTally
__kernel void addListToTally(PARAMETERS)
{
    const uint item = get_global_id(0);
    if (item >= WEDGE_TALLY_STRIPES) {
        return;
    }
    ulong sum = 0u;
    for (uint i = item; i < count; i += WEDGE_TALLY_STRIPES) {
        sum += list[i];
    }
    tally[item] += sum;
}
#endif

/// Pixels within the rectangle that show a surface, and those of them that reflect nothing specularly.
/// out  shaded, matte: as tally
#include "pass/countSurfaces.h"
#ifdef PASS_countSurfaces
__kernel void countSurfaces(PARAMETERS)
{
    const uint item = get_global_id(0);
    if (item >= WEDGE_TALLY_STRIPES) {
        return;
    }
    ulong shown = 0u, dull = 0u;
    for (uint y = p.y0 + item; y < p.y1; y += WEDGE_TALLY_STRIPES) {
        for (uint x = p.x0; x < p.x1; ++x) {
            const uint i = pixelIndex(x, y, p.stride);
            const Vec3 k = LOAD_specular(p.planeSize, i);
            const bool hit = objectId[i] != 0u;
            shown += hit ? 1u : 0u;
            dull += hit && !(k.x + k.y + k.z > 0.0f) ? 1u : 0u;
        }
    }
    shaded[item] = shown;
    matte[item] = dull;
}
#endif

/// sum = before + counts.
#include "pass/addCounts.h"
#ifdef PASS_addCounts
__kernel void addCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    vstore16(loadIdBlock(before, i) + loadIdBlock(counts, i), 0, sum + i);
}
#endif
