#include "host/render/wave_term.h"

#include "host/render/filters/fallback.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

std::vector<graph::Argument> readsMotion(
    const FrameBuilder& frame, const graph::Handle<Pixels>& along, const graph::Handle<Pixels>& directions)
{
    const graph::Reach far = graph::around(WEDGE_MOTION_REACH);
    const bool lean = frame.lean;
    return graph::together("motion",
        { lean ? graph::absent("along") : reads("along", along, far),
            lean ? graph::absent("directions", shortPairs) : reads("directions", directions, far),
            lean ? reads("vectors", directions, far) : graph::absent("vectors", shortPairs) });
}

shared::DistributedParams WaveTerm::of(shared::DistributedParams params) const
{
    params.values = values_;
    params.rays = rays;
    return params;
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
            reads("taken", shape_.full && !adding.probes ? means.taken : counts.taken),
            reads("wanted", wantedOf(adding, counts)), value("sumPlanes", sums), value("extremePlanes", extremes),
            writes("first", out.first), writes("last", out.last), writes("sums", out.sums),
            writes("extremes", out.extremes) });
    return out;
}

std::vector<graph::Argument> WaveTerm::accumulated(const Adding& adding, const PrimaryCounts& counts)
{
    const auto kept = [](const char* name, graph::Version& plane, bool used, const graph::Format& format) {
        return used && plane.graph != 0 ? updates(name, plane) : graph::absent(name, format);
    };
    const auto measured = [&](const char* name, graph::Version& plane, const graph::Format& format) {
        return kept(name, plane, adding.measures, format);
    };
    TermMeans& m = means;
    Totals& t = f_.totals;
    const bool indirect = &sum_ == &t.indirect;
    return joined(
        graph::together("samples of the term",
            { reads("wanted", wantedOf(adding, counts)), kept("termTaken", m.taken, shape_.full, graph::counts),
                kept("samples", t.samples, shape_.layers, graph::counts),
                kept("indirectSamples", t.indirectSamples, shape_.layers && indirect, graph::counts) }),
        graph::group("term",
            { updates("texture", m.texture), updates("value", m.value),
                kept("radiance", m.radiance, true, graph::vectors), kept("deviation", m.deviation, true, graph::floats),
                measured("plain", m.plain, graph::floats), measured("squares", m.squares, graph::floats),
                measured("textureSquares", m.textureSquares, graph::floats), measured("error", m.error, shortFloats),
                measured("spreads", m.spreads, shortPairs) }),
        graph::together("extremes of the term",
            { measured("extremes", m.extremes, extremesFormat()), measured("extreme", m.extreme, shortFloats),
                measured("shadowSums", m.shadowSums, graph::floatPlanes(4)),
                measured("shadowMotion", m.shadowMotion, shortPairs) }));
}

graph::Version WaveTerm::wantedOf(const Adding& adding, const PrimaryCounts& counts) const
{
    return adding.probes ? counts.wanted : adding.first && shape_.lean() ? counts.taken : means.wanted;
}

graph::Handle<Extremes> WaveTerm::wholeExtremes() const
{
    if (!shape_.compact) {
        return means.extremes;
    }
    const bool one = oneExtreme();
    auto whole = f_.graph.plane<Extremes>("slopes or distances", one ? graph::floats : graph::vectors);
    f_.pixels("widths", PassKind::Analysis, { "waves/distributed.cl", one ? "unpackNumber" : "unpackImage" },
        { f_.rectangle(f_.analysisParams()), reads("in", one ? means.extreme : means.extremes), writes("out", whole) });
    return whole;
}

graph::Handle<Share> WaveTerm::weights(std::string_view pass, PassKind kind) const
{
    auto weights = f_.graph.plane<Share>("luminance of texture", graph::floats);
    f_.pixels(pass, kind, { "waves/distributed.cl", "luminanceOf" },
        { f_.rectangle(f_.analysisParams()), reads("image", means.texture), writes("out", weights) });
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

FilteredTerm WaveTerm::fallingBack(const shared::FilterParams* filter, const graph::Handle<Value>& filtered) const
{
    if (!usesFallback(settings()) || means.deviation.graph == 0) {
        return { filtered, {} };
    }
    const char* pass = "fallback";
    const bool gathered = filter != nullptr;
    graph::Handle<Value> variance;
    if (gathered) {
        auto squared = f_.graph.plane<Value>("variance of the term", graph::floats);
        f_.blocks(pass, PassKind::Filter, { "analysis/fallback.cl", "termVariance" },
            { f_.rectangle(f_.analysisParams()), reads("deviation", means.deviation), writes("variance", squared) });
        const FilterRun run { pass, PassKind::Filter };
        shared::FilterParams plain = *filter;
        plain.fitted = 0; // of variances the mean, which is not negative
        variance = gaussianFilter(f_, run, 1, plain, squared, means.beta).value;
    }
    auto shares = f_.graph.plane<Share>("share of own samples", shortPairs);
    ownShares(f_,
        { .values = values_,
            .others = true,
            .filtered = reads("filtered", filtered),
            .noisy = reads("noisy", means.value),
            .deviation = reads("deviation", means.deviation),
            .variance = gathered ? reads("variance", variance) : graph::absent("variance"),
            .texture = reads("texture", means.texture),
            .beta = reads("beta", means.beta) },
        writes("shares", shares));
    return { filtered, shares };
}

} // namespace wedge::render
