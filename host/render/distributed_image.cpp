// The image of a frame of several receivers a pixel, of what its pixels keep of their samples.
#include "host/render/distributed_samples.h"
#include "host/render/filter_chain.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::value;
using graph::writes;

void DistributedSamples::blurs(float samples, Blurs& out)
{
    shared::DistributedParams p = params();
    p.samples = samples;
    const auto sets = samples > 0 || !shape_.layers ? writes : updates; // what is shown without motion is 0
    f_.pixels("widths", PassKind::Analysis, { "waves/distributed.cl", "blurs" },
        { f_.rectangle(p), reads("confusion", confusion_),
            keepsMotion() ? reads("motion", motion_) : graph::absent("motion", shortPairs),
            keepsMotion() && !f_.lean ? reads("motionSpread", motionSpread_) : graph::absent("motionSpread"),
            reads("taken", counts_.taken), sets("lens", out.lens),
            keepsMotion() ? sets("along", out.along) : graph::absent("along"),
            keepsMotion() && !f_.lean ? writes("directions", out.directions) : graph::absent("directions", shortPairs),
            keepsMotion() && f_.lean ? writes("vectors", out.directions) : graph::absent("vectors", shortPairs) });
}

graph::Handle<Radiance>& DistributedSamples::sumOf(WaveTerm& term)
{
    return shape_.apart ? term.sum().filtered : f_.totals.beauty;
}

void DistributedSamples::countSamples()
{
    const std::uint32_t first = shape_.analysed ? firstPaths() : std::numeric_limits<std::uint32_t>::max();
    Totals& t = f_.totals;
    const auto add = [&](graph::Handle<Count>& sum, const graph::Handle<Count>& part) {
        if (sum.graph == 0) {
            sum = part;
            return;
        }
        auto both = f_.graph.plane<Count>("samples", graph::counts);
        f_.pixels("composite", PassKind::Composite, { "frame/progressive.cl", "sumOfHalves" },
            { pixels(), reads("a", sum), reads("b", part), writes("sum", both) });
        sum = both;
    };
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        if (!shape_.full) {
            f_.pixels("composite", PassKind::Composite, { "waves/distributed.cl", "settleCounts" },
                { pixels(), value("first", first), reads("primaryTaken", counts_.taken),
                    updates("counts", term->means.wanted) });
        }
        const graph::Handle<Count>& counted = shape_.full ? term->means.taken : term->means.wanted;
        add(t.samples, counted);
        if (&term->sum() == &t.indirect) {
            add(t.indirectSamples, counted);
        }
    }
    for (graph::Handle<Count>* none : { &t.samples, &t.indirectSamples }) {
        if (none->graph == 0) {
            *none = f_.graph.plane<Count>("no samples", graph::counts);
            f_.zero(*none);
        }
    }
}

graph::Handle<Radiance> DistributedSamples::copyOf(const std::string& name, const graph::Handle<Radiance>& image)
{
    auto copy = f_.graph.plane<Radiance>(name, graph::vectors);
    f_.pixels("composite", PassKind::Composite, { "frame/progressive.cl", "copyImage" },
        { pixels(), reads("in", image), writes("out", copy) });
    return copy;
}

void DistributedSamples::addImage(const graph::Handle<Radiance>& image, graph::Handle<Radiance>& sum)
{
    f_.pixels("composite", PassKind::Composite, { "waves/distributed.cl", "addImage" },
        { pixels(), reads("image", image), updates("sum", sum) });
}

void DistributedSamples::startSums()
{
    // All that is reflected is added to what is emitted, which is not changed where it stays.
    graph::Handle<Radiance>& beauty = f_.totals.beauty;
    beauty = before_.memory != nullptr ? copyOf("beauty", f_.surfaces.emission) : f_.surfaces.emission;
    for (const Added& added : added_) {
        addImage(added.radiance, beauty);
    }
}

void DistributedSamples::addPlain(const std::vector<TermMeans>& all)
{
    const bool kept =
        std::ranges::any_of(terms_, [](const std::unique_ptr<WaveTerm>& term) { return term->bins.has_value(); });
    if (shape_.apart && !kept) {
        plain_ = f_.sumOfParts(
            pixels(), "image before filters", f_.surfaces.emission, f_.totals.direct.noisy, f_.totals.indirect.noisy);
        return;
    }
    plain_ = copyOf("image before filters", shape_.apart ? f_.surfaces.emission : f_.totals.beauty);
    for (std::size_t i = 0; shape_.apart && i < added_.size(); ++i) {
        addImage(added_[i].radiance, plain_);
    }
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        addOwn(*terms_[i], all[i], plain_, false);
    }
}

void DistributedSamples::startParts()
{
    Totals& t = f_.totals;
    for (Sum* sum : { &t.direct, &t.indirect }) {
        const bool lights = sum == &t.direct && !added_.empty();
        for (graph::Handle<Radiance>* radiance : { &sum->filtered, &sum->noisy }) {
            const std::string name = sum == &t.direct ? "direct" : "indirect";
            if (lights) {
                *radiance = copyOf(name, added_.front().radiance);
            } else {
                *radiance = f_.graph.plane<Radiance>(name, graph::vectors);
                f_.zero(*radiance);
            }
            for (std::size_t i = 1; lights && i < added_.size(); ++i) {
                addImage(added_[i].radiance, *radiance);
            }
        }
    }
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        addOwn(*term, term->means, term->sum().noisy, false);
    }
}

void DistributedSamples::addOwn(
    WaveTerm& term, const TermMeans& means, graph::Handle<Radiance>& radiance, bool unlessAnalysed)
{
    const auto condition = [state = state_](const Run&) { return !state->analysed; };
    f_.pixels("composite", PassKind::Composite, { "waves/distributed.cl", "addTerm" },
        { f_.rectangle(term.of(params())), reads("texture", means.texture), reads("value", means.value),
            shape_.published ? reads("termRadiance", means.radiance) : graph::absent("termRadiance", graph::vectors),
            updates("radiance", radiance) },
        unlessAnalysed ? condition : std::function<bool(const Run&)>());
}

void DistributedSamples::addFiltered(
    WaveTerm& term, const FilteredTerm& filtered, const Blurs& own, graph::Handle<Radiance>& radiance)
{
    const shared::DistributedParams p = term.of(params());
    graph::Handle<Texture> texture = term.means.texture;
    if (shape_.moves && f_.settings.distributed.blur) {
        const graph::Reach far = graph::around(WEDGE_MOTION_REACH);
        auto along = f_.graph.plane<Texture>("texture filtered along motion", graph::vectors);
        f_.pixels("filter of motion", PassKind::Filter, { "waves/distributed.cl", "blurMotion" },
            joined({ f_.rectangle(p) }, readsMotion(f_, own.along, own.directions),
                Arguments { reads("texture", term.means.texture, far), graph::absent("value"), writes("out", along) }));
        texture = along;
    }
    f_.pixels("composite", PassKind::Composite, { "waves/distributed.cl", "addFilteredTerm" },
        { f_.rectangle(p), reads("texture", term.means.texture), reads("filteredTexture", texture),
            reads("value", term.means.value), reads("filtered", filtered.value), reads("beta", term.means.beta),
            filtered.shares.graph != 0 ? reads("shares", filtered.shares) : graph::absent("shares", shortPairs),
            shape_.published ? reads("termRadiance", term.means.radiance)
                             : graph::absent("termRadiance", graph::vectors),
            updates("radiance", radiance) });
    addTermFilters(term, &filtered, &texture, radiance);
}

void DistributedSamples::addTermFilters(WaveTerm& term, const FilteredTerm* filtered,
    const graph::Handle<Texture>* filteredTexture, graph::Handle<Radiance>& radiance)
{
    const std::string target = term.target().name;
    if (!isFiltered(f_.settings, target)) {
        return;
    }
    const char* pass = "filters of terms";
    const bool shares = filtered != nullptr && filtered->shares.graph != 0;
    auto arrives = f_.graph.plane<Radiance>("what arrives", graph::vectors);
    const auto beta = [&] { return filtered != nullptr ? reads("beta", term.means.beta) : graph::absent("beta"); };
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "arrivingAtWaves" },
        { pixels(), reads("texture", term.means.texture), reads("value", term.means.value),
            filtered != nullptr ? reads("filtered", filtered->value) : graph::absent("filtered", graph::vectors),
            beta(), shares ? reads("shares", filtered->shares) : graph::absent("shares", shortPairs),
            writes("arrives", arrives) });
    f_.pixels(pass, PassKind::Filter, { "waves/distributed.cl", "addChange" },
        { pixels(), reads("texture", term.means.texture),
            filteredTexture != nullptr ? reads("filteredTexture", *filteredTexture)
                                       : graph::absent("filteredTexture", graph::vectors),
            beta(), reads("before", arrives), reads("after", filteredImage(f_, target, arrives)),
            updates("radiance", radiance) });
}

void DistributedSamples::blur(graph::Handle<Radiance>& image)
{
    const char* pass = "filter of lens and shutter";
    const graph::Reach along { .x = WEDGE_MAX_RADIUS }, across { .y = WEDGE_MAX_RADIUS };
    auto rows = f_.graph.plane<Radiance>("rows of the image", graph::vectors);
    f_.pixels(pass, PassKind::Filter, { "filter/blur.cl", "blurRows" },
        { pixels(), reads("lens", lens_, along), reads("in", image, along), writes("out", rows) });
    f_.pixels(pass, PassKind::Filter, { "filter/blur.cl", "blurColumns" },
        { pixels(), reads("lens", lens_, across), reads("in", rows, across), updates("out", image) });
}

void DistributedSamples::filterTerms(Blurs& own)
{
    if (filters()) {
        f_.graph.only("filters", analysed(), [&] {
            for (const std::unique_ptr<WaveTerm>& term : terms_) {
                const FilteredTerm filtered = term->filtered(params());
                if (term == terms_.front()) { // not before, for the memory's sake
                    blurs(0.0f, own);
                }
                addFiltered(*term, filtered, own, sumOf(*term));
            }
            if (terms_.empty()) {
                blurs(0.0f, own);
            }
        });
    }
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        addOwn(*term, term->means, sumOf(*term), filters());
        const auto unfiltered = [filters = filters(), state = state_](
                                    const Run&) { return !filters || !state->analysed; };
        if (isFiltered(f_.settings, term->target().name)) {
            f_.graph.only(
                "filters of terms", unfiltered, [&] { addTermFilters(*term, nullptr, nullptr, sumOf(*term)); });
        }
    }
}

void DistributedSamples::blurImages()
{
    Totals& t = f_.totals;
    f_.graph.only("filter of the image", analysed(), [&] {
        blur(t.beauty);
        if (shape_.parts) {
            blur(emission_);
        }
        if (shape_.apart) {
            blur(t.direct.filtered);
            blur(t.indirect.filtered);
        }
    });
}

void DistributedSamples::compose()
{
    Totals& t = f_.totals;
    if (!lit_) {
        f_.zero(f_.surfaces.emission);
    }
    if (!shape_.layers) {
        countSamples();
    }
    const std::vector<TermMeans> all = keepSamples();
    if (shape_.apart) {
        startParts();
    } else {
        startSums();
    }
    if (before_.memory != nullptr) {
        addPlain(all);
    }
    Blurs own { f_.graph.plane<Pixels>("lens filter width", graph::floats),
        f_.graph.plane<Pixels>("motion filter width", graph::floats),
        f_.graph.plane<Pixels>("direction of motion", f_.lean ? shortPairs : graph::pairs) };
    if (shape_.layers) {
        f_.zero(own.lens, own.along); // they are shown, filtered or not
    }
    filterTerms(own);
    lens_ = own.lens;
    along_ = own.along;
    if (shape_.apart) {
        t.beauty = f_.sumOfParts(pixels(), "beauty", f_.surfaces.emission, t.direct.filtered, t.indirect.filtered);
    }
    if (shape_.parts) {
        // What is kept is not filtered.
        emission_ =
            before_.memory != nullptr ? copyOf("emission, filtered", f_.surfaces.emission) : f_.surfaces.emission;
    }
    if (filters() && f_.settings.distributed.blur && camera_.apertureRadius > 0) {
        blurImages();
    }
}

void DistributedSamples::show(Outputs& to)
{
    const Totals& t = f_.totals;
    const Surfaces& s = f_.surfaces;
    to.add("beauty", t.beauty, Where::Everywhere, Join::Mean);
    to.add("objectId", s.objectId, Where::Everywhere, Join::Surface);
    to.add("primarySamples", counts_.taken, Where::Everywhere, Join::SumOfTraced);
    to.add("samples", t.samples, Where::OnSurfaces, Join::Sum);
    to.add("indirectSamples", t.indirectSamples, Where::OnSurfaces, Join::Sum);
    to.add("raysTraced", t.rays, Where::Everywhere, Join::SumOfTraced);
    to.add("pathRays", t.pathRays, Where::Everywhere, Join::SumOfTraced);
    if (shape_.parts) {
        // Filters carry light to pixels that hit nothing themselves.
        to.add("emission", emission_, Where::Everywhere, Join::Mean);
        to.add("direct", t.direct.filtered, Where::Everywhere, Join::Mean);
        to.add("indirect", t.indirect.filtered, Where::Everywhere, Join::Mean);
    }
    if (t.notFinite.graph != 0) {
        to.add("notFinite", t.notFinite, Where::OnSurfaces, Join::Sum);
    }
    if (!shape_.layers) {
        return;
    }
    auto rays = f_.graph.plane<Count>("rays, the camera's included", graph::counts);
    f_.blocks("composite", PassKind::Composite, { "frame/tally.cl", "addCounts" },
        { f_.rectangle(f_.analysisParams()), reads("counts", t.rays), reads("before", counts_.taken),
            graph::writes("sum", rays) });
    to.add("rays", rays, Where::Everywhere, Join::Sum);
    to.add("position", s.position, Where::OnSurfaces, Join::Surface);
    to.add("normal", s.normal, Where::OnSurfaces, Join::Surface);
    to.add("pixelSize", s.pixelSize, Where::Everywhere, Join::Surface);
    to.add("depth", s.depth, Where::Everywhere, Join::Surface);
    to.add("albedo", s.diffuse, Where::OnSurfaces, Join::Mean);
    to.add("specular", s.specular, Where::Everywhere, Join::Mean);
    to.add("directNoisy", t.direct.noisy, Where::Everywhere, Join::Mean);
    to.add("indirectNoisy", t.indirect.noisy, Where::Everywhere, Join::Mean);
    for (const Added& added : added_) {
        if (!added.of.layer.empty()) {
            to.add(added.of.layer, added.radiance, Where::Everywhere, Join::Mean);
        }
    }
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        if (term->bins) {
            to.add({ "rejected", term->termName, term->bins->rejected(), Where::OnSurfaces, Join::Mean });
            if (term->bins->density().graph != 0) {
                to.add({ "pathDensity", term->termName, term->bins->density(), Where::OnSurfaces, Join::Mean });
            }
        }
    }
    to.add("motion", motion_);
    if (filters() && f_.settings.distributed.blur) {
        to.add("filterWidthLens", lens_);
        to.add("filterWidthMotion", along_);
    }
}

} // namespace wedge::render
