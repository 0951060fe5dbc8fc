// What wedge asks of a device: its limits, and its quirks, each found by a query or a probe and never by a name.
#pragma once

#include "host/device/opencl.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::device {

enum class DeviceType { Cpu, Gpu, Accelerator, Other };

/// "cpu", "gpu", "accelerator" or "other".
std::string_view deviceTypeName(DeviceType type);

/// Everything wedge queries of a device. Sizes in bytes.
struct DeviceInfo {
    unsigned index = 0; ///< position in listDevices(), what `--device N` names
    std::string platform, platformVersion;
    std::string name, vendor;
    std::string deviceVersion; ///< "OpenCL 3.0 ..."
    std::string driver;
    DeviceType type = DeviceType::Other;
    unsigned computeUnits = 1;
    unsigned clockMegahertz = 0;
    unsigned nativeFloatWidth = 1; ///< floats of one hardware vector
    std::uint64_t globalMemory = 0;
    std::uint64_t maxAllocation = 0; ///< the largest single buffer
    std::uint64_t localMemory = 0; ///< of one work-group
    std::size_t maxWorkGroup = 1; ///< items; a kernel may allow fewer
    bool doubles = false; ///< 64-bit floats in kernels
    bool exactDivision = false; ///< can round quotients and square roots correctly, if told to
    std::string unusable; ///< why wedge cannot run here ("no compiler"), empty if it can

    /// 64 where the device allows it: fills a wavefront of every GPU and a vector of every CPU.
    std::size_t defaultWorkGroup = 1;

    // Quirks.

    /// Event times are zero or absurd (seen with several drivers: zero, or end = start + 1 ns), so that queues must
    /// time by the host's clock. In listDevices() a guess from the timer's resolution; probed by Device::open().
    bool hostTimers = false;
    /// Device memory is host memory: what the device allocates is taken from what the host has.
    bool unifiedMemory = false;
    /// Local memory is ordinary memory (CPUs): staging data in it costs copies and gains nothing.
    bool localMemoryIsGlobal = false;
    /// Most items of one bounded launch. CPU drivers may compile a kernel once for grids below 65535 items and once
    /// more for larger ones; batches that stay below never pay the second compilation in the middle of a frame.
    std::size_t maxTiledItems = 0;
    /// Parts of buffers that overlap, used one after the other, end the process (quirks.h).
    bool failsWithParts = false;
    /// Those in force, a line each for the user (quirks.h).
    std::vector<std::string> quirks;
};

/// A driver's string without blanks at its ends, with which some pad names, and without the terminating zeros that
/// opencl.hpp keeps of some.
std::string trimmed(std::string text);

/// Queries one device and applies its quirks; hostTimers is a guess. Throws wedge::Error if a query fails.
DeviceInfo queryDevice(const cl::Platform& platform, const cl::Device& device, unsigned index);

/// The event's START..END in milliseconds, or nothing where the times cannot be true: no start, an end before the
/// start, or more than the hostMilliseconds in which it was submitted and seen finished. The event must be complete.
/// Throws cl::Error.
std::optional<double> eventMilliseconds(const cl::Event& event, double hostMilliseconds);

/// True if event times cannot be trusted: times a 1 MiB transfer, which takes no device less than a microsecond.
/// Throws cl::Error.
bool probeHostTimers(const cl::Context& context, const cl::Device& device);

} // namespace wedge::device
