#pragma once

#include "benchmarks/common/measure_plan.h"

#include <string>

namespace wedge::benchmark {

/// "64x48" into a plan's size. Throws UsageError.
void setSize(MeasurePlan& plan, const std::string& text);

} // namespace wedge::benchmark
