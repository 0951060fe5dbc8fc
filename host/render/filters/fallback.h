#pragma once

#include "host/render/frame_builder.h"

#include <cstdint>

namespace wedge::render {

/// What falls back to pixels' own samples where filters are off by more than noise (kernels/analysis/fallback.cl). All
/// arguments are read, in planes of the frame.
struct FallsBack {
    std::uint32_t values; ///< numbers of what is filtered: 1 or 3
    bool others; ///< pixels do not count for themselves
    graph::Argument filtered, noisy, deviation;
    graph::Argument variance; ///< gathered as filtered was, or absent
    graph::Argument texture = graph::absent("texture", graph::vectors); ///< what is seen of both
    graph::Argument beta = graph::absent("beta"); ///< widths; below 0 nothing is filtered
};

/// How far it does: shares, a plane of pairs that is written or updated.
void ownShares(FrameBuilder& frame, const FallsBack& of, const graph::Argument& shares);

} // namespace wedge::render
