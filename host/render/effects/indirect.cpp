#include "host/render/effects/indirect.h"

#include "host/render/filters/gaussian.h"
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

Indirect::Indirect(Passes& passes, const DeviceScene& scene, Frame& frame, Term& term, const Settings& settings,
    const shared::FrameParams& fullFrame, const shared::FrameParams& sampledFrame, const image::Window& window)
    : passes_(passes)
    , scene_(scene)
    , frame_(frame)
    , term_(term)
    , settings_(settings)
    , fullFrame_(fullFrame)
    , sampledFrame_(sampledFrame)
    , full_ { 0, 0, static_cast<int>(frame.layout.width), static_cast<int>(frame.layout.height) }
    , window_(window)
{
}

bool Indirect::render(Component component)
{
    component_ = component;
    analysed_ = false;
    term_.clear(passes_.queue());
    const bool complete = sample();
    if (analysed_ && settings_.filtering != Filtering::None) {
        gaussianFilter(passes_, { "filter of indirect", PassKind::Filter, "filter_indirect.cl" },
            filterParams(settings_, fullFrame_, window_), window_, frame_, term_.value, term_, term_.filtered);
        composite(term_.filtered);
    } else {
        composite(term_.value);
    }
    return complete;
}

bool Indirect::sample()
{
    const auto spp = static_cast<std::uint32_t>(settings_.spp);
    if (settings_.method == Method::MonteCarlo) {
        uniformCounts(passes_, countParams(blockWindow(window_, 0, full_.x1, full_.y1)), spp, frame_.objectId, term_);
        return samplePaths("paths", sampledFrame_, 0, spp, settings_.spp);
    }
    // All of the frame even for a crop: the counts' scale comes from all pixels, and a crop is to be the same pixels as
    // the whole image.
    uniformCounts(passes_, countParams(full_), WEDGE_INDIRECT_FIRST_RAYS, frame_.objectId, term_);
    if (!samplePaths("first paths", fullFrame_, 0, WEDGE_INDIRECT_FIRST_RAYS, WEDGE_INDIRECT_FIRST_RAYS)) {
        return false;
    }
    widthsAndCounts();
    analysed_ = true;
    const bool uniform = settings_.sampling == Sampling::Uniform || settings_.indirect.counts == IndirectCounts::Uniform;
    const auto most = static_cast<std::uint32_t>(uniform ? settings_.spp : std::max(settings_.indirect.maxSpp, settings_.spp));
    return samplePaths("second paths", sampledFrame_, WEDGE_INDIRECT_FIRST_RAYS, most, settings_.spp);
}

shared::PathParams Indirect::pathParams() const
{
    shared::PathParams p {};
    p.component = static_cast<std::uint32_t>(component_);
    p.bounces = static_cast<std::uint32_t>(std::max(1, settings_.bounces));
    p.sampler = static_cast<std::uint32_t>(settings_.sampler);
    p.lightSampling = static_cast<std::uint32_t>(settings_.lightSampling);
    p.firstPass = settings_.method == Method::AxisAligned ? WEDGE_INDIRECT_FIRST_RAYS : 0;
    p.areaLights = static_cast<std::uint32_t>(scene_.areaLightList.size());
    p.deltaLights = scene_.deltaLightCount;
    p.sceneDiameter = scene_.diameter;
    p.ambientDistance = settings_.indirect.ambientDistance > 0 ? settings_.indirect.ambientDistance
                                                               : std::numeric_limits<float>::infinity();
    return p;
}

bool Indirect::samplePaths(
    const char* pass, const shared::FrameParams& frame, std::uint32_t from, std::uint32_t most, double mean)
{
    const DeviceScene& s = scene_;
    Frame& f = frame_;
    const double units = std::max(1.0, mean - from) * std::max(1, settings_.bounces);
    const auto slice = static_cast<std::uint32_t>(std::max(1, sliceVertices / std::max(1, settings_.bounces)));
    try {
        for (std::uint32_t last = from; last < most;) {
            // Most pixels are done at twice the mean; the slices up to the cap count for what little is left.
            const double knee = std::min<double>(most, std::max(2.0 * mean, from + 1.0));
            const auto done = [&](double n) {
                return 0.9 * std::min(n - from, knee - from) / (knee - from) + 0.1 * (n - from) / (most - from);
            };
            const double share = done(std::min(last + slice, most)) - done(last);
            last += std::min(slice, most - last);
            passes_.tiles(pass, PassKind::Trace, "indirect.cl", "samplePaths", frame, units * share, pathParams(), s.nodes,
                s.blocks, s.positions, s.normals, s.texcoords, s.indices, s.materialIds, s.materials, s.textures, s.texels,
                s.srgbToLinear, s.positionsAtClose, s.normalsAtClose, s.areaLights, s.deltaLights, f.position, f.normal, f.origin, f.geometric, f.objectId,
                f.gloss, f.specular, term_.wanted, last, term_.sums, term_.taken, term_.value, term_.extremes, f.rays,
                f.pathRays);
            if (passes_.rehearsal()) {
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
    const IndirectSettings& in = settings_.indirect;
    shared::ReflectorParams p {};
    setRectangle(p, window);
    p.width = fullFrame_.width;
    p.height = fullFrame_.height;
    p.stride = fullFrame_.stride;
    p.planeSize = fullFrame_.planeSize;
    p.component = static_cast<std::uint32_t>(component_);
    p.mu = in.mu;
    p.alpha = in.alpha;
    p.widthScale = in.widthScale;
    p.extent = in.extent == ReflectorExtent::Scene ? scene_.largestDimension : 0.0f;
    p.leastReflector = in.leastReflector;
    p.meanFraction = in.meanFraction;
    p.countCap = static_cast<std::uint32_t>(in.maxSpp);
    p.fixedWidth = settings_.filtering == Filtering::Fixed ? settings_.fixedWidth : 0.0f;
    p.countExponent = in.countExponent;
    p.varianceSpread = settings_.varianceSpread;
    return p;
}

shared::AnalysisParams Indirect::countParams(const image::Window& window) const
{
    shared::AnalysisParams p {};
    setRectangle(p, window);
    p.width = fullFrame_.width;
    p.height = fullFrame_.height;
    p.stride = fullFrame_.stride;
    p.planeSize = fullFrame_.planeSize;
    p.countCap = static_cast<std::uint32_t>(settings_.indirect.maxSpp);
    p.leastCount = WEDGE_INDIRECT_FIRST_RAYS;
    return p;
}

void Indirect::visibleExtent()
{
    device::TimedQueue& queue = passes_.queue();
    device::Kernel& bounds = passes_.find("reflectors.cl", "visibleBounds");
    bounds.setArgs(reflectorParams(full_), frame_.position, frame_.objectId, term_.bounds);
    queue.launch("widths", PassKind::Analysis, bounds, WEDGE_EXTENT_STRIPES, 1);
    device::Kernel& extent = passes_.find("reflectors.cl", "visibleExtent");
    extent.setArgs(term_.bounds, term_.extent);
    queue.launch("widths", PassKind::Analysis, extent, 1, 1);
}

void Indirect::widthsAndCounts()
{
    const IndirectSettings& in = settings_.indirect;
    const bool uniform = settings_.sampling == Sampling::Uniform || in.counts == IndirectCounts::Uniform;
    visibleExtent();
    passes_.rows("widths", PassKind::Analysis, "reflectors.cl", "reflectorWidths", reflectorParams(full_), 1,
        term_.extremes, term_.extent, frame_.pixelSize, frame_.gloss, term_.taken, term_.beta, term_.wanted);
    if (uniform) {
        uniformCounts(passes_, countParams(full_), static_cast<std::uint32_t>(settings_.spp), term_.taken, term_);
    } else if (in.counts == IndirectCounts::Variance) {
        countsFromVariance();
    }
}

const device::Buffer<float>& Indirect::reflectance() const
{
    return component_ == Component::Glossy ? frame_.specular : frame_.diffuse;
}

void Indirect::countsFromVariance()
{
    const shared::ReflectorParams p = reflectorParams(full_);
    // Lights have no use for these planes any more.
    device::Buffer<float>& variance = term_.logs;
    device::Buffer<float>& gathered = term_.spread;
    passes_.rows("counts", PassKind::Analysis, "reflectors.cl", "sampleVariance", p, WEDGE_BLOCK_PIXELS, term_.sums,
        term_.taken, reflectance(), variance);
    const bool filtered = settings_.filtering != Filtering::None;
    if (filtered) {
        gaussianFilter(passes_, { "filter of variance", PassKind::Analysis, "filter_variance.cl" },
            filterParams(settings_, fullFrame_, full_), full_, frame_, variance, term_, gathered);
    } else {
        term_.effective.fill(passes_.queue(), 1.0f);
    }
    passes_.rows("counts", PassKind::Analysis, "reflectors.cl", "pathDemand", p, WEDGE_BLOCK_PIXELS,
        filtered ? gathered : variance, term_.effective, term_.beta, frame_.objectId, term_.demand);
    countsFromDemand(passes_, countParams(full_), static_cast<float>(settings_.spp), term_.taken, term_);
}

void Indirect::composite(const device::Buffer<float>& value)
{
    const shared::AnalysisParams p = countParams(blockWindow(window_, 0, full_.x1, full_.y1));
    passes_.rows("composite", PassKind::Composite, "composite.cl", "addIndirect", p, WEDGE_BLOCK_PIXELS,
        static_cast<std::uint32_t>(component_), reflectance(), value, term_.value, term_.taken, frame_.indirect,
        frame_.indirectNoisy, frame_.samples, frame_.indirectSamples);
}

} // namespace wedge::render
