#include "benchmarks/bvh_build/memory_use.h"

#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace wedge::benchmark {
namespace {

/// A line of /proc/self/status in bytes; 0 where there is none.
std::size_t statusBytes(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key; std::getline(status, key))
        if (key == name) {
            std::size_t kilobytes = 0;
            status >> kilobytes;
            return 1024 * kilobytes;
        }
    return 0;
}

} // namespace

std::optional<std::size_t> peakMemory(const std::function<void()>& body)
{
#ifdef __GLIBC__
    malloc_trim(0); // what was freed but kept would not be seen again
#endif
    {
        std::ofstream reset("/proc/self/clear_refs");
        reset << "5"; // the peak becomes what is in use
    }
    const std::size_t before = statusBytes("VmHWM:");
    body();
    const std::size_t peak = statusBytes("VmHWM:");
    if (before == 0 || peak < before)
        return std::nullopt;
    return peak - before;
}

} // namespace wedge::benchmark
