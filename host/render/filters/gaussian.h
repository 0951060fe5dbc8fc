#pragma once

#include "host/device/queue.h"
#include "host/render/frame.h"
#include "host/render/settings.h"
#include "kernels/shared/filter_params.h"
#include "kernels/shared/light.h"

#include <string>
#include <string_view>

namespace wedge::render {

/// The gather's parameters for the pixels of window, without a light: distances are plain ones.
shared::FilterParams filterParams(
    const Settings& settings, const shared::FrameParams& frame, const image::Window& window);

/// The same with distances in the plane parallel to the light.
shared::FilterParams filterParams(const Settings& settings, const shared::FrameParams& frame,
    const shared::AreaLight& light, const image::Window& window);

/// What one run of the filter is called in reports.
struct FilterRun {
    std::string_view pass;
    device::PassKind kind;
};

/// Of the irradiances of distributed frames as published: (5.31) measures distances in space, also those of lights, and
/// of both of a pair the narrower kernel counts.
shared::FilterParams publishedParams(
    const Settings& settings, const shared::FrameParams& frame, const image::Window& window);

} // namespace wedge::render
