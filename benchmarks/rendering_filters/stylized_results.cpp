#include "benchmarks/rendering_filters/stylized_results.h"

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

// Of frames of 640x480 with about 5000 pieces of edge.
constexpr int goalWidth = 640, goalHeight = 480;
constexpr double distanceGoal = 250, shadeGoal = 20, abstractionGoal = 150; ///< milliseconds, upper bounds
constexpr double styleGoal = 500, softStyleGoal = 1500; ///< likewise

/// Names and times, in the order of the passes.
std::vector<std::pair<std::string, const Summary*>> columnsOf(const StylizedTimes& times)
{
    return { { "matte", &times.matte }, { "edges", &times.edges }, { "distance", &times.distance },
        { "blur", &times.blur }, { "transfer", &times.transfer }, { "style", &times.style }, { "frame", &times.frame },
        { "no_style", &times.plainFrame } };
}

} // namespace

std::vector<Claim> claimsOf(const StylizedResult& scene, const StylizedPlan& plan)
{
    ClaimList list("rendering_filters", "stylized_" + scene.source.name);
    const bool goals = scene.source.hasGoals && plan.width == goalWidth && plan.height == goalHeight;
    // Of the parts of soft shadows none are stated.
    const auto goal = [&](double value) { return goals ? std::optional(value) : std::nullopt; };
    const auto hardGoal = [&](double value) { return scene.soft ? std::nullopt : goal(value); };
    if (!scene.soft) {
        list.add("edge_pieces", static_cast<double>(scene.pieces), "pieces");
    }
    list.add("style_ms", scene.times.style, "ms", {}, goal(scene.soft ? softStyleGoal : styleGoal));
    list.add("distance_ms", scene.times.distance, "ms", {}, hardGoal(distanceGoal));
    list.add("restyle_ms", scene.restyle.shade, "ms", {}, hardGoal(shadeGoal));
    if (scene.restyle.abstraction) {
        list.add("restyle_abstraction_ms", *scene.restyle.abstraction, "ms", {}, hardGoal(abstractionGoal));
    }
    if (scene.errors) {
        list.add("distance_error", scene.errors->device, "1");
    }
    return list.claims;
}

Json dataOf(const StylizedResult& scene, const StylizedPlan& plan)
{
    Json out { { "name", scene.source.name }, { "origin", scene.source.origin },
        { "edge_pieces", scene.soft ? Json() : Json(scene.pieces) } };
    for (const auto& [name, time] : columnsOf(scene.times)) {
        out["ms"][name] = json(*time);
    }
    out["restyle_ms"] = json(scene.restyle.shade);
    out["restyle_abstraction_ms"] = scene.restyle.abstraction ? json(*scene.restyle.abstraction) : Json();
    out["errors"] = nullptr;
    if (scene.errors) {
        out["errors"] = { { "pixels", scene.errors->pixels }, { "device", number(scene.errors->device) } };
        out["errors"]["sampled"] = Json::array();
        for (std::size_t i = 0; i < plan.samples.size(); ++i) {
            out["errors"]["sampled"].push_back(
                { { "pieces", plan.samples[i] }, { "rms", number(scene.errors->sampled[i]) } });
        }
    }
    return out;
}

std::string tableOf(const StylizedResult& scene, const StylizedPlan& plan)
{
    std::string out = scene.soft ? fmt::format("{}: soft shadows\n ", scene.source.name)
                                 : fmt::format("{}: {} pieces of edge\n ", scene.source.name, scene.pieces);
    for (const auto& [name, time] : columnsOf(scene.times)) {
        out += fmt::format(" {} {:.1f}", name, time->median);
    }
    out += fmt::format(" restyle {:.1f}", scene.restyle.shade.median);
    if (scene.restyle.abstraction) {
        out += fmt::format(" restyle_abstraction {:.1f}", scene.restyle.abstraction->median);
    }
    out += " ms\n";
    if (scene.errors) {
        out += fmt::format("  RMS in light of {} pixels: device {:.6f}", scene.errors->pixels, scene.errors->device);
        for (std::size_t i = 0; i < plan.samples.size(); ++i) {
            out += fmt::format(", {} random pieces {:.4f}", plan.samples[i], scene.errors->sampled[i]);
        }
        out += "\n";
    }
    return out;
}

} // namespace wedge::benchmark
