#include "effects/area_lights/light_pixels.h"

#include "effects/area_lights/light_widths.h"
#include "effects/area_lights/maaf.h"
#include "host/render/filters/widening.h"
#include "host/render/sinks.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

constexpr const char* composite = "frame/composite.cl";

// What one launch over one tile may cost, too.
constexpr std::uint32_t monteCarloSlice = 64;
constexpr std::uint32_t secondPassSlice = 256;

} // namespace

LightPixels::LightPixels(FrameBuilder& frame, const TermLight& light)
    : PixelTerm(frame, { "light", "shadow rays", "first pass", "second pass" }, frame.totals.direct,
        { .sums = frame.specular() ? 4u : 2u,
            .values = frame.specular() ? 2u : 1u,
            .extremes = 2,
            .part = frame.specular() ? shortPairs : shortFloats })
    , index_(light.number)
    , term_(light.name)
    , quad_(light.quad)
    , changer_(light.changer)
    , light_(light.light)
    , channels_(frame.specular() ? 2 : 1)
    , filter_(shadowFilterOf(frame, light_))
{
}

PixelTerm::Sampler LightPixels::sampler()
{
    return { .kernel = { "light/area_light.cl", "sampleShadows" },
        .arguments = shadowSamples(f_, pixels_, lightSampleParams(s_, index_), light_),
        .rays = { pixels_.tallyRays() },
        .measures = sinks::slopes(),
        .measured = "slopes",
        .slice = f_.analysed() ? secondPassSlice : monteCarloSlice,
        .workUnits = 1 };
}

std::uint32_t LightPixels::mostSamples() const
{
    return static_cast<std::uint32_t>(s_.sampling == Sampling::Uniform ? s_.spp : std::max(s_.maxSpp, s_.spp));
}

PixelTerm::CountsFrom LightPixels::countsFrom() const
{
    const bool uniform = s_.sampling == Sampling::Uniform;
    if (!uniform && s_.counts != Counts::Variance) {
        return CountsFrom::Spectrum;
    }
    // Where no more samples are asked for than the first pass takes of every pixel there is nothing to share out.
    const bool more = s_.spp > static_cast<int>(WEDGE_FIRST_PASS_RAYS);
    return !more ? CountsFrom::Nothing : uniform ? CountsFrom::Mean : CountsFrom::Variance;
}

void LightPixels::keepMore(std::vector<graph::Sink>& sinks, Arguments& sunk)
{
    if (f_.analysed()) {
        filter_->keep(sinks, sunk);
    }
}

graph::Handle<Value> LightPixels::meansOf(const char* pass, PassKind kind)
{
    auto out = g_.plane<Value>("value", graph::floatPlanes(channels_));
    f_.pixels(pass, kind, { "light/light_means.cl", "lightMeans" },
        { f_.rectangle(analysisParams()), sampleParams(), reads("sums", sums_), reads("taken", taken_),
            writes("value", out) });
    return out;
}

void LightPixels::widths()
{
    lightWidths(f_, analysisParams(),
        { extremes_, [this]() -> graph::Version { return sums_; }, reflectedSums(f_, sums_) }, beta_, wanted_,
        filter_->bothSlopes());
}

PixelTerm::Uncertain LightPixels::uncertainty()
{
    const shared::AnalysisParams p = analysisParams();
    graph::Handle<Value> visibility = meansOf("filter of first pass", PassKind::Analysis);
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
    return { uncertainty, p, { .oneObject = true, .ownToo = true } };
}

void LightPixels::addFiltered()
{
    Gathered filtered = filteredPlanes(f_, channels_);
    const bool shows = filter_->shown().graph != 0;
    g_.only("filter of light", analysed(), [&] { filter(filtered); });
    if (shows) {
        f_.layers->add({ componentsLayer(s_).name, term_, filter_->shown(), Where::OnSurfaces });
    }
    // Not in that group: what is added up need not be there before it.
    shade(filtered.value, analysed());
    shade(value_, [state = state()](const Run&) { return !state->analysed; });
    if (changer_ != nullptr) {
        g_.only("change of light", analysed(), [&] { changeVisibility(filtered.value); });
        if (f_.layers != nullptr) {
            changer_->showVisibility(f_, { light_, quad_, filtered.value }, analysed());
        }
    }
}

void LightPixels::widened()
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

void LightPixels::filter(Gathered& filtered)
{
    filter_->narrow(analysisParams(), lightSamples(), beta_);
    // What was stopped early has not the counts that the parts of samples were made for.
    if (widens(s_) && filter_->widens()) {
        g_.only(
            "widening", [](const Run& run) { return !run.cut(); }, [&] { widened(); });
    }
    filter_->gather(filterParams(), analysisParams(), lightSamples(), beta_, filtered);
}

void LightPixels::shade(const graph::Handle<Value>& shown, const std::function<bool(const Run&)>& condition)
{
    const Arguments values = graph::together("values",
        { reads("value", shown), reads("noisy", value_),
            f_.analysed() ? reads("parts", parts_) : graph::absent("parts", f_.specular() ? shortPairs : shortFloats),
            reads("taken", taken_) });
    const auto sum = [&direct = f_.totals.direct] {
        return graph::together("sum",
            { updates("direct", direct.filtered), updates("directNoisy", direct.noisy),
                updates("deviation", direct.deviation) });
    };
    f_.blocks(
        "composite", PassKind::Composite, { composite, "addDiffuse" }, joined(ofMatt(), values, sum()), condition);
    if (f_.specular()) {
        f_.blocks("composite", PassKind::Composite, { composite, "addSpecular" }, joined(ofLobes(), values, sum()),
            condition);
    }
}

void LightPixels::changeVisibility(const graph::Handle<Value>& shown)
{
    const graph::Handle<Value> more = changer_->changeVisibility(f_, { light_, quad_, shown });
    graph::Handle<Radiance>& change = f_.totals.direct.change;
    f_.blocks("composite", PassKind::Composite, { composite, "addDiffuseChange" },
        joined(ofMatt(), Arguments { reads("more", more), updates("change", change) }));
    if (f_.specular()) {
        f_.blocks("composite", PassKind::Composite, { composite, "addSpecularChange" },
            joined(ofLobes(), Arguments { reads("more", more), updates("change", change) }));
    }
}

Arguments LightPixels::ofMatt() const
{
    const Surfaces& s = f_.surfaces;
    return joined({ f_.rectangle(analysisParams()), sampleParams(), light(), quadratureOf(f_, index_) }, places(s),
        Arguments { reads("diffuse", s.diffuse) });
}

Arguments LightPixels::ofLobes() const
{
    const Surfaces& s = f_.surfaces;
    return joined({ f_.rectangle(analysisParams()), sampleParams(), light(), value("frame", f_.wholeFrame()),
                      value("directions", lobeDirections(s_.spp)), quadratureOf(f_, index_) },
        places(s), Arguments { reads("gloss", s.gloss), reads("specular", s.specular) });
}

} // namespace wedge::render
