#pragma once

#include "host/device/limits.h"
#include "host/device/opencl.h"

#include <string>
#include <vector>

namespace wedge::device {

/// The devices of all platforms, in the order of the OpenCL loader; the same on every call of a process. Empty where
/// there is no platform. A platform that fails to answer is left out. Includes devices that wedge cannot use, which
/// say so in `unusable`.
std::vector<DeviceInfo> listDevices();

/// Throws the Error that says why listDevices() is empty. Returns where it is not.
void requireDevices();

/// Lines for the user about this process's drivers, each once: where their caches are if not where they were wanted,
/// what was found damaged there, and why a driver shows no device.
std::vector<std::string> deviceNotices();

/// A device with its context. Copies share both.
class Device {
public:
    /// Opens the device that the selector names: "" the first GPU, or else the first CPU, or else the first device;
    /// "cpu" or "gpu" the first of that type; a number, the index in listDevices(); anything else, the first device
    /// with that text in its name, or else in its platform's name. Case does not matter, and unusable devices count
    /// only where an index names one. Throws Error: none found, none that can be used, no match (lists the devices), or
    /// unusable.
    static Device open(const std::string& selector);

    const DeviceInfo& info() const { return info_; }
    const cl::Device& cl() const { return device_; }
    const cl::Context& context() const { return context_; }

private:
    Device(DeviceInfo info, cl::Device device);

    DeviceInfo info_;
    cl::Device device_;
    cl::Context context_;
};

} // namespace wedge::device
