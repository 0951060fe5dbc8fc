#include "host/render/effects/indirect.h"

#include "host/render/filters/widening.h"
#include "host/render/sample_counts.h"
#include "kernels/shared/indirect.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

// Vertices of a pixel's paths between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr int sliceVertices = 96;

} // namespace

std::vector<IndirectTerm> indirectTerms(const Settings& settings, bool specular)
{
    if (settings.integrator == Integrator::AmbientOcclusion) {
        return { { Component::Ambient, "Ambient" } };
    }
    if (settings.bounces == 0) {
        return {};
    }
    std::vector<IndirectTerm> terms { { Component::Diffuse, "Indirect" } };
    if (specular) {
        terms.push_back({ Component::Glossy, "Glossy" });
    }
    return terms;
}

Indirect::Indirect(const TermContext& context, Term& term, Component component)
    : c_(context)
    , term_(term)
    , component_(component)
{
}

bool Indirect::render()
{
    term_.clear(c_.passes.queue());
    const bool complete = sample();
    if (analysed_ && c_.settings.filtering != Filtering::None) {
        const shared::FilterParams params = filterParams(c_.settings, c_.fullFrame, c_.window);
        // What was stopped early has not the counts that the parts of samples were made for.
        if (complete && widens(c_.settings)) {
            widen(params);
        }
        gaussianFilter(c_.passes, { "filter of indirect", PassKind::Filter, "filter_indirect.cl" }, params, c_.window,
            c_.frame, term_.value, term_.beta, c_.scratch, c_.scratch.filtered);
        composite(c_.scratch.filtered);
    } else {
        composite(term_.value);
    }
    return complete;
}

void Indirect::widen(const shared::FilterParams& params)
{
    Scratch& scratch = c_.scratch;
    c_.passes.rows("filter of indirect", PassKind::Filter, "widen.cl", "oneOfPaths", countParams(c_.full()),
        WEDGE_BLOCK_PIXELS, static_cast<std::uint32_t>(component_), WEDGE_INDIRECT_FIRST_RAYS, reflectance(),
        term_.value, term_.taken, scratch.visibility, scratch.deviation, scratch.weights);
    const Widening widening(c_, "filter of indirect", params, c_.settings.indirect.widening);
    widening.compare(scratch.visibility, scratch.deviation, term_.beta);
    widening.apply(scratch.visibility, scratch.deviation, scratch.weights, term_.beta);
}

bool Indirect::sample()
{
    const auto spp = static_cast<std::uint32_t>(c_.settings.spp);
    if (c_.settings.method == Method::MonteCarlo) {
        uniformCounts(c_.passes, countParams(blockWindow(c_.window, 0, c_.full().x1, c_.full().y1)), spp,
            c_.frame.objectId, term_.wanted);
        return samplePaths("paths", c_.sampledFrame, 0, spp, c_.settings.spp);
    }
    // All of the frame even for a crop: the counts' scale comes from all pixels, and a crop is to be the same pixels as
    // the whole image.
    uniformCounts(c_.passes, countParams(c_.full()), WEDGE_INDIRECT_FIRST_RAYS, c_.frame.objectId, term_.wanted);
    if (!samplePaths("first paths", c_.fullFrame, 0, WEDGE_INDIRECT_FIRST_RAYS, WEDGE_INDIRECT_FIRST_RAYS)) {
        return false;
    }
    widthsAndCounts();
    const bool uniform =
        c_.settings.sampling == Sampling::Uniform || c_.settings.indirect.counts == IndirectCounts::Uniform;
    const auto most =
        static_cast<std::uint32_t>(uniform ? c_.settings.spp : std::max(c_.settings.indirect.maxSpp, c_.settings.spp));
    return samplePaths("second paths", c_.sampledFrame, WEDGE_INDIRECT_FIRST_RAYS, most, c_.settings.spp);
}

shared::PathParams Indirect::pathParams() const
{
    shared::PathParams p {};
    p.component = static_cast<std::uint32_t>(component_);
    p.bounces = static_cast<std::uint32_t>(std::max(1, c_.settings.bounces));
    p.sampler = samplerOf(c_);
    p.lightSampling = static_cast<std::uint32_t>(c_.settings.lightSampling);
    p.firstPass = c_.settings.method == Method::AxisAligned && !c_.frame.distributed ? WEDGE_INDIRECT_FIRST_RAYS : 0;
    // Of a distributed frame's receivers each has but some of its pixel's samples.
    p.strata = c_.frame.distributed ? static_cast<std::uint32_t>(c_.settings.spp) : 0;
    p.areaLights = static_cast<std::uint32_t>(c_.scene.areaLightList.size());
    p.deltaLights = c_.scene.deltaLightCount;
    p.sceneDiameter = c_.scene.diameter;
    p.ambientDistance = c_.settings.indirect.ambientDistance > 0 ? c_.settings.indirect.ambientDistance
                                                                 : std::numeric_limits<float>::infinity();
    return p;
}

bool Indirect::samplePaths(
    const char* pass, const shared::FrameParams& frame, std::uint32_t from, std::uint32_t most, double mean)
{
    const DeviceScene& s = c_.scene;
    Frame& f = c_.frame;
    const double units = std::max(1.0, mean - from) * std::max(1, c_.settings.bounces);
    const auto slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / std::max(1, c_.settings.bounces)));
    try {
        for (std::uint32_t last = from; last < most;) {
            // Most pixels are done at twice the mean; the slices up to the cap count for what little is left.
            const double knee = std::min<double>(most, std::max(2.0 * mean, from + 1.0));
            const auto done = [&](double n) {
                return 0.9 * std::min(n - from, knee - from) / (knee - from) + 0.1 * (n - from) / (most - from);
            };
            const double share = done(std::min(last + slice, most)) - done(last);
            last += std::min(slice, most - last);
            c_.passes.tiles(pass, PassKind::Trace, "indirect.cl", "samplePaths", frame, units * share, pathParams(),
                s.nodes, s.blocks, surfaceArguments(s), s.areaLights, s.deltaLights, f.receivers(), f.specular,
                term_.wanted, last, term_.sums, term_.taken, term_.value, term_.extremes, f.rays, f.pathRays);
            if (c_.passes.rehearsal()) {
                break;
            }
        }
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

shared::ReflectorParams Indirect::reflectorParams(const image::Window& window) const
{
    const IndirectSettings& in = c_.settings.indirect;
    shared::ReflectorParams p {};
    setRectangle(p, window);
    p.width = c_.fullFrame.width;
    p.height = c_.fullFrame.height;
    p.stride = c_.fullFrame.stride;
    p.planeSize = c_.fullFrame.planeSize;
    p.component = static_cast<std::uint32_t>(component_);
    p.mu = in.mu;
    p.alpha = in.alpha;
    p.widthScale = in.widthScale;
    p.extent = in.extent == ReflectorExtent::Scene ? c_.scene.largestDimension : 0.0f;
    p.leastReflector = in.leastReflector;
    p.meanFraction = in.meanFraction;
    p.countCap = static_cast<std::uint32_t>(in.maxSpp);
    p.fixedWidth = c_.settings.filtering == Filtering::Fixed ? c_.settings.fixedWidth : 0.0f;
    p.meanOnly = c_.frame.shape.packed() ? 1 : 0;
    p.countExponent = in.countExponent;
    p.varianceSpread = c_.settings.varianceSpread;
    return p;
}

shared::AnalysisParams Indirect::countParams(const image::Window& window) const
{
    shared::AnalysisParams p = analysisParams(c_, window);
    p.countCap = static_cast<std::uint32_t>(c_.settings.indirect.maxSpp);
    // Where the first paths met nothing bright there is still noise of what they may meet: rare, and large.
    p.leastCount = std::max(WEDGE_INDIRECT_FIRST_RAYS, static_cast<std::uint32_t>(c_.settings.spp) / 2);
    return p;
}

void Indirect::visibleExtent()
{
    device::TimedQueue& queue = c_.passes.queue();
    device::Kernel& bounds = c_.passes.find("reflectors.cl", "visibleBounds");
    bounds.setArgs(reflectorParams(c_.full()), c_.frame.position, c_.frame.objectId, c_.scratch.bounds);
    queue.launch("widths", PassKind::Analysis, bounds, WEDGE_EXTENT_STRIPES, 1);
    device::Kernel& extent = c_.passes.find("reflectors.cl", "visibleExtent");
    extent.setArgs(c_.scratch.bounds, c_.scratch.extent);
    queue.launch("widths", PassKind::Analysis, extent, 1, 1);
}

void Indirect::widths()
{
    visibleExtent();
    const bool packed = c_.frame.shape.packed();
    const device::Buffer<float>& reflectors = packed ? c_.scratch.slopes : term_.extremes;
    if (packed) {
        c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "unpackSecond", countParams(c_.full()), 1,
            term_.plain, reflectors);
    }
    c_.passes.rows("widths", PassKind::Analysis, "reflectors.cl", "reflectorWidths", reflectorParams(c_.full()), 1,
        reflectors, c_.frame.objectId, c_.scratch.extent, c_.frame.pixelSize, c_.frame.gloss, term_.taken,
        packed ? c_.scratch.width : term_.beta, term_.wanted);
    analysed_ = true;
}

void Indirect::widthsAndCounts()
{
    const IndirectSettings& in = c_.settings.indirect;
    const bool uniform = c_.settings.sampling == Sampling::Uniform || in.counts == IndirectCounts::Uniform;
    widths();
    if (uniform) {
        uniformCounts(
            c_.passes, countParams(c_.full()), static_cast<std::uint32_t>(c_.settings.spp), term_.taken, term_.wanted);
    } else if (in.counts == IndirectCounts::Variance) {
        countsFromVariance();
    }
}

const device::Buffer<float>& Indirect::reflectance() const
{
    return component_ == Component::Glossy ? c_.frame.specular : c_.frame.diffuse;
}

void Indirect::countsFromVariance()
{
    const shared::ReflectorParams p = reflectorParams(c_.full());
    // Lights have no use for these planes any more.
    device::Buffer<float>& variance = c_.scratch.logs;
    device::Buffer<float>& gathered = c_.scratch.spread;
    c_.passes.rows("counts", PassKind::Analysis, "reflectors.cl", "sampleVariance", p, WEDGE_BLOCK_PIXELS, term_.sums,
        term_.taken, reflectance(), variance);
    if (c_.settings.filtering != Filtering::None) {
        // For the effective counts alone.
        gaussianFilter(c_.passes, { "pixels gathered", PassKind::Analysis, "filter_variance.cl" },
            filterParams(c_.settings, c_.fullFrame, c_.full()), c_.full(), c_.frame, variance, term_.beta, c_.scratch,
            gathered);
    } else {
        c_.scratch.effective.fill(c_.passes.queue(), 1.0f);
    }
    c_.passes.rows("counts", PassKind::Analysis, "reflectors.cl", "pathDemand", p, WEDGE_BLOCK_PIXELS, variance,
        c_.scratch.effective, term_.beta, c_.frame.objectId, c_.scratch.demand);
    countsFromDemand(
        c_.passes, countParams(c_.full()), static_cast<float>(c_.settings.spp), term_.taken, c_.scratch, term_.wanted);
}

void Indirect::composite(const device::Buffer<float>& value)
{
    const shared::AnalysisParams p = countParams(blockWindow(c_.window, 0, c_.full().x1, c_.full().y1));
    c_.passes.rows("composite", PassKind::Composite, "composite.cl", "addIndirect", p, WEDGE_BLOCK_PIXELS,
        static_cast<std::uint32_t>(component_), pathParams().firstPass, reflectance(), value, term_.value, term_.taken,
        c_.frame.indirect, c_.frame.indirectNoisy, c_.frame.indirectDeviation, c_.frame.samples,
        c_.frame.indirectSamples);
}

void Indirect::sampleWave(Waves& waves, const shared::WaveParams& wave, double workUnits)
{
    const DeviceScene& s = c_.scene;
    const device::Buffer<float>& reflectance = component_ == Component::Glossy ? waves.specular : waves.diffuse;
    waves.share(c_.passes, term_, wave);
    c_.passes.tiles("paths", PassKind::Trace, "indirect.cl", "samplePaths", waves.receiverParams(wave), workUnits,
        pathParams(), s.nodes, s.blocks, surfaceArguments(s), s.areaLights, s.deltaLights, waves.receivers(),
        waves.specular, waves.wanted, std::numeric_limits<std::uint32_t>::max(), waves.sums, waves.taken, waves.value,
        waves.extremes, waves.rays, waves.pathRays);
    shared::WaveParams adding = wave;
    adding.omits |= term_.shape.omits();
    waves.pixels(c_.passes, "accumulatePaths", adding, component_ == Component::Ambient ? 1u : 0u, waves.pixelFirst,
        waves.pixelCount, c_.frame.primaryTaken, c_.frame.hits, waves.objectId, reflectance, waves.sums, waves.extremes,
        term_.accumulated(), c_.frame.samples, c_.frame.indirectSamples);
}

void Indirect::publishedWidths(const shared::DistributedParams& params, const device::Buffer<float>& flags)
{
    c_.passes.rows("widths", PassKind::Analysis, "published.cl", "publishedReflectors", params, 1,
        c_.settings.distributed.mu, static_cast<std::uint32_t>(component_), flags, term_.extremes, c_.frame.gloss,
        c_.frame.confusion, c_.frame.pixelSize, c_.frame.objectId, term_.beta, term_.demand);
    analysed_ = true;
}

void Indirect::filterDistributed(const shared::DistributedParams& params)
{
    const shared::FilterParams filter = c_.settings.distributed.published
        ? publishedParams(c_.settings, c_.fullFrame, c_.full())
        : filterParams(c_.settings, c_.fullFrame, c_.full());
    if (widens(c_.settings)) {
        widenDistributed(c_, term_, params, Widening(c_, "filter of indirect", filter, c_.settings.indirect.widening));
    }
    // The gather's rows go elsewhere, and its columns know nothing of the value.
    const device::Buffer<float>& value = c_.frame.shape.packed() ? c_.scratch.filtered : term_.value;
    if (c_.frame.shape.packed()) {
        c_.passes.rows(
            "filter of indirect", PassKind::Filter, "distributed.cl", "unpackImage", params, 1, term_.value, value);
    }
    gaussianFilter(c_.passes, { "filter of indirect", PassKind::Filter, "filter_indirect.cl" }, filter, c_.full(),
        c_.frame, value, term_.beta, c_.scratch, c_.scratch.filtered);
    addFilteredTerm(c_, term_, params, c_.frame.indirect);
}

} // namespace wedge::render
