#pragma once

#include "benchmarks/harness/scene_result.h"

#include <vector>

namespace wedge::benchmark {

/// The best single width, with the settings' counts or their mean for each pixel.
FixedWidth bestFixedWidth(Lab& lab, const FixedWidthRule& rule, const render::Settings& usual);

/// The error by mu with everything adaptive, samples following from mu; none where the plan has no mu.
std::vector<Measured> convergence(Lab& lab, const Case& of, bool published);

/// The benchmark's ablations of one setting at the plan's budgets. Uniform counts are about the means of the adaptive
/// ones. The one width is the best one at the usual budget, found for AS and NAS each. plain: the points of the first
/// baseline.
std::vector<CurveResult> ablations(
    Lab& lab, const Benchmark& benchmark, const Case& of, bool published, const std::vector<Measured>& plain);

/// Sample counts of variants: those of the plan and the usual one, ascending.
std::vector<int> budgetsOf(const MeasurePlan& plan, int usualSpp);

/// The benchmark's variants at these budgets.
std::vector<CurveResult> variants(
    Lab& lab, const Benchmark& benchmark, const Case& of, const std::vector<int>& budgets);

/// True if each point has a smaller error than the one before.
bool falls(const std::vector<Measured>& points);

} // namespace wedge::benchmark
