#include "host/device/queue.h"

#include "host/device/cl_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace wedge::device {
namespace {

/// Events kept before the oldest are measured: bounds the memory of drivers that hold on to every command.
constexpr std::size_t maxPending = 1024;
double millisecondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to)
{
    return std::chrono::duration<double, std::milli>(to - from).count();
}

std::size_t paddedTo(std::size_t size, std::size_t multiple) { return (size + multiple - 1) / multiple * multiple; }

} // namespace

std::string_view passKindName(PassKind kind)
{
    switch (kind) {
    case PassKind::Trace:
        return "trace";
    case PassKind::Analysis:
        return "analysis";
    case PassKind::Filter:
        return "filter";
    case PassKind::Composite:
        return "composite";
    case PassKind::Transfer:
        break;
    }
    return "transfer";
}

TimedQueue::TimedQueue(const Device& device, bool finishAfterEachLaunch)
    : device_(device)
    , waitForEach_(finishAfterEachLaunch)
    , hostTimers_(device.info().hostTimers)
{
    checked("a queue", device_.info().name,
        [this] { queue_ = cl::CommandQueue(device_.context(), device_.cl(), CL_QUEUE_PROFILING_ENABLE); });
}

TimedQueue::~TimedQueue()
{
    try {
        finish(); // buffers may be freed next
    } catch (const std::exception&) {
        // Whoever wanted to know has called finish().
    }
}

std::size_t TimedQueue::passOf(std::string_view name, PassKind kind)
{
    const auto found =
        std::find_if(passes_.begin(), passes_.end(), [name](const Pass& p) { return p.record.name == name; });
    if (found != passes_.end()) {
        assert(found->record.kind == kind);
        return static_cast<std::size_t>(found - passes_.begin());
    }
    passes_.push_back({ { std::string(name), kind, 0.0, 0, 0, {} }, "" });
    return passes_.size() - 1;
}

std::string TimedQueue::subjectOf(std::size_t pass) const
{
    const Pass& p = passes_[pass];
    return fmt::format("pass {}{}{}", p.record.name, p.kernel.empty() ? "" : ", ", p.kernel);
}

/// Calls call(event), which enqueues one command; its time will count for the pass.
template <class Call>
void TimedQueue::submit(std::size_t pass, const Call& call)
{
    Pending pending { {}, pass, Clock::now() };
    try {
        call(pending.event);
    } catch (const cl::Error& error) {
        throwClError(error, subjectOf(pass), device_.info().name);
    }
    ++passes_[pass].record.launches;
    pending_.push_back(std::move(pending));
}

void TimedQueue::enqueueKernel(std::size_t pass, Kernel& kernel, Size global, Size local, unsigned dimensions)
{
    if (passes_[pass].kernel.empty() || waitForEach_) {
        passes_[pass].kernel = kernel.description();
    }
    std::vector<std::string>& kernels = passes_[pass].record.kernels;
    if (std::find(kernels.begin(), kernels.end(), kernel.name()) == kernels.end()) {
        kernels.push_back(kernel.name());
    }
    submit(pass, [&](cl::Event& event) {
        const std::size_t globalSizes[] = { global.x, global.y };
        const std::size_t localSizes[] = { local.x, local.y };
        cl_event handle = nullptr;
        require(::clEnqueueNDRangeKernel(
                    queue_(), kernel.cl()(), dimensions, nullptr, globalSizes, localSizes, 0, nullptr, &handle),
            "clEnqueueNDRangeKernel");
        event = cl::Event(handle);
    });
}

void TimedQueue::launchSized(
    std::string_view pass, PassKind kind, Kernel& kernel, Size global, Size local, unsigned dimensions)
{
    kernel.requireWorkGroup(local.x * local.y);
    const std::size_t index = passOf(pass, kind);
    if (global.x == 0 || global.y == 0) {
        return;
    }
    enqueueKernel(index, kernel, { paddedTo(global.x, local.x), paddedTo(global.y, local.y) }, local, dimensions);
    limitPending();
}

void TimedQueue::launch(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t global, std::size_t local)
{
    launchSized(pass, kind, kernel, { global, 1 }, { local, 1 }, 1);
}

void TimedQueue::launch2D(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t globalX,
    std::size_t globalY, std::size_t localX, std::size_t localY)
{
    launchSized(pass, kind, kernel, { globalX, globalY }, { localX, localY }, 2);
}

void TimedQueue::transfer(std::string_view pass, std::uint64_t bytes, const std::function<void(cl::Event&)>& call)
{
    const std::size_t index = passOf(pass, PassKind::Transfer);
    if (bytes == 0) {
        return;
    }
    submit(index, call);
    passes_[index].record.bytes += bytes;
    limitPending();
}

void TimedQueue::write(
    std::string_view pass, const cl::Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from)
{
    transfer(pass, bytes,
        [&](cl::Event& event) { queue_.enqueueWriteBuffer(buffer, CL_TRUE, offset, bytes, from, nullptr, &event); });
}

void TimedQueue::read(std::string_view pass, const cl::Buffer& buffer, std::size_t offset, std::size_t bytes, void* to)
{
    transfer(pass, bytes,
        [&](cl::Event& event) { queue_.enqueueReadBuffer(buffer, CL_TRUE, offset, bytes, to, nullptr, &event); });
}

void TimedQueue::fill(
    std::string_view pass, const cl::Buffer& buffer, std::size_t bytes, const void* pattern, std::size_t patternBytes)
{
    transfer(pass, bytes, [&](cl::Event& event) {
        cl_event handle = nullptr;
        require(::clEnqueueFillBuffer(queue_(), buffer(), pattern, patternBytes, 0, bytes, 0, nullptr, &handle),
            "clEnqueueFillBuffer");
        event = cl::Event(handle);
    });
}

void TimedQueue::recordTransfer(std::string_view pass, std::uint64_t bytes, double milliseconds)
{
    PassRecord& record = passes_[passOf(pass, PassKind::Transfer)].record;
    record.bytes += bytes;
    record.milliseconds += milliseconds;
    ++record.launches;
}

void TimedQueue::addBytes(std::string_view pass, PassKind kind, std::uint64_t bytes)
{
    passes_[passOf(pass, kind)].record.bytes += bytes;
}

void TimedQueue::limitPending()
{
    if (oneAtATime()) {
        finish();
    }
    if (pending_.size() >= maxPending) {
        while (pending_.size() > maxPending / 2) {
            retire();
        }
    }
}

/// Waits for the oldest pending command, adds its time to its pass and returns it.
double TimedQueue::retire()
{
    const Pending oldest = std::move(pending_.front());
    pending_.pop_front();
    double milliseconds = 0.0;
    try {
        ::cl_event handle = oldest.event();
        const cl_int waited = ::clWaitForEvents(1, &handle);
        // A failed command's own status says more than that waiting for it failed.
        const cl_int status = oldest.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
        require(status < 0 ? status : waited, status < 0 ? "execution" : "clWaitForEvents");
        const Clock::time_point now = Clock::now();
        const auto measured =
            hostTimers_ ? std::nullopt : eventMilliseconds(oldest.event, millisecondsBetween(oldest.submitted, now));
        hostTimers_ = !measured;
        milliseconds = measured ? *measured : millisecondsBetween(std::max(oldest.submitted, lastRetired_), now);
        lastRetired_ = now;
    } catch (const cl::Error& error) {
        throwClError(error, subjectOf(oldest.pass), device_.info().name);
    }
    passes_[oldest.pass].record.milliseconds += milliseconds;
    return milliseconds;
}

void TimedQueue::finish()
{
    const cl_int status = ::clFinish(queue_());
    // Each event is waited for too: it says which launch failed, and some drivers return from clFinish() early once
    // the queue has been flushed.
    while (!pending_.empty()) {
        retire();
    }
    checked("the queue", device_.info().name, [status] { require(status, "clFinish"); });
}

std::vector<PassRecord> TimedQueue::takeRecords()
{
    finish();
    std::vector<PassRecord> records;
    for (Pass& pass : passes_) {
        records.push_back(std::move(pass.record));
    }
    passes_.clear();
    return records;
}

double TimedQueue::deviceMilliseconds()
{
    finish();
    double sum = 0.0;
    for (const Pass& pass : passes_) {
        sum += pass.record.milliseconds;
    }
    return sum;
}

} // namespace wedge::device
