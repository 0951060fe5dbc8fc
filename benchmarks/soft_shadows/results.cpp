#include "benchmarks/soft_shadows/results.h"

namespace wedge::benchmark {
namespace {

PointForm formOf(const SceneResult& result, const std::string& setting)
{
    return { result.noiseOf(setting), "shadow_rays" };
}

} // namespace

std::vector<Claim> claimsOf(const SceneResult& result)
{
    ClaimList list("soft_shadows", result.source.name);
    const Goals& goals = result.source.goals;
    for (const ShadowSetting& setting : result.settings) {
        const bool published = setting.name == "published";
        const std::string suffix = published ? "_published" : "";
        addTimeClaims(list, setting, suffix, result.source.paper, goals.overhead);
        if (!setting.method.runs.empty()) {
            addErrorClaims(list, setting, suffix, goals.paperSamplesSaved,
                published ? goals.samplesSavedPublished : goals.samplesSaved);
            list.add("mu_monotonic" + suffix, falls(setting.convergence) ? 1 : 0, "1", {}, 1);
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
    out["paper"] = dataOf(result.source.paper);
    out["references"] = dataOf(result.references);
    for (const ShadowSetting& setting : result.settings) {
        const PointForm form = formOf(result, setting.name);
        Json& written = out["settings"][setting.name];
        written = dataOf(setting, form);
        if (!setting.method.runs.empty()) {
            written["convergence"] = dataOf(setting.convergence, form);
        }
    }
    if (result.fixedBlur) {
        out["fixed_blur"] = dataOf(*result.fixedBlur, formOf(result, "default"));
    }
    out["curves"] = Json::array();
    for (const Series& s : result.series) {
        out["curves"].push_back(dataOf(s, formOf(result, s.setting)));
    }
    return out;
}

Json dataOf(const Plan& plan)
{
    Json out = dataOf(static_cast<const MeasurePlan&>(plan));
    out["default_spp"] = defaultSpp;
    out["published_mu"] = publishedMu;
    return out;
}

} // namespace wedge::benchmark
