// What a frame counts.
#include "core/vector16.h"
#include "shared/filter_params.h"
#include "shared/frame.h"

/// Adds up a plane's numbers within the rectangle.
/// in      counts: a plane
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
            sum += counts[pixelIndex(x, y, p.stride)];
        }
    }
    tally[item] += sum;
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
