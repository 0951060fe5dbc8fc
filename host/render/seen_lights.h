#pragma once

#include "host/render/waves.h"

#include <optional>

namespace wedge::render {

/// Declares a plane of what pixels see of the area lights where that is known without sampling, see
/// kernels/waves/seen_lights.cl: by cameras that stand still, through boxes or the pixels' centres. None where there is
/// nothing to know.
std::optional<graph::Handle<Radiance>> seenLights(FrameBuilder& frame, const shared::CameraParams& camera);

} // namespace wedge::render
