#include "host/render/sample_bins.h"

#include "host/render/sample_passes.h"
#include "host/render/wave_term.h"
#include "kernels/shared/sample_filter.h"

#include <stdexcept>
#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

SampleBins::SampleBins(
    FrameBuilder& frame, ChosenSampleFilter chosen, graph::Handle<Packed> bins, graph::Handle<Share> exposure)
    : frame_(frame)
    , chosen_(std::move(chosen))
    , bins_(bins)
    , exposure_(exposure)
{
    if (!chosen_.filter->kernelOfBins()) {
        throw std::logic_error("filter \"" + chosen_.filter->name() + "\" has no kernel over bins of samples");
    }
}

bool SampleBins::givesExposure()
{
    const float given = chosen_.filter->exposure(chosen_.values);
    if (given != 0.0f) {
        frame_.fill("exposure", exposure_, given);
    }
    return given != 0.0f;
}

void SampleBins::expose(const graph::Handle<Sums>& ofProbes, const graph::Handle<Count>& takenByProbes)
{
    exposureOfProbes(frame_, ofProbes, takenByProbes, exposure_);
}

Arguments SampleBins::sunk()
{
    return graph::together("samples by brightness",
        { updates("bins", bins_), reads("exposure", exposure_), updates("notFinite", frame_.totals.notFinite) });
}

Arguments SampleBins::notSunk()
{
    return graph::together("samples by brightness",
        { graph::absent("bins", sampleBins), graph::absent("exposure"), graph::absent("notFinite", graph::counts) });
}

TermMeans SampleBins::kept(const TermMeans& all, bool layers)
{
    graph::Graph& g = frame_.graph;
    const graph::Argument p = frame_.rectangle(frame_.analysisParams());
    const auto like = [&g]<class Quantity>(const char* name, const graph::Handle<Quantity>& of) {
        return of.graph != 0 ? g.plane<Quantity>(name, g.resources()[of.resource].format) : graph::Handle<Quantity> {};
    };
    density_ = {};
    if (layers && chosen_.filter->measuresDensity()) {
        density_ = g.plane<Share>("path density", graph::floats);
    }
    auto shares = g.plane<Packed>("shares of bins", binShares);
    frame_.pixels(samplePass, PassKind::Filter, *chosen_.filter->kernelOfBins(),
        joined({ p }, chosen_.filter->arguments(chosen_.values, frame_.analysed()),
            Arguments { reads("bins", bins_, graph::around(WEDGE_SAMPLE_REACH)), reads("exposure", exposure_),
                writes("shares", shares),
                density_.graph != 0 ? writes("density", density_) : graph::absent("density") }));

    TermMeans out = all;
    auto sums = g.plane<Sums>("mean of kept samples", graph::vectors);
    auto excess = g.plane<Radiance>("light of rejected samples", graph::vectors);
    auto taken = g.plane<Count>("pixels with samples", graph::counts);
    out.deviation = like("deviation of kept samples", all.deviation);
    out.spreads = like("spreads of kept samples", all.spreads);
    out.squares = like("squares of kept samples", all.squares);
    const auto from = [](const char* name, const auto& plane, const graph::Format& format) {
        return plane.graph != 0 ? reads(name, plane) : graph::absent(name, format);
    };
    const auto to = [](const char* name, auto& plane, const graph::Format& format) {
        return plane.graph != 0 ? writes(name, plane) : graph::absent(name, format);
    };
    frame_.pixels(samplePass, PassKind::Filter, { "filter/kept_bins.cl", "keepBins" },
        joined({ p, value("lossy", chosen_.filter->losesLight() ? 1u : 0u), reads("bins", bins_),
                   reads("shares", shares) },
            graph::together("term",
                { reads("value", all.value), reads("texture", all.texture),
                    from("deviation", all.deviation, graph::floats), from("spreads", all.spreads, shortPairs),
                    from("squares", all.squares, graph::floats),
                    from("textureSquares", all.textureSquares, graph::floats) }),
            graph::together("kept",
                { writes("sums", sums), writes("taken", taken), writes("excess", excess),
                    to("kept_deviation", out.deviation, graph::floats), to("kept_spreads", out.spreads, shortPairs),
                    to("kept_squares", out.squares, graph::floats) })));
    graph::Handle<Value> parts;
    spread(frame_, chosen_.filter->spread(chosen_.values), chosen_.filter->widest(chosen_.values),
        { excess, taken, sums, parts });
    out.value = like("value of kept samples", all.value);
    meansOfKept(frame_, sums, taken, out.value);
    if (layers) {
        rejected_ = excess;
    }
    return out;
}

} // namespace wedge::render
