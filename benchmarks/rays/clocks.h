#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Cycles and instructions of this process in user mode, where the kernel lets it count them. Threads that start later
/// are included, so it is made before any of them.
class HardwareCounters {
public:
    HardwareCounters();
    ~HardwareCounters();
    HardwareCounters(const HardwareCounters&) = delete;
    HardwareCounters& operator=(const HardwareCounters&) = delete;

    struct Values {
        double cycles = 0, instructions = 0;
    };
    /// Since construction; nothing where they cannot be counted.
    std::optional<Values> read() const;
    /// Why they cannot be counted, "" if they can.
    const std::string& problem() const { return problem_; }

private:
    int cycles_ = -1, instructions_ = -1;
    std::string problem_;
};

/// The frequency of the processor's time stamp counter in Hz, by a wait of 50 ms; 0 where there is none.
double timeStampFrequency();

/// One of the things that are compared.
struct Contender {
    std::string name; ///< column of the tables
    bool ours = false;
    std::function<void()> run; ///< traces all rays once
};

/// What runs of one contender took.
struct Runs {
    std::string name;
    bool ours = false;
    std::vector<double> seconds; ///< of each repetition: wall clock, or processor time over threads
    std::vector<double> cycles, instructions; ///< of all threads; empty where they are not counted
};

/// How runs are timed.
struct TimingPlan {
    int repeats = 7;
    bool cpuTime = false; ///< processor time of all threads over `threads`, for machines with other load
    unsigned threads = 1;
    const HardwareCounters* counters = nullptr;
};

/// Runs every contender once untimed, then in each repetition each of them once, another one first each time.
std::vector<Runs> timeInterleaved(const std::vector<Contender>& contenders, const TimingPlan& plan);

} // namespace wedge::benchmark
