#pragma once

#include "host/render/waves.h"

#include <optional>

namespace wedge::render {

/// Declares a plane of what pixels see of the area lights where that is known without sampling, see
/// kernels/waves/seen_lights.cl: of pinholes that stand still and the lights that they see. None where there is nothing
/// to know.
std::optional<graph::Handle<Radiance>> seenLights(FrameBuilder& frame, const shared::CameraParams& camera);

} // namespace wedge::render
