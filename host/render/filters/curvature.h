#pragma once

#include "host/render/filters/filter_graph.h"
#include "kernels/shared/curvature.h"

namespace wedge::render {

/// Declares how widths along the image's axes, metres, follow from the surfaces' curvatures and the nearest occluders,
/// (6.13), (6.17), (6.20) (kernels/analysis/curvature.cl); beta becomes the mean of both. params: without rectangle and
/// layout. occluders: of each pixel the least r / cos theta of a hidden direction, metres, 0 where there is none.
void curvatureWidths(FrameBuilder& frame, shared::CurvatureParams params, const graph::Handle<Extremes>& occluders,
    const graph::Handle<Count>& taken, AxisWidths& widths, graph::Handle<Metres>& beta);

/// The same of less noise: distances are the least ones of the object's pixels around, of which the mean is taken over
/// those around.
graph::Handle<Extremes> smoothedOccluders(FrameBuilder& frame, const graph::Handle<Extremes>& occluders);

} // namespace wedge::render
