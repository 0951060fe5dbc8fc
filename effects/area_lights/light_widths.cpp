#include "effects/area_lights/light_widths.h"

namespace wedge::render {

using device::PassKind;
using graph::around;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

/// Weighted sums of `planes` planes over the neighbourhood that slopes spread to.
graph::Handle<Logarithms> spreadOver(FrameBuilder& frame, const shared::AnalysisParams& params, std::uint32_t planes,
    const graph::Handle<Logarithms>& from)
{
    const graph::Argument p = frame.rectangle(params);
    const int radius = static_cast<int>(params.fillRadius);
    auto rows = frame.graph.plane<Logarithms>("spread along rows", graph::floatPlanes(planes));
    auto spread = frame.graph.plane<Logarithms>("spread", graph::floatPlanes(planes));
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "spreadRows" },
        { p, value("planes", planes), reads("in", from, { .x = radius }), writes("out", rows) });
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "spreadColumns" },
        { p, value("planes", planes), reads("in", rows, { .y = radius }), writes("out", spread) });
    return spread;
}

} // namespace

void smoothedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Share>* ratio,
    SlopeWindow window)
{
    const graph::Argument p = frame.rectangle(params);
    const Surfaces& s = frame.surfaces;
    const std::uint32_t planes = ratio != nullptr ? 3 : 2;
    graph::Handle<Extremes> least = slopes;
    auto logs = frame.graph.plane<Logarithms>("logarithms", graph::floatPlanes(planes));
    if (window.eroded) {
        least = frame.graph.plane<Extremes>("eroded slopes", graph::floats);
        frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "erodeSlopes" },
            { p, reads("slopes", slopes, around(1)), reads("objectId", s.objectId, around(1)),
                writes("eroded", least) });
    }
    const graph::Argument radius = value("radius", window.radius);
    const graph::Reach near = around(window.radius);
    frame.zero(logs); // what spreads comes from the padding, too
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "smoothSlopes" },
        { p, radius, reads("eroded", least, near), reads("objectId", s.objectId, near), updates("logSlopes", logs) });
    if (ratio != nullptr) {
        frame.blocks("widths", PassKind::Analysis, { "analysis/two_slopes.cl", "smoothLargest" },
            { p, radius, reads("slopes", slopes, near), reads("objectId", s.objectId, near),
                updates("logSlopes", logs) });
    }
    const auto spread = spreadOver(frame, params, planes, logs);
    if (ratio != nullptr) {
        frame.blocks("widths", PassKind::Analysis, { "analysis/two_slopes.cl", "slopeRatios" },
            { p, reads("logSlopes", logs), reads("spread", spread), writes("ratio", *ratio) });
    }
    frame.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "widths" },
        { p, reads("logSlopes", logs), reads("spread", spread), reads("objectId", s.objectId),
            reads("pixelSize", s.pixelSize), reads("sums", lit()), writes("beta", beta) });
}

void publishedWidths(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Extremes>& slopes,
    const std::function<graph::Version()>& lit, graph::Handle<Metres>& beta, graph::Handle<Count>& wanted)
{
    const graph::Argument p = frame.rectangle(params);
    const Surfaces& s = frame.surfaces;
    auto distances = frame.graph.plane<Logarithms>("distances", graph::floatPlanes(4));
    frame.zero(distances); // what spreads comes from the padding, too
    frame.blocks("widths", PassKind::Analysis, { "analysis/analysis.cl", "publishedDistances" },
        { p, reads("slopes", slopes), reads("position", s.position), reads("objectId", s.objectId),
            updates("distances", distances) });
    const auto spread = spreadOver(frame, params, 4, distances);
    frame.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "publishedWidths" },
        { p, value("countMu", frame.settings.mu), reads("slopes", slopes), reads("distances", spread),
            reads("objectId", s.objectId), reads("pixelSize", s.pixelSize), reads("sums", lit()), writes("beta", beta),
            writes("wanted", wanted) });
}

} // namespace wedge::render
