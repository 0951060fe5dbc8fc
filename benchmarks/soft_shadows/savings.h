#pragma once

#include "benchmarks/common/savings.h"

#include <vector>

namespace wedge::benchmark {

/// The baselines that a setting is measured against, with curves that reach the method's least error if they can.
/// Default: "stratified", the thesis' baseline, shaded like the method; "sobol", the same with the method's sampler;
/// "plain_mc", stratified and with the cosine and the distance sampled too. Published: "stratified_separate".
std::vector<Comparison> compareWithBaselines(Lab& lab, const Method& method);

} // namespace wedge::benchmark
