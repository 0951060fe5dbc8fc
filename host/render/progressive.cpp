#include "host/render/progressive.h"

#include <algorithm>
#include <chrono>

namespace wedge::render {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int firstStep = 16; // 8 first paths of each half

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

} // namespace

std::vector<int> stepCounts(int spp)
{
    const int last = std::max(2, spp - spp % 2);
    std::vector<int> counts;
    for (int count = firstStep; count < last; count *= 2) {
        counts.push_back(count);
    }
    counts.push_back(last);
    return counts;
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

void Renderer::beginHalves(const Settings& settings, bool keepLayers)
{
    frame_->clear(queue_);
    const bool lit = settings.integrator == Integrator::Path;
    halves_->begin(contextOf(settings), *waves_, lit ? deviceScene_->areaLightList.size() : 0,
        cameraParams(scene_, frame_->layout.height, settings.antialias), keepLayers);
}

void Renderer::rehearseHalves(const Settings& settings)
{
    const std::atomic<bool> stop { false };
    beginHalves(settings, true);
    halves_->refine(stepCounts(settings.spp).front(), stop);
    halves_->show(*frame_);
    halves_->error(*frame_);
}

FrameStatistics Renderer::renderProgressively(const Settings& wanted, const Control& control,
    const std::function<void(const ProgressiveStep&)>& onStep, bool keepLayers)
{
    Settings settings = wanted;
    settings.progressive = true;
    allocate(settings, keepLayers);
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
    // Frames between steps are to be whole: the halves look at the flag themselves, and the queue never does.
    queue_.setCancelFlag(nullptr);
    beginHalves(settings, keepLayers);
    ProgressiveStep step;
    for (std::size_t i = 0; i < counts.size() && !(i > 0 && stop); ++i) {
        step.spp = counts[i];
        const bool whole = halves_->refine(step.spp, stop);
        halves_->show(*frame_);
        step.error = halves_->error(*frame_);
        const bool good = step.error.rmse() <= control.targetError;
        keepHalfPlanes(settings, keepLayers);
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

void Renderer::keepHalfPlanes(const Settings& settings, bool keepLayers)
{
    termPlanes_.clear();
    for (std::size_t i = 0; keepLayers && i < halves_->terms().size(); ++i) {
        keepPlanes(settings, *halves_->terms()[i], halves_->analysed());
    }
}

} // namespace wedge::render
