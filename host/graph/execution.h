#pragma once

#include "host/device/buffer.h"
#include "host/device/program.h"
#include "host/graph/plan.h"
#include "host/graph/rerun.h"
#include "host/graph/trial.h"

#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace wedge::graph {

/// The kernels of a device's programs, each compiled when first asked for.
class Kernels {
public:
    explicit Kernels(device::ProgramLibrary& library)
        : library_(library)
    {
    }
    device::Kernel& find(const device::ProgramSource& program, const std::string& kernel);
    /// Those whose kernels were asked for.
    std::set<device::ProgramSource> programs() const;

private:
    device::ProgramLibrary& library_;
    std::map<std::pair<device::ProgramSource, std::string>, device::Kernel> kernels_;
};

/// Device memory that plans have in turn.
class Memory {
public:
    explicit Memory(const device::Device& device)
        : device_(device)
    {
    }
    /// Allocates pieces of exactly these sizes, bytes; those that there are stay if that is what they are. Throws Error
    /// where the device refuses.
    void hold(const std::vector<std::uint64_t>& slabs);
    /// Bytes allocated.
    std::uint64_t bytes() const;
    const device::Buffer<std::uint8_t>& slab(std::size_t i) const { return slabs_.at(i); }

private:
    const device::Device& device_;
    std::vector<device::Buffer<std::uint8_t>> slabs_;
};

class Execution;

/// What steps on the host and the makers of values see of the execution.
class Run {
public:
    device::TimedQueue& queue() const { return queue_; }
    /// Every kernel is launched at its full size over nothing, for drivers to compile: nothing is computed.
    bool rehearsal() const { return rehearsal_; }
    /// Whether something was left out since somebody asked to stop: a launch was ended early, or a loop before its last
    /// iteration. What is not for sampling goes on.
    bool cut() const { return cut_; }
    /// The pixels that the pass in hand covers.
    const Window& window() const { return pass_->window; }
    /// Iteration of the innermost loop around the pass in hand, or of the one `outward` around that.
    std::size_t iteration(std::size_t outward = 0) const { return iterations_.at(iterations_.size() - 1 - outward); }
    /// Memory of what the step in hand uses. Throws std::logic_error for anything else.
    template <class T>
    device::Buffer<T> buffer(const Version& version) const
    {
        const Resource& resource = used(version);
        return device::Buffer<T>::over(memory(version), resource.bytes() / sizeof(T), resource.name);
    }

private:
    friend class Execution;

    Run(device::TimedQueue& queue, bool rehearsal, const std::atomic<bool>* stop)
        : queue_(queue)
        , rehearsal_(rehearsal)
        , stop_(stop)
    {
    }
    const Resource& used(const Version& version) const;
    const cl::Buffer& memory(const Version& version) const;
    bool stopped() const { return stop_ != nullptr && stop_->load(); }

    device::TimedQueue& queue_;
    bool rehearsal_;
    const std::atomic<bool>* stop_;
    bool cut_ = false;
    const Execution* execution_ = nullptr;
    const PlannedPass* pass_ = nullptr; ///< in hand
    std::vector<std::size_t> iterations_; ///< of the loops, outermost first
};

/// A plan with its memory, ready to run.
class Execution {
public:
    /// memory: as Plan::slabs has it, which this has until it ends. Throws std::logic_error if the plan has a pass
    /// with overlapping memory.
    Execution(const Plan& plan, Memory& memory, Kernels& kernels, device::TimedQueue& queue);

    /// Runs all passes; returns false if some were cut, which *stop asks for, null for never. poison: what has no
    /// contents yet is filled with not-a-numbers, for tests: nobody may see them.
    bool run(const std::atomic<bool>* stop = nullptr, bool poison = false);
    /// The values that are changing(), as a run would have them now.
    ChangingValues changingValues();
    /// After a run() of the same plan that was whole, in the same memory: runs the passes whose values are others than
    /// `before`, and all that go by what these make. Of plans that can (Plan::runsAgain). Returns as run().
    bool runAgain(const ChangingValues& before, const std::atomic<bool>* stop = nullptr);
    /// Launches every kernel at its full size over nothing; bodies of loops once.
    void rehearse();
    /// What rehearse() launches, which launches nothing this once: for other processes to compile.
    std::vector<Trial> trials();
    const Plan& plan() const { return plan_; }

    /// Contents of a wanted version, or of an import, after run().
    template <class T>
    device::Buffer<T> output(const Version& version) const
    {
        const Resource& resource = plan_.graph.resources().at(version.resource);
        return device::Buffer<T>::over(memory_.at(version.resource), resource.bytes() / sizeof(T), resource.name);
    }

private:
    friend class Run;

    /// Whether all passes from begin up to and without end are left out.
    bool leavesOut(std::size_t begin, std::size_t end) const;
    void runRange(Run& run, std::size_t begin, std::size_t end, int loop);
    void runPass(Run& run, const PlannedPass& planned);
    void launch(Run& run, const PlannedPass& planned);
    void setArguments(Run& run, device::Kernel& kernel, const PlannedPass& planned, const Window& window) const;
    void launchRows(Run& run, device::Kernel& kernel, const PlannedPass& planned);
    void rehearse(Run& run, const PlannedPass& planned);
    Trial trialOf(Run& run, const PlannedPass& planned) const;
    /// How a launch over rows covers its window: bands of rows, so that none is long.
    struct Rows {
        Window all;
        std::size_t columns; ///< items
        int band; ///< rows of a launch
        std::size_t columnsOfGroup;
    };
    Rows rowsOf(const PlannedPass& planned) const;
    void fillNew(const PlannedPass& planned);

    const Plan& plan_;
    Kernels& kernels_;
    device::TimedQueue& queue_;
    std::vector<cl::Buffer> memory_; ///< of each resource that is used
    bool poison_ = false;
    std::vector<Trial>* trials_ = nullptr; ///< while they are asked for
    std::vector<bool> left_; ///< of each pass: it is left out, since what it made is there; empty: none is
};

} // namespace wedge::graph
