#pragma once

#include "benchmarks/common/claims.h"
#include "benchmarks/lottery/measure.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// The whole result file; docs/benchmarks.md has its form.
Json lotteryResults(
    const std::vector<LotteryResult>& results, const LotteryPlan& plan, const device::DeviceInfo& device);

/// The results in a file of an earlier call, none where there is no file. Throws Error for a file of another plan, of
/// another version or device, or rendered by other kernels: those are not to be mixed.
std::vector<LotteryResult> resumeLottery(
    const std::string& path, const LotteryPlan& plan, const device::DeviceInfo& device);

} // namespace wedge::benchmark
