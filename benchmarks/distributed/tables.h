#pragma once

#include "benchmarks/distributed/run.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Table 5.2 with the thesis' rows; errors by rays and rays saved where they were measured; goals.
std::string tablesOf(const std::vector<DistributedResult>& results);

} // namespace wedge::benchmark
