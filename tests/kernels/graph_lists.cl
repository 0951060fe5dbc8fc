// Passes of the tests of host/graph that make lists of pixels, and work on them.
#include "core/lists.h"
#include "shared/frame.h"
#include "shared/pixel_grid.h"

#define BLOCKS_ACROSS ((from.width + WEDGE_BLOCK_PIXELS - 1u) / WEDGE_BLOCK_PIXELS)

static inline bool isBright(float value) { return value > 20.0f; }

// How many pixels of each block of a row are bright; blocks row by row.
#include "pass/countBright.h"
#ifdef PASS_countBright
__kernel void countBright(PARAMETERS)
{
    const uint block = (uint)get_global_id(0);
    if (block >= blocks) {
        return;
    }
    const uint y = block / BLOCKS_ACROSS, x = block % BLOCKS_ACROSS * WEDGE_BLOCK_PIXELS;
    uint sum = 0u;
    for (uint u = x; u < min(x + WEDGE_BLOCK_PIXELS, from.width); ++u) {
        sum += isBright(LOAD_in(from.size, pixelIndex(u, y, from.stride))) ? 1u : 0u;
    }
    counts[block] = sum;
}
#endif

// Where each is, and what it holds.
#include "pass/listBright.h"
#ifdef PASS_listBright
__kernel void listBright(PARAMETERS)
{
    const uint block = (uint)get_global_id(0);
    if (block >= blocks) {
        return;
    }
    const uint y = block / BLOCKS_ACROSS, x = block % BLOCKS_ACROSS * WEDGE_BLOCK_PIXELS;
    uint at = first[block];
    for (uint u = x; u < min(x + WEDGE_BLOCK_PIXELS, from.width); ++u) {
        const float value = LOAD_in(from.size, pixelIndex(u, y, from.stride));
        if (isBright(value)) {
            WEDGE_APPEND(bright, capacity, at, vec3((float)u, (float)y, value));
            ++at;
        }
    }
}
#endif

// Each element into its pixel, squared, and one more visit of it.
#include "pass/showBright.h"
#ifdef PASS_showBright
__kernel void showBright(PARAMETERS)
{
    WEDGE_ITEM(item);
    const Vec3 element = LOAD_bright(capacity, item);
    STORE_image(to.size, pixelIndex((uint)element.x, (uint)element.y, to.stride), element.z * element.z);
    visits[item] += 1u;
}
#endif

#include "pass/darkness.h"
#ifdef PASS_darkness
__kernel void darkness(PARAMETERS)
{
    WEDGE_PIXEL(to, x, y, i);
    STORE_out(to.size, i, 0.0f);
}
#endif
