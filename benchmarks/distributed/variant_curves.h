#pragma once

#include "benchmarks/distributed/plan.h"
#include "benchmarks/distributed/whole_image.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// Error against rays of one way to make the image.
struct VariantCurve {
    std::string name; ///< "default", "published", "no_factoring", "uniform_counts", "fixed_blur"
    std::string meaning; ///< one line
    std::vector<Measured> points; ///< one a budget, of "published" one a mu
    std::vector<double> widths; ///< of "fixed_blur", standard deviations in pixels
};

/// Sample counts of the curves: those of the plan and the default one, ascending.
std::vector<int> budgetsOf(const WholeImage& subject, const DistributedPlan& plan);

/// All curves but those of unfiltered images.
std::vector<VariantCurve> measureVariants(Lab& lab, const WholeImage& subject, const DistributedPlan& plan);

} // namespace wedge::benchmark
