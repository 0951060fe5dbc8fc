#include "host/render/filters/filter_graph.h"

#include "host/graph/execution.h"
#include "host/render/filters/widening.h"

#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::around;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

/// What the passes of kernels/filter/filter.cl are compiled with; more: besides.
device::Defines gatherDefines(const FrameBuilder& frame, std::uint32_t channels, device::Defines more = {})
{
    more.emplace_back("WEDGE_GATHER_CHANNELS", std::to_string(channels));
    if (frame.lean && channels == 3) {
        more.emplace_back("WEDGE_GATHER_VALUE_ONLY", ""); // of indirect light nobody reads the effective counts
    }
    return frame.surfaceFormats(std::move(more));
}

/// Both passes, into planes that are there. apart: pairs have the mean of both squared bandwidths.
void filterAlong(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels, const shared::FilterParams& params,
    const graph::Handle<Value>& value, const AxisWidths& widths, bool apart, Gathered& out)
{
    const int pixels = static_cast<int>(params.maxRadius);
    const graph::Reach along { .x = pixels }, across { .y = pixels };
    auto rows = frame.graph.plane<Value>("rows filtered", graph::floatPlanes(channels));
    auto rowCounts = frame.graph.plane<Count>("effective count of rows", graph::floats);
    const device::Defines defines = gatherDefines(
        frame, channels, apart ? device::Defines { { "WEDGE_GATHER_MEAN_SQUARE", "" } } : device::Defines {});
    frame.blocks(run.pass, run.kind, { "filter/filter.cl", "filterRows", {}, defines },
        joined({ frame.rectangle(params), reads("value", value, along), reads("beta", widths.x, along) },
            gathered(frame, along), Arguments { writes("filtered", rows), writes("effective", rowCounts) }));
    frame.blocks(run.pass, run.kind, { "filter/filter.cl", "filterColumns", {}, defines },
        joined({ frame.rectangle(params), reads("value", rows, across), reads("beta", widths.y, across) },
            gathered(frame, across),
            Arguments { reads("effectiveRows", rowCounts), writes("filtered", out.value),
                writes("effective", out.effective) }));
}

} // namespace

Arguments gathered(const FrameBuilder& frame, graph::Reach reach)
{
    const Surfaces& s = frame.surfaces;
    return graph::together("gathered",
        { reads("position", s.position, reach), reads("normal", s.normal, reach),
            reads("pixelSize", s.pixelSize, reach), reads("objectId", s.objectId, reach) });
}

Gathered filteredPlanes(FrameBuilder& frame, std::uint32_t channels)
{
    return { frame.graph.plane<Value>("filtered", graph::floatPlanes(channels)),
        frame.graph.plane<Count>("effective count", graph::floats) };
}

Gathered gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta)
{
    Gathered out = filteredPlanes(frame, channels);
    gaussianFilter(frame, run, channels, params, value, beta, out);
    return out;
}

Gathered gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const AxisWidths& widths)
{
    Gathered out = filteredPlanes(frame, channels);
    filterAlong(frame, run, channels, params, value, widths, true, out);
    return out;
}

void gaussianFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta,
    Gathered& out)
{
    filterAlong(frame, run, channels, params, value, { beta, beta }, false, out);
}

void shearedFilter(FrameBuilder& frame, const FilterRun& run, std::uint32_t channels,
    const shared::FilterParams& params, const graph::Handle<Value>& value, const graph::Handle<Metres>& beta,
    const Shearing& shearing, Gathered& out)
{
    const int pixels = static_cast<int>(params.maxRadius);
    const graph::Reach along { .x = pixels }, across { .y = pixels };
    auto rows = frame.graph.plane<Value>("rows filtered", graph::floatPlanes(channels));
    auto rowCounts = frame.graph.plane<Count>("effective count of rows", graph::floats);
    auto rowGradients = frame.graph.plane<Value>("gradients of rows", shearing.format);
    device::Defines defines = gatherDefines(frame, channels, { { "WEDGE_GATHER_SHEARED", "" } });
    if (shearing.curved) {
        defines.emplace_back("WEDGE_GATHER_CURVED", "");
    }
    frame.blocks(run.pass, run.kind, { "filter/filter.cl", "shearRows", {}, defines },
        joined({ frame.rectangle(params), reads("value", value, along), reads("beta", beta, along) },
            gathered(frame, along),
            Arguments { reads("gradients", shearing.gradients, along), reads("slopeWidth", shearing.slopeWidth),
                writes("filtered", rows), writes("effective", rowCounts), writes("gradientsOfRows", rowGradients) }));
    frame.blocks(run.pass, run.kind, { "filter/filter.cl", "shearColumns", {}, defines },
        joined({ frame.rectangle(params), reads("value", rows, across), reads("beta", beta, across) },
            gathered(frame, across),
            Arguments { reads("gradients", rowGradients, across), reads("slopeWidth", shearing.slopeWidth),
                reads("effectiveRows", rowCounts), writes("filtered", out.value),
                writes("effective", out.effective) }));
}

graph::Handle<Count> gatheredCounts(FrameBuilder& frame, std::string_view pass, device::PassKind kind,
    const shared::FilterParams& params, const graph::Handle<Metres>& beta)
{
    const int pixels = static_cast<int>(params.maxRadius);
    const graph::Reach across { .x = pixels, .y = pixels };
    auto effective = frame.graph.plane<Count>("effective count", graph::floats);
    frame.blocks(pass, kind, { "filter/filter_counts.cl", "gatherCounts", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(params), reads("beta", beta, across) }, gathered(frame, across),
            Arguments { writes("effective", effective) }));
    return effective;
}

void widen(FrameBuilder& frame, std::string_view pass, shared::FilterParams params, float pixels, float noise,
    Compared compared, graph::Handle<Metres>& beta)
{
    params.maxRadius = static_cast<std::uint32_t>(comparedReach(frame.settings, pixels));
    const int far = static_cast<int>(params.maxRadius);
    const graph::Reach along { .x = far }, across { .y = far }, near = around(WEDGE_SHRINK_REACH);
    const graph::Reach noisy { .x = 2 * WEDGE_BLOCK_PIXELS - 1, .y = 3 * WEDGE_SHRINK_REACH };
    const shared::AnalysisParams p = frame.analysisParams();
    const auto all = value("frame", frame.wholeFrame());
    graph::Graph& g = frame.graph;
    auto wider = g.plane<Metres>("width to compare with", graph::floats);
    auto narrowRows = g.plane<Value>("rows, narrow", graph::floats);
    auto wideRows = g.plane<Value>("rows, wide", graph::floats);
    // Of equal samples of narrow and of wide filters.
    auto difference = g.plane<Value>("difference", graph::floats);
    auto apart = g.plane<Share>("variance that is not shared", graph::floats);
    auto squares = g.plane<Value>("squares", graph::floats);
    auto variance = g.plane<Value>("variance", graph::floats);
    auto shares = g.plane<Share>("shares", graph::floats);
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "comparedWidths", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(p), all, value("pixels", pixels), reads("deviation", compared.deviation, noisy) },
            places(frame.surfaces), Arguments { reads("beta", beta), writes("compared", wider) }));
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "compareRows", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(params), reads("value", compared.value, along), reads("beta", beta, along),
                   reads("compared", wider, along) },
            gathered(frame, along),
            Arguments { writes("narrowRows", narrowRows), writes("wideRows", wideRows),
                writes("narrowCounts", difference), writes("wideCounts", apart) }));
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "compareColumns", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(params), reads("narrowRows", narrowRows, across), reads("wideRows", wideRows, across),
                   reads("beta", beta, across), reads("compared", wider, across) },
            gathered(frame, across), Arguments { updates("difference", difference), updates("apart", apart) }));
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "widenSquares", {}, frame.surfaceFormats() },
        { frame.rectangle(p), reads("difference", difference), reads("apart", apart),
            reads("deviation", compared.deviation), reads("weights", compared.weights), writes("squares", squares),
            writes("variance", variance) });
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "wideShares", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(p), all, value("pixels", pixels), value("noise", noise),
                   reads("difference", squares, near), reads("variance", variance, near) },
            places(frame.surfaces, near), Arguments { reads("beta", beta, near), writes("shares", shares) }));
    frame.blocks(pass, PassKind::Filter, { "analysis/widening.cl", "widen", {}, frame.surfaceFormats() },
        joined({ frame.rectangle(p), all, value("pixels", pixels), reads("shares", shares, near) },
            places(frame.surfaces, near), Arguments { updates("beta", beta) }));
}

void demandOf(FrameBuilder& frame, const shared::AnalysisParams& params, const graph::Handle<Uncertainty>& uncertainty,
    Demanding demanding, graph::Handle<Demand>& demand)
{
    const graph::Reach near = around(WEDGE_DEMAND_REACH);
    frame.blocks("counts", PassKind::Analysis, { "analysis/demand.cl", "demandOf" },
        { frame.rectangle(params), value("oneObject", demanding.oneObject ? 1u : 0u),
            value("ownToo", demanding.ownToo ? 1u : 0u), reads("uncertainty", uncertainty, near),
            reads("objectId", frame.surfaces.objectId, near), writes("demand", demand) });
}

} // namespace wedge::render
