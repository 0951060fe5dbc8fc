#include "host/render/renderer.h"

#include "host/device/driver_cache.h"
#include "host/device/quirks.h"
#include "host/graph/explain.h"
#include "host/render/compilers.h"
#include "host/render/distributed_frame.h"
#include "host/render/effect.h"
#include "host/render/filter_chain.h"
#include "host/render/glass.h"
#include "host/render/halves.h"
#include "host/render/pixel_frame.h"
#include "host/render/progressive.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <numeric>
#include <set>
#include <unistd.h>
#include <utility>

namespace wedge::render {

namespace {

constexpr std::size_t mostCompilers = 7; ///< besides this process

/// By the memory that is free: each takes some 200 MB.
std::size_t compilersThatFit()
{
    const long pages = ::sysconf(_SC_AVPHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
    constexpr std::uint64_t each = std::uint64_t { 400 } << 20;
    return pages > 0 && bytes > 0
        ? static_cast<std::size_t>(static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes) / each)
        : 0;
}

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

device::BuildOptions optionsOf(const PreparedScene& scene, const Options& options, const Hierarchy& hierarchy)
{
    const SceneTraits& traits = scene.traits();
    device::BuildOptions out;
    if (traits.specular) {
        out.defines.emplace_back("WEDGE_SPECULAR", "1");
    }
    if (traits.microfacets) {
        out.defines.emplace_back("WEDGE_GGX", "1");
    }
    if (traits.normalMaps) {
        out.defines.emplace_back("WEDGE_NORMAL_MAPS", "1");
    }
    if (traits.mirrors) {
        out.defines.emplace_back("WEDGE_MIRRORS", "1");
    }
    if (traits.touchingGlass > 0.0f) {
        out.defines.emplace_back("WEDGE_TOUCHING_GLASS", "1");
    }
    const SceneLights& lights = scene.lights();
    if (lights.emitters.trees || lights.shared.trees) {
        out.defines.emplace_back("WEDGE_EMITTER_TREES", "1");
    }
    if (lights.emitters.tables || lights.shared.tables) {
        out.defines.emplace_back("WEDGE_EMITTER_TABLES", "1");
    }
    if (scene.picture() != nullptr) {
        out.defines.emplace_back("WEDGE_ENVIRONMENT_MAP", "1");
    }
    if (hierarchy.traversal == Traversal::Scalar) {
        out.defines.emplace_back("WEDGE_TRAVERSAL_SCALAR", "1");
    }
    if (traits.moves) {
        out.defines.emplace_back("WEDGE_MOTION", "1");
    }
    if (hierarchy.hasCutouts) {
        out.defines.emplace_back("WEDGE_CUTOUTS", "1");
    }
    out.fastMath = options.fastMath;
    out.kernelDir = options.kernelDir;
    out.generated = programSources(scene);
    return out;
}

} // namespace

Renderer::Renderer(PreparedScene scene, const device::Device& device, Options options)
    : scene_(std::move(scene))
    , device_(device)
    , options_(std::move(options))
    , hierarchy_(buildHierarchy(scene_, options_.bvh, resolveTraversal(options_.traversal, device.info())))
    , queue_(device, options_.checkLaunches)
    , memory_(device_)
{
    buildPrograms();
}

Renderer::~Renderer() = default;

void Renderer::buildPrograms()
{
    device::BuildOptions options = optionsOf(scene_, options_, hierarchy_);
    if (programs_ && options.defines == programOptions_.defines && options.generated == programOptions_.generated) {
        return;
    }
    kernels_.reset();
    programs_ = std::make_unique<device::ProgramLibrary>(device_, options);
    kernels_.emplace(*programs_);
    programOptions_ = std::move(options);
}

void Renderer::changeScene(const scene::Change& change, const std::function<void(scene::Scene&)>& alter)
{
    queue_.finish();
    if (change.onlyKnobs && compiled_ && compiled_->kept) {
        compiled_->runsAgain = true; // its passes find the knobs where they are
        scene_.change(change, alter);
        return;
    }
    frame_.reset();
    compiled_.reset(); // it refers to the scene
    planned_.reset();
    if (change.lights || change.geometry) {
        deviceScene_.reset(); // devices may work in the scene's memory
    }
    scene_.change(change, alter);
    if (change.geometry) {
        hierarchy_ = buildHierarchy(scene_, options_.bvh, hierarchy_.traversal);
    }
    buildPrograms();
}

graph::SlabRules Renderer::slabRules() const
{
    graph::SlabRules rules = graph::slabRulesOf(device_.info());
    rules.sharing = options_.checkLaunches ? graph::Sharing::Apart : rules.sharing;
    return rules;
}

std::unique_ptr<FrameGraph> Renderer::declare(const PreparedScene& scene, const DeviceScene* deviceScene,
    const Settings& settings, std::size_t packet, bool keepLayers, FrameFilter* filter)
{
    if (isDistributed(settings, scene)) {
        return std::make_unique<DistributedFrame>(scene, deviceScene, settings, packet, keepLayers, filter);
    }
    return std::make_unique<PixelFrame>(scene, deviceScene, settings, packet, keepLayers, filter);
}

device::MemoryPlan Renderer::plan(const PreparedScene& scene, const Hierarchy& hierarchy, const Settings& settings,
    bool keepLayers, const graph::SlabRules& slabs, FrameFilter* filter)
{
    const auto planned = [&](const StepRange& step) {
        device::MemoryPlan plan;
        addLasting(plan, scene, hierarchy, settings, filter);
        HalfMemories memories { SampleMemory(nullptr), SampleMemory(nullptr) };
        const std::unique_ptr<FrameGraph> frame =
            declareUnbacked(scene, hierarchy, settings, keepLayers, filter, memories, step);
        for (const SampleMemory& memory : memories) {
            memory.addTo(plan);
        }
        graph::Plan(frame->graph(), device::partAlignment, slabs).addTo(plan);
        return plan;
    };
    device::MemoryPlan most = planned(firstStep(settings));
    if (settings.progressive) {
        // The first step has first paths, and waves go by the new samples of a step.
        device::MemoryPlan other = planned(largestStep(settings.spp));
        if (other.total() > most.total()) {
            most = std::move(other);
        }
    }
    return most;
}

std::unique_ptr<FrameGraph> Renderer::declareUnbacked(const PreparedScene& scene, const Hierarchy& hierarchy,
    const Settings& settings, bool keepLayers, FrameFilter* filter, HalfMemories& memories, const StepRange& step)
{
    const std::size_t packet = packetSize(hierarchy.traversal);
    if (!settings.progressive) {
        return declare(scene, nullptr, settings, packet, keepLayers, filter);
    }
    return std::make_unique<HalvesFrame>(scene, nullptr, settings, packet, keepLayers, memories, step.before, step.spp);
}

void Renderer::filterFrames(std::shared_ptr<FrameFilter> filter)
{
    queue_.finish();
    frame_.reset();
    compiled_.reset(); // it may refer to the other one
    planned_.reset();
    filter_ = std::move(filter);
}

FrameFilter* Renderer::filterOf(const Settings& settings) const
{
    return filter_ && filter_->filters(settings) && !settings.progressive ? filter_.get() : nullptr;
}

void Renderer::addLasting(device::MemoryPlan& plan, const PreparedScene& scene, const Hierarchy& hierarchy,
    const Settings& settings, const FrameFilter* filter)
{
    DeviceScene::plan(plan, scene, hierarchy);
    if (sampleFilterOf(settings).filter != nullptr && !isDistributed(settings, scene)) {
        plan.otherWayOut("take fewer samples with --spp, which filters of samples keep"); // of a band of rows
    }
    if (filter != nullptr) {
        filter->addTo(plan, settings, scene);
    }
}

bool Renderer::takeLasting(const Settings& settings)
{
    device::MemoryPlan plan;
    addLasting(plan, scene_, hierarchy_, settings, filterOf(settings));
    if (!plan.fits(device_.info(), options_.memoryLimit)) {
        return false;
    }
    if (!deviceScene_) {
        deviceScene_ = std::make_unique<DeviceScene>(scene_, hierarchy_, device_, queue_);
    }
    if (FrameFilter* filter = filterOf(settings)) {
        filter->allocate(settings, scene_);
    }
    return true;
}

void Renderer::compile(const std::function<std::unique_ptr<FrameGraph>()>& declare)
{
    const Clock::time_point start = Clock::now();
    compiled_ = std::make_unique<CompiledFrame>(declare(), slabRules());
    compileSeconds_ += secondsSince(start);
    ++framesCompiled_;
}

void Renderer::compile(const Settings& settings, bool keepLayers)
{
    if (compiled_ && compiled_->isOf(settings, keepLayers)) {
        return;
    }
    assert(deviceScene_);
    compile([&] {
        return declare(
            scene_, deviceScene_.get(), settings, packetSize(hierarchy_.traversal), keepLayers, filterOf(settings));
    });
}

const device::MemoryPlan& Renderer::plan(const Settings& settings, bool keepLayers)
{
    validate(settings, isDistributed(settings, scene_));
    const bool compiles = !settings.progressive && takeLasting(settings);
    if (compiles) {
        compile(settings, keepLayers);
    }
    if (!planned_ || planned_->keepLayers != keepLayers || planned_->settings != settings) {
        planned_.reset();
        device::MemoryPlan memory;
        if (compiles) {
            addLasting(memory, scene_, hierarchy_, settings, filterOf(settings));
            compiled_->plan().addTo(memory);
        } else {
            memory = planUnbacked(settings, keepLayers);
        }
        planned_ = Planned { settings, keepLayers, std::move(memory) };
    }
    return planned_->memory;
}

template <class Use>
auto Renderer::withPlan(const Settings& settings, bool keepLayers, const Use& use) const
{
    validate(settings, isDistributed(settings, scene_));
    if (compiled_ && !settings.progressive && compiled_->isOf(settings, keepLayers)) {
        return use(compiled_->plan());
    }
    HalfMemories memories { SampleMemory(nullptr), SampleMemory(nullptr) };
    const CompiledFrame frame(
        declareUnbacked(scene_, hierarchy_, settings, keepLayers, filterOf(settings), memories, firstStep(settings)),
        slabRules());
    return use(frame.plan());
}

Explanation Renderer::explain(const Settings& settings, bool keepLayers) const
{
    return withPlan(settings, keepLayers, [](const graph::Plan& plan) {
        return Explanation { graph::explain(plan), graph::drawing(plan) };
    });
}

std::vector<device::ProgramSource> Renderer::programs(const Settings& settings, bool keepLayers) const
{
    return withPlan(settings, keepLayers, [](const graph::Plan& plan) {
        std::set<device::ProgramSource> found;
        for (const graph::PlannedPass& planned : plan.passes) {
            if (planned.program) {
                found.insert(*planned.program);
            }
        }
        return std::vector<device::ProgramSource>(found.begin(), found.end());
    });
}

void Renderer::prepare(const Settings& settings, bool keepLayers)
{
    plan(settings, keepLayers).check(device_.info(), options_.memoryLimit);
    [[maybe_unused]] const bool taken = takeLasting(settings);
    assert(taken); // as it is part of the plan
    frame_.reset(); // it has parts of the memory
    halfMemories_.reset();
    if (settings.progressive) {
        compiled_.reset(); // it may have those of the halves
        memory_.hold({}); // before there is more
        halfMemories_ = std::make_unique<HalfMemories>(HalfMemories { SampleMemory(&device_), SampleMemory(&device_) });
    }
}

void Renderer::rehearse(const Settings& settings, bool keepLayers)
{
    const Clock::time_point start = Clock::now();
    const device::DriverCache::Mark mark; // drivers compile at the first launch
    prepare(settings, keepLayers);
    queue_.setProgress({});
    queue_.setCancelFlag(nullptr);
    if (settings.progressive) {
        runStep(settings, keepLayers, firstStep(settings), nullptr, true);
    } else {
        run(nullptr, true);
    }
    queue_.finish();
    queue_.takeRecords();
    queue_.forgetCosts(); // of nothing
    setupSeconds_ = secondsSince(start);
}

FrameStatistics Renderer::render(const Settings& settings, const Control& control, bool keepLayers)
{
    assert(!settings.progressive);
    prepare(settings, keepLayers);
    queue_.takeRecords();
    std::atomic<bool> stop { false };
    const double total = compiled_->declared().workUnits();
    const Clock::time_point start = Clock::now();
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
    statistics.complete = run(&stop, false);
    queue_.finish();
    statistics.wallMilliseconds = 1e3 * secondsSince(start);
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
    statistics.frame = settings.frame;
    statistics.memoryBytes = plan(settings, compiled_->declared().keepsLayers()).total();
    countWork(settings, statistics);
    return statistics;
}

bool Renderer::run(const std::atomic<bool>* stop, bool rehearsal)
{
    graph::Execution execution(compiled_->plan(), memory_, *kernels_, queue_);
    std::optional<graph::ChangingValues> before;
    std::swap(before, compiled_->kept);
    const bool again = std::exchange(compiled_->runsAgain, false) && before && !rehearsal;
    bool whole = true;
    if (again) {
        whole = execution.runAgain(*before, stop);
        frame_ = compiled_->declared().outputs(execution);
    } else {
        whole = run(execution, stop, rehearsal);
    }
    if (whole && !rehearsal && compiled_->plan().runsAgain) {
        compiled_->kept = execution.changingValues();
    }
    return whole;
}

bool Renderer::run(graph::Execution& execution, const std::atomic<bool>* stop, bool rehearsal)
{
    bool whole = true;
    if (rehearsal) {
        rehearse(execution);
    } else {
        whole = execution.run(stop, options_.poison);
    }
    frame_ = compiled_->declared().outputs(execution);
    return whole;
}

void Renderer::rehearse(graph::Execution& execution)
{
    const graph::Plan& plan = execution.plan();
    const device::DeviceInfo& info = device_.info();
    if (!device::driverKeepsKernels(info.platformVersion) || info.type != device::DeviceType::Cpu) {
        execution.rehearse();
        return;
    }
    const KnownKernels kernels(device_, *programs_, programOptions_, plan);
    if (!kernels.areKnown()) {
        const CompileWork work = compileWork(device_, programOptions_, plan, execution.trials());
        if (options_.onCompile) {
            options_.onCompile(work.kernels());
        }
        const std::size_t others =
            std::min({ std::size_t { std::max(info.computeUnits, 1u) - 1 }, mostCompilers, compilersThatFit() });
        // Who edits kernels wants one message, and all warnings.
        if (!options_.compiler.empty() && options_.kernelDir.empty() && others > 0) {
            compileSideBySide(options_.compiler, others, work, queue_, *kernels_);
        }
    }
    execution.rehearse();
    queue_.finish();
    kernels.remember();
}

} // namespace wedge::render
