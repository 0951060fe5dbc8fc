#pragma once

#include "host/device/memory_plan.h"
#include "host/device/program.h"
#include "host/graph/execution.h"
#include "host/render/compiled_frame.h"
#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/frame_filter.h"
#include "host/render/halves.h"
#include "host/render/hierarchy.h"
#include "host/render/prepared_scene.h"
#include "host/render/settings.h"

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wedge::render {

/// What stays the same from frame to frame.
struct Options {
    std::string kernelDir; ///< kernels to use in place of the embedded ones, "" for none
    bool fastMath = false;
    /// Waits for each launch, so that a device error names the right kernel, and gives each plane memory of its own.
    bool checkLaunches = false;
    bool poison = false; ///< fills memory with not-a-numbers before it is used, which must not show: for tests
    std::uint64_t memoryLimit = 0; ///< bytes on the device, 0: the device's own limit
    bvh::Mode bvh = bvh::Mode::Default; ///< how the hierarchy is built: the image is the same
    Traversal traversal = Traversal::Automatic;
    /// The path of wedge, to be started for compiling kernels side by side; "": one after the other.
    std::string compiler {};
    /// Called with the number of kernels before those are compiled that were not before, where that can be known.
    std::function<void(std::size_t kernels)> onCompile {};
};

/// How a render is watched and stopped.
struct Control {
    std::function<void(double fraction)> progress; ///< called now and then with what is done, 0 to 1
    const std::atomic<bool>* cancel = nullptr; ///< set from elsewhere: stop soon
    double timeLimitSeconds = 0; ///< stop sampling after this long; 0: never
    double targetError =
        0; ///< progressive renders stop when their estimated RMS error, radiance, is no larger; 0: never
};

/// What a frame cost and took.
struct FrameStatistics {
    std::optional<std::uint32_t> frame; ///< its number in a sequence
    bool complete = true; ///< false: stopped early; the image is made of what was sampled until then
    double wallMilliseconds = 0; ///< from the first launch to the last result, on the host's clock
    double deviceMilliseconds = 0; ///< sum of the passes
    std::vector<device::PassRecord> passes;
    std::uint64_t shadedPixels = 0;
    double sppMean = 0; ///< samples a pixel and term that it has
    double primarySpp = 1; ///< primary samples a pixel
    double directSpp = 0, indirectSpp = 0; ///< the same of area lights and of indirect terms alone
    std::uint64_t primaryRays = 0, shadowRays = 0, indirectRays = 0;
    /// Samples of indirect light that are left out because they are not finite; of frames with a filter of samples.
    std::optional<std::uint64_t> notFiniteSamples;
    /// Pixels whose light was below 0 before it was clamped; of frames that subtract shadows and clamp.
    std::optional<std::uint64_t> clampedPixels;
    std::uint64_t memoryBytes = 0;

    /// Analysis, filter and composite as a fraction of the device's time.
    double overheadFraction() const;
    double milliseconds(device::PassKind kind) const;
    double milliseconds(const std::string& pass) const;
};

/// A graph for people.
struct Explanation {
    std::string text; ///< see graph::explain()
    std::string drawing; ///< SVG
};

struct ProgressiveStep;
struct StepRange;

/// Renders frames of one scene on one device. Construction builds the hierarchy, the programs and the scene's buffers;
/// render() may be called any number of times with other settings.
class Renderer {
public:
    Renderer(PreparedScene scene, const device::Device& device, Options options = {});
    /// Prepares a copy of the scene.
    Renderer(const scene::Scene& scene, const device::Device& device, Options options = {})
        : Renderer(PreparedScene(scene), device, std::move(options))
    {
    }
    ~Renderer();

    /// Device memory that a frame of these settings takes, before anything of it is allocated; of a progressive one the
    /// step that takes most.
    /// keepLayers: as render() has it.
    /// slabs: as graph::place() has them. filter: as filterFrames() has it.
    static device::MemoryPlan plan(const PreparedScene& scene, const Hierarchy& hierarchy, const Settings& settings,
        bool keepLayers = false, const graph::SlabRules& slabs = {}, FrameFilter* filter = nullptr);
    /// The same of this renderer's. Puts the scene on the device, and what its filter keeps, where there is room for
    /// that: for frames that are to be rendered.
    const device::MemoryPlan& plan(const Settings& settings, bool keepLayers = false);
    /// The same of a frame that is not: allocates nothing.
    device::MemoryPlan planUnbacked(const Settings& settings, bool keepLayers = false) const
    {
        return plan(scene_, hierarchy_, settings, keepLayers, slabRules(), filterOf(settings));
    }

    /// The passes of a frame, or of the first step of a progressive one, what they use, and the planes' memory.
    /// Allocates nothing.
    Explanation explain(const Settings& settings, bool keepLayers = false) const;
    /// The programs of the same frame's kernels, each once, and what all of them are built with. Allocates nothing.
    std::vector<device::ProgramSource> programs(const Settings& settings, bool keepLayers = false) const;
    const device::BuildOptions& programOptions() const { return programOptions_; }

    /// Renders; the result stays on the device until the next call. Throws Error if memory does not suffice or the
    /// device fails. keepLayers: for frames of which layers will be read. Distributed frames, which else keep little
    /// but the beauty, fill and filter all that layers show.
    FrameStatistics render(const Settings& settings, const Control& control = {}, bool keepLayers = false);

    /// Renders in steps of ever more samples, which all stay and count, up to wanted.spp (see stepCounts() in
    /// progressive.h). After each the image so far is on the device, as render() leaves it, and onStep is called. A
    /// cancelled or late render ends between two waves of samples, or before the next step; the last image has them
    /// all. Returns the statistics of all steps. Needs settings without published counts; always samples by the
    /// sequence. Throws as render().
    FrameStatistics renderProgressively(const Settings& wanted, const Control& control,
        const std::function<void(const ProgressiveStep&)>& onStep, bool keepLayers = false);

    /// Launches all kernels of these settings at full size over nothing, so that no compilation falls into render().
    void rehearse(const Settings& settings, bool keepLayers = false);

    /// From now on frames that it filters have that filter's passes, after their own; null: none do.
    void filterFrames(std::shared_ptr<FrameFilter> filter);

    /// Lets `alter` change the scene in the parts that `change` names, and in its camera. What was made of those is
    /// given up before and made anew after it.
    void changeScene(const scene::Change& change, const std::function<void(scene::Scene&)>& alter);

    const PreparedScene& scene() const { return scene_; }
    bvh::Mode bvhMode() const { return options_.bvh; }
    const bvh::Bvh& hierarchy() const { return hierarchy_.bvh; }
    Traversal traversal() const { return hierarchy_.traversal; } ///< never Automatic
    const device::Device& device() const { return device_; }
    std::string buildOptions() const { return programs_->optionsString(); }
    double setupSeconds() const { return setupSeconds_; }
    /// Frames, or steps of progressive ones, that were declared and planned since this is there.
    std::size_t framesCompiled() const { return framesCompiled_; }
    /// What declaring and planning them took.
    double compileSeconds() const { return compileSeconds_; }

    /// Of the last frame: the image, counts and objects, and all else that layers show where those were kept.
    const Frame& frame() const { return *frame_; }
    device::TimedQueue& queue() { return queue_; }
    /// Of the programs, until the scene changes.
    graph::Kernels& kernels() { return *kernels_; }
    graph::SlabRules slabRules() const;

private:
    static std::unique_ptr<FrameGraph> declare(const PreparedScene& scene, const DeviceScene* deviceScene,
        const Settings& settings, std::size_t packet, bool keepLayers, FrameFilter* filter);
    /// Of a frame that is only to be planned, or of a step of a progressive one.
    static std::unique_ptr<FrameGraph> declareUnbacked(const PreparedScene& scene, const Hierarchy& hierarchy,
        const Settings& settings, bool keepLayers, FrameFilter* filter, HalfMemories& memories, const StepRange& step);
    /// That of frames of these settings; null: none.
    FrameFilter* filterOf(const Settings& settings) const;
    /// Adds what outlives frames. filter: null: none
    static void addLasting(device::MemoryPlan& plan, const PreparedScene& scene, const Hierarchy& hierarchy,
        const Settings& settings, const FrameFilter* filter);
    /// Puts that on the device, where it is not there, if it does not take more than there may be. Returns whether it
    /// is there.
    bool takeLasting(const Settings& settings);
    /// Makes compiled_ one of these settings, of frames that are not progressive, if it is not.
    void compile(const Settings& settings, bool keepLayers);
    /// Makes compiled_ the frame that it declares.
    void compile(const std::function<std::unique_ptr<FrameGraph>()>& declare);
    /// Tests the settings and whether memory suffices, and makes compiled_ theirs if they are not progressive.
    void prepare(const Settings& settings, bool keepLayers);
    /// Runs compiled_, or rehearses it. Returns false if it was stopped before all samples were taken.
    bool run(const std::atomic<bool>* stop, bool rehearsal);
    bool run(graph::Execution& execution, const std::atomic<bool>* stop, bool rehearsal);
    /// Compiles all of its kernels.
    void rehearse(graph::Execution& execution);
    struct Step {
        ErrorEstimate error;
        bool whole; ///< it was not stopped before all its samples were taken
    };
    /// One step of a progressive frame.
    Step runStep(const Settings& settings, bool keepLayers, const StepRange& range, const std::atomic<bool>* stop,
        bool rehearsal);
    /// Calls use(plan) with what was compiled, or is to look at alone.
    template <class Use>
    auto withPlan(const Settings& settings, bool keepLayers, const Use& use) const;
    /// With the sums of the passes, memory, and what the frame counted.
    FrameStatistics completed(const Settings& settings, FrameStatistics statistics);
    void countWork(const Settings& settings, FrameStatistics& statistics);
    /// The programs that the scene needs, where they are not there.
    void buildPrograms();

    PreparedScene scene_;
    device::Device device_;
    Options options_;
    Hierarchy hierarchy_;
    device::TimedQueue queue_;
    device::BuildOptions programOptions_;
    std::unique_ptr<device::ProgramLibrary> programs_;
    std::unique_ptr<DeviceScene> deviceScene_;
    std::optional<graph::Kernels> kernels_; ///< of the programs
    std::shared_ptr<FrameFilter> filter_;
    graph::Memory memory_; ///< of the frame
    std::unique_ptr<HalfMemories> halfMemories_; ///< of progressive frames
    std::unique_ptr<CompiledFrame> compiled_; ///< of the last frame, or step of a progressive one
    /// plan() of the last settings.
    struct Planned {
        Settings settings;
        bool keepLayers;
        device::MemoryPlan memory;
    };
    std::optional<Planned> planned_;
    std::size_t framesCompiled_ = 0;
    double compileSeconds_ = 0;
    std::unique_ptr<Frame> frame_; ///< parts of the memory
    double setupSeconds_ = 0;
};

} // namespace wedge::render
