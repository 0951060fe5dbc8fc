// What is said where drivers show no device: whether there is no driver, or one that shows none, and why.
#pragma once

#include "host/device/opencl.h"
#include "host/error.h"

#include <string>
#include <vector>

namespace wedge::device {

/// A platform without a device.
struct SilentPlatform {
    std::string name, version;
    cl_int code = CL_DEVICE_NOT_FOUND; ///< what its driver answered
};

/// Why one of the platforms shows no device, where that is known, or "": PoCL shows none where it can make no folder
/// for what it compiles.
std::string whySilent(const std::vector<SilentPlatform>& platforms);

/// The error where there is no device at all. code: what the loader answered when it was asked for platforms.
Error noDevice(cl_int code, const std::vector<SilentPlatform>& platforms);

} // namespace wedge::device
