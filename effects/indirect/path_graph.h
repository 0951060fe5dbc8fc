#pragma once

#include "effects/indirect/indirect.h"
#include "host/render/frame_builder.h"

#include <memory>

namespace wedge::render {

/// Declares one component of indirect light, or ambient occlusion, where the pixels are the receivers, thesis chapter
/// 4: distances of reflectors, widths and counts, paths, filter; adds it to totals.indirect. state, beta: as for
/// addAreaLight().
void addPaths(
    FrameBuilder& frame, Component component, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta);

} // namespace wedge::render
