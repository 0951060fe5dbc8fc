#include "host/render/distributed_samples.h"

#include "host/render/seen_lights.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using graph::reads;
using graph::Run;
using graph::updates;
using graph::value;

namespace {

// Samples of a pixel between two looks at what the image would be if the render stopped.
constexpr std::uint32_t monteCarloRound = 16;

constexpr std::uint32_t allSamples = std::numeric_limits<std::uint32_t>::max();

bool somethingMoves(const scene::Scene& scene) { return scene::geometryMoves(scene) || scene::cameraMoves(scene); }

} // namespace

bool isDistributed(const Settings& settings, const scene::Scene& scene)
{
    return scene.camera.apertureRadius > 0 || somethingMoves(scene) || settings.antialias || settings.progressive;
}

SampleShape sampleShape(const Settings& settings, const scene::Scene& scene, bool keepLayers, bool apart)
{
    SampleShape shape;
    shape.analysed = settings.method == Method::AxisAligned;
    shape.published = shape.analysed && settings.distributed.published;
    // Counts from the spectrum, published slopes and widths from the nearest reflectors need more than one image does.
    const bool usual = !settings.distributed.published && settings.slopes == Slopes::Smoothed
        && !(settings.sampling == Sampling::Adaptive && settings.counts == Counts::Spectrum)
        && settings.indirect.meanFraction > 0;
    shape.layers = keepLayers;
    shape.parts = keepLayers || hasStage(settings.filters, Stage::Frame);
    shape.apart = shape.parts || apart;
    shape.full = keepLayers || settings.progressive || (shape.analysed && !usual);
    shape.compact = shape.analysed && usual && !keepLayers;
    shape.moves = somethingMoves(scene);
    shape.geometryMoves = scene::geometryMoves(scene);
    return shape;
}

DistributedSamples::DistributedSamples(FrameBuilder& frame, const SampleShape& shape, const Before& before)
    : f_(frame)
    , shape_(shape)
    , before_(before)
    , camera_(cameraParams(frame.description, frame.layout.height, pixelFilterOf(frame.settings)))
    , lit_(frame.settings.integrator == Integrator::Path)
{
    f_.lean = shape.lean();
    f_.host(
        "samples", [state = state_, analysed = shape.analysed && before.taken > 0, complete = before.taken > 0](Run&) {
            state->analysed = analysed;
            state->complete = complete;
        });
    keepPixels();
    f_.precomputeDirections();
    const std::vector<Term> terms = frameTerms(frame.settings, frame.description);
    for (const Term& term : terms) {
        terms_.push_back(term.inWaves(frame, shape));
        terms_.back()->termName = term.name;
    }
    direct_ = countOf(Part::Direct, terms);
    const auto demand = [&](const char* name) {
        return before.guides && shape.analysed ? kept<Demand>(name, graph::floats)
                                               : f_.graph.plane<Demand>(name, graph::floats);
    };
    demand_ = demand("primary demand");
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        keepTerm(*term);
        keepBins(*term);
        term->means.demand = demand("demand");
    }
}

template <class Quantity>
graph::Handle<Quantity> DistributedSamples::kept(
    const std::string& name, const graph::Format& format, std::uint64_t elements)
{
    if (before_.memory == nullptr) {
        auto plane =
            elements == 0 ? f_.graph.plane<Quantity>(name, format) : f_.graph.list<Quantity>(name, format, elements);
        f_.zero(plane);
        return plane;
    }
    const std::uint64_t bytes = (elements == 0 ? f_.layout.size : elements) * format.bytes;
    auto plane = f_.graph.imported<Quantity>(name, format, before_.memory->next(name, bytes), elements);
    if (before_.taken == 0) {
        f_.zero(plane);
    }
    return plane;
}

void DistributedSamples::keepPixels()
{
    Surfaces& s = f_.surfaces;
    s.position = kept<Position>("position", graph::vectors);
    s.normal = kept<Normal>("normal", f_.normals(shape_.compact));
    s.objectId = kept<ObjectId>("object id", graph::counts);
    s.emission = kept<Radiance>("emission", graph::vectors);
    counts_.taken = kept<Count>("primary samples taken", graph::counts);
    hits_ = kept<Count>("hits", shape_.compact ? shortCounts : graph::counts);
    confusion_ = kept<Pixels>("circles of confusion", shape_.compact ? shortRanges : graph::pairs);
    if (shape_.measures()) {
        s.pixelSize = kept<Metres>("pixel size", shape_.compact ? shortFloats : graph::floats);
        s.gloss = kept<Gloss>("gloss", shape_.compact ? shortGloss : wholeGloss);
        emissionSquares_ = kept<Squares>("emission squares", graph::floats);
    }
    if (keepsMotion()) {
        motion_ = kept<Pixels>("motion", f_.lean ? shortPairs : graph::pairs);
        if (!f_.lean) {
            motionSpread_ = kept<Pixels>("differences of motions", graph::floats);
        }
    }
    for (Unfiltered& of : frameUnfiltered(f_.settings, f_.description)) {
        auto radiance = kept<Radiance>(of.name, graph::vectors);
        auto squares = kept<Squares>("squares of " + of.name, graph::floats);
        added_.push_back({ std::move(of), radiance, squares });
    }
    if (shape_.apart) {
        const graph::Format& format = shape_.compact ? packedColours : graph::vectors;
        s.diffuse = kept<Reflectance>("diffuse", format);
        s.specular = kept<Reflectance>("specular", format);
    }
    Totals& t = f_.totals;
    if (sampleFilterOf(f_.settings).filter != nullptr) {
        t.notFinite = kept<Count>("samples not finite", graph::counts);
    }
    if (shape_.layers) {
        s.depth = kept<Metres>("depth", graph::floats);
        t.samples = kept<Count>("samples", graph::counts);
        t.indirectSamples = kept<Count>("indirect samples", graph::counts);
        t.rays = kept<Count>("rays", graph::counts);
        t.pathRays = kept<Count>("path rays", graph::counts);
    } else {
        // Sums are all that is of interest.
        const std::uint64_t pixels = std::min<std::uint64_t>(
            WaveSchedule::capacity, std::uint64_t { WEDGE_TILE_PIXELS } * f_.wholeFrame().tileCount);
        t.rays = kept<Count>("rays", graph::counts, pixels);
        t.pathRays = kept<Count>("path rays", graph::counts, pixels);
    }
}

void DistributedSamples::keepTerm(WaveTerm& term)
{
    TermMeans& m = term.means;
    // Means that samples are added to again and again have more bits than those that are made once.
    const bool fraction = term.isFraction(), compact = shape_.compact;
    const graph::Format fractions = shape_.full ? packedColours : packedFractions;
    m.texture = kept<Texture>("texture", !compact ? graph::vectors : fraction ? packedColours : fractions);
    m.value = kept<Value>("value", !compact ? graph::vectors : fraction ? fractions : packedColours);
    if (shape_.lean()) {
        m.error = kept<Value>("error of taking apart", shortFloats);
    } else if (shape_.measures()) {
        m.plain = kept<Value>("plain mean", graph::floats);
    }
    if (compact) {
        m.spreads = kept<Deviation>("spreads", shortPairs);
    } else if (shape_.measures()) {
        m.squares = kept<Squares>("squares", graph::floats);
        m.textureSquares = kept<Squares>("texture squares", graph::floats);
    }
    if (compact && term.oneExtreme()) {
        m.extreme = kept<Extremes>("slope or distance", shortFloats);
    } else if (shape_.measures()) {
        m.extremes = kept<Extremes>("slopes or distances", term.extremesFormat());
    }
    if (term.shadowsMove() && shape_.lean()) {
        m.shadowMotion = kept<Pixels>("motion of shadows", shortPairs);
    } else if (term.shadowsMove() && shape_.measures()) {
        m.shadowSums = kept<Pixels>("sums of shadows' motions", graph::floatPlanes(4));
    }
    if (shape_.analysed && !shape_.published) {
        m.deviation = kept<Deviation>("deviation", compact ? shortFloats : graph::floats);
    }
    if (shape_.published) {
        m.radiance = kept<Radiance>("radiance of the term", graph::vectors);
    }
    if (shape_.full) {
        m.taken = kept<Count>("samples taken", graph::counts);
    }
}

void DistributedSamples::keepBins(WaveTerm& term)
{
    const ChosenSampleFilter chosen = sampleFilterOf(f_.settings, term.target());
    if (chosen.filter != nullptr) {
        const auto bins = kept<Packed>("samples by brightness", sampleBins);
        term.bins.emplace(f_, chosen, bins, kept<Share>("exposure of samples", graph::floats, 1));
    }
}

std::function<bool(const Run&)> DistributedSamples::analysed() const
{
    return [state = state_](const Run&) { return state->analysed; };
}

bool DistributedSamples::hasFixedCounts() const
{
    return shape_.published && !shape_.moves && f_.description.camera.apertureRadius <= 0 && !f_.settings.progressive
        && !terms_.empty() && std::ranges::all_of(terms_, [](const std::unique_ptr<WaveTerm>& term) {
               return term->publishedSamples() > 0;
           });
}

std::uint32_t DistributedSamples::firstPaths() const
{
    constexpr std::uint32_t fixed = 4;
    return hasFixedCounts() ? fixed
                            : static_cast<std::uint32_t>(std::min(f_.settings.distributed.firstPaths, f_.settings.spp));
}

shared::DistributedParams DistributedSamples::params() const
{
    const DistributedSettings& d = f_.settings.distributed;
    shared::DistributedParams p {};
    p.width = f_.layout.width;
    p.height = f_.layout.height;
    p.stride = f_.layout.stride;
    p.planeSize = static_cast<std::uint32_t>(f_.layout.size);
    p.factoringError = d.factoringError;
    p.factoringRadius = static_cast<std::uint32_t>(d.factoringRadius);
    p.blurWidth = d.blurWidth;
    p.blurExponent = d.blurExponent;
    p.shutterWidth = d.shutterWidth;
    p.shutterExponent = d.shutterExponent;
    p.leastRadius = d.leastRadius;
    p.irradianceWidth = d.irradianceWidth;
    p.oneVelocity = d.oneVelocity;
    p.published = d.published ? 1 : 0;
    p.frames = static_cast<float>(d.frames);
    p.never = d.factoring == Factoring::Never ? 1 : 0;
    return p;
}

void DistributedSamples::take(const DistributedSamples* guide)
{
    if (shape_.analysed && !shape_.published && lit_) {
        seenLights_ = seenLights(f_, camera_);
    }
    exposeBins();
    if (shape_.analysed) {
        adaptive(guide);
    } else {
        monteCarlo();
    }
    if (before_.guides && shape_.analysed) {
        f_.graph.want(demand_, f_.graph.image());
        for (const std::unique_ptr<WaveTerm>& term : terms_) {
            f_.graph.want(term->means.demand, f_.graph.image());
        }
    }
    f_.host("sampled", [state = state_](Run& run) { state->complete = state->complete || !run.cut(); });
}

void DistributedSamples::monteCarlo()
{
    const auto spp = static_cast<std::uint32_t>(f_.settings.spp);
    counts_.wanted = f_.graph.plane<Count>("primary samples wanted", graph::counts);
    f_.fill("counts", counts_.wanted, spp);
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        term->means.wanted = f_.graph.plane<Count>("samples wanted", graph::counts);
        f_.fill("counts", term->means.wanted, spp);
    }
    const std::uint32_t before = before_.taken, more = spp > before ? spp - before : 0;
    const auto last = [before, spp](std::size_t round) {
        return static_cast<std::uint32_t>(
            std::min<std::uint64_t>(spp, before + (std::uint64_t { round } + 1) * monteCarloRound));
    };
    sample(false, counts_,
        { .rounds = (more + monteCarloRound - 1) / monteCarloRound,
            .last = last,
            .most = static_cast<double>(std::min(more, monteCarloRound)),
            .workUnits = static_cast<double>(more) });
}

void DistributedSamples::adaptive(const DistributedSamples* guide)
{
    const std::uint32_t first = firstPaths();
    const bool fixed = hasFixedCounts();
    if (before_.taken < first) {
        // Of lean frames the wave says what is wanted.
        PrimaryCounts counts { counts_.taken, counts_.taken };
        if (!f_.lean) {
            counts.wanted = f_.graph.plane<Count>("primary samples wanted first", graph::counts);
            f_.fill("counts", counts.wanted, first);
            for (const std::unique_ptr<WaveTerm>& term : terms_) {
                term->means.wanted = f_.graph.plane<Count>("samples wanted first", graph::counts);
                f_.fill("counts", term->means.wanted, fixed ? term->publishedSamples() : first);
            }
        }
        sample(true, counts,
            { .last = [first, fixed](std::size_t) { return fixed ? allSamples : first; },
                .most = static_cast<double>(first),
                .workUnits = static_cast<double>(first),
                .everywhere = true });
        counts_.taken = counts.taken;
        f_.host("analysable", [state = state_](Run& run) { state->analysed = !run.cut(); });
    }
    counts_.wanted = f_.graph.plane<Count>("primary samples wanted", graph::counts);
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        TermMeans& m = term->means;
        m.wanted = f_.graph.plane<Count>("samples wanted", graph::counts);
        m.beta = f_.graph.plane<Metres>("filter width", graph::floats);
        if (!shape_.full) {
            m.taken = counts_.taken;
        }
    }
    f_.graph.only("analysis", analysed(), [&] {
        if (shape_.published) {
            publishedCounts();
        } else {
            const std::vector<TermMeans> all = keepSamples();
            widths(all);
            counts(guide != nullptr ? *guide : *this);
            goOnWith(all);
        }
        limitTiles(f_, counts_, roomOfWaves(f_.layout, mostNew()));
    });
    const double units = f_.settings.spp - static_cast<double>(std::max(before_.taken, first));
    sample(false, counts_, { .last = [](std::size_t) { return allSamples; }, .most = mostNew(), .workUnits = units });
}

double DistributedSamples::mostNew() const
{
    const double most = std::max(f_.settings.distributed.maxSpp, f_.settings.spp);
    // Counts of our own keep within a budget of rays; they are rounded to whole samples.
    return shape_.published ? most : std::min(most, raysOfPath() * f_.settings.spp + 1.0);
}

double DistributedSamples::raysOfPath() const
{
    double rays = 1.0;
    for (const std::unique_ptr<WaveTerm>& term : terms_) {
        rays += term->rays;
    }
    return rays;
}

void DistributedSamples::sample(bool first, PrimaryCounts& counts, Waves::Sampling sampling)
{
    const bool measures = shape_.full ? shape_.measures() : first;
    const Adding adding { first, measures };
    shared::WaveParams settings {};
    settings.sampler = waveSampler(f_.settings);
    settings.published = shape_.published ? 1 : 0;
    settings.alike = first && f_.lean ? 1 : 0;
    settings.oneVelocity = f_.settings.distributed.oneVelocity;
    sampling.terms = terms_.size();
    sampling.seenLights = seenLights_;
    Waves waves(f_, settings, camera_, counts, std::move(sampling));
    waves.declare(lit_, [&] {
        for (std::size_t i = 0; i < direct_; ++i) {
            terms_[i]->sample(waves, adding, counts, hits_);
        }
        addUnfiltered(waves);
        for (std::size_t i = direct_; i < terms_.size(); ++i) {
            terms_[i]->sample(waves, adding, counts, hits_);
        }
        accumulateSurfaces(waves, adding);
    });
}

void DistributedSamples::addUnfiltered(Waves& waves)
{
    for (Added& added : added_) {
        auto radiance = waves.list<Radiance>("radiance", graph::vectors);
        f_.zero(radiance);
        added.of.sample(f_, waves, radiance);
        waves.pixels("accumulateDelta",
            joined({ waves.pixelParams(), waves.params() }, waves.pixelLists(reads("taken", waves.counts().taken)),
                Arguments { reads("objectId", waves.receivers().objectId), reads("lit", radiance),
                    updates("delta", added.radiance), updates("deltaSquares", added.squares) }));
    }
}

void DistributedSamples::accumulateSurfaces(Waves& waves, const Adding& adding)
{
    Surfaces& s = f_.surfaces;
    const auto kept = [](bool keep, const char* name, graph::Version& plane, const graph::Format& format) {
        return keep ? updates(name, plane) : graph::absent(name, format);
    };
    const bool measures = adding.measures, layers = shape_.layers, moves = keepsMotion();
    waves.pixels("accumulateSurfaces",
        joined(
            { waves.pixelParams(), waves.params(), value("camera", camera_), value("raysOfImage", layers ? 1u : 0u) },
            waves.pixelLists(updates("taken", waves.counts().taken)), waves.receiverSurfaces(),
            graph::group("kept",
                { updates("hits", hits_), updates("objectId", s.objectId), updates("position", s.position),
                    updates("normal", s.normal), kept(measures, "gloss", s.gloss, wholeGloss),
                    kept(shape_.apart, "diffuse", s.diffuse, graph::vectors),
                    kept(shape_.apart, "specular", s.specular, graph::vectors), updates("emission", s.emission),
                    kept(measures, "emissionSquares", emissionSquares_, graph::floats),
                    kept(measures, "pixelSize", s.pixelSize, graph::floats),
                    kept(layers, "distance", s.depth, graph::floats), updates("confusion", confusion_),
                    kept(moves, "motion", motion_, shortPairs),
                    kept(moves && !f_.lean, "motionSpread", motionSpread_, graph::floats),
                    updates("rays", f_.totals.rays), updates("pathRays", f_.totals.pathRays) })));
}

} // namespace wedge::render
