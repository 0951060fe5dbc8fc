#include "host/render/pixel_frame.h"

#include "host/render/filter_chain.h"
#include "host/render/filters/fallback.h"
#include "host/render/frame_filter.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::writes;

PixelFrame::PixelFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
    std::size_t packetSize, bool keepLayers, FrameFilter* filter)
    : FrameGraph(settings, scene, keepLayers, false)
    , apart_(showsParts() || filter != nullptr)
    , f_ { graph_, scene, deviceScene, settings_, layout_, packetSize }
{
    f_.narrowLobes = scene.traits().narrowLobes;
    const bool lit = settings.integrator == Integrator::Path;
    primary(lit);
    f_.precomputeDirections();
    f_.layers = keepLayers ? &outputs_ : nullptr;
    addTerms(Part::Direct);
    for (const Unfiltered& added : unfiltered_) {
        addUnfiltered(added);
    }
    const bool fallsBack = usesFallback(settings), reflects = countOf(Part::Indirect, terms_) > 0;
    // Two planes become one before paths are traced.
    auto beauty = graph_.plane<Radiance>("emission and direct light", graph::vectors);
    addReflected(f_.surfaces.emission, f_.totals.direct, fallsBack && countOf(Part::Direct, terms_) > 0, beauty);
    addTerms(Part::Indirect);
    if (reflects) {
        addReflected(beauty, f_.totals.indirect, fallsBack, f_.totals.beauty);
    } else {
        f_.totals.beauty = beauty;
    }
    if (filter != nullptr) {
        filter->declare(f_);
    }
    show();
}

void PixelFrame::show()
{
    const Surfaces& s = f_.surfaces;
    const Totals& t = f_.totals;
    outputs_.add("beauty", t.beauty);
    outputs_.add("objectId", s.objectId);
    outputs_.add("samplesTally", t.tallies.samples);
    outputs_.add("indirectTally", t.tallies.indirectSamples);
    outputs_.add("raysTally", t.tallies.rays);
    outputs_.add("pathRaysTally", t.tallies.pathRays);
    if (t.tallies.notFinite.graph != 0) {
        outputs_.add("notFiniteTally", t.tallies.notFinite);
    }
    if (t.tallies.clamped.graph != 0) {
        outputs_.add("clampedTally", t.tallies.clamped);
    }
    if (keepsLayers_ || std::ranges::any_of(terms_, &Term::ofLobes)) {
        outputs_.add("specular", s.specular); // pixels that have some are sampled for more terms
    }
    if (showsParts()) {
        outputs_.add("emission", s.emission);
        outputs_.add("direct", t.direct.filtered, Where::OnSurfaces);
        outputs_.add("indirect", t.indirect.filtered, Where::OnSurfaces);
    }
    if (keepsLayers_) {
        outputs_.add("albedo", s.diffuse, Where::OnSurfaces);
        outputs_.add("normal", s.normal, Where::OnSurfaces);
        outputs_.add("position", s.position, Where::OnSurfaces);
        outputs_.add("origin", s.origin);
        outputs_.add("depth", s.depth);
        outputs_.add("pixelSize", s.pixelSize);
        outputs_.add("samples", t.samples, Where::OnSurfaces);
        outputs_.add("rays", t.rays);
        outputs_.add("directNoisy", t.direct.noisy, Where::OnSurfaces);
        outputs_.add("indirectNoisy", t.indirect.noisy, Where::OnSurfaces);
    }
    finish(f_);
}

void PixelFrame::primary(bool lit)
{
    Surfaces& s = f_.surfaces;
    // Gathers read the padding, which is of no object; and what is not hit, or not seen before a frame is stopped, is
    // 0.
    f_.eachFound(s,
        [this]<class Quantity>(const char* name, graph::Handle<Quantity>& plane, const graph::Format& format, ReadBy) {
            plane = graph_.plane<Quantity>(name, format);
            f_.zero(plane);
        });
    Totals& t = f_.totals;
    for (Sum* sum : { &t.direct, &t.indirect }) {
        const std::string name = sum == &t.direct ? "direct" : "indirect";
        sum->filtered = graph_.plane<Radiance>(name, graph::vectors);
        sum->noisy = graph_.plane<Radiance>(name + " noisy", graph::vectors);
        sum->deviation = graph_.plane<Deviation>(name + " deviation", shortFloats);
        f_.zero(sum->filtered, sum->noisy, sum->deviation);
    }
    t.samples = graph_.plane<Count>("samples", graph::counts);
    t.rays = graph_.plane<Count>("rays", graph::counts);
    const auto tally = [this](const char* name) { return graph_.list<Tally>(name, tallySums, WEDGE_TALLY_STRIPES); };
    t.tallies = { tally("tally of samples"), tally("tally of indirect samples"), tally("tally of rays"),
        tally("tally of path rays"), {}, {} };
    if (sampleFilterOf(settings_).filter != nullptr) {
        t.tallies.notFinite = tally("tally of samples not finite");
        f_.zero(t.tallies.notFinite);
    }
    t.beauty = graph_.plane<Radiance>("beauty", graph::vectors);
    f_.zero(t.samples, t.tallies.samples, t.tallies.indirectSamples, t.tallies.rays, t.tallies.pathRays);
    f_.fill("camera rays", t.rays, std::uint32_t { 1 });
    f_.trace("primary rays", { "frame/primary.cl", "primary" },
        joined({ f_.frame() }, f_.met(lit), f_.found(s, updates)), f_.analysed(),
        [](const graph::Launch&) { return 1.0; });
    if (!lit) {
        f_.zero(s.emission);
    }
}

void PixelFrame::addTerms(Part part)
{
    Sum& sum = part == Part::Direct ? f_.totals.direct : f_.totals.indirect;
    if (std::ranges::any_of(terms_, [&](const Term& t) { return t.part == part && t.gathersVariance; })) {
        sum.variance = graph_.plane<Value>("gathered variance", shortFloats);
        f_.zero(sum.variance);
    }
    if (std::ranges::any_of(
            terms_, [&](const Term& t) { return t.part == part && (t.changed || isFiltered(settings_, t.target)); })) {
        sum.change = graph_.plane<Radiance>("change by filters of terms", graph::vectors);
        f_.zero(sum.change);
    }
    for (const Term& term : terms_) {
        if (term.part == part) {
            const std::unique_ptr<PixelTerm> declared = term.inPixels(f_);
            declared->declare();
            if (declared->rejected().graph != 0) {
                outputs_.add({ "rejected", term.name, declared->rejected(), Where::OnSurfaces });
            }
            if (declared->density().graph != 0) {
                outputs_.add({ "pathDensity", term.name, declared->density(), Where::OnSurfaces });
            }
            if (keepsLayers_ && f_.analysed()) {
                showWidths(f_, term, declared->state(), declared->beta(), f_.surfaces.pixelSize);
            }
        }
    }
}

void PixelFrame::addUnfiltered(const Unfiltered& added)
{
    auto radiance = graph_.plane<Radiance>("radiance of " + added.name, graph::vectors);
    f_.zero(radiance);
    PixelReceivers pixels(f_);
    added.sample(f_, pixels, radiance);
    pixels.countRays();
    Sum& sum = f_.totals.direct;
    if (added.changes) {
        addChanging(radiance);
    } else {
        f_.pixels("composite", PassKind::Composite, { "frame/sums.cl", "addUnfiltered" },
            { f_.rectangle(f_.analysisParams()), reads("radiance", radiance), updates("direct", sum.filtered),
                updates("directNoisy", sum.noisy) });
    }
    if (keepsLayers_ && !added.layer.empty()) {
        outputs_.add(added.layer, radiance, Where::OnSurfaces);
    }
}

void PixelFrame::addChanging(const graph::Handle<Radiance>& radiance)
{
    auto filtered = graph_.plane<Radiance>("direct with what changes", graph::vectors);
    auto noisy = graph_.plane<Radiance>("direct noisy with what changes", graph::vectors);
    f_.zero(filtered, noisy);
    Sum& sum = f_.totals.direct;
    f_.pixels("composite", PassKind::Composite, { "frame/sums.cl", "addChanging" },
        { f_.rectangle(f_.analysisParams()), reads("radiance", radiance), reads("direct", sum.filtered),
            reads("directNoisy", sum.noisy), updates("sum", filtered), updates("sumNoisy", noisy) });
    sum.filtered = filtered;
    sum.noisy = noisy;
}

void PixelFrame::addReflected(
    const graph::Handle<Radiance>& below, Sum& sum, bool fallsBack, graph::Handle<Radiance>& out)
{
    auto shares = graph_.plane<Share>("share of own samples", graph::pairs);
    auto reflected = graph_.plane<Radiance>("fallen back", graph::vectors);
    const bool changed = sum.change.graph != 0, writesOwn = (fallsBack || changed) && apart_;
    if (fallsBack) {
        f_.zero(shares);
        // What was stopped has not the counts that the parts of samples were made for.
        graph_.only(
            "fallback", [](const Run& run) { return !run.cut(); },
            [&] {
                ownShares(f_,
                    { .values = 3,
                        .others = false,
                        .filtered = reads("filtered", sum.filtered),
                        .noisy = reads("noisy", sum.noisy),
                        .deviation = reads("deviation", sum.deviation),
                        .variance = sum.variance.graph != 0 ? reads("variance", sum.variance)
                                                            : graph::absent("variance", shortFloats) },
                    updates("shares", shares));
            });
    }
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addReflected" },
        { f_.rectangle(f_.analysisParams()), reads("below", below), reads("light", sum.filtered),
            reads("objectId", f_.surfaces.objectId),
            fallsBack ? reads("shares", shares) : graph::absent("shares", graph::pairs),
            fallsBack ? reads("noisy", sum.noisy) : graph::absent("noisy", graph::vectors),
            changed ? reads("change", sum.change) : graph::absent("change", graph::vectors),
            writesOwn ? writes("reflected", reflected) : graph::absent("reflected", graph::vectors),
            writes("sum", out) });
    if (writesOwn) {
        sum.filtered = reflected;
    }
}

} // namespace wedge::render
