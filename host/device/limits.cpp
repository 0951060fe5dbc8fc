#include "host/device/limits.h"

#include "host/device/cl_error.h"
#include "host/device/quirks.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <vector>

namespace wedge::device {
namespace {

/// Work-groups of 64 are full on every GPU and give CPUs whole vectors with little private memory.
constexpr std::size_t usualWorkGroup = 64;
/// See DeviceInfo::maxTiledItems: the drivers' bound on the grid is 65535, exclusive.
constexpr std::size_t smallGridItems = 65534;
/// Times may exceed the host's by the clocks' drift and resolution.
constexpr double clockSlackMilliseconds = 1.0;

DeviceType typeOf(cl_device_type type)
{
    if ((type & CL_DEVICE_TYPE_GPU) != 0) {
        return DeviceType::Gpu;
    }
    if ((type & CL_DEVICE_TYPE_CPU) != 0) {
        return DeviceType::Cpu;
    }
    return (type & CL_DEVICE_TYPE_ACCELERATOR) != 0 ? DeviceType::Accelerator : DeviceType::Other;
}

/// Why the device cannot run wedge's programs, or "".
std::string whyUnusable(const cl::Device& device, const std::string& version)
{
    unsigned majorVersion = 0;
    unsigned minorVersion = 0;
    const int parsed = std::sscanf(version.c_str(), "OpenCL %u.%u", &majorVersion, &minorVersion);
    if (parsed != 2) {
        return "a version that is none of OpenCL: " + version;
    }
    if (majorVersion * 10 + minorVersion < 12) {
        return "older than OpenCL 1.2";
    }
    if (device.getInfo<CL_DEVICE_AVAILABLE>() == CL_FALSE) {
        return "not available";
    }
    if (device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE) {
        return "no compiler";
    }
    return device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() == CL_FALSE ? "big-endian" : "";
}

} // namespace

std::string trimmed(std::string text)
{
    const std::string blanks(" \t\r\n\0", 5);
    const auto last = text.find_last_not_of(blanks);
    text.erase(last == std::string::npos ? 0 : last + 1);
    text.erase(0, std::min(text.find_first_not_of(blanks), text.size()));
    return text;
}

std::string_view deviceTypeName(DeviceType type)
{
    switch (type) {
    case DeviceType::Cpu:
        return "cpu";
    case DeviceType::Gpu:
        return "gpu";
    case DeviceType::Accelerator:
        return "accelerator";
    case DeviceType::Other:
        break;
    }
    return "other";
}

DeviceInfo queryDevice(const cl::Platform& platform, const cl::Device& device, unsigned index)
{
    return checked("device query", "device " + std::to_string(index), [&] {
        DeviceInfo info;
        info.index = index;
        info.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        info.platformVersion = trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
        info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
        info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
        info.deviceVersion = trimmed(device.getInfo<CL_DEVICE_VERSION>());
        info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
        info.type = typeOf(device.getInfo<CL_DEVICE_TYPE>());
        info.computeUnits = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
        info.clockMegahertz = device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>();
        info.nativeFloatWidth = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
        info.globalMemory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
        info.maxAllocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
        info.localMemory = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
        info.maxWorkGroup = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
        info.doubles = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
        info.exactDivision = (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
        info.unusable = whyUnusable(device, info.deviceVersion);
        info.defaultWorkGroup = std::min(usualWorkGroup, info.maxWorkGroup);
        info.hostTimers = device.getInfo<CL_DEVICE_PROFILING_TIMER_RESOLUTION>() == 0;
        info.unifiedMemory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
        info.localMemoryIsGlobal = device.getInfo<CL_DEVICE_LOCAL_MEM_TYPE>() != CL_LOCAL;
        info.maxTiledItems =
            info.type == DeviceType::Cpu ? smallGridItems : std::numeric_limits<cl_uint>::max() / std::size_t { 2 };
        info.failsWithParts = driverFailsWithParts(info.platformVersion);
        info.quirks = applyQuirks(info);
        return info;
    });
}

std::optional<double> eventMilliseconds(const cl::Event& event, double hostMilliseconds)
{
    cl_ulong start = 0;
    cl_ulong end = 0;
    if (event.getProfilingInfo(CL_PROFILING_COMMAND_START, &start) != CL_SUCCESS
        || event.getProfilingInfo(CL_PROFILING_COMMAND_END, &end) != CL_SUCCESS || start == 0 || end < start) {
        return std::nullopt;
    }
    const double milliseconds = static_cast<double>(end - start) * 1e-6;
    if (milliseconds > hostMilliseconds + clockSlackMilliseconds) {
        return std::nullopt;
    }
    return milliseconds;
}

bool probeHostTimers(const cl::Context& context, const cl::Device& device)
{
    const std::vector<char> data(std::size_t { 1 } << 20);
    const cl::CommandQueue queue(context, device, CL_QUEUE_PROFILING_ENABLE);
    const cl::Buffer buffer(context, CL_MEM_READ_WRITE, data.size());
    cl::Event event;
    const auto before = std::chrono::steady_clock::now();
    queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, data.size(), data.data(), nullptr, &event);
    event.wait();
    const std::chrono::duration<double, std::milli> host = std::chrono::steady_clock::now() - before;
    const std::optional<double> milliseconds = eventMilliseconds(event, host.count());
    return !milliseconds || *milliseconds < 1e-3;
}

} // namespace wedge::device
