#include "host/render/pixel_term.h"

#include "host/render/filters/count_scale.h"
#include "host/render/sample_slices.h"
#include "host/render/sinks.h"

#include <algorithm>
#include <utility>

namespace wedge::render {

using graph::Run;
using graph::updates;

PixelTerm::PixelTerm(FrameBuilder& frame, Names names, Sum& sum, const Kept& kept)
    : f_(frame)
    , g_(frame.graph)
    , s_(frame.settings)
    , sum_(sum)
    , pixels_(frame)
    , beta_(g_.plane<Metres>("filter width", graph::floats))
    , sums_(g_.plane<Sums>("sums", graph::floatPlanes(kept.sums)))
    , value_(g_.plane<Value>("value", graph::floatPlanes(kept.values)))
    , parts_(g_.plane<Value>("value of part", kept.part))
    , extremes_(g_.plane<Extremes>("slopes or distances", graph::floatPlanes(kept.extremes)))
    , taken_(g_.plane<Count>("samples taken", graph::counts))
    , wanted_(g_.plane<Count>("samples wanted", graph::counts))
    , names_(std::move(names))
{
    f_.host("term", [state = state_](Run&) { *state = {}; });
}

void PixelTerm::declare()
{
    f_.zero(sums_, taken_, keepsParts() ? parts_ : value_);
    if (!f_.analysed()) {
        plain();
        return;
    }
    f_.zero(extremes_);
    start();
    uniformCounts(f_, firstSamples(), f_.surfaces.objectId, wanted_);
    sample(names_.first, true, 0, firstSamples());
    pixels_.countRays();
    f_.host("analysable", [state = state_](Run& run) { state->analysed = !run.cut(); });
    wanted_ = g_.plane<Count>("samples wanted", graph::counts); // no version of the first: that ends here
    g_.only("analysis of " + names_.stages, analysed(), [&] {
        widths();
        counts();
    });
    if (countsFrom() != CountsFrom::Nothing) {
        g_.only(
            "rest of " + names_.stages, analysed(), [&] { sample(names_.rest, false, firstSamples(), mostSamples()); });
        pixels_.countRays();
    }
    countSamples();
    means();
    if (s_.filtering == Filtering::None) {
        addPlain();
    } else {
        addFiltered();
    }
}

void PixelTerm::plain()
{
    const auto spp = static_cast<std::uint32_t>(s_.spp);
    uniformCounts(f_, spp, f_.surfaces.objectId, wanted_);
    sample(names_.plain, false, 0, spp);
    pixels_.countRays();
    countSamples();
    addPlain();
}

void PixelTerm::sample(const std::string& pass, bool first, std::uint32_t from, std::uint32_t most)
{
    const double mean = first ? most : s_.spp;
    const SampleSlices slices(from, most, sampler().slice, mean);
    g_.loop("slices", slices.counter(), [&] {
        Sampler sampler = this->sampler();
        std::vector<graph::Sink> becoming { sinks::sums(), keepsParts() ? sinks::parts() : sinks::means() };
        Arguments sunk { updates("sums", sums_), keepsParts() ? updates("parts", parts_) : updates("value", value_) };
        keepMore(becoming, sunk);
        if (first) {
            becoming.push_back(sampler.measures);
            sunk.push_back(updates(sampler.measured, extremes_));
        }
        sampler.kernel.sinks = std::move(becoming);
        f_.trace(pass, std::move(sampler.kernel),
            joined(sampler.arguments, sampleCounts(wanted_, slices.last(), taken_, sampler.rays), sunk), first,
            slices.workUnits(std::max(1.0, mean - from) * sampler.workUnits));
    });
}

void PixelTerm::counts()
{
    if (countsFrom() == CountsFrom::Mean) {
        uniformCounts(f_, static_cast<std::uint32_t>(s_.spp), mask(), wanted_);
    } else if (countsFrom() == CountsFrom::Variance) {
        const Uncertain of = uncertainty();
        auto demand = g_.plane<Demand>("demand", graph::floats);
        demandOf(f_, of.params, of.uncertainty, of.demanding, demand);
        countsFromDemands(f_, { { demand, 1.0f, static_cast<float>(of.params.leastCount), &wanted_ } },
            { static_cast<float>(s_.spp), static_cast<float>(of.params.countCap), mask() });
    }
}

void PixelTerm::countSamples()
{
    Totals& t = f_.totals;
    f_.count(taken_, false, t.tallies.samples, &t.samples);
    if (&sum_ == &t.indirect) {
        f_.count(taken_, false, t.tallies.indirectSamples);
    }
}

std::function<bool(const Run&)> PixelTerm::analysed() const
{
    return [state = state_](const Run&) { return state->analysed; };
}

} // namespace wedge::render
