#include "effects/indirect/path_graph.h"

#include "host/render/filters/count_scale.h"
#include "host/render/filters/curvature.h"
#include "host/render/filters/filter_graph.h"
#include "host/render/filters/widening.h"
#include "host/render/sample_slices.h"
#include "host/render/sinks.h"
#include "kernels/shared/environment.h"
#include "kernels/shared/indirect.h"

#include <algorithm>

namespace wedge::render {

using device::PassKind;
using graph::reads;
using graph::Run;
using graph::tallies;
using graph::updates;
using graph::value;
using graph::writes;

namespace {

// Vertices of a pixel's paths between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr int sliceVertices = 96;

constexpr std::uint32_t channels = 3;

/// One component of a frame that is being declared.
class PathGraph {
public:
    PathGraph(
        FrameBuilder& frame, Component component, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta)
        : f_(frame)
        , g_(frame.graph)
        , s_(frame.settings)
        , component_(component)
        , reflectance_(isGlossy(component) ? frame.surfaces.specular : frame.surfaces.diffuse)
        , sum_(isDirect(component) ? frame.totals.direct : frame.totals.indirect)
        , vertices_(isDirect(component) ? 1 : std::max(1, frame.settings.bounces))
        , state_(state)
        , beta_(beta)
        , axes_ { g_.plane<Metres>("width along x", graph::floats), g_.plane<Metres>("width along y", graph::floats) }
        , sums_(g_.plane<Sums>("sums", graph::floatPlanes(4)))
        , value_(g_.plane<Value>("value", graph::floatPlanes(channels)))
        , parts_(g_.plane<Value>("value of part", packedColours))
        , extremes_(g_.plane<Extremes>("distances", graph::floatPlanes(3)))
        , taken_(g_.plane<Count>("samples taken", graph::counts))
        , rays_(g_.plane<Count>("rays of light", graph::counts))
        , pathRays_(g_.plane<Count>("rays of paths", graph::counts))
        , wanted_(g_.plane<Count>("samples wanted", graph::counts))
        , irradiance_(g_.plane<Value>("irradiance", graph::floats))
        , deviation_(g_.plane<Deviation>("deviation", graph::floats))
        , weights_(g_.plane<Share>("weights", graph::floats))
        , whole_(g_.plane<Value>("what lobes would see", graph::floats))
    {
    }

    void declare()
    {
        f_.zero(sums_, taken_, rays_, pathRays_);
        if (!f_.analysed() || !varies()) {
            f_.zero(value_);
        }
        if (!f_.analysed()) {
            declarePlain();
            return;
        }
        firstPaths();
        wanted_ = g_.plane<Count>("samples wanted", graph::counts); // no version of the first: that ends here
        const auto analysed = [state = state_](const Run&) { return state->analysed; };
        g_.only("analysis of paths", analysed, [&] { widthsAndCounts(); });
        if (!takesFirstPathsOnly(component_, s_)) {
            const int most = isUniform() ? s_.spp : std::max(s_.indirect.maxSpp, s_.spp);
            g_.only("rest of paths", analysed, [&] {
                paths("second paths", firstPathsOf(component_, s_), static_cast<std::uint32_t>(most), s_.spp, false);
            });
            countRays();
        }
        countSamples();
        correctLobes();
        if (varies()) {
            deviations();
        }
        if (s_.filtering == Filtering::None) {
            addSamples();
            addFiltered(value_);
            return;
        }
        if (widensHere()) {
            widened();
        }
        if (!isOfFractions(f_, component_)) {
            addSamples(); // not before: widening takes the most memory
        }
        addFiltered(filtered());
    }

private:
    /// Of a frame that is not analysed: all samples at once.
    void declarePlain()
    {
        const auto spp = static_cast<std::uint32_t>(s_.spp);
        uniformCounts(f_, spp, f_.surfaces.objectId, wanted_);
        paths("paths", 0, spp, s_.spp, false);
        countSamples();
        countRays();
        addSamples();
        addFiltered(value_);
    }

    /// What the analysis is made of, and widths that filter nothing.
    void firstPaths()
    {
        f_.zero(extremes_);
        if (varies()) {
            f_.zero(parts_);
        }
        unshadowed();
        const std::uint32_t first = firstPathsOf(component_, s_);
        uniformCounts(f_, first, f_.surfaces.objectId, wanted_);
        paths("first paths", 0, first, first, true);
        countRays();
        f_.host("analysable", [state = state_](Run& run) { state->analysed = !run.cut(); });
        f_.zero(beta_);
        if (byCurvature()) {
            f_.zero(axes_.x, axes_.y);
        }
    }

    void widened()
    {
        // What was stopped early has not the counts that the parts of samples were made for.
        g_.only(
            "widening", [state = state_](const Run& run) { return state->analysed && !run.cut(); },
            [&] {
                widen(f_, "filter of indirect", filterParams(), wideningOf(component_, s_), pinholeNoise,
                    { irradiance_, deviation_, weights_ }, beta_);
            });
    }

    graph::Handle<Value> filtered()
    {
        shared::FilterParams params = filterParams();
        params.fitted = std::min(params.fitted, channels); // of the variance the mean, which is not negative
        const std::uint32_t planes = varies() ? channels + 1 : channels;
        const FilterRun run { "filter of indirect", PassKind::Filter };
        return byCurvature() ? gaussianFilter(f_, run, planes, params, value_, axes_).value
                             : gaussianFilter(f_, run, planes, params, value_, beta_).value;
    }

    bool isUniform() const { return s_.sampling == Sampling::Uniform || s_.indirect.counts == IndirectCounts::Uniform; }
    /// Whether a pixel's samples are asked how much they vary, for what filters do.
    bool varies() const { return widensHere() || usesFallback(s_); }
    bool byCurvature() const { return isByCurvature(component_, s_); }
    bool widensHere() const { return widens(s_) && !byCurvature(); }
    shared::FilterParams filterParams() const { return pathFilterParams(f_, component_); }
    shared::AnalysisParams countParams() const { return pathCountParams(f_.analysisParams(), component_, s_); }
    shared::ReflectorParams reflectorParams() const { return render::reflectorParams(f_, component_); }

    void countSamples()
    {
        Totals& t = f_.totals;
        f_.count(taken_, false, t.tallies.samples, &t.samples);
        if (!isDirect(component_)) {
            f_.count(taken_, false, t.tallies.indirectSamples);
        }
    }
    /// After a pass that traced some; and begins anew, so that nothing of it takes memory until there are more. Not
    /// without a pass: counting makes nobody clear a plane.
    void countRays()
    {
        f_.count(rays_, true, f_.totals.tallies.rays, &f_.totals.rays);
        f_.count(pathRays_, true, f_.totals.tallies.pathRays);
        rays_ = g_.plane<Count>("rays of light", graph::counts);
        pathRays_ = g_.plane<Count>("rays of paths", graph::counts);
        f_.zero(rays_, pathRays_);
    }
    void unshadowed();
    void correctLobes();
    void paths(const char* pass, std::uint32_t from, std::uint32_t most, double mean, bool everywhere);
    void widthsAndCounts();
    void countsFromVariance();
    void deviations();
    void addSamples();
    void addFiltered(const graph::Handle<Value>& filtered);

    FrameBuilder& f_;
    graph::Graph& g_;
    const Settings& s_;
    Component component_;
    graph::Handle<Reflectance> reflectance_;
    Sum& sum_;
    int vertices_; ///< of a path
    std::shared_ptr<TermState> state_;
    graph::Handle<Metres>& beta_;
    AxisWidths axes_; ///< where they follow from curvatures; beta_ is their mean then
    graph::Handle<Sums> sums_;
    graph::Handle<Value> value_, parts_;
    graph::Handle<Extremes> extremes_;
    graph::Handle<Count> taken_, rays_, pathRays_, wanted_;
    graph::Handle<Value> irradiance_;
    graph::Handle<Deviation> deviation_;
    graph::Handle<Share> weights_;
    graph::Handle<Value> whole_; ///< of lobes, what they would see if nothing were hidden
};

/// Makes fractions of samples, and what they are fractions of a part of the reflectance.
void PathGraph::unshadowed()
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

void PathGraph::correctLobes()
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

void PathGraph::paths(const char* pass, std::uint32_t from, std::uint32_t most, double mean, bool everywhere)
{
    const auto slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / vertices_));
    const SampleSlices slices(from, most, slice, mean);
    std::vector<graph::Sink> becoming { sinks::sums() };
    Arguments sunk { updates("sums", sums_) };
    if (f_.analysed() && varies()) {
        becoming.push_back(sinks::parts()); // means come of the sums in the end: deviations()
        sunk.push_back(updates("parts", parts_));
    } else {
        becoming.push_back(sinks::means());
        sunk.push_back(updates("value", value_));
    }
    if (f_.analysed() && from == 0) { // distances are for the analysis
        becoming.push_back(sinks::distances());
        sunk.push_back(updates("reflectors", extremes_));
    }
    g_.loop("slices", slices.counter(), [&] {
        f_.trace(pass, { "paths/indirect.cl", "samplePaths", becoming },
            joined({ f_.frame(), value("params", pathParams(f_, component_)) }, f_.hierarchy(), f_.geometry(),
                sceneLights(f_, component_), f_.receivers(), Arguments { reads("specular", f_.surfaces.specular) },
                sampleCounts(
                    wanted_, slices.last(), taken_, { tallies("rays", rays_), tallies("pathRays", pathRays_) }),
                sunk),
            everywhere, slices.workUnits(std::max(1.0, mean - from) * vertices_));
    });
}

void PathGraph::widthsAndCounts()
{
    if (byCurvature()) {
        const bool smooth = s_.environment.widths == EnvironmentWidths::Corrected;
        curvatureWidths(f_, curvatureParams(f_, component_), smooth ? smoothedOccluders(f_, extremes_) : extremes_,
            taken_, axes_, beta_);
    } else {
        reflectorWidths(f_, reflectorParams(), extremes_, taken_, beta_);
    }
    if (takesFirstPathsOnly(component_, s_)) {
        return;
    }
    if (isUniform()) {
        uniformCounts(f_, static_cast<std::uint32_t>(s_.spp), taken_, wanted_);
    } else if (s_.indirect.counts == IndirectCounts::Variance) {
        countsFromVariance();
    } else {
        reflectorCounts(f_, reflectorParams(), extremes_, taken_, wanted_);
    }
}

void PathGraph::countsFromVariance()
{
    const graph::Argument p = f_.rectangle(reflectorParams());
    auto variance = g_.plane<Value>("variance", graph::floats);
    f_.blocks("counts", PassKind::Analysis, { "paths/reflectors.cl", "sampleVariance" },
        { p, reads("sums", sums_), reads("taken", taken_), reads("reflectance", reflectance_),
            writes("variance", variance) });
    auto effective = g_.plane<Count>("effective count of variance", graph::floats);
    if (s_.filtering != Filtering::None) {
        effective = gatheredCounts(f_, "pixels gathered", PassKind::Analysis, filterParams(), beta_);
    } else {
        f_.fill("ones", effective, 1.0f);
    }
    auto uncertainty = g_.plane<Uncertainty>("uncertainty", graph::floats);
    f_.blocks("counts", PassKind::Analysis, { "analysis/demand.cl", "uncertaintyOf" },
        { f_.rectangle(countParams()), reads("variance", variance), reads("effective", effective), reads("beta", beta_),
            writes("uncertainty", uncertainty) });
    auto demand = g_.plane<Demand>("demand", graph::floats);
    demandOf(f_, countParams(), uncertainty, { .oneObject = true, .ownToo = false }, demand);
    countsFromDemands(f_, { { demand, 1.0f, static_cast<float>(countParams().leastCount), &wanted_ } },
        { static_cast<float>(s_.spp), static_cast<float>(countParams().countCap), taken_ });
}

void PathGraph::deviations()
{
    f_.blocks("filter of indirect", PassKind::Filter, { "analysis/widening.cl", "oneOfPaths", {}, f_.surfaceFormats() },
        { f_.rectangle(countParams()), value("component", static_cast<std::uint32_t>(component_)),
            value("fractions", isOfFractions(f_, component_) ? 1u : 0u),
            value("firstPass", firstPathsOf(component_, s_)), reads("reflectance", reflectance_),
            updates("value", sums_), reads("parts", parts_), reads("taken", taken_), writes("irradiance", irradiance_),
            writes("deviation", deviation_), writes("weights", weights_) });
    value_ = graph::Handle<Value> { static_cast<const graph::Version&>(sums_) };
}

void PathGraph::addSamples()
{
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addPathSamples" },
        { f_.rectangle(countParams()), value("component", static_cast<std::uint32_t>(component_)),
            reads("reflectance", reflectance_), reads("value", value_),
            varies() ? reads("deviations", deviation_) : graph::absent("deviations"), reads("taken", taken_),
            updates("indirectNoisy", sum_.noisy), updates("deviation", sum_.deviation) });
}

void PathGraph::addFiltered(const graph::Handle<Value>& filtered)
{
    f_.blocks("composite", PassKind::Composite, { "frame/composite.cl", "addIndirect" },
        { f_.rectangle(countParams()), value("component", static_cast<std::uint32_t>(component_)),
            value("varies", varies() ? 1u : 0u), reads("reflectance", reflectance_), reads("value", filtered),
            reads("taken", taken_), updates("indirect", sum_.filtered), updates("variance", sum_.variance) });
}

} // namespace

void addPaths(
    FrameBuilder& frame, Component component, const std::shared_ptr<TermState>& state, graph::Handle<Metres>& beta)
{
    PathGraph(frame, component, state, beta).declare();
}

} // namespace wedge::render
