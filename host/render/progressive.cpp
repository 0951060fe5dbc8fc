#include "host/render/progressive.h"

#include "host/render/halves.h"

#include <algorithm>
#include <chrono>

namespace wedge::render {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int leastStep = 16; // 8 first paths of each half

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

} // namespace

std::vector<int> stepCounts(int spp)
{
    const int last = std::max(2, spp - spp % 2);
    std::vector<int> counts;
    for (int count = leastStep; count < last; count *= 2) {
        counts.push_back(count);
    }
    counts.push_back(last);
    return counts;
}

StepRange firstStep(const Settings& settings) { return { 0, stepCounts(settings.spp).front() }; }

StepRange largestStep(int spp)
{
    StepRange largest, step;
    for (const int count : stepCounts(spp)) {
        step = { step.spp, count };
        if (step.spp - step.before > largest.spp - largest.before) {
            largest = step;
        }
    }
    return largest;
}

void addRecords(std::vector<device::PassRecord>& sum, const std::vector<device::PassRecord>& more)
{
    for (const device::PassRecord& record : more) {
        const auto known = std::ranges::find(sum, record.name, &device::PassRecord::name);
        if (known == sum.end()) {
            sum.push_back(record);
            continue;
        }
        known->milliseconds += record.milliseconds;
        known->bytes += record.bytes;
        known->launches += record.launches;
    }
}

Renderer::Step Renderer::runStep(
    const Settings& settings, bool keepLayers, const StepRange& range, const std::atomic<bool>* stop, bool rehearsal)
{
    for (SampleMemory& memory : *halfMemories_) {
        memory.rewind();
    }
    frame_.reset(); // it has parts of the memory
    const HalvesFrame* halves = nullptr;
    compile([&] {
        auto frame = std::make_unique<HalvesFrame>(scene_, deviceScene_.get(), settings,
            packetSize(hierarchy_.traversal), keepLayers, *halfMemories_, range.before, range.spp);
        halves = frame.get();
        return frame;
    });
    graph::Execution execution(compiled_->plan(), memory_, *kernels_, queue_);
    const bool whole = run(execution, stop, rehearsal);
    return { rehearsal ? ErrorEstimate { 0, 0 } : halves->error(execution, queue_), whole };
}

FrameStatistics Renderer::renderProgressively(const Settings& wanted, const Control& control,
    const std::function<void(const ProgressiveStep&)>& onStep, bool keepLayers)
{
    Settings settings = wanted;
    settings.progressive = true;
    prepare(settings, keepLayers);
    queue_.takeRecords();
    std::atomic<bool> stop { false };
    const Clock::time_point start = Clock::now();
    const auto look = [&] {
        if ((control.cancel != nullptr && control.cancel->load())
            || (control.timeLimitSeconds > 0 && secondsSince(start) > control.timeLimitSeconds)) {
            stop = true;
        }
    };
    const std::vector<int> counts = stepCounts(settings.spp);
    queue_.setProgress([&](double done) {
        look();
        if (control.progress) {
            control.progress(std::clamp(2 * done / counts.back(), 0.0, 1.0));
        }
    });
    queue_.setCancelFlag(nullptr);
    ProgressiveStep step;
    for (std::size_t i = 0; i < counts.size() && !(i > 0 && stop); ++i) {
        step.spp = counts[i];
        const auto [error, whole] =
            runStep(settings, keepLayers, { i == 0 ? 0 : counts[i - 1], step.spp }, &stop, false);
        step.error = error;
        const bool good = control.targetError > 0 && step.error.rmse() <= control.targetError;
        queue_.finish();
        FrameStatistics statistics;
        statistics.passes = std::move(step.statistics.passes);
        addRecords(statistics.passes, queue_.takeRecords());
        statistics.complete = whole && (good || i + 1 == counts.size());
        statistics.wallMilliseconds = 1e3 * secondsSince(start);
        step.statistics = completed(settings, std::move(statistics));
        if (onStep) {
            onStep(step);
        }
        if (!whole || good) {
            break;
        }
        look();
    }
    queue_.setProgress({});
    return step.statistics;
}

} // namespace wedge::render
