#pragma once

#include "effects/area_lights/soft_shadows.h"
#include "host/render/frame_builder.h"

#include <memory>

namespace wedge::render {

/// Declares direct light of an area light where the pixels are the receivers, thesis chapter 3: slopes of occluders,
/// widths and counts, samples, filter, shading; adds it to totals.direct.
/// state: filled in while the graph runs. beta: the filter's widths, metres, which are written where state says so.
void addAreaLight(
    FrameBuilder& frame, const TermLight& light, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta);

} // namespace wedge::render
