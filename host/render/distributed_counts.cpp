// Where texture and irradiance are taken apart and how wide the irradiance's filter is then, and which samples of a
// frame of several receivers a pixel are worth most.
#include "host/render/distributed_samples.h"

#include "host/render/filters/count_scale.h"
#include "host/render/filters/filter_graph.h"

#include <algorithm>
#include <cmath>

namespace wedge::render {

using device::PassKind;
using graph::around;
using graph::reads;
using graph::updates;
using graph::value;
using graph::writes;

void DistributedSamples::publishedCounts()
{
    const DistributedSettings& d = f_.settings.distributed;
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        TermMeans& m = term->means;
        auto flags = f_.graph.plane<Share>("flags", graph::floats);
        f_.pixels("widths", PassKind::Analysis, { "analysis/published.cl", "publishedFlags" },
            { pixels(), reads("texture", m.texture), reads("value", m.value), reads("termRadiance", m.radiance),
                writes("flags", flags) });
        term->publishedWidths(params(), flags, confusion_);
        if (hasFixedCounts()) {
            f_.fill("counts", m.demand, 0.0f); // what is taken is all
        }
    }
    const auto most = static_cast<std::uint32_t>(d.maxSpp);
    f_.pixels("counts", PassKind::Analysis, { "analysis/published.cl", "publishedPrimary" },
        { pixels(), value("mu", d.mu), value("mixed", static_cast<float>(d.mixedPaths)), reads("confusion", confusion_),
            reads("motion", motion_), reads("motionSpread", motionSpread_), writes("demand", demand_) });
    const auto count = [&](const graph::Handle<Demand>& demand, const graph::Handle<Count>& least,
                           const graph::Handle<Count>& taken, graph::Handle<Count>& wanted) {
        f_.pixels("counts", PassKind::Analysis, { "analysis/published.cl", "publishedCounts" },
            { pixels(), value("most", most), reads("demand", demand, around(1)), reads("least", least),
                reads("taken", taken), writes("wanted", wanted) });
    };
    count(demand_, counts_.taken, counts_.taken, counts_.wanted);
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        count(term->means.demand, counts_.wanted, term->means.taken, term->means.wanted);
    }
}

void DistributedSamples::widths(const std::vector<TermMeans>& all)
{
    const int reach = f_.settings.distributed.factoringRadius;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        const std::unique_ptr<WaveTerm>& term = terms_[i];
        TermMeans& m = term->means;
        graph::Version error = m.error;
        if (!f_.lean) {
            auto made = f_.graph.plane<Value>("error of taking apart", graph::floats);
            f_.pixels("widths", PassKind::Analysis, { "waves/distributed.cl", "factoringError" },
                { pixels(), reads("texture", m.texture), reads("value", all[i].value), reads("plain", m.plain),
                    writes("error", made) });
            error = made;
        }
        term->widths();
        f_.pixels("widths", PassKind::Analysis, { "waves/distributed.cl", "factoredWidths" },
            { pixels(), reads("error", error, around(reach)), reads("confusion", confusion_),
                reads("pixelSize", f_.surfaces.pixelSize), reads("objectId", f_.surfaces.objectId, around(reach)),
                updates("beta", m.beta) });
    }
}

void DistributedSamples::demandOfTerm(WaveTerm& term, const Blurs& blurs, graph::Handle<Squares>& ofTextures)
{
    TermMeans& m = term.means;
    const graph::Argument p = f_.rectangle(term.of(params()));
    auto ofTexture = f_.graph.plane<Squares>("variance of texture", graph::floats);
    auto ofIrradiance = f_.graph.plane<Value>("variance of irradiance", graph::floats);
    f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "splitVariance" },
        { p, reads("texture", m.texture), reads("value", m.value),
            shape_.compact ? reads("spreads", m.spreads) : graph::absent("spreads", shortPairs),
            shape_.compact ? graph::absent("squares") : reads("squares", m.squares),
            shape_.compact ? graph::absent("textureSquares") : reads("textureSquares", m.textureSquares),
            reads("taken", counts_.taken), writes("ofTexture", ofTexture), writes("ofIrradiance", ofIrradiance) });
    f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "addPlane" },
        { p, reads("part", ofTexture), updates("sum", ofTextures) });
    const auto effective = gatheredCounts(f_, "pixels gathered", PassKind::Analysis,
        filterParams(f_.settings, f_.wholeFrame(), f_.graph.image()), m.beta);
    demandOfRays(p, ofIrradiance, effective, m.beta, blurs, m.uncertainty, m.demand);
}

void DistributedSamples::demandOfRays(const graph::Argument& p, const graph::Version& variance,
    const graph::Version& effective, const graph::Handle<Metres>& beta, const Blurs& blurs,
    graph::Handle<Uncertainty>& uncertainty, graph::Handle<Demand>& demand)
{
    uncertainty = f_.graph.plane<Uncertainty>("uncertainty", graph::floats);
    f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "uncertaintyOfRays" },
        { p, reads("variance", variance), reads("effective", effective), reads("beta", beta), reads("lens", blurs.lens),
            keepsMotion() ? reads("along", blurs.along) : graph::absent("along"), writes("uncertainty", uncertainty) });
    shared::AnalysisParams params = f_.analysisParams();
    params.countExponent = f_.settings.distributed.countExponent;
    params.varianceSpread = f_.settings.distributed.varianceSpread;
    demandOf(f_, params, uncertainty, { .oneObject = false, .ownToo = false }, demand);
}

void DistributedSamples::demands()
{
    shared::DistributedParams p = params();
    p.rays = 1.0f;
    p.alongMotion = keepsMotion() ? 1 : 0;
    const graph::Argument pixels = f_.rectangle(p);
    const auto plane = [&](const char* name) { return f_.graph.plane<Squares>(name, graph::floats); };
    // Of what pixels will have: there are more samples to come.
    Blurs own { f_.graph.plane<Pixels>("lens filter width to come", graph::floats),
        f_.graph.plane<Pixels>("motion filter width to come", graph::floats),
        f_.graph.plane<Pixels>("direction of motion", f_.lean ? shortPairs : graph::pairs) };
    blurs(static_cast<float>(f_.settings.spp), own);
    auto ofTextures = plane("variance of textures");
    const auto variance = [&](const graph::Handle<Radiance>& image, const graph::Handle<Squares>& squares,
                              graph::Handle<Squares>& out) {
        f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "emissionVariance" },
            { pixels, reads("emission", image), reads("squares", squares), reads("taken", counts_.taken),
                writes("variance", out) });
    };
    if (lit_) {
        variance(f_.surfaces.emission, emissionSquares_, ofTextures);
    } else {
        f_.zero(ofTextures); // what emits is not shown
    }
    for (const Added& added : added_) {
        auto ofLight = f_.graph.plane<Squares>("variance of " + added.of.name, graph::floats);
        variance(added.radiance, added.squares, ofLight);
        f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "addPlane" },
            { pixels, reads("part", ofLight), updates("sum", ofTextures) });
    }
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        demandOfTerm(*term, own, ofTextures);
    }
    // Nothing but lens and shutter averages textures and what emits.
    auto none = f_.graph.plane<Metres>("no widths", graph::floats);
    f_.fill("counts", none, -1.0f);
    demandOfRays(pixels, ofTextures, ofTextures, none, own, uncertainty_, demand_);
    const DistributedSettings& d = f_.settings.distributed;
    const auto atLeast = [&](float apart, float together, const TermMeans& term, const graph::Handle<Demand>& least,
                             graph::Handle<Demand>& demand) {
        f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "atLeast" },
            { pixels, value("apart", apart), value("together", together), reads("beta", term.beta),
                reads("least", least), updates("demand", demand) });
    };
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        atLeast(d.leastPrimaries, d.leastPrimaries, term->means, term->means.demand, demand_);
    }
    // Where a term is not taken apart its texture is known at receivers that sample it alone.
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        atLeast(d.leastSecondaries, 1.0f, term->means, demand_, term->means.demand);
    }
}

void DistributedSamples::counts(const DistributedSamples& guide)
{
    demands();
    const DistributedSettings& d = f_.settings.distributed;
    const auto spp = static_cast<float>(f_.settings.spp);
    const auto first = static_cast<float>(std::min(d.firstPaths, f_.settings.spp));
    const auto most =
        static_cast<float>(std::max(d.maxSpp, f_.settings.spp)); // no pixel can keep below the mean of all
    const auto leastOf = [&](float share) { return std::max(first, std::floor(share * spp)); };
    const float leastOfTerms = leastOf(std::max(d.leastShare, d.leastTermShare));
    // Samples of terms go to new receivers: one at least.
    const float least = std::min(std::max(leastOf(d.leastShare), first + 1.0f), spp);
    std::vector<AskedSamples> kinds { { guide.demand_, 1.0f, least, &counts_.wanted, counts_.taken, uncertainty_ } };
    for (std::size_t i = 0; i < terms_.size(); ++i) {
        TermMeans& m = terms_[i]->means;
        kinds.push_back(
            { guide.terms_[i]->means.demand, terms_[i]->rays, leastOfTerms, &m.wanted, m.taken, m.uncertainty });
    }
    // What uniform counts would take.
    countsFromDemands(f_, kinds, { static_cast<float>(raysOfPath() * f_.settings.spp), most });
    if (f_.settings.progressive) {
        f_.pixels("counts", PassKind::Analysis, { "waves/distributed.cl", "limitStep" },
            { pixels(), reads("taken", counts_.taken), updates("wanted", counts_.wanted) });
    }
}

} // namespace wedge::render
