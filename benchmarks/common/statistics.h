#pragma once

#include <vector>

namespace wedge::benchmark {

/// Order statistics of repeated measurements, in their unit. Quartiles interpolate linearly between neighbours.
struct Summary {
    double median = 0, q1 = 0, q3 = 0, min = 0, max = 0;
    /// What claims give as their spread: the distance between the quartiles.
    double spread() const { return q3 - q1; }
};

/// All zero for no values.
Summary summarize(std::vector<double> values);

} // namespace wedge::benchmark
