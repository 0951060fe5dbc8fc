#include "host/render/pixel_term.h"

#include "host/render/filters/count_scale.h"
#include "host/render/sample_passes.h"
#include "host/render/sample_slices.h"
#include "host/render/sinks.h"
#include "kernels/shared/sample_filter.h"

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
    if (sampleFilter().filter != nullptr) {
        filterSamples();
    } else {
        sampleInPasses();
    }
    countSamples();
    means();
    s_.filtering == Filtering::None ? addPlain() : addFiltered();
}

void PixelTerm::sampleInPasses()
{
    uniformCounts(f_, firstSamples(), f_.surfaces.objectId, wanted_);
    sample(firstPass());
    pixels_.countRays();
    analysable();
    wanted_ = g_.plane<Count>("samples wanted", graph::counts); // no version of the first: that ends here
    g_.only("analysis of " + names_.stages, analysed(), [&] {
        widths();
        counts();
    });
    if (countsFrom() != CountsFrom::Nothing) {
        g_.only("rest of " + names_.stages, analysed(), [&] { sample(secondPass()); });
        pixels_.countRays();
    }
}

PixelTerm::Draw PixelTerm::firstPass() const
{
    return { .pass = names_.first,
        .from = 0,
        .most = firstSamples(),
        .mean = static_cast<double>(firstSamples()),
        .measures = true,
        .everywhere = true };
}

PixelTerm::Draw PixelTerm::secondPass() const
{
    return { .pass = names_.rest, .from = firstSamples(), .most = mostSamples(), .mean = static_cast<double>(s_.spp) };
}

void PixelTerm::analysable()
{
    f_.host("analysable", [state = state_](Run& run) { state->analysed = !run.cut(); });
}

void PixelTerm::plain()
{
    if (sampleFilter().filter != nullptr) {
        filterSamples();
    } else {
        const auto spp = static_cast<std::uint32_t>(s_.spp);
        uniformCounts(f_, spp, f_.surfaces.objectId, wanted_);
        sample({ .pass = names_.plain, .from = 0, .most = spp, .mean = static_cast<double>(spp) });
        pixels_.countRays();
    }
    countSamples();
    addPlain();
}

ChosenSampleFilter PixelTerm::sampleFilter() const { return sampleFilterOf(s_, target()); }

void PixelTerm::filterSamples()
{
    const std::uint32_t first = f_.analysed() ? firstSamples() : 0;
    const bool asks = f_.analysed() && countsFrom() == CountsFrom::Variance;
    const std::uint32_t alike =
        asks || (f_.analysed() && countsFrom() == CountsFrom::Nothing) ? first : static_cast<std::uint32_t>(s_.spp);
    StoredSamples stored(f_, sampleFilter(), alike, first);
    stored.sums = sums_;
    stored.taken = taken_;
    stored.parts = keepsParts() ? parts_ : stored.parts;
    if (f_.layers != nullptr && stored.measuresDensity()) {
        stored.density = g_.plane<Share>("path density", graph::floats);
        f_.zero(stored.density);
    }
    if (stored.probed()) {
        exposeSamples(stored);
    }
    uniformCounts(f_, alike, f_.surfaces.objectId, wanted_);
    sampleBands(stored, alike, f_.analysed());
    sums_ = stored.sums;
    taken_ = stored.taken;
    if (f_.analysed()) {
        analysable();
        wanted_ = g_.plane<Count>("samples wanted", graph::counts);
        g_.only("analysis of " + names_.stages, analysed(), [&] {
            widths();
            if (asks) {
                counts();
            }
        });
    }
    if (asks) {
        // All of a pixel's samples are compared with each other: so the first are taken once more.
        g_.only("rest of " + names_.stages, analysed(), [&] {
            StoredSamples all = stored.ofMore(mostSamples());
            sampleBands(all, mostSamples(), false);
            stored.takeKept(all);
        });
    }
    pixels_.countRays();
    f_.count(stored.notFinite, false, f_.totals.tallies.notFinite);
    stored.spread();
    sums_ = stored.sums;
    taken_ = stored.taken;
    if (keepsParts()) {
        parts_ = stored.parts;
    } else {
        stored.means(value_);
    }
    if (f_.layers != nullptr) {
        rejected_ = stored.excess;
        density_ = stored.density;
    }
}

void PixelTerm::sampleBands(StoredSamples& stored, std::uint32_t most, bool measures)
{
    const std::uint32_t first = measures ? firstSamples() : 0;
    pixels_.limit(stored.rows());
    stored.eachBand([&] {
        const auto draw = [&](const std::string& pass, std::uint32_t from, std::uint32_t to, bool measured) {
            Arguments sunk = stored.sunk();
            std::vector<graph::Sink> becoming { stored.sink() };
            if (measured) {
                const Sampler of = sampler();
                becoming.push_back(of.measures);
                sunk.push_back(updates(of.measured, extremes_));
            }
            const double mean = std::min(static_cast<double>(to), static_cast<double>(std::max(s_.spp, 1)));
            sample({ .pass = pass, .from = from, .most = to, .mean = std::max(mean, from + 1.0), .measures = measured },
                wanted_, stored.drawn, std::move(becoming), std::move(sunk));
        };
        if (first > 0) {
            draw(names_.first, 0, first, true);
        }
        if (most > first) {
            draw(f_.analysed() ? names_.rest : names_.plain, first, most, false);
        }
    });
    pixels_.limit({});
}

void PixelTerm::exposeSamples(StoredSamples& stored)
{
    auto sums = g_.plane<Sums>("sums of probes", g_.resources()[sums_.resource].format);
    auto taken = g_.plane<Count>("samples of probes", graph::counts);
    f_.zero(sums, taken);
    constexpr std::uint32_t each = WEDGE_PROBE_SAMPLES;
    const double mean = double { WEDGE_PROBE_SAMPLES } / (WEDGE_PROBE_STEP * WEDGE_PROBE_STEP);
    const std::string pass = "probes of " + names_.stages;
    sample({ .pass = pass, .from = 0, .most = each, .mean = mean, .everywhere = true },
        probeCounts(f_, f_.surfaces.objectId), taken, { sinks::sums() }, { updates("sums", sums) });
    stored.expose(sums, taken);
}

void PixelTerm::sample(const Draw& draw)
{
    std::vector<graph::Sink> becoming { sinks::sums(), keepsParts() ? sinks::parts() : sinks::means() };
    Arguments sunk { updates("sums", sums_), keepsParts() ? updates("parts", parts_) : updates("value", value_) };
    keepMore(becoming, sunk);
    if (draw.measures) {
        const Sampler sampler = this->sampler();
        becoming.push_back(sampler.measures);
        sunk.push_back(updates(sampler.measured, extremes_));
    }
    sample(draw, wanted_, taken_, std::move(becoming), std::move(sunk));
}

void PixelTerm::sample(const Draw& draw, const graph::Handle<Count>& wanted, graph::Handle<Count>& taken,
    std::vector<graph::Sink> becoming, Arguments sunk)
{
    Sampler sampler = this->sampler();
    const SampleSlices slices(draw.from, draw.most, sampler.slice, draw.mean);
    auto units = slices.workUnits(std::max(1.0, draw.mean - draw.from) * sampler.workUnits);
    if (const RowsOf& rows = pixels_.rows()) {
        units = [all = std::move(units), rows](const graph::Launch& launch) {
            return all(launch) * rows(launch).height() / std::max(1, launch.window.height());
        };
    }
    g_.loop("slices", slices.counter(), [&] {
        sampler.kernel.sinks = std::move(becoming);
        f_.trace(draw.pass, std::move(sampler.kernel),
            joined(sampler.arguments, sampleCounts(wanted, slices.last(), taken, sampler.rays), sunk), draw.everywhere,
            units, pixels_.rows());
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
