// Lists whose length the device knows (host/graph/lists.h): the kernels that find where each block's elements begin, in
// whatever file includes this, and how elements are written.
#ifndef WEDGE_LISTS_H
#define WEDGE_LISTS_H

#include "core/formats.h"

/// Writes element `at` of the list NAME, which has room for `size`, if there is room for it.
#define WEDGE_APPEND(NAME, size, at, value)                                                                            \
    do {                                                                                                               \
        if ((at) < (size)) {                                                                                           \
            STORE_##NAME(size, at, value);                                                                             \
        }                                                                                                              \
    } while (0)

/// Elements of the blocks of each part, which has as many consecutive ones as others. What is beyond 32 bits counts as
/// the most that they hold.
///
/// in   counts: elements of each block
/// out  sums
#include "pass/sumParts.h"
#ifdef PASS_sumParts
__kernel void sumParts(PARAMETERS)
{
    const uint part = (uint)get_global_id(0), size = (blocks + parts - 1u) / parts;
    const uint begin = part * size, end = min(begin + size, blocks);
    if (begin >= end) {
        return;
    }
    uint sum = 0u;
    for (uint block = begin; block < end; ++block) {
        sum = add_sat(sum, counts[block]);
    }
    sums[part] = sum;
}
#endif

/// Where each block's elements begin: one block's after the other's.
/// in   counts; sums: of sumParts()
/// out  first: of each block, may be beyond what there is room for; listed: how many elements there are, and how many
///      had no room
#include "pass/placeBlocks.h"
#ifdef PASS_placeBlocks
__kernel void placeBlocks(PARAMETERS)
{
    const uint part = (uint)get_global_id(0), size = (blocks + parts - 1u) / parts;
    const uint begin = part * size, end = min(begin + size, blocks);
    if (begin >= end) {
        return;
    }
    uint at = 0u;
    for (uint other = 0u; other < part; ++other) {
        at = add_sat(at, sums[other]);
    }
    for (uint block = begin; block < end; ++block) {
        first[block] = at;
        at = add_sat(at, counts[block]);
    }
    if (end == blocks) {
        listed[0] = min(at, capacity);
        listed[1] = at - min(at, capacity);
    }
}
#endif

#endif
