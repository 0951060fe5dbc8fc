#include "benchmarks/soft_shadows/results.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

using Optional = std::optional<double>;

constexpr double wallGapGoal = 0.05;

/// Collects the claims of one scene.
class ClaimList {
public:
    explicit ClaimList(const std::string& scene)
        : prefix_("soft_shadows." + scene + ".")
    {
    }

    void add(const std::string& quantity, const Summary& value, const std::string& unit, Optional paper = {},
        Optional goal = {})
    {
        claims.push_back({ prefix_ + quantity, value.median, unit, value.spread(), paper, goal });
    }
    void add(
        const std::string& quantity, double value, const std::string& unit, Optional paper = {}, Optional goal = {})
    {
        claims.push_back({ prefix_ + quantity, value, unit, {}, paper, goal });
    }

    std::vector<Claim> claims;

private:
    std::string prefix_;
};

Summary errorOf(const Method& method)
{
    std::vector<double> errors;
    std::ranges::transform(method.runs, std::back_inserter(errors), &Measured::rmse);
    return summarize(errors);
}

void addTimeClaims(ClaimList& list, const SettingResult& setting, const SceneSource& source)
{
    const std::string suffix = setting.name == "published" ? "_published" : "";
    const PaperRow* paper = source.paper;
    const Timing& t = setting.timing;
    list.add("overhead" + suffix, t["overhead_fraction"], "1",
        paper ? Optional(paper->overhead / paper->total) : Optional(), source.goals.overhead);
    list.add("overhead_ms" + suffix, t["overhead"], "ms", paper ? Optional(paper->overhead) : Optional());
    list.add("total_ms" + suffix, t["total"], "ms", paper ? Optional(paper->total) : Optional());
    list.add("spp" + suffix, t.spp, "samples/pixel", paper ? Optional(paper->spp) : Optional());
    list.add("wall_gap" + suffix, t["wall_gap"], "1", {}, wallGapGoal);
    list.add("mrays_s" + suffix, t.megaraysPerSecond, "Mrays/s");
}

void addErrorClaims(ClaimList& list, const SettingResult& setting, const Goals& goals)
{
    const bool published = setting.name == "published";
    const std::string suffix = published ? "_published" : "";
    for (const auto& [baseline, saved] : setting.baselines) {
        const bool main = baseline.name == "stratified" || published;
        const std::string versus = main ? "" : "_vs_" + baseline.name;
        list.add("samples_saved" + suffix + versus, summarize(saved.samples), "1",
            main ? goals.paperSamplesSaved : Optional(),
            !main           ? Optional()
                : published ? goals.samplesSavedPublished
                            : goals.samplesSaved);
        if (main) {
            list.add("rays_saved" + suffix, summarize(saved.rays), "1");
        }
    }
    list.add("rmse" + suffix, errorOf(setting.method), "radiance");
    list.add("mu_monotonic" + suffix, falls(setting.convergence) ? 1 : 0, "1", {}, 1);
}

Json dataOf(const Measured& m, double noise)
{
    return { { "spp", number(m.spp) }, { "shadow_rays", number(m.shadowRays) }, { "rmse", number(m.rmse) },
        { "rmse_corrected", number(withoutNoise(m.rmse, noise)) }, { "mu", m.mu }, { "seed", m.seed } };
}

Json dataOf(const std::vector<Measured>& points, double noise)
{
    Json out = Json::array();
    for (const Measured& point : points) {
        out.push_back(dataOf(point, noise));
    }
    return out;
}

/// The noise of the reference that a setting is measured against.
double noiseOf(const SceneResult& result, const std::string& setting)
{
    const auto found = result.references.find(setting == "published" ? "shading apart" : "true integral");
    return found == result.references.end() ? 0.0 : found->second.noise;
}

Json dataOf(const SettingResult& setting, double noise)
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
    out["method"] = dataOf(setting.method.runs, noise);
    out["baselines"] = Json::array();
    for (const auto& [baseline, saved] : setting.baselines) {
        out["baselines"].push_back({ { "name", baseline.name }, { "meaning", baseline.meaning },
            { "points", dataOf(baseline.points, noise) }, { "samples_saved", json(summarize(saved.samples)) },
            { "rays_saved", json(summarize(saved.rays)) }, { "extrapolated", saved.extrapolated } });
    }
    out["convergence"] = dataOf(setting.convergence, noise);
    return out;
}

Json dataOf(const PaperRow& p)
{
    return { { "scene", p.name }, { "triangles", p.triangles }, { "spp", p.spp }, { "first_pass", p.firstPass },
        { "second_pass", p.secondPass }, { "tracing", p.tracing }, { "widths_and_counts", p.analysis },
        { "filter", p.filter }, { "overhead", p.overhead }, { "total", p.total }, { "fps_with", p.fpsWith },
        { "fps_without", p.fpsWithout }, { "overhead_fraction", p.overhead / p.total } };
}

} // namespace

std::vector<Claim> claimsOf(const SceneResult& result)
{
    ClaimList list(result.source.name);
    for (const SettingResult& setting : result.settings) {
        addTimeClaims(list, setting, result.source);
        if (!setting.method.runs.empty()) {
            addErrorClaims(list, setting, result.source.goals);
        }
    }
    if (result.fixedBlur) {
        const double adaptive = result.setting("default").method.runs.front().rmse;
        list.add("rmse_ratio_fixed_blur", result.fixedBlur->measured.rmse / adaptive, "1");
    }
    return list.claims;
}

Json dataOf(const SceneResult& result)
{
    Json out;
    out["name"] = result.source.name;
    out["origin"] = result.source.origin;
    out["triangles"] = result.triangles;
    out["seconds"] = number(result.seconds);
    out["paper"] = result.source.paper != nullptr ? dataOf(*result.source.paper) : Json(nullptr);
    out["references"] = Json::array();
    for (const auto& [integrand, r] : result.references) {
        out["references"].push_back({ { "integrand", integrand }, { "spp", r.spp }, { "noise", number(r.noise) },
            { "cached", r.cached }, { "other_kernels", r.otherKernels } });
    }
    for (const SettingResult& setting : result.settings) {
        out["settings"][setting.name] = dataOf(setting, noiseOf(result, setting.name));
    }
    if (result.fixedBlur) {
        out["fixed_blur"] = dataOf(result.fixedBlur->measured, noiseOf(result, "default"));
        out["fixed_blur"]["width_pixels"] = result.fixedBlur->width;
    }
    out["curves"] = Json::array();
    for (const Series& s : result.series) {
        out["curves"].push_back({ { "setting", s.setting }, { "sampling", s.sampling }, { "filter", s.filter },
            { "fixed_width_pixels", s.fixedWidth ? Json(*s.fixedWidth) : Json(nullptr) },
            { "points", dataOf(s.points, noiseOf(result, s.setting)) } });
    }
    return out;
}

Json resultsOf(const std::vector<SceneResult>& results, const std::vector<std::string>& skipped, const Plan& plan,
    const device::DeviceInfo& device)
{
    Json out = resultSkeleton("soft_shadows", device);
    for (const SceneResult& result : results) {
        for (const Claim& claim : claimsOf(result)) {
            out["claims"].push_back(json(claim));
        }
    }
    out["plan"] = { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height },
        { "frames", plan.frames }, { "seeds", plan.seeds }, { "reference_spp", plan.referenceSpp },
        { "largest_baseline", plan.largestBaseline }, { "default_spp", defaultSpp }, { "published_mu", publishedMu } };
    out["skipped"] = skipped;
    out["scenes"] = Json::array();
    for (const SceneResult& result : results) {
        out["scenes"].push_back(dataOf(result));
    }
    return out;
}

} // namespace wedge::benchmark
