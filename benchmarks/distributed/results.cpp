#include "benchmarks/distributed/results.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using Optional = std::optional<double>;

constexpr double sobolGoal = 3.0;
constexpr double memoryGoal = 150e6; // bytes

Optional paperOf(const DistributedResult& result, Optional PaperFrame::*value)
{
    return result.source.paper ? (*result.source.paper).*value : Optional();
}

void addTimeClaims(ClaimList& list, const DistributedResult& result, std::size_t index, const std::string& suffix)
{
    const Timing& t = result.settings[index].timing;
    const Optional seconds = paperOf(result, &PaperFrame::seconds);
    list.add("rays_per_pixel" + suffix, result.raysPerPixel[index], "rays/pixel",
        result.source.paper ? Optional(result.source.paper->raysPerPixel) : Optional());
    if (t.columns.empty()) {
        return;
    }
    list.add("overhead" + suffix, t["overhead_fraction"], "1", paperOf(result, &PaperFrame::overhead),
        suffix.empty() ? result.source.overheadGoal : Optional());
    list.add("overhead_ms" + suffix, t["overhead"], "ms");
    list.add("overhead_wall" + suffix, t["overhead_wall_fraction"], "1");
    list.add("total_ms" + suffix, t["total"], "ms", seconds ? Optional(1e3 * *seconds) : Optional());
    list.add("wall_gap" + suffix, t["wall_gap"], "1");
    list.add("mrays_s" + suffix, t.megaraysPerSecond, "Mrays/s");
}

void addErrorClaims(
    ClaimList& list, const DistributedResult& result, const SettingResult& setting, const std::string& suffix)
{
    const bool judged = suffix.empty();
    for (const auto& [baseline, saved] : setting.baselines) {
        const bool main = baseline.name == "stratified";
        const Optional goal = main ? result.source.raysSavedGoal : Optional(sobolGoal);
        list.add((main ? "rays_saved" : "rays_saved_vs_" + baseline.name) + suffix, summarize(saved.rays), "1",
            main ? paperOf(result, &PaperFrame::raysSaved) : Optional(), judged ? goal : Optional());
    }
    list.add("rmse" + suffix, summarize(setting.method.errors()), "radiance");
}

double monotonic(const std::vector<Measured>& points)
{
    return std::ranges::is_sorted(points, std::ranges::greater {}, &Measured::error) ? 1.0 : 0.0;
}

/// What the curves say: rays saved at each budget, whether errors keep falling, what each part of the method is worth.
void addCurveClaims(ClaimList& list, const DistributedResult& result)
{
    const std::vector<Measured>& usual = result.curve("default").points;
    const Curve& stratified = result.settings.front().baselines.front().baseline.rays;
    for (std::size_t i = 0; i < usual.size(); ++i) {
        list.add(fmt::format("rays_saved_{}spp", result.budgets[i]),
            costAt(stratified, usual[i].error).cost / usual[i].rays, "1");
    }
    list.add("error_falls", monotonic(usual), "1", {}, 1.0);
    list.add("error_falls_published", monotonic(result.curve("published").points), "1");
    const auto at =
        static_cast<std::size_t>(std::ranges::find(result.budgets, result.usualSpp) - result.budgets.begin());
    for (const char* variant : { "no_factoring", "uniform_counts", "fixed_blur" }) {
        list.add(fmt::format("rmse_ratio_{}", variant), result.curve(variant).points[at].error / usual[at].error, "1");
    }
}

Json dataOf(const VariantCurve& curve, const PointForm& form)
{
    Json out = { { "name", curve.name }, { "meaning", curve.meaning }, { "points", dataOf(curve.points, form) } };
    if (!curve.widths.empty()) {
        out["widths_pixels"] = curve.widths;
    }
    return out;
}

Json dataOf(const Map& map)
{
    return { { "file", map.file }, { "quantity", map.quantity }, { "unit", map.unit }, { "low", number(map.low) },
        { "high", number(map.high) }, { "logarithmic", map.logarithmic } };
}

Json orNull(const Optional& value) { return value ? number(*value) : Json(nullptr); }

Json dataOf(const std::optional<PaperFrame>& paper)
{
    return !paper ? Json(nullptr)
                  : Json { { "triangles", orNull(paper->triangles) }, { "rays_per_pixel", paper->raysPerPixel },
                        { "overhead_fraction", orNull(paper->overhead) }, { "seconds", orNull(paper->seconds) },
                        { "rays_saved", orNull(paper->raysSaved) } };
}

} // namespace

std::vector<Claim> claimsOf(const DistributedResult& result)
{
    ClaimList list(result.program, result.source.name);
    for (std::size_t i = 0; i < result.settings.size(); ++i) {
        const std::string suffix = result.settings[i].name == "published" ? "_published" : "";
        addTimeClaims(list, result, i, suffix);
        if (!result.curves.empty()) {
            addErrorClaims(list, result, result.settings[i], suffix);
        }
    }
    if (!result.curves.empty()) {
        addCurveClaims(list, result);
    }
    list.add("memory_bytes", static_cast<double>(result.memoryBytes), "B", {}, memoryGoal);
    return list.claims;
}

Json dataOf(const DistributedResult& result)
{
    Json out;
    out["name"] = result.source.name;
    out["origin"] = result.source.origin;
    out["triangles"] = result.triangles;
    out["bounces"] = result.bounces;
    out["seconds"] = number(result.seconds);
    out["paper"] = dataOf(result.source.paper);
    out["rays_saved_goal"] = orNull(result.source.raysSavedGoal);
    out["rays_saved_aim"] = orNull(result.source.raysSavedAim);
    out["memory_bytes"] = result.memoryBytes;
    out["references"] = dataOf(result.references);
    const PointForm form { result.noise() };
    out["settings"] = Json::array();
    for (std::size_t i = 0; i < result.settings.size(); ++i) {
        Json setting = { { "setting", result.settings[i].name }, { "rays_per_pixel", number(result.raysPerPixel[i]) } };
        setting.update(dataOf(result.settings[i], form));
        out["settings"].push_back(std::move(setting));
    }
    out["curves"] = Json::array();
    for (const VariantCurve& curve : result.curves) {
        out["curves"].push_back(dataOf(curve, form));
    }
    out["maps"] = Json::array();
    for (const Map& map : result.maps) {
        out["maps"].push_back(dataOf(map));
    }
    return out;
}

Json dataOf(const DistributedPlan& plan)
{
    Json out = dataOf(static_cast<const MeasurePlan&>(plan));
    out["timed_width"] = plan.timedWidth;
    out["timed_height"] = plan.timedHeight;
    out["budgets"] = plan.budgets;
    out["published_mu"] = plan.publishedMu;
    return out;
}

} // namespace wedge::benchmark
