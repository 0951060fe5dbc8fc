#include "host/render/filters/fallback.h"

#include "kernels/shared/filter_params.h"

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::value;
using graph::writes;

void ownShares(FrameBuilder& frame, const FallsBack& of, const graph::Argument& shares)
{
    const graph::Argument p = frame.rectangle(frame.analysisParams());
    const bool gathered = of.variance.absent == nullptr;
    auto differences = frame.graph.plane<Share>("what filters are off", gathered ? shortQuadruples : shortTriples);
    frame.pixels("fallback", PassKind::Filter, { "analysis/fallback.cl", "fallbackDifferences" },
        { p, value("values", of.values), of.texture, of.filtered, of.noisy, of.deviation, of.variance, of.beta,
            writes("differences", differences) });
    const graph::Reach near = graph::around(WEDGE_SHRINK_REACH);
    frame.blocks("fallback", PassKind::Filter, { "analysis/fallback.cl", "ownShares" },
        { p, value("gathered", gathered ? 1u : 0u), value("others", of.others ? 1u : 0u),
            reads("differences", differences, near), reads("objectId", frame.surfaces.objectId, near), shares });
}

} // namespace wedge::render
