#include "effects/indirect/path_pixels.h"

#include "host/render/filters/curvature.h"
#include "host/render/sinks.h"
#include "kernels/shared/environment.h"
#include "kernels/shared/indirect.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

// Of a pixel's paths between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr int sliceVertices = 96;

constexpr std::uint32_t channels = 3;

} // namespace

PathPixels::PathPixels(FrameBuilder& frame, Component component)
    : PixelTerm(frame, { "paths", "paths", "first paths", "second paths" },
        isDirect(component) ? frame.totals.direct : frame.totals.indirect,
        { .sums = channels + 1, .values = channels, .extremes = 3, .part = packedColours })
    , component_(component)
    , reflectance_(isGlossy(component) ? frame.surfaces.specular : frame.surfaces.diffuse)
    , vertices_(isDirect(component) ? 1 : std::max(1, frame.settings.bounces))
    , axes_ { g_.plane<Metres>("width along x", graph::floats), g_.plane<Metres>("width along y", graph::floats) }
    , irradiance_(g_.plane<Value>("irradiance", graph::floats))
    , deviation_(g_.plane<Deviation>("deviation", graph::floats))
    , weights_(g_.plane<Share>("weights", graph::floats))
    , whole_(g_.plane<Value>("what lobes would see", graph::floats))
{
}

PixelTerm::Sampler PathPixels::sampler()
{
    return { .kernel = { "paths/indirect.cl", "samplePaths" },
        .arguments = pathSamples(f_, pixels_, pathParams(f_, component_), component_),
        .rays = { pixels_.tallyRays(), pixels_.tallyPathRays() },
        .measures = sinks::distances(),
        .measured = "reflectors",
        .slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / vertices_)),
        .workUnits = static_cast<double>(vertices_) };
}

PixelTerm::CountsFrom PathPixels::countsFrom() const
{
    if (takesFirstPathsOnly(component_, s_)) {
        return CountsFrom::Nothing;
    }
    if (isUniform()) {
        return CountsFrom::Mean;
    }
    return s_.indirect.counts == IndirectCounts::Variance ? CountsFrom::Variance : CountsFrom::Spectrum;
}

std::uint32_t PathPixels::mostSamples() const
{
    const int most = isUniform() ? s_.spp : std::max(s_.indirect.maxSpp, s_.spp);
    // Memory has room for as many of every pixel of a band. With four times the mean caustics err by a tenth more.
    constexpr std::int64_t mostOfStored = 8;
    const bool stored = sampleFilter().filter != nullptr;
    return static_cast<std::uint32_t>(stored ? std::min<std::int64_t>(most, mostOfStored * s_.spp) : most);
}

shared::AnalysisParams PathPixels::countParams() const
{
    shared::AnalysisParams p = pathCountParams(f_.analysisParams(), component_, s_);
    if (sampleFilter().filter != nullptr) {
        p.countCap = std::max(mostSamples(), p.leastCount);
    }
    return p;
}

void PathPixels::start()
{
    f_.zero(beta_); // widths that filter nothing, where the first paths were stopped
    if (byCurvature()) {
        f_.zero(axes_.x, axes_.y);
    }
    unshadowed();
}

void PathPixels::unshadowed()
{
    const bool lobes = isOfFractions(f_, component_);
    if (!lobes && !isRelative(component_, s_)) {
        return;
    }
    auto reflectance = g_.plane<Reflectance>("reflectance times unshadowed light", graph::vectors);
    const Surfaces& s = f_.surfaces;
    if (lobes) {
        f_.pixels("composite", PassKind::Composite, { "light/unshadowed_environment.cl", "lobesOfPixels" },
            joined({ f_.rectangle(countParams()), value("frame", f_.wholeFrame()), value("rings", lobeRings(s_.spp)) },
                f_.beyond(),
                Arguments { reads("position", s.position), reads("normal", s.normal), reads("gloss", s.gloss),
                    reads("specular", s.specular), writes("unshadowed", reflectance), writes("whole", whole_) }));
    } else {
        f_.blocks("composite", PassKind::Composite, { "light/unshadowed_environment.cl", "environmentOfPixels" },
            joined({ f_.rectangle(countParams()) }, f_.beyond(),
                Arguments {
                    reads("normal", s.normal), reads("diffuse", s.diffuse), writes("unshadowed", reflectance) }));
    }
    reflectance_ = reflectance;
}

void PathPixels::correctLobes()
{
    if (!isOfFractions(f_, component_)) {
        return;
    }
    const graph::Reach near = graph::around(WEDGE_LOBE_REACH);
    f_.pixels("composite", PassKind::Composite, { "light/unshadowed_environment.cl", "correctLobes" },
        { f_.rectangle(countParams()), reads("specular", f_.surfaces.specular), reads("sums", sums_, near),
            reads("taken", taken_, near), reads("objectId", f_.surfaces.objectId, near), reads("whole", whole_, near),
            updates("unshadowed", reflectance_) });
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addLobeSamples" },
        { f_.rectangle(countParams()), value("firstPass", firstPathsOf(component_, s_)),
            reads("specular", f_.surfaces.specular), reads("sums", sums_), reads("parts", parts_),
            reads("taken", taken_), updates("noisy", sum_.noisy), updates("deviation", sum_.deviation) });
}

void PathPixels::widths()
{
    if (byCurvature()) {
        const bool smooth = s_.environment.widths == EnvironmentWidths::Corrected;
        curvatureWidths(f_, curvatureParams(f_, component_), smooth ? smoothedOccluders(f_, extremes_) : extremes_,
            taken_, axes_, beta_);
    } else {
        reflectorWidths(f_, reflectorParams(), extremes_, taken_, beta_);
    }
    if (countsFrom() == CountsFrom::Spectrum) {
        reflectorCounts(f_, reflectorParams(), extremes_, taken_, wanted_);
    }
}

PixelTerm::Uncertain PathPixels::uncertainty()
{
    const shared::AnalysisParams counts = countParams();
    auto variance = g_.plane<Value>("variance", graph::floats);
    f_.blocks("counts", PassKind::Analysis, { "paths/reflectors.cl", "sampleVariance" },
        { f_.rectangle(reflectorParams()), reads("sums", sums_), reads("taken", taken_),
            reads("reflectance", reflectance_), writes("variance", variance) });
    auto effective = g_.plane<Count>("effective count of variance", graph::floats);
    if (s_.filtering != Filtering::None) {
        effective = gatheredCounts(f_, "pixels gathered", PassKind::Analysis, filterParams(), beta_);
    } else {
        f_.fill("ones", effective, 1.0f);
    }
    auto uncertainty = g_.plane<Uncertainty>("uncertainty", graph::floats);
    f_.blocks("counts", PassKind::Analysis, { "analysis/demand.cl", "uncertaintyOf" },
        { f_.rectangle(counts), reads("variance", variance), reads("effective", effective), reads("beta", beta_),
            writes("uncertainty", uncertainty) });
    return { uncertainty, counts, { .oneObject = true, .ownToo = false } };
}

void PathPixels::means()
{
    correctLobes();
    if (varies()) {
        deviations();
    }
}

void PathPixels::addPlain()
{
    addSamples();
    add(value_);
}

void PathPixels::addFiltered()
{
    if (widensHere()) {
        // What was stopped early has not the counts that the parts of samples were made for.
        g_.only(
            "widening", [state = state()](const Run& run) { return state->analysed && !run.cut(); },
            [&] { widened(); });
    }
    if (!isOfFractions(f_, component_)) {
        addSamples(); // not before: widening takes the most memory
    }
    add(filtered());
}

void PathPixels::widened()
{
    widen(f_, "filter of indirect", filterParams(), wideningOf(component_, s_), pinholeNoise,
        { irradiance_, deviation_, weights_ }, beta_);
}

graph::Handle<Value> PathPixels::filtered()
{
    shared::FilterParams params = filterParams();
    params.fitted = std::min(params.fitted, channels); // of the variance the mean, which is not negative
    const std::uint32_t planes = varies() ? channels + 1 : channels;
    const FilterRun run { "filter of indirect", PassKind::Filter };
    return byCurvature() ? gaussianFilter(f_, run, planes, params, value_, axes_).value
                         : gaussianFilter(f_, run, planes, params, value_, beta_).value;
}

void PathPixels::deviations()
{
    f_.blocks("filter of indirect", PassKind::Filter, { "analysis/widening.cl", "oneOfPaths", {}, f_.surfaceFormats() },
        { f_.rectangle(countParams()), component(), value("fractions", isOfFractions(f_, component_) ? 1u : 0u),
            value("firstPass", firstPathsOf(component_, s_)), reads("reflectance", reflectance_),
            updates("value", sums_), reads("parts", parts_), reads("taken", taken_), writes("irradiance", irradiance_),
            writes("deviation", deviation_), writes("weights", weights_) });
    value_ = graph::Handle<Value> { static_cast<const graph::Version&>(sums_) };
}

void PathPixels::addSamples()
{
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addPathSamples" },
        { f_.rectangle(countParams()), component(), reads("reflectance", reflectance_), reads("value", value_),
            varies() ? reads("deviations", deviation_) : graph::absent("deviations"), reads("taken", taken_),
            updates("indirectNoisy", sum_.noisy), updates("deviation", sum_.deviation) });
}

void PathPixels::add(const graph::Handle<Value>& shown)
{
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addIndirect" },
        { f_.rectangle(countParams()), component(), value("varies", varies() ? 1u : 0u),
            reads("reflectance", reflectance_), reads("value", shown), reads("taken", taken_),
            updates("indirect", sum_.filtered), updates("variance", sum_.variance) });
    addTermFilters(shown);
}

void PathPixels::addTermFilters(const graph::Handle<Value>& shown)
{
    if (!isFiltered(s_, target().name)) {
        return;
    }
    const char* pass = "filters of terms";
    auto arrives = g_.plane<Radiance>("what arrives", graph::vectors);
    f_.blocks(pass, PassKind::Filter, { "frame/composite.cl", "arrivingAtPixels" },
        { f_.rectangle(countParams()), component(), reads("value", shown), reads("taken", taken_),
            writes("arrives", arrives) });
    const graph::Handle<Radiance> filtered = filteredImage(f_, target().name, arrives);
    f_.blocks(pass, PassKind::Filter, { "frame/composite.cl", "addTermChange" },
        { f_.rectangle(countParams()), component(), reads("reflectance", reflectance_), reads("before", arrives),
            reads("after", filtered), reads("taken", taken_), updates("change", sum_.change) });
}

} // namespace wedge::render
