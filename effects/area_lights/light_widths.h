#pragma once

#include "host/render/frame_builder.h"
#include "kernels/shared/filter_params.h"

#include <functional>

namespace wedge::render {

/// Declares how the widths of a light's filter, metres, follow from slopes of occluders by default: the least one,
/// eroded, smoothed and spread (kernels/analysis/analysis.cl).
/// slopes: the least of each pixel, in the first plane; lit(): above 0 where the light is seen, in the first plane,
/// asked for when it is needed. ratio: if there is one, the largest slope, which is in the second plane then, smoothed
/// and spread as well, over the least (kernels/analysis/two_slopes.cl)
void smoothedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Share>* ratio = nullptr);

/// The same as published, and counts from the spectrum. slopes: least and largest
void publishedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Count>& wanted);

} // namespace wedge::render
