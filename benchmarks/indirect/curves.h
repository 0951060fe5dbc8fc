#pragma once

#include "benchmarks/common/setting_result.h"
#include "benchmarks/indirect/plan.h"

#include <vector>

namespace wedge::benchmark {

/// The curves of Fig. 4.10 for one setting, with one bounce: uniform counts with the filter, adaptive counts with the
/// filter, at the same means; and plain stratified path tracing, which `plain` has been measured for.
std::vector<Series> filterCurves(Lab& lab, const Plan& plan, bool published, const std::vector<Measured>& plain);

/// The default setting's mean count, the same for each pixel, with the best single width in place of the adaptive ones.
FixedBlur bestUniformBlur(Lab& lab, const render::Settings& usual);

} // namespace wedge::benchmark
