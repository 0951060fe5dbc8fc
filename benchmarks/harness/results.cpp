#include "benchmarks/harness/results.h"

namespace wedge::benchmark {
namespace {

Json dataOf(const Measured& m, const char* raysKey)
{
    Json out { { "spp", number(m.spp) }, { raysKey, number(m.rays) }, { "rmse", number(m.rmse) },
        { "rmse_corrected", number(m.corrected) }, { "mu", m.mu }, { "seed", m.seed } };
    if (m.regionError > 0) {
        out["rmse_region"] = number(m.regionError);
    }
    return out;
}

Json dataOf(const Comparison& c, const char* raysKey);
Json dataOf(const CurveResult& curve, const char* raysKey);
Json dataOf(const Bias& b);
Json dataOf(const Map& map);
Json dataOf(const CaseSetting& setting, const Benchmark& benchmark);

/// All of them, as dataOf(ITEM, more...) has each.
template <class Item, class... More>
Json listOf(const std::vector<Item>& items, const More&... more)
{
    Json out = Json::array();
    for (const Item& item : items) {
        out.push_back(dataOf(item, more...));
    }
    return out;
}

Json dataOf(const Comparison& c, const char* raysKey)
{
    Json out { { "name", c.baseline.name }, { "meaning", c.baseline.meaning },
        { "points", listOf(c.baseline.points, raysKey) }, { "samples_saved", json(summarize(c.saved.samples)) },
        { "rays_saved", json(summarize(c.saved.rays)) }, { "extrapolated", c.saved.extrapolated } };
    if (!c.saved.region.empty()) {
        out["region_saved"] = json(summarize(c.saved.region));
        out["region_extrapolated"] = c.saved.regionExtrapolated;
    }
    return out;
}

Json dataOf(const CurveResult& curve, const char* raysKey)
{
    Json out = curve.head;
    out["points"] = listOf(curve.points, raysKey);
    if (!curve.widths.empty()) {
        out["widths_pixels"] = curve.widths;
    }
    return out;
}

Json dataOf(const FixedWidth& fixed, const char* raysKey)
{
    Json out = dataOf(fixed.measured, raysKey);
    out["width_pixels"] = fixed.width;
    return out;
}

Json dataOf(const Bias& b)
{
    return { { "setting", settingName(b.published) }, { "mu", b.mu }, { "spp", number(b.spp) },
        { "bias", number(b.rms) }, { "mean_error", number(b.meanError) }, { "rmse", number(b.rmse) } };
}

Json dataOf(const Map& map)
{
    return { { "file", map.file }, { "quantity", map.quantity }, { "unit", map.unit }, { "low", number(map.low) },
        { "high", number(map.high) }, { "logarithmic", map.logarithmic } };
}

Json dataOf(const std::map<std::string, Reference>& references)
{
    Json out = Json::array();
    for (const auto& [integrand, r] : references) {
        out.push_back({ { "integrand", integrand }, { "spp", r.spp }, { "noise", number(r.noise) },
            { "cached", r.cached }, { "other_kernels", r.otherKernels } });
    }
    return out;
}

Json dataOf(const CaseSetting& setting, const Benchmark& benchmark)
{
    Json out = benchmark.settingData(setting);
    out["spp"] = number(setting.timing.spp);
    out["mrays_s"] = number(setting.timing.megaraysPerSecond);
    for (const auto& [name, summary] : setting.timing.columns) {
        out["timing"][name] = json(summary);
    }
    if (setting.method.runs.empty()) {
        return out;
    }
    out["method"] = listOf(setting.method.runs, benchmark.raysKey);
    out["baselines"] = listOf(setting.baselines, benchmark.raysKey);
    if (!setting.convergence.empty()) {
        out["convergence"] = listOf(setting.convergence, benchmark.raysKey);
    }
    if (benchmark.region != nullptr) {
        out["region_fraction"] = number(setting.regionFraction);
    }
    if (setting.blur) {
        out["blur"] = { { "width_pixels", *benchmark.blurWidth },
            { "points", listOf(setting.blur->runs, benchmark.raysKey) } };
    }
    if (setting.rival) {
        out["rival"] = { { "name", benchmark.rival->name }, { "meaning", benchmark.rival->meaning },
            { "points", listOf(setting.rival->runs, benchmark.raysKey) } };
    }
    if (setting.fixedWidth && !benchmark.settingsByName) {
        out["fixed_blur"] = dataOf(*setting.fixedWidth, benchmark.raysKey);
    }
    return out;
}

} // namespace

Json dataOf(const Benchmark& benchmark, const SceneResult& result)
{
    Json out { { "name", result.source.name }, { "origin", result.source.origin }, { "triangles", result.triangles },
        { "seconds", number(result.seconds) } };
    out.update(benchmark.sceneData(result));
    out["references"] = dataOf(result.references);
    if (benchmark.settingsByName) {
        for (const CaseSetting& setting : result.settings) {
            out["settings"][settingName(setting.published)] = dataOf(setting, benchmark);
            if (setting.fixedWidth) {
                out["fixed_blur"] = dataOf(*setting.fixedWidth, benchmark.raysKey);
            }
        }
    } else {
        out["settings"] = listOf(result.settings, benchmark);
    }
    out["curves"] = listOf(result.curves, benchmark.raysKey);
    if (benchmark.plan.biasSeeds > 0) {
        out["bias"] = listOf(result.biases);
    }
    if (benchmark.byRays) {
        out["maps"] = listOf(result.maps);
    }
    return out;
}

Json dataOf(const Benchmark& benchmark, const MeasurePlan& plan)
{
    Json out { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height }, { "frames", plan.frames },
        { "seeds", plan.seeds }, { "reference_spp", plan.referenceSpp }, { "largest_baseline", plan.largestBaseline } };
    out.update(benchmark.planData(plan));
    return out;
}

} // namespace wedge::benchmark
