#pragma once

#include "host/device/device.h"
#include "host/device/kernel.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::device {

enum class PassKind { Trace, Analysis, Filter, Composite, Transfer };

/// "trace", "analysis", "filter", "composite" or "transfer".
std::string_view passKindName(PassKind kind);

/// What the launches of one name cost together.
struct PassRecord {
    std::string name;
    PassKind kind = PassKind::Trace;
    double milliseconds = 0.0; ///< on the device
    std::uint64_t bytes = 0; ///< moved by transfers, and by kernels that said so with addBytes()
    unsigned launches = 0;
    std::vector<std::string> kernels; ///< that it launched, each once, in their order
};

/// The user asked to stop.
class Cancelled : public std::exception {
public:
    const char* what() const noexcept override { return "cancelled"; }
};

/// An in-order queue that knows what each pass cost. Launches return at once; their times are read from their events
/// (start to end) when the queue finishes, or taken by the host's clock, one launch at a time, where the device's
/// event times are worthless. Every failure is a wedge::Error with the call, the pass, the kernel and the device.
class TimedQueue {
public:
    /// finishAfterEachLaunch: waits for every launch, so that an error names the kernel that made it.
    explicit TimedQueue(const Device& device, bool finishAfterEachLaunch = false);
    ~TimedQueue();
    TimedQueue(const TimedQueue&) = delete;
    TimedQueue& operator=(const TimedQueue&) = delete;

    /// Launches over at least `global` items in work-groups of `local` items: global is padded to a multiple of
    /// local, so kernels test their bounds. Nothing is launched for 0 items. Throws Error if local is 0 or above the
    /// kernel's limit.
    void launch(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t global, std::size_t local);

    /// The same in two dimensions; x varies fastest.
    void launch2D(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t globalX, std::size_t globalY,
        std::size_t localX, std::size_t localY);

    /// Launches groupCount work-groups of `local` items in batches of about setTargetMilliseconds(), the first one
    /// small. Before each batch the kernel's argument firstGroupArg (uint) is set to the batch's first group, so that
    /// a kernel's group is firstGroup + get_group_id(0), and what it computes may depend on nothing else of the
    /// batching. Between batches it reports progress and tests the cancel flag: then it finishes the queue and throws
    /// Cancelled. One batch runs while the next is prepared, and
    /// all have finished on return. workUnits: what the whole launch counts for in the progress.
    void launchTiled(std::string_view pass, PassKind kind, Kernel& kernel, std::size_t groupCount, std::size_t local,
        unsigned firstGroupArg, double workUnits = 1.0);

    /// Copies bytes to or from a buffer at an offset in bytes; waits for it, and so for all launches before it.
    void write(
        std::string_view pass, const cl::Buffer& buffer, std::size_t offset, std::size_t bytes, const void* from);
    void read(std::string_view pass, const cl::Buffer& buffer, std::size_t offset, std::size_t bytes, void* to);
    /// Repeats a pattern (1, 2, 4 ... 128 bytes) over the first bytes of a buffer; bytes is a multiple of it.
    void fill(std::string_view pass, const cl::Buffer& buffer, std::size_t bytes, const void* pattern,
        std::size_t patternBytes);

    /// Adds a transfer that was made outside this queue.
    void recordTransfer(std::string_view pass, std::uint64_t bytes, double milliseconds);
    /// Adds to what a pass is said to move through memory.
    void addBytes(std::string_view pass, PassKind kind, std::uint64_t bytes);

    /// Waits for all launches and reads their times.
    void finish();
    /// Finishes, and hands over one record a pass name, in order of first appearance; the queue starts anew.
    std::vector<PassRecord> takeRecords();

    /// Forgets what tiled passes cost: the next ones begin with small batches again. For after launches over nothing.
    void forgetCosts() { millisecondsPerGroup_.clear(); }
    /// Finishes; the device time of all records since they were last taken.
    double deviceMilliseconds();

    /// Called between the batches of launchTiled() with the work units finished since this call.
    void setProgress(std::function<void(double workUnitsDone)> progress)
    {
        progress_ = std::move(progress);
        workUnitsDone_ = 0.0;
    }
    /// Watched by launchTiled(); nullptr for none. Must outlive its use here.
    void setCancelFlag(const std::atomic<bool>* flag) { cancel_ = flag; }
    /// How long a batch of launchTiled() should take; watchdogs kill launches of seconds. 100 unless set.
    void setTargetMilliseconds(double milliseconds) { targetMilliseconds_ = milliseconds; }

    const Device& device() const { return device_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Pass {
        PassRecord record;
        std::string kernel; ///< the last one launched, for errors that surface later
    };
    struct Pending {
        cl::Event event;
        std::size_t pass; ///< index into passes_
        Clock::time_point submitted;
    };
    struct Size {
        std::size_t x, y;
    };

    std::size_t passOf(std::string_view name, PassKind kind);
    std::string subjectOf(std::size_t pass) const;
    void launchSized(
        std::string_view pass, PassKind kind, Kernel& kernel, Size global, Size local, unsigned dimensions);
    void enqueueKernel(std::size_t pass, Kernel& kernel, Size global, Size local, unsigned dimensions);
    template <class Call>
    void submit(std::size_t pass, const Call& call);
    void transfer(std::string_view pass, std::uint64_t bytes, const std::function<void(cl::Event&)>& call);
    bool oneAtATime() const { return waitForEach_ || hostTimers_; }
    void limitPending();
    void throwIfCancelled();
    double retire();

    Device device_;
    cl::CommandQueue queue_;
    bool waitForEach_;
    bool hostTimers_; ///< as the device's, and from the first absurd event time on
    std::deque<Pending> pending_; ///< submitted and not yet measured, in order
    Clock::time_point lastRetired_ {};
    std::vector<Pass> passes_;
    std::map<std::string, double, std::less<>> millisecondsPerGroup_; ///< of tiled passes, as last measured
    std::function<void(double)> progress_;
    const std::atomic<bool>* cancel_ = nullptr;
    double targetMilliseconds_ = 100.0;
    double workUnitsDone_ = 0.0;
};

} // namespace wedge::device
