#pragma once

#include "bvh/box.h"
#include "kernels/shared/bvh_types.h"

namespace wedge::bvh::detail {

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
