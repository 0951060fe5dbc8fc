#include "benchmarks/rays/clocks.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <thread>

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace wedge::benchmark {
namespace {

using Clock = std::chrono::steady_clock;

int openCounter(std::uint64_t event)
{
    perf_event_attr attributes {};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = event;
    attributes.inherit = 1;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    return static_cast<int>(::syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
}

std::optional<double> readCounter(int file)
{
    std::uint64_t value = 0;
    if (file < 0 || ::read(file, &value, sizeof value) != static_cast<ssize_t>(sizeof value))
        return {};
    return static_cast<double>(value);
}

double processorSeconds()
{
    timespec now {};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wallSeconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

void timeOne(const Contender& contender, const TimingPlan& plan, Runs& runs)
{
    const auto before = plan.counters ? plan.counters->read() : std::nullopt;
    const double start = plan.cpuTime ? processorSeconds() : wallSeconds();
    contender.run();
    const double end = plan.cpuTime ? processorSeconds() : wallSeconds();
    runs.seconds.push_back(plan.cpuTime ? (end - start) / plan.threads : end - start);
    if (const auto after = before ? plan.counters->read() : std::nullopt) {
        runs.cycles.push_back(after->cycles - before->cycles);
        runs.instructions.push_back(after->instructions - before->instructions);
    }
}

} // namespace

HardwareCounters::HardwareCounters()
    : cycles_(openCounter(PERF_COUNT_HW_CPU_CYCLES))
{
    if (cycles_ < 0) {
        problem_ = std::strerror(errno);
        return;
    }
    instructions_ = openCounter(PERF_COUNT_HW_INSTRUCTIONS);
    if (instructions_ < 0)
        problem_ = std::strerror(errno);
}

HardwareCounters::~HardwareCounters()
{
    for (const int file : { cycles_, instructions_ })
        if (file >= 0)
            ::close(file);
}

std::optional<HardwareCounters::Values> HardwareCounters::read() const
{
    const auto cycles = readCounter(cycles_), instructions = readCounter(instructions_);
    if (!cycles || !instructions)
        return {};
    return Values { *cycles, *instructions };
}

double timeStampFrequency()
{
#if defined(__x86_64__)
    const double start = wallSeconds();
    const auto first = __rdtsc();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto last = __rdtsc();
    return static_cast<double>(last - first) / (wallSeconds() - start);
#else
    return 0;
#endif
}

std::vector<Runs> timeInterleaved(const std::vector<Contender>& contenders, const TimingPlan& plan)
{
    std::vector<Runs> out;
    for (const Contender& contender : contenders) {
        contender.run();
        out.push_back({ contender.name, contender.ours, {}, {}, {} });
    }
    for (std::size_t repeat = 0; repeat < static_cast<std::size_t>(plan.repeats); ++repeat)
        for (std::size_t k = 0; k < contenders.size(); ++k) {
            const std::size_t i = (k + repeat) % contenders.size();
            timeOne(contenders[i], plan, out[i]);
        }
    return out;
}

} // namespace wedge::benchmark
