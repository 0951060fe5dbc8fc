#pragma once

#include "benchmarks/common/error_curve.h"
#include "benchmarks/common/lab.h"

#include <functional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Unfiltered images with the same number of samples everywhere: error against samples, and against rays.
struct Baseline {
    std::string name;
    std::string meaning; ///< one line
    std::vector<Measured> points;
    Curve samples, rays;
    Curve region; ///< samples against the error of Subject::regionOf(); empty where there is none
};

/// The method at one budget, once a seed.
struct Method {
    std::string setting; ///< "default" or "published"
    std::vector<Measured> runs;

    double leastError() const;
    double leastRegionError() const;
    std::vector<double> errors() const;
};

/// How many times the method's samples (or rays) a baseline needs for the same error, once a seed.
struct Savings {
    std::vector<double> samples, rays;
    std::vector<double> region; ///< samples at equal error of Subject::regionOf(), which the means are not of
    bool extrapolated = false, regionExtrapolated = false;
};

/// A baseline, and what the method saves against it.
struct Comparison {
    Baseline baseline;
    Savings saved;
};

/// The settings once for each of the plan's seeds, from 1.
Method measureMethod(Lab& lab, const std::string& name, const render::Settings& settings);

/// What a baseline renders with that many samples.
using BaselineSettings = std::function<render::Settings(int spp)>;

/// Measures a baseline with curves that reach the method's least errors if they can, within the plan's limits, and what
/// the method saves against it. Throws Error where the method has no error.
Comparison compareWith(Lab& lab, const Method& method, const std::string& name, const std::string& meaning,
    const BaselineSettings& settings);

/// Equal raw errors are equal errors without the reference's noise too, which is in both in the same way: only beyond
/// and between a curve's points it matters whether it has been subtracted.
Savings savings(const Method& method, const Baseline& baseline);

} // namespace wedge::benchmark
