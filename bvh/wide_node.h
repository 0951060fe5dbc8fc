#pragma once

#include "bvh/box.h"
#include "kernels/shared/bvh_types.h"

namespace wedge::bvh::detail {

/// The box of a slot.
inline Box slotBox(const shared::BvhNode& node, unsigned slot)
{
    return { Float4 { node.loX[slot], node.loY[slot], node.loZ[slot], 0 },
        Float4 { node.hiX[slot], node.hiY[slot], node.hiZ[slot], 0 } };
}

inline void setBox(shared::BvhNode& node, unsigned slot, Float4 lo, Float4 hi)
{
    node.loX[slot] = lo[0];
    node.loY[slot] = lo[1];
    node.loZ[slot] = lo[2];
    node.hiX[slot] = hi[0];
    node.hiY[slot] = hi[1];
    node.hiZ[slot] = hi[2];
}

} // namespace wedge::bvh::detail
