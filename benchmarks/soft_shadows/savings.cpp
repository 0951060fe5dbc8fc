#include "benchmarks/soft_shadows/savings.h"

#include "host/error.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

using render::Sampler;
using render::Settings;
using render::Shading;

// Apart from the method's seeds 1, 2, 3 ...
constexpr std::uint32_t baselineSeed = 101;

double leastError(const std::vector<Measured>& runs) { return std::ranges::min(runs, {}, &Measured::rmse).rmse; }

Baseline measureBaseline(
    Lab& lab, const std::string& name, const std::string& meaning, Sampler sampler, Shading shading, double error)
{
    Baseline out { name, meaning, {}, {}, {} };
    const auto measure = [&](int spp) {
        Settings settings = render::monteCarlo(spp);
        settings.sampler = sampler;
        settings.shading = shading;
        out.points.push_back(lab.measure(settings, baselineSeed));
        return CurvePoint { out.points.back().spp, out.points.back().rmse };
    };
    for (const int spp : lab.plan().baselineSpp) {
        out.samples.push_back(measure(spp));
    }
    extend(out.samples, error, lab.plan().largestBaseline, measure);
    for (const Measured& point : out.points) {
        out.rays.push_back({ point.shadowRays, point.rmse });
    }
    return out;
}

} // namespace

Method measureMethod(Lab& lab, bool published)
{
    Method out { published ? "published" : "default", {} };
    const Settings settings = published ? render::asPublished(publishedMu) : render::axisAligned(defaultSpp);
    for (int seed = 1; seed <= lab.plan().seeds; ++seed) {
        out.runs.push_back(lab.measure(settings, static_cast<std::uint32_t>(seed)));
    }
    return out;
}

std::vector<Baseline> measureBaselines(Lab& lab, const Method& method)
{
    const double error = leastError(method.runs);
    if (!(error > 0)) {
        throw Error("scene " + lab.name(), "has no error to compare", "measure one with soft shadows in view");
    }
    if (method.setting == "published") {
        return { measureBaseline(lab, "stratified_separate", "unfiltered, stratified, shading apart from visibility",
            Sampler::Stratified, Shading::Separate, error) };
    }
    return {
        measureBaseline(lab, "stratified", "unfiltered, stratified, shaded like the method", Sampler::Stratified,
            Shading::Ratio, error),
        measureBaseline(lab, "sobol", "unfiltered, Owen-scrambled Sobol, shaded like the method", Sampler::Sobol,
            Shading::Ratio, error),
        measureBaseline(lab, "plain_mc", "unfiltered, stratified, cosine and distance sampled too", Sampler::Stratified,
            Shading::Inside, error),
    };
}

Savings savings(const Method& method, const Baseline& baseline)
{
    Savings out;
    for (const Measured& run : method.runs) {
        const Crossing samples = costAt(baseline.samples, run.rmse);
        out.samples.push_back(samples.cost / run.spp);
        out.rays.push_back(costAt(baseline.rays, run.rmse).cost / run.shadowRays);
        out.extrapolated |= samples.extrapolated;
    }
    return out;
}

} // namespace wedge::benchmark
