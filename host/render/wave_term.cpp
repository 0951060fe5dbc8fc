#include "host/render/wave_term.h"

#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "kernels/shared/packed.h"

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

shared::DistributedParams WaveTerm::of(shared::DistributedParams params) const
{
    params.values = values_;
    params.rays = rays;
    return params;
}

std::uint32_t WaveTerm::omits() const
{
    return (extremePlanes() < 2 ? WEDGE_OMITS_EXTREMES : 0u)
        | (means.deviation.graph == 0 ? WEDGE_OMITS_DEVIATION : 0u);
}

WaveTerm::Shared WaveTerm::share(
    Waves& waves, const Adding& adding, const PrimaryCounts& counts, std::uint32_t sums, std::uint32_t extremes) const
{
    Shared out { waves.list<Count>("first samples", graph::counts), waves.list<Count>("last samples", graph::counts),
        waves.list<Sums>("sums", graph::floatPlanes(sums)),
        waves.list<Extremes>("slopes or distances", graph::floatPlanes(extremes)) };
    const Receivers& r = waves.receivers();
    waves.list("lists", { "waves/waves.cl", "shareSamples" }, 1,
        { waves.pixelParams(), waves.params(), reads("pixelOf", r.pixelOf), reads("shareOf", r.shareOf),
            reads("taken", shape_.full ? means.taken : counts.taken),
            reads("wanted", (adding.omits & WEDGE_OMITS_COUNTS) != 0 ? counts.taken : means.wanted),
            value("sumPlanes", sums), value("extremePlanes", extremes), writes("first", out.first),
            writes("last", out.last), writes("sums", out.sums), writes("extremes", out.extremes) });
    return out;
}

std::vector<graph::Argument> WaveTerm::accumulated(const Adding& adding, const PrimaryCounts& counts)
{
    const bool measures = (adding.omits & WEDGE_OMITS_ANALYSIS) == 0;
    const auto kept = [&](const char* name, graph::Version& plane, bool used, const graph::Format& format) {
        return used && plane.graph != 0 ? updates(name, plane) : f_.nowhere(name, format);
    };
    const graph::Format sums = f_.packed ? shortPairs : graph::floats;
    const bool counted = (adding.omits & WEDGE_OMITS_COUNTS) == 0;
    return { counted ? reads("termWanted", means.wanted) : f_.nothing("termWanted", graph::counts),
        shape_.full ? updates("termTaken", means.taken) : reads("termTaken", counts.taken),
        updates("texture", means.texture), updates("value", means.value), kept("plain", means.plain, measures, sums),
        kept("squares", means.squares, measures, sums),
        kept("textureSquares", means.textureSquares, measures, graph::floats),
        kept("termRadiance", means.radiance, true, graph::vectors),
        kept("deviation", means.deviation, true, f_.packed ? shortFloats : graph::floats),
        kept("extremes", means.extremes, measures, extremesFormat()) };
}

graph::Argument WaveTerm::samplesOf(std::string name, graph::Handle<Count>& total) const
{
    return shape_.layers ? updates(std::move(name), total) : f_.nowhere(std::move(name), graph::counts);
}

graph::Handle<Extremes> WaveTerm::leastExtreme() const
{
    if (!f_.packed) {
        return means.extremes;
    }
    auto extreme = f_.graph.plane<Extremes>("slopes or distances", graph::floats);
    f_.pixels("widths", PassKind::Analysis, { "analysis/analysis.cl", "unpackSecond" },
        { f_.rectangle(f_.analysisParams()), reads("packed", means.plain), writes("out", extreme) });
    return extreme;
}

graph::Handle<Share> WaveTerm::weights(std::string_view pass, PassKind kind) const
{
    auto weights = f_.graph.plane<Share>("luminance of texture", graph::floats);
    f_.pixels(pass, kind, { "analysis/analysis.cl", "luminanceOf" },
        { f_.rectangle(f_.analysisParams()), value("bits", shared::textureBits(f_.packed ? 1 : 0, isFraction())),
            reads("image", means.texture), writes("out", weights) });
    return weights;
}

graph::Handle<Value> WaveTerm::visibility(std::string_view pass, const shared::DistributedParams& params) const
{
    auto seen = f_.graph.plane<Value>("value in one number", graph::floats);
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "visibilityOf" },
        { f_.rectangle(of(params)), reads("texture", means.texture), reads("value", means.value),
            writes("visibility", seen) });
    return seen;
}

void WaveTerm::widen(
    std::string_view pass, const shared::DistributedParams& params, const shared::FilterParams& filter, float pixels)
{
    const graph::Handle<Value> seen = visibility(pass, params);
    const graph::Handle<Share> worth = weights(pass, PassKind::Filter);
    render::widen(f_, pass, filter, pixels, distributedNoise, { seen, means.deviation, worth }, means.beta);
}

void WaveTerm::fallBack(
    const shared::DistributedParams& params, const shared::FilterParams* filter, graph::Handle<Value>& filtered)
{
    if (!usesFallback(settings()) || means.deviation.graph == 0) {
        return;
    }
    const char* pass = "fallback";
    const graph::Argument p = f_.rectangle(f_.analysisParams());
    const bool gathered = filter != nullptr;
    const auto flag = value("gathered", gathered ? 1u : 0u);
    graph::Handle<Value> variance;
    if (gathered) {
        auto squared = f_.graph.plane<Value>("variance of the term", graph::floats);
        f_.blocks(pass, PassKind::Filter, { "analysis/fallback.cl", "termVariance" },
            { p, reads("deviation", means.deviation), writes("variance", squared) });
        const FilterRun run { pass, PassKind::Filter };
        shared::FilterParams plain = *filter;
        plain.fitted = 0; // of variances the mean, which is not negative
        variance = gaussianFilter(f_, run, 1, plain, squared, means.beta).value;
    }
    auto differences = f_.graph.plane<Share>("what filters are off", gathered ? shortQuadruples : shortTriples);
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "termDifferences" },
        { f_.rectangle(of(params)), flag, reads("texture", means.texture), reads("value", means.value),
            reads("filtered", filtered), reads("deviation", means.deviation),
            gathered ? reads("variance", variance) : f_.nothing("variance"), reads("beta", means.beta),
            writes("differences", differences) });
    const graph::Reach near = graph::around(WEDGE_SHRINK_REACH);
    auto shares = f_.graph.plane<Share>("share of own samples", shortPairs);
    f_.blocks(pass, PassKind::Filter, { "analysis/fallback.cl", "ownShares" },
        { p, flag, reads("differences", differences, near), reads("objectId", f_.surfaces.objectId, near),
            writes("shares", shares) });
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "fallBackTerm" },
        { f_.rectangle(of(params)), reads("texture", means.texture), reads("value", means.value),
            reads("shares", shares), updates("filtered", filtered) });
}

} // namespace wedge::render
