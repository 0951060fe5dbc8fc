#include "host/render/effects/indirect.h"

#include "host/render/filters/widening.h"
#include "kernels/shared/indirect.h"

#include <algorithm>
#include <limits>

namespace wedge::render {

using device::PassKind;

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

shared::PathParams pathParams(const Settings& settings, Component component)
{
    shared::PathParams p {};
    p.component = static_cast<std::uint32_t>(component);
    p.bounces = static_cast<std::uint32_t>(std::max(1, settings.bounces));
    p.sampler = static_cast<std::uint32_t>(settings.sampler);
    p.lightSampling = static_cast<std::uint32_t>(settings.lightSampling);
    p.firstPass = settings.method == Method::AxisAligned ? WEDGE_INDIRECT_FIRST_RAYS : 0;
    p.ambientDistance = settings.indirect.ambientDistance > 0 ? settings.indirect.ambientDistance
                                                              : std::numeric_limits<float>::infinity();
    return p;
}

shared::PathParams Indirect::pathParams() const
{
    shared::PathParams p = render::pathParams(c_.settings, component_);
    p.sampler = samplerOf(c_);
    p.firstPass = 0;
    p.strata = static_cast<std::uint32_t>(c_.settings.spp); // receivers have but some of their pixel's samples
    p.areaLights = static_cast<std::uint32_t>(c_.scene.areaLightList.size());
    p.deltaLights = c_.scene.deltaLightCount;
    p.sceneDiameter = c_.scene.diameter;
    return p;
}

shared::ReflectorParams reflectorParams(const Settings& settings, Component component)
{
    const IndirectSettings& in = settings.indirect;
    shared::ReflectorParams p {};
    p.component = static_cast<std::uint32_t>(component);
    p.mu = in.mu;
    p.alpha = in.alpha;
    p.widthScale = in.widthScale;
    p.leastReflector = in.leastReflector;
    p.meanFraction = in.meanFraction;
    p.countCap = static_cast<std::uint32_t>(in.maxSpp);
    p.fixedWidth = settings.filtering == Filtering::Fixed ? settings.fixedWidth : 0.0f;
    p.countExponent = in.countExponent;
    p.varianceSpread = settings.varianceSpread;
    return p;
}

shared::ReflectorParams Indirect::reflectorParams(const image::Window& window) const
{
    shared::ReflectorParams p = render::reflectorParams(c_.settings, component_);
    setRectangle(p, window);
    p.width = c_.fullFrame.width;
    p.height = c_.fullFrame.height;
    p.stride = c_.fullFrame.stride;
    p.planeSize = c_.fullFrame.planeSize;
    p.extent = c_.settings.indirect.extent == ReflectorExtent::Scene ? c_.scene.largestDimension : 0.0f;
    p.meanOnly = c_.frame.shape.packed() ? 1 : 0;
    return p;
}

shared::AnalysisParams pathCountParams(shared::AnalysisParams p, const Settings& settings)
{
    p.countCap = static_cast<std::uint32_t>(settings.indirect.maxSpp);
    // Where the first paths met nothing bright there is still noise of what they may meet: rare, and large.
    p.leastCount = std::max(WEDGE_INDIRECT_FIRST_RAYS, static_cast<std::uint32_t>(settings.spp) / 2);
    return p;
}

shared::AnalysisParams Indirect::countParams(const image::Window& window) const
{
    return pathCountParams(analysisParams(c_, window), c_.settings);
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
