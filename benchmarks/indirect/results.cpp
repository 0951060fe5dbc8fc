#include "benchmarks/indirect/results.h"

#include "benchmarks/indirect/indirect_light.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// What of the scene's cases a setting belongs to.
const BounceCase& caseOf(const SceneResult& result, int bounces)
{
    return *std::ranges::find(result.source.cases, bounces, &BounceCase::bounces);
}

std::string suffixOf(const std::string& setting) { return setting == "published" ? "_published" : ""; }

Json dataOf(const Bias& b)
{
    return { { "setting", b.setting }, { "mu", b.mu }, { "spp", number(b.spp) }, { "bias", number(b.rms) },
        { "mean_error", number(b.meanError) }, { "rmse", number(b.rmse) } };
}

Json dataOf(const SceneResult& result, const IndirectSetting& setting)
{
    Json out = { { "setting", setting.name }, { "bounces", setting.bounces } };
    out["paper"] = dataOf(caseOf(result, setting.bounces).paper);
    const PointForm form { result.noiseOf(setting.bounces) };
    out.update(dataOf(setting, form));
    if (setting.fixedBlur) {
        out["fixed_blur"] = dataOf(*setting.fixedBlur, form);
    }
    return out;
}

} // namespace

std::vector<Claim> claimsOf(const SceneResult& result)
{
    ClaimList list("indirect", result.source.name);
    for (const IndirectSetting& setting : result.settings) {
        const bool one = setting.bounces == 1;
        const std::string bounces = one ? ""
            : setting.bounces == 0      ? "_ambient"
                                        : fmt::format("_{}_bounces", setting.bounces);
        const std::string suffix = suffixOf(setting.name) + bounces;
        const bool judged = setting.name == "default";
        const BounceCase& paths = caseOf(result, setting.bounces);
        addTimeClaims(list, setting, suffix, paths.paper, judged ? paths.overheadGoal : std::nullopt);
        if (!setting.method.runs.empty()) {
            addErrorClaims(list, setting, suffix, one ? result.source.paperSamplesSaved : std::nullopt,
                one && judged ? result.source.samplesSavedGoal : std::nullopt);
        }
        if (setting.fixedBlur) {
            const double adaptive = setting.method.runs.front().error;
            list.add("rmse_ratio_fixed_blur" + suffix, setting.fixedBlur->measured.error / adaptive, "1");
        }
    }
    for (const Bias& bias : result.biases) {
        list.add(fmt::format("bias_mu{:g}{}", bias.mu, suffixOf(bias.setting)), bias.rms, "radiance");
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
    out["references"] = dataOf(result.references);
    out["settings"] = Json::array();
    for (const IndirectSetting& setting : result.settings) {
        out["settings"].push_back(dataOf(result, setting));
    }
    const PointForm form { result.noiseOf(1) };
    out["curves"] = Json::array();
    for (const Series& series : result.series) {
        out["curves"].push_back(dataOf(series, form));
    }
    out["bias"] = Json::array();
    for (const Bias& bias : result.biases) {
        out["bias"].push_back(dataOf(bias));
    }
    return out;
}

Json dataOf(const Plan& plan)
{
    Json out = dataOf(static_cast<const MeasurePlan&>(plan));
    out["bias_seeds"] = plan.biasSeeds;
    return out;
}

} // namespace wedge::benchmark
