#pragma once

#include "benchmarks/common/error_curve.h"
#include "benchmarks/soft_shadows/lab.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Unfiltered images with the same number of samples everywhere: error against samples, and against rays.
struct Baseline {
    std::string name;
    std::string meaning; ///< one line
    std::vector<Measured> points;
    Curve samples, rays;
};

/// The method at one budget, once a seed.
struct Method {
    std::string setting; ///< "default" or "published"
    std::vector<Measured> runs;
};

/// How many times the method's samples (or rays) a baseline needs for the same error, once a seed.
struct Savings {
    std::vector<double> samples, rays;
    bool extrapolated = false;
};

Method measureMethod(Lab& lab, bool published);

/// The baselines that a setting is measured against, with curves that reach the method's least error if they can.
/// Default: "stratified", the thesis' baseline, shaded like the method; "sobol", the same with the method's sampler;
/// "plain_mc", stratified and with the cosine and the distance sampled too. Published: "stratified_separate".
std::vector<Baseline> measureBaselines(Lab& lab, const Method& method);

/// Equal raw errors are equal errors without the reference's noise too, which is in both in the same way: nothing
/// needs to be subtracted here.
Savings savings(const Method& method, const Baseline& baseline);

} // namespace wedge::benchmark
