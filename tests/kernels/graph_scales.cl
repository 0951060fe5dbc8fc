// Passes of the tests of host/graph over planes of several scales.
#include "core/formats.h"
#include "shared/frame.h"
#include "shared/pixel_grid.h"

// Numbers that no two pixels near each other share.
#include "pass/pattern.h"
#ifdef PASS_pattern
__kernel void pattern(PARAMETERS)
{
    WEDGE_PIXEL(to, x, y, i);
    STORE_out(to.size, i, (float)((x * 7u + y * 13u) % 32u) + 0.125f * (float)x);
}
#endif

// Mean of the pixels that a coarser one lies over.
#include "pass/coarser.h"
#ifdef PASS_coarser
__kernel void coarser(PARAMETERS)
{
    WEDGE_PIXEL(to, x, y, i);
    const uint side = to.scale / from.scale;
    const uint endX = min(side * (x + 1u), from.width), endY = min(side * (y + 1u), from.height);
    float sum = 0.0f;
    for (uint v = side * y; v < endY; ++v) {
        for (uint u = side * x; u < endX; ++u) {
            sum += LOAD_in(from.size, pixelIndex(u, v, from.stride));
        }
    }
    STORE_out(to.size, i, sum / (float)((endX - side * x) * (endY - side * y)));
}
#endif

// Mean of a pixel and its neighbours within `reach`, those that there are; a block of pixels an item.
#include "pass/blurred.h"
#ifdef PASS_blurred
__kernel void blurred(PARAMETERS)
{
    WEDGE_PIXEL(to, x, y, i);
    const uint y0 = (uint)max((int)y - (int)reach, 0), y1 = min(y + reach + 1u, to.height);
    for (uint k = 0u; k < WEDGE_BLOCK_PIXELS && x + k < to.x1; ++k) {
        const uint x0 = (uint)max((int)(x + k) - (int)reach, 0), x1 = min(x + k + reach + 1u, to.width);
        float sum = 0.0f;
        for (uint v = y0; v < y1; ++v) {
            for (uint u = x0; u < x1; ++u) {
                sum += LOAD_in(to.size, pixelIndex(u, v, to.stride));
            }
        }
        STORE_out(to.size, (uint)i + k, sum / (float)((x1 - x0) * (y1 - y0)));
    }
}
#endif

// Between the centres of a coarser plane's pixels.
#include "pass/finer.h"
#ifdef PASS_finer
__kernel void finer(PARAMETERS)
{
    WEDGE_PIXEL(to, x, y, i);
    const float side = (float)(from.scale / to.scale);
    const float u = clamp(((float)x + 0.5f) / side - 0.5f, 0.0f, (float)(from.width - 1u));
    const float v = clamp(((float)y + 0.5f) / side - 0.5f, 0.0f, (float)(from.height - 1u));
    const uint x0 = (uint)u, y0 = (uint)v;
    const uint x1 = min(x0 + 1u, from.width - 1u), y1 = min(y0 + 1u, from.height - 1u);
    const float s = u - (float)x0, t = v - (float)y0;
    const float upper = (1.0f - s) * LOAD_in(from.size, pixelIndex(x0, y0, from.stride))
        + s * LOAD_in(from.size, pixelIndex(x1, y0, from.stride));
    const float lower = (1.0f - s) * LOAD_in(from.size, pixelIndex(x0, y1, from.stride))
        + s * LOAD_in(from.size, pixelIndex(x1, y1, from.stride));
    STORE_out(to.size, i, (1.0f - t) * upper + t * lower);
}
#endif
