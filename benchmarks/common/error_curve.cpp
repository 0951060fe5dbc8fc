#include "benchmarks/common/error_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace wedge::benchmark {
namespace {

// Beyond the predicted cost, so that the error is nearly always reached at once; and never further at a time than this.
constexpr double margin = 1.15;
constexpr double largestStep = 6.0;

} // namespace

Crossing costAt(const Curve& curve, double error)
{
    const bool positive = std::ranges::all_of(curve, [](const CurvePoint& p) { return p.cost > 0 && p.error > 0; });
    if (curve.size() < 2 || !positive || !(error > 0)) {
        throw std::invalid_argument("costAt: needs two points, and positive costs and errors");
    }
    std::size_t i = 1;
    while (i + 1 < curve.size() && curve[i].error > error) {
        ++i;
    }
    const CurvePoint& a = curve[i - 1];
    const CurvePoint& b = curve[i];
    if (!(a.cost < b.cost)) {
        throw std::invalid_argument("costAt: costs must ascend");
    }
    const bool extrapolated = error > curve.front().error || b.error > error;
    const double fall = std::log(a.error / b.error);
    if (!(fall > 0)) {
        return { b.error <= error ? a.cost : std::numeric_limits<double>::infinity(), extrapolated };
    }
    return { a.cost * std::exp(std::log(a.error / error) / fall * std::log(b.cost / a.cost)), extrapolated };
}

void extend(Curve& curve, double error, int most, const std::function<CurvePoint(int samples)>& measure)
{
    while (curve.back().error > error && curve.back().cost < most) {
        const double last = curve.back().cost;
        const double wanted = std::clamp(margin * costAt(curve, error).cost, margin * last, largestStep * last);
        const double side = std::ceil(std::sqrt(std::min(wanted, static_cast<double>(most))));
        curve.push_back(measure(static_cast<int>(side * side)));
    }
}

} // namespace wedge::benchmark
