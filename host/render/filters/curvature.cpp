#include "host/render/filters/curvature.h"

namespace wedge::render {

using graph::reads;
using graph::writes;

namespace {

shared::CurvatureParams placed(const FrameBuilder& frame, shared::CurvatureParams params)
{
    params.height = frame.layout.height;
    params.stride = frame.layout.stride;
    params.planeSize = static_cast<std::uint32_t>(frame.layout.size);
    return params;
}

} // namespace

void curvatureWidths(FrameBuilder& frame, shared::CurvatureParams params, const graph::Handle<Extremes>& occluders,
    const graph::Handle<Count>& taken, AxisWidths& widths, graph::Handle<Metres>& beta)
{
    const Surfaces& s = frame.surfaces;
    frame.blocks("widths", device::PassKind::Analysis, { "analysis/curvature.cl", "curvatureWidths" },
        joined({ frame.rectangle(placed(frame, params)), reads("occluders", occluders) }, places(s, graph::around(1)),
            Arguments { reads("pixelSize", s.pixelSize), reads("gloss", s.gloss), reads("taken", taken),
                writes("widthX", widths.x), writes("widthY", widths.y), writes("beta", beta) }));
}

graph::Handle<Extremes> smoothedOccluders(FrameBuilder& frame, const graph::Handle<Extremes>& occluders)
{
    const graph::Argument p = frame.rectangle(placed(frame, {}));
    const graph::Handle<ObjectId>& objects = frame.surfaces.objectId;
    const graph::Reach near = graph::around(WEDGE_OCCLUDER_REACH), far = graph::around(WEDGE_OCCLUDER_MEAN_REACH);
    auto nearest = frame.graph.plane<Extremes>("nearest occluders", graph::floats);
    auto mean = frame.graph.plane<Extremes>("mean occluders", graph::floats);
    frame.blocks("widths", device::PassKind::Analysis, { "analysis/curvature.cl", "nearestOccluders" },
        { p, reads("occluders", occluders, near), reads("objectId", objects, near), writes("nearest", nearest) });
    frame.blocks("widths", device::PassKind::Analysis, { "analysis/curvature.cl", "meanOccluders" },
        { p, reads("nearest", nearest, far), reads("objectId", objects, far), writes("mean", mean) });
    return mean;
}

} // namespace wedge::render
