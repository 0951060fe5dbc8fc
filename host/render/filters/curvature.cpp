#include "host/render/filters/curvature.h"

namespace wedge::render {

using graph::reads;
using graph::writes;

void curvatureWidths(FrameBuilder& frame, shared::CurvatureParams params, const graph::Handle<Extremes>& occluders,
    const graph::Handle<Count>& taken, AxisWidths& widths, graph::Handle<Metres>& beta)
{
    const Surfaces& s = frame.surfaces;
    const graph::Reach near = graph::around(1);
    params.height = frame.layout.height;
    params.stride = frame.layout.stride;
    params.planeSize = static_cast<std::uint32_t>(frame.layout.size);
    frame.blocks("widths", device::PassKind::Analysis, { "analysis/curvature.cl", "curvatureWidths" },
        { frame.rectangle(params), reads("occluders", occluders), reads("position", s.position, near),
            reads("normal", s.normal, near), reads("objectId", s.objectId, near), reads("pixelSize", s.pixelSize),
            reads("gloss", s.gloss), reads("taken", taken), writes("widthX", widths.x), writes("widthY", widths.y),
            writes("beta", beta) });
}

} // namespace wedge::render
