#include "effects/area_lights/light_graph.h"

#include "effects/area_lights/light_widths.h"
#include "effects/area_lights/maaf.h"
#include "effects/area_lights/shadow_filter.h"
#include "effects/area_lights/soft_shadows.h"
#include "host/graph/execution.h"
#include "host/render/filters/count_scale.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "host/render/sample_slices.h"
#include "host/render/sinks.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::tallies;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

// Samples of a pixel between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr std::uint32_t monteCarloSlice = 64;
constexpr std::uint32_t secondPassSlice = 256;

/// One light of a frame that is being declared.
class LightGraph {
public:
    LightGraph(FrameBuilder& frame, const TermLight& light, const std::shared_ptr<TermState>& state,
        graph::Handle<Metres>& beta)
        : f_(frame)
        , g_(frame.graph)
        , s_(frame.settings)
        , index_(light.number)
        , term_(light.name)
        , light_(light.light)
        , channels_(frame.specular() ? 2 : 1)
        , filter_(shadowFilterOf(frame, light_))
        , state_(state)
        , beta_(beta)
        , sums_(g_.plane<Sums>("sums", graph::floatPlanes(2 * channels_)))
        , value_(g_.plane<Value>("value", graph::floatPlanes(channels_)))
        , parts_(g_.plane<Value>("value of part", frame.specular() ? shortPairs : shortFloats))
        , extremes_(g_.plane<Extremes>("slopes", graph::floatPlanes(2)))
        , taken_(g_.plane<Count>("samples taken", graph::counts))
        , rays_(g_.plane<Count>("rays of light", graph::counts))
        , wanted_(g_.plane<Count>("samples wanted", graph::counts))
    {
    }

    void declare()
    {
        f_.zero(sums_, taken_, rays_);
        if (!f_.analysed()) {
            declarePlain();
            return;
        }
        firstPass();
        countRays();
        wanted_ = g_.plane<Count>("samples wanted", graph::counts); // no version of the first: that ends here
        g_.only("analysis of light", analysed(), [&] { widthsAndCounts(); });
        if (!takesFirstPassOnly()) {
            g_.only(
                "rest of light", analysed(), [&] { samples("second pass", WEDGE_FIRST_PASS_RAYS, secondPassSlice); });
            countRays();
        }
        countSamples();
        value_ = means("filter", PassKind::Filter);
        if (s_.filtering == Filtering::None) {
            shade(value_, {});
            return;
        }
        Gathered filtered = filteredPlanes(f_, channels_);
        const bool shows = filter_->shown().graph != 0;
        g_.only("filter of light", analysed(), [&] { filter(filtered); });
        if (shows) {
            f_.layers->add({ componentsLayer(s_).name, term_, filter_->shown(), Where::OnSurfaces });
        }
        // Not in that group: what is added up need not be there before it.
        shade(filtered.value, analysed());
        shade(value_, [state = state_](const Run&) { return !state->analysed; });
    }

private:
    shared::FilterParams filterParams() const { return render::filterParams(s_, f_.wholeFrame(), light_, g_.image()); }

    void countSamples() { f_.count(taken_, false, f_.totals.tallies.samples, &f_.totals.samples); }
    /// After a pass that traced some; and begins anew, so that nothing of it takes memory until there are more. Not
    /// without a pass: counting makes nobody clear a plane.
    void countRays()
    {
        f_.count(rays_, true, f_.totals.tallies.rays, &f_.totals.rays);
        rays_ = g_.plane<Count>("rays of light", graph::counts);
        f_.zero(rays_);
    }
    /// Whether no more samples are asked for than the first pass takes of every pixel: there is nothing to share out.
    bool takesFirstPassOnly() const
    {
        const bool shared = s_.sampling == Sampling::Uniform || s_.counts == Counts::Variance;
        return shared && s_.spp <= static_cast<int>(WEDGE_FIRST_PASS_RAYS);
    }
    LightSamples lightSamples() const { return { sums_, value_, taken_ }; }
    /// Once the first pass is complete.
    std::function<bool(const Run&)> analysed() const
    {
        return [state = state_](const Run&) { return state->analysed; };
    }
    /// Of a frame that is not analysed: all samples at once.
    void declarePlain();
    /// The sinks of a pass that analysed frames have, and what they are handed.
    std::pair<std::vector<graph::Sink>, Arguments> becoming();
    graph::Handle<Value> means(const char* pass, PassKind kind);
    void firstPass();
    void samples(const char* pass, std::uint32_t from, std::uint32_t slice);
    void widthsAndCounts();
    void countsFromVariance();
    void widened();
    void filter(Gathered& filtered);
    void shade(const graph::Handle<Value>& shown, const std::function<bool(const Run&)>& condition);

    shared::AnalysisParams analysisParams() const
    {
        return filter_->withWidths(lightParams(f_.analysisParams(), s_, light_));
    }
    graph::Argument sampleParams() const { return value("params", lightSampleParams(s_, index_)); }
    graph::Argument light() const { return value("light", light_); }
    graph::Argument quadrature() const
    {
        return f_.outside("nodes", "float", f_.scene != nullptr ? &f_.scene->quadratures[index_].cl() : nullptr);
    }

    FrameBuilder& f_;
    graph::Graph& g_;
    const Settings& s_;
    std::uint32_t index_;
    std::string term_;
    shared::AreaLight light_;
    std::uint32_t channels_;
    std::unique_ptr<ShadowFilter> filter_;
    std::shared_ptr<TermState> state_;
    graph::Handle<Metres>& beta_;
    graph::Handle<Sums> sums_;
    graph::Handle<Value> value_, parts_;
    graph::Handle<Extremes> extremes_;
    graph::Handle<Count> taken_, rays_, wanted_;
};

void LightGraph::declarePlain()
{
    f_.zero(value_);
    uniformCounts(f_, static_cast<std::uint32_t>(s_.spp), f_.surfaces.objectId, wanted_);
    samples("shadow rays", 0, monteCarloSlice);
    countSamples();
    countRays();
    shade(value_, {});
}

std::pair<std::vector<graph::Sink>, Arguments> LightGraph::becoming()
{
    std::vector<graph::Sink> sinks { sinks::sums() };
    Arguments sunk { updates("sums", sums_) };
    if (!f_.analysed()) {
        sinks.push_back(sinks::means());
        sunk.push_back(updates("value", value_));
        return { std::move(sinks), std::move(sunk) };
    }
    sinks.push_back(sinks::parts());
    sunk.push_back(updates("parts", parts_));
    filter_->keep(sinks, sunk);
    return { std::move(sinks), std::move(sunk) };
}

/// What the samples that are there are filtered as.
graph::Handle<Value> LightGraph::means(const char* pass, PassKind kind)
{
    auto out = g_.plane<Value>("value", graph::floatPlanes(channels_));
    f_.pixels(pass, kind, { "light/light_means.cl", "lightMeans" },
        { f_.rectangle(analysisParams()), sampleParams(), reads("sums", sums_), reads("taken", taken_),
            writes("value", out) });
    return out;
}

void LightGraph::firstPass()
{
    f_.zero(extremes_, parts_);
    filter_->start();
    uniformCounts(f_, WEDGE_FIRST_PASS_RAYS, f_.surfaces.objectId, wanted_);
    auto [sinks, sunk] = becoming();
    sinks.push_back(sinks::slopes());
    sunk.push_back(updates("slopes", extremes_));
    f_.trace("first pass", { "light/area_light.cl", "sampleShadows", std::move(sinks) },
        joined({ f_.frame(), sampleParams(), light() }, f_.hierarchy(), f_.receivers(),
            sampleCounts(wanted_, value("lastSample", WEDGE_FIRST_PASS_RAYS), taken_, { tallies("rays", rays_) }),
            sunk),
        true, [](const graph::Launch&) { return WEDGE_FIRST_PASS_RAYS; });
    f_.host("analysable", [state = state_](Run& run) { state->analysed = !run.cut(); });
}

void LightGraph::samples(const char* pass, std::uint32_t from, std::uint32_t slice)
{
    const int most = s_.sampling == Sampling::Uniform ? s_.spp : std::max(s_.maxSpp, s_.spp);
    const SampleSlices slices(from, static_cast<std::uint32_t>(most), slice, s_.spp);
    g_.loop("slices", slices.counter(), [&] {
        const auto [sinks, sunk] = becoming();
        f_.trace(pass, { "light/area_light.cl", "sampleShadows", sinks },
            joined({ f_.frame(), sampleParams(), light() }, f_.hierarchy(), f_.receivers(),
                sampleCounts(wanted_, slices.last(), taken_, { tallies("rays", rays_) }), sunk),
            false, slices.workUnits(std::max(1.0, static_cast<double>(s_.spp) - from)));
    });
}

void LightGraph::widthsAndCounts()
{
    lightWidths(f_, analysisParams(),
        { extremes_, [this]() -> graph::Version { return sums_; }, reflectedSums(f_, sums_) }, beta_, wanted_,
        filter_->bothSlopes());
    if (takesFirstPassOnly()) {
        return;
    }
    if (s_.sampling == Sampling::Uniform) {
        uniformCounts(f_, static_cast<std::uint32_t>(s_.spp), f_.surfaces.objectId, wanted_);
    } else if (s_.counts == Counts::Variance) {
        countsFromVariance();
    }
}

void LightGraph::countsFromVariance()
{
    const shared::AnalysisParams p = analysisParams();
    graph::Handle<Value> visibility = means("filter of first pass", PassKind::Analysis);
    auto effective = g_.plane<Count>("effective count of first pass", graph::floats);
    if (s_.filtering == Filtering::None) {
        f_.fill("ones", effective, 1.0f);
    } else {
        const Gathered gathered = gaussianFilter(
            f_, { "filter of first pass", PassKind::Analysis }, channels_, filterParams(), visibility, beta_);
        visibility = gathered.value;
        effective = gathered.effective;
    }
    auto uncertainty = g_.plane<Uncertainty>("uncertainty", graph::floats);
    f_.blocks("counts", PassKind::Analysis, { "analysis/demand.cl", "visibilityUncertainty" },
        { f_.rectangle(p), reads("filtered", visibility), reads("effective", effective), reads("beta", beta_),
            writes("uncertainty", uncertainty) });
    auto demand = g_.plane<Demand>("demand", graph::floats);
    demandOf(f_, p, uncertainty, { .oneObject = true, .ownToo = true }, demand);
    countsFromDemands(f_, { { demand, 1.0f, static_cast<float>(p.leastCount), &wanted_ } },
        { static_cast<float>(s_.spp), static_cast<float>(p.countCap), f_.surfaces.objectId });
}

void LightGraph::widened()
{
    auto visibility = g_.plane<Value>("visibility", graph::floats);
    auto deviation = g_.plane<Deviation>("deviation", graph::floats);
    auto weights = g_.plane<Share>("weights", graph::floats);
    f_.blocks("filter", PassKind::Filter, { "analysis/widening.cl", "oneOfLight", {}, f_.surfaceFormats() },
        { f_.rectangle(analysisParams()), value("firstPass", WEDGE_FIRST_PASS_RAYS), reads("value", value_),
            reads("parts", parts_), reads("taken", taken_), reads("sums", sums_), reads("diffuse", f_.surfaces.diffuse),
            reads("specular", f_.surfaces.specular), writes("visibility", visibility), writes("deviation", deviation),
            writes("weights", weights) });
    widen(f_, "filter", filterParams(), s_.widening, pinholeNoise, { visibility, deviation, weights }, beta_);
}

void LightGraph::filter(Gathered& filtered)
{
    filter_->narrow(analysisParams(), lightSamples(), beta_);
    // What was stopped early has not the counts that the parts of samples were made for.
    if (widens(s_) && filter_->widens()) {
        g_.only(
            "widening", [](const Run& run) { return !run.cut(); }, [&] { widened(); });
    }
    filter_->gather(filterParams(), analysisParams(), lightSamples(), beta_, filtered);
}

void LightGraph::shade(const graph::Handle<Value>& shown, const std::function<bool(const Run&)>& condition)
{
    const graph::Argument p = f_.rectangle(analysisParams());
    const Surfaces& s = f_.surfaces;
    const Arguments values = graph::together("values",
        { reads("value", shown), reads("noisy", value_),
            f_.analysed() ? reads("parts", parts_) : graph::absent("parts", f_.specular() ? shortPairs : shortFloats),
            reads("taken", taken_) });
    const auto sum = [&direct = f_.totals.direct] {
        return graph::together("sum",
            { updates("direct", direct.filtered), updates("directNoisy", direct.noisy),
                updates("deviation", direct.deviation) });
    };
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addDiffuse" },
        joined({ p, sampleParams(), light(), quadrature() }, places(s), Arguments { reads("diffuse", s.diffuse) },
            values, sum()),
        condition);
    if (f_.specular()) {
        f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addSpecular" },
            joined({ p, sampleParams(), light(), value("frame", f_.wholeFrame()),
                       value("directions", lobeDirections(s_.spp)), quadrature() },
                places(s), Arguments { reads("gloss", s.gloss), reads("specular", s.specular) }, values, sum()),
            condition);
    }
}

} // namespace

void addAreaLight(
    FrameBuilder& frame, const TermLight& light, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta)
{
    LightGraph(frame, light, state, beta).declare();
}

} // namespace wedge::render
