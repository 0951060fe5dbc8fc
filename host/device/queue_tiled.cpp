#include "host/device/batch_sizer.h"
#include "host/device/cl_error.h"
#include "host/device/queue.h"

#include <limits>
#include <utility>

namespace wedge::device {
namespace {

/// The first batch of an unknown kernel: enough to fill the device a few times, and a small part of any frame.
constexpr std::size_t firstGroupsPerUnit = 16;

} // namespace

void TimedQueue::launchTiled(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t groupCount,
    std::size_t local, unsigned firstGroupArg, double workUnits)
{
    kernel.requireWorkGroup(local);
    if (groupCount > std::numeric_limits<cl_uint>::max()) {
        throw Error("work-groups of pass " + std::string(pass), std::to_string(groupCount), "render a smaller image");
    }
    const std::size_t index = passOf(pass, kind);
    if (groupCount == 0) {
        workUnitsDone_ += workUnits;
        return;
    }
    const DeviceInfo& info = device_.info();
    const auto seen = millisecondsPerGroup_.find(pass);
    BatchSizer sizer(targetMilliseconds_, info.maxTiledItems / local, firstGroupsPerUnit * info.computeUnits,
        seen != millisecondsPerGroup_.end() ? seen->second : -1.0);
    std::deque<std::size_t> running; // groups of our batches, which are the last ones of pending_
    const auto finishOldest = [&] {
        while (pending_.size() > running.size()) {
            retire(); // passes launched before
        }
        const std::size_t groups = std::exchange(running.front(), 0);
        running.pop_front();
        sizer.measured(groups, retire());
        workUnitsDone_ += workUnits * static_cast<double>(groups) / static_cast<double>(groupCount);
        if (progress_) {
            progress_(workUnitsDone_);
        }
    };
    for (std::size_t first = 0; first < groupCount;) {
        throwIfCancelled();
        const std::size_t groups = std::min(sizer.groups(), groupCount - first);
        kernel.setArg(firstGroupArg, static_cast<cl_uint>(first));
        enqueueKernel(index, kernel, { groups * local, 1 }, { local, 1 }, 1);
        running.push_back(groups);
        first += groups;
        // One batch stays on the device while the next is enqueued, unless nothing is known of the cost yet.
        const std::size_t allowed = !sizer.known() || oneAtATime() ? 0 : 1;
        while (running.size() > allowed) {
            finishOldest();
        }
    }
    while (!running.empty()) {
        finishOldest();
    }
    millisecondsPerGroup_.insert_or_assign(std::string(pass), sizer.millisecondsPerGroup());
}

void TimedQueue::throwIfCancelled()
{
    if (cancel_ != nullptr && *cancel_) {
        finish();
        throw Cancelled();
    }
}

} // namespace wedge::device
