#include "benchmarks/rendering_filters/shadow_results.h"

#include <cmath>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Upper bounds of what subtraction leaves of the error of lights alone, and of what dividing leaves of that.
constexpr double additiveGoal = 0.55, meanAdditiveGoal = 0.4, meanRatioGoal = 0.6, energyGoal = 0.05;
/// And of what a few lights a pixel have of the error of all, of lobes that are wider than lights are apart.
constexpr double chosenGoal = 1.1;

/// Lights among which pixels choose, where claims are of that.
constexpr int chosenLights = 100;

constexpr const char* program = "rendering_filters";

/// The points that claims are of; null where they are not there.
struct Compared {
    const ShadowPoint *additive = nullptr, *sameTime = nullptr, *subtractive = nullptr, *ratio = nullptr;

    explicit Compared(const ShadowedScene& scene)
        : additive(pointOf(scene.points, additiveWay, scene.claimedLights))
        , sameTime(pointOf(scene.points, additiveWay, 0, subtractiveWay))
        , subtractive(pointOf(scene.points, subtractiveWay, scene.claimedLights))
        , ratio(pointOf(scene.points, ratioWay, scene.claimedLights))
    {
    }
};

double errorRatio(const ShadowPoint& a, const ShadowPoint& b) { return a.errors.rmse / b.errors.rmse; }

double geometricMean(const std::vector<double>& values)
{
    double sum = 0;
    for (const double value : values) {
        sum += std::log(value);
    }
    return std::exp(sum / static_cast<double>(values.size()));
}

std::optional<double> goalOf(const ShadowedScene& scene, double goal)
{
    return scene.source.hasGoals ? std::optional(goal) : std::nullopt;
}

std::string nameOf(const ShadowPoint& point)
{
    return point.timeOf.empty() ? point.way : fmt::format("{}, time of {}", point.way, point.timeOf);
}

} // namespace

std::vector<Claim> claimsOf(const ShadowedScene& scene)
{
    const Compared of(scene);
    ClaimList subtractive(program, "subtractive_" + scene.source.name), ratio(program, "ratio_" + scene.source.name);
    if (of.subtractive != nullptr && of.sameTime != nullptr) {
        subtractive.add(
            "error_vs_additive", errorRatio(*of.subtractive, *of.sameTime), "1", {}, goalOf(scene, additiveGoal));
        subtractive.add("display_vs_additive", of.subtractive->errors.display / of.sameTime->errors.display, "1");
        subtractive.add("lights_of_equal_time", of.sameTime->count, "lights");
    }
    if (of.subtractive != nullptr && of.additive != nullptr) {
        subtractive.add("error_vs_additive_of_equal_lights", errorRatio(*of.subtractive, *of.additive), "1");
    }
    if (of.ratio != nullptr && of.subtractive != nullptr) {
        ratio.add("error_vs_subtractive", errorRatio(*of.ratio, *of.subtractive), "1");
    }
    if (of.ratio != nullptr) {
        ratio.add("energy_error", std::abs(of.ratio->errors.energy), "1", {}, goalOf(scene, energyGoal));
    }
    const ShadowPoint *chosen = pointOf(scene.points, chosenWay, chosenLights),
                      *all = pointOf(scene.points, ratioWay, chosenLights);
    if (chosen != nullptr && all != nullptr) {
        const bool wide = scene.source.name.ends_with("phong40");
        ratio.add("error_of_8_a_pixel", errorRatio(*chosen, *all), "1", {},
            wide ? goalOf(scene, chosenGoal) : std::optional<double>());
    }
    std::vector<Claim> out = std::move(subtractive.claims);
    out.insert(out.end(), ratio.claims.begin(), ratio.claims.end());
    return out;
}

std::vector<Claim> meanClaims(const std::vector<ShadowedScene>& scenes)
{
    std::vector<double> overAdditive, overSubtractive;
    for (const ShadowedScene& scene : scenes) {
        const Compared of(scene);
        if (!scene.source.hasGoals || of.subtractive == nullptr) {
            continue;
        }
        if (of.sameTime != nullptr) {
            overAdditive.push_back(errorRatio(*of.subtractive, *of.sameTime));
        }
        if (of.ratio != nullptr) {
            overSubtractive.push_back(errorRatio(*of.ratio, *of.subtractive));
        }
    }
    ClaimList subtractive(program, "subtractive_mean"), ratio(program, "ratio_mean");
    if (!overAdditive.empty()) {
        subtractive.add("error_vs_additive", geometricMean(overAdditive), "1", {}, meanAdditiveGoal);
    }
    if (!overSubtractive.empty()) {
        ratio.add("error_vs_subtractive", geometricMean(overSubtractive), "1", {}, meanRatioGoal);
    }
    std::vector<Claim> out = std::move(subtractive.claims);
    out.insert(out.end(), ratio.claims.begin(), ratio.claims.end());
    return out;
}

Json dataOf(const ShadowedScene& scene)
{
    Json out { { "name", scene.source.name }, { "origin", scene.source.origin },
        { "reference", scene.source.plainReference ? plainWay : filteredWay },
        { "reference_noise", number(scene.noise) }, { "exposure", number(scene.exposure) } };
    out["points"] = Json::array();
    for (const ShadowPoint& point : scene.points) {
        out["points"].push_back({ { "way", point.way }, { "count", point.count },
            { "time_of", point.timeOf.empty() ? Json() : Json(point.timeOf) }, { "errors", dataOf(point.errors) },
            { "rmse_from_lights", number(point.fromLights) }, { "rays_per_pixel", number(point.rays) },
            { "ms", json(point.milliseconds) },
            { "clamped_pixels", point.clampedPixels ? Json(*point.clampedPixels) : Json() } });
    }
    return out;
}

std::string tableOf(const ShadowedScene& scene)
{
    std::string out = fmt::format("{}: noise of the reference {:.6f}\n"
                                  "{:<26} {:>5} {:>9} {:>9} {:>8} {:>9} {:>7} {:>8} {:>8}\n",
        scene.source.name, scene.noise, "way", "count", "rmse", "display", "energy", "of lights", "rays", "ms",
        "clamped");
    for (const ShadowPoint& p : scene.points) {
        out += fmt::format("{:<26} {:>5} {:>9.6f} {:>9.6f} {:>7.2f}% {:>9.6f} {:>7.1f} {:>8.1f} {:>8}\n", nameOf(p),
            p.count, p.errors.rmse, p.errors.display, 100 * p.errors.energy, p.fromLights, p.rays,
            p.milliseconds.median, p.clampedPixels ? fmt::format("{}", *p.clampedPixels) : "-");
    }
    return out;
}

} // namespace wedge::benchmark
