#include "host/render/renderer.h"

#include "host/render/pixel_frame.h"

#include "host/device/driver_cache.h"
#include "host/render/distributed_frame.h"
#include "host/render/effects/indirect.h"
#include "host/render/effects/soft_shadows.h"
#include "host/render/filters/widening.h"
#include "host/render/halves.h"
#include "kernels/shared/distributed.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <numeric>

namespace wedge::render {

using device::PassKind;

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool needsAnalysis(const Settings& settings) { return settings.method == Method::AxisAligned; }

TermShape termShape(const Settings& settings, bool specular)
{
    const TermShape direct = SoftShadows::termShape(specular, needsAnalysis(settings));
    return tracesPaths(settings) ? direct.with(Indirect::termShape(needsAnalysis(settings))) : direct;
}

/// Planes of what is filtered at once: a term's value, or an image.
constexpr std::uint32_t filteredPlanes = 3;

/// Slopes of lights, and where things move what their shadows' motions add up to.
std::uint32_t lightExtremes(const scene::Scene& scene) { return scene::geometryMoves(scene) ? 6 : 2; }

/// What a frame's buffers are for. Lean are distributed frames of which nothing but the image is wanted, and that are
/// made as by default: without counts from the spectrum, published slopes and widths from the nearest reflectors.
FrameShape frameShape(const Settings& settings, const scene::Scene& scene, bool keepLayers)
{
    const bool usual = !settings.distributed.published && settings.slopes == Slopes::Smoothed
        && !(settings.sampling == Sampling::Adaptive && settings.counts == Counts::Spectrum)
        && settings.indirect.meanFraction > 0;
    FrameShape shape;
    shape.distributed = isDistributed(settings, scene);
    shape.lean = shape.distributed && !keepLayers && !settings.progressive && (usual || !needsAnalysis(settings));
    if (shape.lean) {
        shape.analysed = needsAnalysis(settings);
        shape.shutter = scene::geometryMoves(scene) || scene::cameraMoves(scene);
        shape.deltaLights = !scene.pointLights.empty() || !scene.directionalLights.empty();
    }
    return shape;
}

/// Pixels over which filters reach, one after the other: those of terms, of shadows along their motion, and of the
/// lens.
int filterReach(const Settings& settings, const scene::Scene& scene)
{
    const bool moves = scene::geometryMoves(scene) || scene::cameraMoves(scene), lens = scene.camera.apertureRadius > 0;
    return settings.maxRadius + widenReach(settings) + (moves ? WEDGE_MOTION_REACH : 0) + (lens ? WEDGE_MAX_RADIUS : 0);
}

/// What receivers of waves need for the terms in turn.
TermShape receiverShape(const Settings& settings, const scene::Scene& scene, bool specular)
{
    return termShape(settings, specular).with({ 0, 0, lightExtremes(scene), false, false, false, false, false });
}

/// One a term where pixels have several receivers, which serve all terms at once; else the one that all take turns in.
std::vector<TermShape> termShapes(
    const Settings& settings, const scene::Scene& scene, bool specular, const FrameShape& frame)
{
    TermShape shape { 0, 3, 3, needsAnalysis(settings), true, false, frame.lean, false };
    shape.published = shape.analysed && settings.distributed.published;
    TermShape light = shape;
    light.light = true;
    light.sums = frame.lean ? 0 : 1;
    light.extremes = lightExtremes(scene);
    if (frame.lean) {
        // Widths come from the least slope, and from the mean of reflectors' distances, which lie with the plain mean.
        shape.extremes = 0;
        light.extremes = shape.analysed && scene::geometryMoves(scene) ? 1 : 0;
    }
    const std::size_t lights = settings.integrator == Integrator::Path ? scene.areaLights.size() : 0;
    std::vector<TermShape> shapes(lights, light);
    shapes.resize(lights + indirectTerms(settings, specular).size(), shape);
    return shapes;
}

/// Bytes that waves and, between them, what analyses and filters have in turn.
std::uint64_t leanBytes(const PlaneLayout& layout, const FrameShape& frame, const TermShape& receivers)
{
    const std::uint64_t scratch = frame.analysed ? Scratch::leanPlanes * layout.size * sizeof(float) : 0;
    return std::max(scratch, Waves::bytes(receivers, frame.deltaLights));
}

/// A plane of which the window's pixels alone are known; the others are 0.
std::vector<float> onlyInside(const image::Window& window, const PlaneLayout& layout, const std::vector<float>& plane)
{
    std::vector<float> out(plane.size(), 0.0f);
    for (int y = window.y0; y < window.y1; ++y) {
        const std::size_t row =
            shared::pixelIndex(static_cast<std::uint32_t>(window.x0), static_cast<std::uint32_t>(y), layout.stride);
        std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(row), window.width(),
            out.begin() + static_cast<std::ptrdiff_t>(row));
    }
    return out;
}

device::BuildOptions programOptions(const scene::Scene& scene, const Options& options, Traversal traversal)
{
    device::BuildOptions out;
    if (hasSpecular(scene)) {
        out.defines.emplace_back("WEDGE_SPECULAR", "1");
    }
    if (traversal == Traversal::Scalar) {
        out.defines.emplace_back("WEDGE_TRAVERSAL_SCALAR", "1");
    }
    if (scene::geometryMoves(scene)) {
        out.defines.emplace_back("WEDGE_MOTION", "1");
    }
    out.fastMath = options.fastMath;
    out.kernelDir = options.kernelDir;
    return out;
}

} // namespace

std::vector<std::string> termNames(const Settings& settings, const scene::Scene& scene)
{
    std::vector<std::string> names;
    const std::size_t lights = settings.integrator == Integrator::Path ? scene.areaLights.size() : 0;
    for (std::size_t i = 0; i < lights; ++i) {
        names.push_back(lights == 1 ? "" : std::to_string(i + 1));
    }
    for (const IndirectTerm& term : indirectTerms(settings, hasSpecular(scene))) {
        names.emplace_back(term.name);
    }
    return names;
}

Renderer::Renderer(const scene::Scene& scene, const device::Device& device, Options options)
    : scene_(scene)
    , device_(device)
    , options_(std::move(options))
    , hierarchy_(buildHierarchy(scene, options_.bvh, resolveTraversal(options_.traversal, device.info())))
    , queue_(device, options_.checkLaunches)
    , programs_(std::make_unique<device::ProgramLibrary>(device, programOptions(scene, options_, hierarchy_.traversal)))
    , passes_(std::make_unique<Passes>(*programs_, queue_, packetSize(hierarchy_.traversal)))
    , kernels_(*programs_)
    , memory_(device_)
    , unused_(device::Buffer<std::uint32_t>(device_, 0, "nothing").cl())
{
}

Renderer::~Renderer() = default;

device::MemoryPlan Renderer::plan(const scene::Scene& scene, const Hierarchy& hierarchy, const Settings& settings,
    bool keepLayers, std::uint64_t mostSlabBytes)
{
    const PlaneLayout layout(settings.width, settings.height);
    device::MemoryPlan plan;
    DeviceScene::plan(plan, scene, hierarchy);
    if (!isDistributed(settings, scene)) {
        const PixelFrame frame(scene, nullptr, settings, packetSize(hierarchy.traversal), cl::Buffer(), keepLayers);
        graph::Plan(frame.graph(), device::partAlignment, mostSlabBytes).addTo(plan);
        return plan;
    }
    const bool specular = hasSpecular(scene);
    const FrameShape frame = frameShape(settings, scene, keepLayers);
    Frame::plan(plan, layout, frame);
    const std::vector<TermShape> shapes = termShapes(settings, scene, specular, frame);
    if (settings.progressive) {
        Halves::plan(plan, layout, shapes);
    } else {
        for (const TermShape& shape : shapes) {
            Term::plan(plan, layout, shape);
        }
    }
    const TermShape receivers = receiverShape(settings, scene, specular);
    Waves::planTiles(plan, layout);
    if (frame.lean) {
        plan.add("receivers, or analysis and filters", leanBytes(layout, frame, receivers));
    } else {
        plan.add("receivers", Waves::bytes(receivers, true));
    }
    if (needsAnalysis(settings) && !frame.lean) {
        Scratch::plan(plan, layout, filteredPlanes);
    }
    return plan;
}

void Renderer::allocate(const Settings& settings, bool keepLayers)
{
    validate(settings, isDistributed(settings, scene_));
    plan(settings, keepLayers).check(device_.info(), options_.memoryLimit);
    if (!deviceScene_) {
        deviceScene_ = std::make_unique<DeviceScene>(scene_, hierarchy_, device_, queue_);
    }
    if (!isDistributed(settings, scene_)) {
        terms_.clear();
        halves_.reset();
        waves_.reset();
        scratch_.reset();
        return; // what is needed is allocated with the graph
    }
    memory_.hold({});
    pixelFrame_.reset();
    const PlaneLayout layout(settings.width, settings.height);
    const FrameShape frame = frameShape(settings, scene_, keepLayers);
    if (!frame_ || !(frame_->layout == layout) || !(frame_->shape == frame)) {
        terms_.clear();
        halves_.reset();
        waves_.reset();
        scratch_.reset();
        frame_.reset();
        frame_ = std::make_unique<Frame>(device_, queue_, layout, frame);
    }
    std::vector<TermShape> shapes = termShapes(settings, scene_, deviceScene_->specular, frame);
    if (settings.progressive) {
        if (!halves_ || !halves_->hold(layout, shapes)) {
            halves_.reset();
            halves_ = std::make_unique<Halves>(device_, queue_, layout, shapes);
        }
        shapes.clear();
    } else {
        halves_.reset();
    }
    terms_.resize(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (!terms_[i] || !terms_[i]->shape.holds(shapes[i])) {
            terms_[i].reset();
            terms_[i] = std::make_unique<Term>(device_, queue_, *frame_, shapes[i]);
        }
    }
    if (frame.lean) {
        allocateLeanWaves(settings, layout);
    } else {
        allocateWaves(settings, layout);
    }
}

void Renderer::allocateWaves(const Settings& settings, const PlaneLayout& layout)
{
    const TermShape receivers = receiverShape(settings, scene_, deviceScene_->specular);
    if (!waves_ || !waves_->shape.holds(receivers)) {
        waves_.reset();
        waves_ = std::make_unique<Waves>(device_, layout, receivers);
    }
    if (needsAnalysis(settings) && (!scratch_ || scratch_->values < filteredPlanes)) {
        scratch_.reset();
        scratch_ = std::make_unique<Scratch>(device_, queue_, layout, filteredPlanes);
    }
    if (!scratch_) {
        scratch_ = std::make_unique<Scratch>(device_, queue_, PlaneLayout(1, 1), 0);
    }
}

void Renderer::allocateLeanWaves(const Settings& settings, const PlaneLayout& layout)
{
    const TermShape receivers = receiverShape(settings, scene_, deviceScene_->specular);
    if (waves_ && waves_->shape.holds(receivers)) {
        return;
    }
    waves_.reset();
    scratch_.reset();
    const device::Buffer<float> memory(
        device_, leanBytes(layout, frame_->shape, receivers) / sizeof(float), "receivers, or analysis and filters");
    waves_ = std::make_unique<Waves>(device_, layout, receivers, frame_->shape.deltaLights, memory);
    scratch_ = frame_->shape.analysed ? std::make_unique<Scratch>(device_, layout, memory)
                                      : std::make_unique<Scratch>(device_, queue_, PlaneLayout(1, 1), 0);
}

void Renderer::rehearse(const Settings& settings, bool keepLayers)
{
    const Clock::time_point start = Clock::now();
    const device::DriverCache::Mark mark; // drivers compile at the first launch
    allocate(settings, keepLayers);
    passes_->setRehearsal(true);
    queue_.setProgress({});
    queue_.setCancelFlag(nullptr);
    if (settings.progressive) {
        rehearseHalves(settings);
    } else {
        renderPasses(settings, keepLayers);
    }
    queue_.finish();
    passes_->setRehearsal(false);
    queue_.takeRecords();
    queue_.forgetCosts(); // of nothing
    setupSeconds_ = secondsSince(start);
}

double Renderer::workUnits(const Settings& settings) const
{
    const double paths =
        tracesPaths(settings) ? settings.spp * std::max(1, settings.bounces) * (hasSpecular(scene_) ? 2.0 : 1.0) : 0.0;
    if (settings.integrator == Integrator::AmbientOcclusion) {
        return 1.0 + settings.spp;
    }
    return 1.0 + (scene_.pointLights.empty() && scene_.directionalLights.empty() ? 0.0 : 1.0)
        + static_cast<double>(scene_.areaLights.size()) * settings.spp + paths;
}

FrameStatistics Renderer::render(const Settings& settings, const Control& control, bool keepLayers)
{
    assert(!settings.progressive);
    allocate(settings, keepLayers);
    queue_.takeRecords();
    std::atomic<bool> stop { false };
    const double total = workUnits(settings);
    const Clock::time_point start = Clock::now();
    // Of distributed frames waves are finished first: pixels without some of the terms would be wrong, not missing.
    stop_ = &stop;
    queue_.setCancelFlag(nullptr);
    queue_.setProgress([&](double done) {
        if ((control.cancel != nullptr && control.cancel->load())
            || (control.timeLimitSeconds > 0 && secondsSince(start) > control.timeLimitSeconds)) {
            stop = true;
        }
        if (control.progress) {
            control.progress(std::clamp(done / total, 0.0, 1.0));
        }
    });
    FrameStatistics statistics;
    statistics.complete = renderPasses(settings, keepLayers);
    queue_.finish();
    statistics.wallMilliseconds = 1e3 * secondsSince(start);
    stop_ = nullptr;
    queue_.setCancelFlag(nullptr);
    queue_.setProgress({});
    statistics.passes = queue_.takeRecords();
    return completed(settings, std::move(statistics));
}

FrameStatistics Renderer::completed(const Settings& settings, FrameStatistics statistics)
{
    for (const device::PassRecord& record : statistics.passes) {
        statistics.deviceMilliseconds += record.milliseconds;
    }
    const bool layers = frame_->distributed ? !frame_->shape.lean : pixelFrame_->keepsLayers();
    statistics.memoryBytes = plan(settings, layers).total();
    countWork(settings, statistics);
    return statistics;
}

TermContext Renderer::contextOf(const Settings& settings)
{
    const image::Window output = outputWindow(settings);
    const image::Window whole { 0, 0, settings.width, settings.height };
    image::Window sampled = needsAnalysis(settings)
        ? blockWindow(output, filterReach(settings, scene_), settings.width, settings.height)
        : output;
    // Tiles are to be those of the whole image.
    constexpr int tile = static_cast<int>(WEDGE_TILE);
    sampled = { sampled.x0 / tile * tile, sampled.y0 / tile * tile, sampled.x1, sampled.y1 };
    return { *passes_, *deviceScene_, *frame_, *scratch_, settings,
        frameParams(scene_, frame_->layout, whole, settings.seed),
        frameParams(scene_, frame_->layout, sampled, settings.seed), output,
        scene::geometryMoves(scene_) || scene::cameraMoves(scene_) };
}

bool Renderer::renderPasses(const Settings& settings, bool keepLayers)
{
    if (!isDistributed(settings, scene_)) {
        return renderPixels(settings, keepLayers);
    }
    frame_->clear(queue_);
    termPlanes_.clear();
    return distributedPasses(contextOf(settings), keepLayers);
}

bool Renderer::renderPixels(const Settings& settings, bool keepLayers)
{
    frame_.reset(); // it has parts of the memory
    pixelFrame_ = std::make_unique<PixelFrame>(
        scene_, deviceScene_.get(), settings, packetSize(hierarchy_.traversal), unused_, keepLayers);
    const graph::Plan plan(pixelFrame_->graph(), device::partAlignment, mostSlabBytes());
    graph::Execution execution(plan, memory_, kernels_, queue_);
    termPlanes_.clear();
    if (passes_->rehearsal()) {
        execution.rehearse();
        frame_ = pixelFrame_->outputs(execution);
        return true;
    }
    const bool complete = execution.run(stop_, options_.poison);
    frame_ = pixelFrame_->outputs(execution);
    const std::vector<std::string> names = termNames(settings, scene_);
    for (std::size_t i = 0; keepLayers && i < names.size(); ++i) {
        const PixelFrame::TermWidths& term = pixelFrame_->terms()[i];
        std::vector<float> shown;
        if (term.state->analysed) {
            shown = onlyInside(
                outputWindow(settings), frame_->layout, execution.output<float>(term.beta).downloadAll(queue_));
        }
        termPlanes_.push_back({ names[i], std::move(shown) });
    }
    return complete;
}

bool Renderer::distributedPasses(const TermContext& context, bool keepLayers)
{
    const bool lit = context.settings.integrator == Integrator::Path;
    DistributedFrame distributed(context, *waves_, terms_, lit ? deviceScene_->areaLightList.size() : 0,
        cameraParams(scene_, frame_->layout.height, context.settings.antialias), keepLayers);
    const bool complete = distributed.render(stop_);
    for (std::size_t i = 0; keepLayers && i < terms_.size(); ++i) {
        keepPlanes(context.settings, *terms_[i], distributed.analysed());
    }
    return complete;
}

void Renderer::keepPlanes(const Settings& settings, const Term& term, bool analysed)
{
    const std::string name = termNames(settings, scene_).at(termPlanes_.size());
    termPlanes_.push_back({ name, analysed ? term.beta.downloadAll(queue_) : std::vector<float>() });
}

} // namespace wedge::render
