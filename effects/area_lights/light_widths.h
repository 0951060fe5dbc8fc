#pragma once

#include "host/render/frame_builder.h"
#include "kernels/shared/filter_params.h"

#include <functional>

namespace wedge::render {

/// Over which pixels slopes are taken together.
struct SlopeWindow {
    bool eroded = true; ///< the least one of 3 x 3 pixels first
    int radius = 1; ///< then means over 2 radius + 1 by as many
};

/// Declares how the widths of a light's filter, metres, follow from slopes of occluders by default: the least one,
/// eroded and smoothed as the window says, and spread (kernels/analysis/analysis.cl).
/// slopes: the least of each pixel, in the first plane; lit(): above 0 where the light is seen, in the first plane,
/// asked for when it is needed. ratio: if there is one, the largest slope, which is in the second plane then, smoothed
/// and spread as well, over the least (kernels/analysis/two_slopes.cl)
void smoothedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Share>* ratio = nullptr,
    SlopeWindow window = {});

/// The same as published, and counts from the spectrum. slopes: least and largest
void publishedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Count>& wanted);

} // namespace wedge::render
