#pragma once

#include "host/render/frame_builder.h"

#include <cstdint>
#include <memory>

namespace wedge::render {

/// Declares direct light of an area light where the pixels are the receivers, thesis chapter 3: slopes of occluders,
/// widths and counts, samples, filter, shading; adds it to totals.direct.
/// state: filled in while the graph runs. beta: the filter's widths, metres, which are written where state says so.
void addAreaLight(
    FrameBuilder& frame, std::uint32_t index, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta);

} // namespace wedge::render
