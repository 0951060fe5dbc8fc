// What layers show that no other pass asks for.
#include "core/formats.h"
#include "shared/filter_params.h"
#include "shared/wedge.h"

/// Widths of a term's filter in metres, and in pixels as they lie on the surface.
/// in   beta, -1 where there is no filter; pixelSize
/// out  widths: two planes
#include "pass/showWidths.h"
#ifdef PASS_showWidths
__kernel void showWidths(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const float width = fmax(beta[i], 0.0f), size = LOAD_pixelSize(p.planeSize, i);
    widths[i] = width;
    widths[p.planeSize + i] = size > 0.0f ? width / size : 0.0f;
}
#endif
