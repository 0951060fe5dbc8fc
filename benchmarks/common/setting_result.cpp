#include "benchmarks/common/setting_result.h"

#include "benchmarks/common/image_bias.h"

namespace wedge::benchmark {
namespace {

using Optional = std::optional<double>;

constexpr double wallGapGoal = 0.05;

} // namespace

void addTimeClaims(ClaimList& list, const SettingResult& setting, const std::string& suffix, const PaperRow* paper,
    Optional overheadGoal)
{
    const Timing& t = setting.timing;
    list.add("overhead" + suffix, t["overhead_fraction"], "1",
        paper ? Optional(paper->overhead / paper->total) : Optional(), overheadGoal);
    list.add("overhead_ms" + suffix, t["overhead"], "ms", paper ? Optional(paper->overhead) : Optional());
    list.add("total_ms" + suffix, t["total"], "ms", paper ? Optional(paper->total) : Optional());
    list.add("spp" + suffix, t.spp, "samples/pixel", paper ? Optional(paper->spp) : Optional());
    list.add("wall_gap" + suffix, t["wall_gap"], "1", {}, wallGapGoal);
    list.add("mrays_s" + suffix, t.megaraysPerSecond, "Mrays/s");
}

void addErrorClaims(
    ClaimList& list, const SettingResult& setting, const std::string& suffix, Optional paper, Optional goal)
{
    bool main = true;
    for (const auto& [baseline, saved] : setting.baselines) {
        const std::string versus = main ? "" : "_vs_" + baseline.name;
        list.add("samples_saved" + versus + suffix, summarize(saved.samples), "1", main ? paper : Optional(),
            main ? goal : Optional());
        if (main) {
            list.add("rays_saved" + suffix, summarize(saved.rays), "1");
        }
        main = false;
    }
    list.add("rmse" + suffix, summarize(setting.method.errors()), "radiance");
}

Json dataOf(const Measured& m, const PointForm& form)
{
    return { { "spp", number(m.spp) }, { form.rays, number(m.rays) }, { "rmse", number(m.rmse) },
        { "rmse_corrected", number(withoutNoise(m.rmse, form.noise)) }, { "mu", m.mu }, { "seed", m.seed } };
}

Json dataOf(const std::vector<Measured>& points, const PointForm& form)
{
    Json out = Json::array();
    for (const Measured& point : points) {
        out.push_back(dataOf(point, form));
    }
    return out;
}

Json dataOf(const SettingResult& setting, const PointForm& form)
{
    Json out;
    out["spp"] = number(setting.timing.spp);
    out["mrays_s"] = number(setting.timing.megaraysPerSecond);
    for (const auto& [name, summary] : setting.timing.columns) {
        out["timing"][name] = json(summary);
    }
    if (setting.method.runs.empty()) {
        return out;
    }
    out["method"] = dataOf(setting.method.runs, form);
    out["baselines"] = Json::array();
    for (const auto& [baseline, saved] : setting.baselines) {
        out["baselines"].push_back({ { "name", baseline.name }, { "meaning", baseline.meaning },
            { "points", dataOf(baseline.points, form) }, { "samples_saved", json(summarize(saved.samples)) },
            { "rays_saved", json(summarize(saved.rays)) }, { "extrapolated", saved.extrapolated } });
    }
    return out;
}

Json dataOf(const Series& s, const PointForm& form)
{
    return { { "setting", s.setting }, { "sampling", s.sampling }, { "filter", s.filter },
        { "fixed_width_pixels", s.fixedWidth ? Json(*s.fixedWidth) : Json(nullptr) },
        { "points", dataOf(s.points, form) } };
}

Json dataOf(const FixedBlur& blur, const PointForm& form)
{
    Json out = dataOf(blur.measured, form);
    out["width_pixels"] = blur.width;
    return out;
}

Json dataOf(const PaperRow* p)
{
    if (p == nullptr) {
        return nullptr;
    }
    return { { "scene", p->name }, { "triangles", p->triangles }, { "spp", p->spp }, { "first_pass", p->firstPass },
        { "second_pass", p->secondPass }, { "tracing", p->tracing }, { "widths_and_counts", p->analysis },
        { "filter", p->filter }, { "overhead", p->overhead }, { "total", p->total }, { "fps_with", p->fpsWith },
        { "fps_without", p->fpsWithout }, { "overhead_fraction", p->overhead / p->total } };
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

Json dataOf(const MeasurePlan& plan)
{
    return { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height }, { "frames", plan.frames },
        { "seeds", plan.seeds }, { "reference_spp", plan.referenceSpp }, { "largest_baseline", plan.largestBaseline } };
}

} // namespace wedge::benchmark
