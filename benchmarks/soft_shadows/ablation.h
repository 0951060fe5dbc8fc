#pragma once

#include "benchmarks/common/setting_result.h"
#include "benchmarks/soft_shadows/shadow_lab.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// The curves of Fig. 3.6c: the six combinations of sampling and filter at the plan's budgets, for one setting. Uniform
/// counts are about the means of the adaptive ones; NAS with UF is plain Monte Carlo. NAF has the width with the
/// smallest error at about 28 samples, found for AS and NAS each.
std::vector<Series> ablations(ShadowLab& lab, bool published);

/// The default setting at its usual budget, with one width in place of the adaptive ones: the best one.
FixedBlur bestFixedBlur(ShadowLab& lab);

/// The error by mu; sampling and filter adaptive, samples following from mu.
std::vector<Measured> convergence(ShadowLab& lab, bool published);

/// True if each point has a smaller error than the one before.
bool falls(const std::vector<Measured>& points);

} // namespace wedge::benchmark
