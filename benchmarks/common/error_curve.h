#pragma once

#include <functional>
#include <vector>

namespace wedge::benchmark {

/// What one render cost and how far it is from the reference.
struct CurvePoint {
    double cost = 0; ///< samples a pixel, or rays
    double error = 0; ///< RMS
};

/// Error against cost, by ascending cost.
using Curve = std::vector<CurvePoint>;

/// Where a curve reaches an error.
struct Crossing {
    double cost = 0;
    bool extrapolated = false; ///< the error lies beyond the curve's ends
};

/// The cost at which the curve reaches `error`, linear in the logarithms of both. Beyond either end the first or last
/// piece goes on, which is marked. Where the curve is not monotonic, the first piece that reaches the error counts.
/// The curve needs two points of different cost, and positive errors and costs; otherwise std::invalid_argument.
/// A last piece that does not fall never reaches a smaller error: the cost is then infinite.
Crossing costAt(const Curve& curve, double error);

/// Lengthens a curve until it reaches `error` or costs `most`: each further point lies at the whole square that
/// costAt() predicts with a margin. Jittered strata fill a light evenly only in square counts.
/// measure: renders with that many samples.
void extend(Curve& curve, double error, int most, const std::function<CurvePoint(int samples)>& measure);

} // namespace wedge::benchmark
