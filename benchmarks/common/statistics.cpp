#include "benchmarks/common/statistics.h"

#include <algorithm>
#include <cmath>

namespace wedge::benchmark {
namespace {

double quantile(const std::vector<double>& sorted, double q)
{
    const double at = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(at));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

} // namespace

Summary summarize(std::vector<double> values)
{
    if (values.empty()) {
        return {};
    }
    std::ranges::sort(values);
    return { quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75), values.front(), values.back() };
}

} // namespace wedge::benchmark
