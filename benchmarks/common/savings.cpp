#include "benchmarks/common/savings.h"

#include "host/error.h"

#include <algorithm>
#include <iterator>

namespace wedge::benchmark {
namespace {

// Apart from the method's seeds 1, 2, 3 ...
constexpr std::uint32_t baselineSeed = 101;

} // namespace

double Method::leastError() const { return std::ranges::min(runs, {}, &Measured::error).error; }

double Method::leastRegionError() const { return std::ranges::min(runs, {}, &Measured::regionError).regionError; }

std::vector<double> Method::errors() const
{
    std::vector<double> out;
    std::ranges::transform(runs, std::back_inserter(out), &Measured::error);
    return out;
}

Method measureMethod(Lab& lab, const std::string& name, const render::Settings& settings)
{
    Method out { name, {} };
    for (int seed = 1; seed <= lab.plan().seeds; ++seed) {
        out.runs.push_back(lab.measure(settings, static_cast<std::uint32_t>(seed)));
    }
    return out;
}

Comparison compareWith(Lab& lab, const Method& method, const std::string& name, const std::string& meaning,
    const BaselineSettings& settings)
{
    const double error = method.leastError();
    if (!(error > 0)) {
        throw Error("scene " + lab.name(), "has no error to compare", "measure one in which the method estimates");
    }
    Baseline out { name, meaning, {}, {}, {}, {} };
    const double regionError = method.leastRegionError();
    const auto measure = [&](int spp) {
        out.points.push_back(lab.measure(settings(spp), baselineSeed));
        return CurvePoint { out.points.back().spp, out.points.back().error };
    };
    for (const int spp : lab.plan().baselineSpp) {
        out.samples.push_back(measure(spp));
    }
    if (lab.plan().powersOfFour) {
        const auto reached = [&] {
            return out.points.back().error <= error && out.points.back().regionError <= regionError;
        };
        for (int spp = 4 * lab.plan().baselineSpp.back(); !reached() && spp <= lab.plan().largestBaseline; spp *= 4) {
            out.samples.push_back(measure(spp));
        }
    } else {
        extend(out.samples, error, lab.plan().largestBaseline, measure);
    }
    for (const Measured& point : out.points) {
        out.rays.push_back({ point.rays, point.error });
        if (regionError > 0) {
            out.region.push_back({ point.spp, point.regionError });
        }
    }
    Savings saved = savings(method, out);
    return { std::move(out), std::move(saved) };
}

Savings savings(const Method& method, const Baseline& baseline)
{
    Savings out;
    for (const Measured& run : method.runs) {
        const Crossing samples = costAt(baseline.samples, run.error);
        out.samples.push_back(samples.cost / run.spp);
        out.rays.push_back(costAt(baseline.rays, run.error).cost / run.rays);
        out.extrapolated |= samples.extrapolated;
        if (!baseline.region.empty()) {
            const Crossing region = costAt(baseline.region, run.regionError);
            out.region.push_back(region.cost / run.spp);
            out.regionExtrapolated |= region.extrapolated;
        }
    }
    return out;
}

} // namespace wedge::benchmark
