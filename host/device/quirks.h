// Faults of drivers that wedge works around, in one place, each told by what the driver reports and never by a name of
// a device. docs/porting.md has the drivers that were tried.
#pragma once

#include "host/device/limits.h"

#include <string>
#include <string_view>
#include <vector>

namespace wedge::device {

/// Whether a platform's version is that of a PoCL whose default way to make work-groups ("loopvec") ends the process
/// while it compiles: 6 and older on LLVM 18 and newer, which verifies what these hand to it ("Instruction Combining
/// did not reach a fixpoint after 1 iterations", PoCL's issue 1608, mended in 7.0). Continuation-based synchronisation
/// ("cbs") compiles everything, to the same bits, and runs in 0.85 to 1.05 of the time.
bool poclFailsToCompile(std::string_view platformVersion);

/// Whether a platform's driver keeps what it compiled by itself and finds it again: PoCL, unless POCL_KERNEL_CACHE is
/// set, and not to 1, in the environment. Asked for a program's binary, it compiles all of its kernels once more, for
/// work-groups of any size: what it has compiled and launched by then is for given sizes.
bool driverKeepsKernels(std::string_view platformVersion);

/// Whether a platform's driver ends the process when parts of one buffer are released that overlap in part: NVIDIA's
/// (580.159 does, in clReleaseMemObject; parts that are the same, or lie apart, are fine).
bool driverFailsWithParts(std::string_view platformVersion);

/// Does what has to be done before the driver of this device compiles anything, and says which quirks are in force
/// there, a line each. What the user has set in the environment stays as it is.
std::vector<std::string> applyQuirks(const DeviceInfo& info);

} // namespace wedge::device
