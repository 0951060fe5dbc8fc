#pragma once

#include "bvh/box.h"
#include "kernels/shared/bvh_types.h"

#include <cmath>
#include <limits>

namespace wedge::bvh::detail {

/// A box that moves: at the shutter's opening and at its closing. Between the two its planes move evenly.
struct MovingBox {
    Box open, close;

    static MovingBox empty() { return { Box::empty(), Box::empty() }; }

    void grow(const MovingBox& other)
    {
        open.grow(other.open);
        close.grow(other.close);
    }

    /// Half the surface at a time.
    double halfAreaAt(float time) const
    {
        const Float4 s = { 1 - time, 1 - time, 1 - time, 0 }, t = { time, time, time, 0 };
        return Box { open.lo * s + close.lo * t, open.hi * s + close.hi * t }.halfArea();
    }

    /// Its mean over all times: a polynomial of the second degree, of which Simpson's rule is exact.
    double halfArea() const { return (open.halfArea() + 4 * halfAreaAt(0.5f) + close.halfArea()) / 6; }
};

/// From a plane at the opening to itself at the closing, the float next to it that is no more (direction -infinity) or
/// no less (infinity), so that planes never move into their box.
inline float displacement(float open, float close, float direction)
{
    const float d = close - open;
    const double exact = double { close } - double { open };
    return (direction < 0 ? d > exact : d < exact) ? std::nextafter(d, direction) : d;
}

/// Where it then arrives, rounded in the same way.
inline float displaced(float open, float move, float direction)
{
    const float p = open + move;
    const double exact = double { open } + double { move };
    return (direction < 0 ? p > exact : p < exact) ? std::nextafter(p, direction) : p;
}

/// Writes a box to a slot of a MovingNode or MovingNode4.
template <typename Node>
void setBox(Node& node, unsigned slot, const MovingBox& box)
{
    constexpr float inf = std::numeric_limits<float>::infinity();
    const Float4 lo = box.open.lo, hi = box.open.hi;
    node.loX[slot] = lo[0];
    node.loY[slot] = lo[1];
    node.loZ[slot] = lo[2];
    node.hiX[slot] = hi[0];
    node.hiY[slot] = hi[1];
    node.hiZ[slot] = hi[2];
    node.moveLoX[slot] = displacement(lo[0], box.close.lo[0], -inf);
    node.moveLoY[slot] = displacement(lo[1], box.close.lo[1], -inf);
    node.moveLoZ[slot] = displacement(lo[2], box.close.lo[2], -inf);
    node.moveHiX[slot] = displacement(hi[0], box.close.hi[0], inf);
    node.moveHiY[slot] = displacement(hi[1], box.close.hi[1], inf);
    node.moveHiZ[slot] = displacement(hi[2], box.close.hi[2], inf);
}

/// The box of a slot.
inline MovingBox slotBox(const shared::MovingNode& node, unsigned slot)
{
    constexpr float inf = std::numeric_limits<float>::infinity();
    const Float4 lo = { node.loX[slot], node.loY[slot], node.loZ[slot], 0 };
    const Float4 hi = { node.hiX[slot], node.hiY[slot], node.hiZ[slot], 0 };
    const Float4 closeLo = { displaced(lo[0], node.moveLoX[slot], -inf), displaced(lo[1], node.moveLoY[slot], -inf),
        displaced(lo[2], node.moveLoZ[slot], -inf), 0 };
    const Float4 closeHi = { displaced(hi[0], node.moveHiX[slot], inf), displaced(hi[1], node.moveHiY[slot], inf),
        displaced(hi[2], node.moveHiZ[slot], inf), 0 };
    return { { lo, hi }, { closeLo, closeHi } };
}

} // namespace wedge::bvh::detail
