#pragma once

#include "host/device/buffer.h"
#include "host/render/frame.h"
#include "host/render/passes.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"

namespace wedge::render {

/// The gather's parameters for the pixels of window.
shared::FilterParams filterParams(const Settings& settings, const shared::FrameParams& frame,
    const shared::AreaLight& light, const image::Window& window);

/// The separable world-space Gaussian of kernels/filter.cl from term.value into term.filtered (and the effective
/// counts into term.effective), over window; it reads up to settings.maxRadius pixels beyond. No state.
void gaussianFilter(Passes& passes, std::string_view pass, device::PassKind kind, const Settings& settings,
    const shared::FrameParams& frameParams, const shared::AreaLight& light, const image::Window& window,
    const Frame& frame, Term& term);

} // namespace wedge::render
