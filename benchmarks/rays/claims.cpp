#include "benchmarks/rays/results.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

/// What a class is to reach against Embree.
struct ClassGoals {
    const char* name;
    std::optional<double> single, packet, best;
};

constexpr ClassGoals goals[] = {
    { "primary", 4.0, 1.3, {} },
    { "area_shadow", 2.4, 1.2, {} },
    { "ambient", {}, {}, {} },
    { "diffuse", 1.4, {}, 1.2 },
};
constexpr double frameGoal = 2.8;

void add(std::vector<Claim>& out, const std::string& id, const std::vector<double>& values, const char* unit,
    std::optional<double> goal = {})
{
    const Summary s = summarize(values);
    out.push_back({ "rays." + id, s.median, unit, s.spread(), {}, goal });
}

void addClass(std::vector<Claim>& out, const std::string& scene, const ClassResult& result, const std::string& mode)
{
    const auto* goal = std::ranges::find(goals, result.name, [](const ClassGoals& g) { return std::string(g.name); });
    const std::string prefix = scene + "." + result.name, suffix = mode.empty() ? "" : "_" + mode;
    const std::string ours = result.chosen(mode);
    add(out, prefix + "_mrays_s" + suffix, result.megarays(ours), "Mrays/s");
    add(out, prefix + "_vs_embree_single" + suffix, result.ratios(ours, "embree single"), "1", goal->single);
    add(out, prefix + "_vs_embree_packet" + suffix, result.ratios(ours, "embree packets high"), "1", goal->packet);
    add(out, prefix + "_vs_embree_best" + suffix, result.ratios(ours, result.embreeBest()), "1", goal->best);
    if (result.coherent)
        return;
    // Incoherent rays by our single rays too, like against like.
    const std::string single = wedgeColumn(false, mode);
    add(out, prefix + "_single_vs_embree_single" + suffix, result.ratios(single, "embree single"), "1", goal->single);
    add(out, prefix + "_single_vs_embree_best" + suffix, result.ratios(single, result.embreeBest()), "1", goal->best);
}

} // namespace

std::vector<Claim> claimsOf(const RaySceneResult& scene)
{
    std::vector<Claim> out;
    for (const ClassResult& result : scene.classes) {
        addClass(out, scene.name, result, "");
        addClass(out, scene.name, result, "quality");
        out.push_back({ "rays." + scene.name + "." + result.name + "_unexplained_hits",
            static_cast<double>(result.difference.unexplained()), "rays", {}, {}, 0.0 });
        out.push_back({ "rays." + scene.name + "." + result.name + "_packets_unlike_single",
            static_cast<double>(result.packetMismatches), "rays", {}, {}, 0.0 });
    }
    if (scene.frame) {
        const FrameResult& frame = *scene.frame;
        std::vector<double> milliseconds;
        for (const double seconds : frame.ourSeconds())
            milliseconds.push_back(1e3 * seconds);
        add(out, scene.name + ".frame_ms", milliseconds, "ms");
        add(out, scene.name + ".frame_vs_embree_single", frame.ratios("embree frame single"), "1", frameGoal);
        add(out, scene.name + ".frame_vs_embree_packet", frame.ratios("embree frame packets high"), "1");
    }
    return out;
}

std::vector<Claim> claimsOf(const std::vector<GrowthPoint>& growth)
{
    std::vector<Claim> out;
    if (growth.size() < 2)
        return out;
    for (std::size_t c = 0; c < growth.front().classes.size(); ++c) {
        const ClassResult &first = growth.front().classes[c], &last = growth.back().classes[c];
        const auto grows = [&](const std::string& column) {
            return summarize(first.megarays(column)).median / summarize(last.megarays(column)).median;
        };
        const std::string theirs = first.coherent ? "embree packets high" : "embree single";
        out.push_back({ "rays.growth." + first.name + "_time_ratio", grows(first.chosen()), "1", {}, {}, {} });
        out.push_back({ "rays.growth." + first.name + "_time_ratio_vs_embree", grows(first.chosen()) / grows(theirs),
            "1", {}, {}, 1.0 });
    }
    return out;
}

std::vector<Claim> claimsOf(const RayResults& results)
{
    std::vector<Claim> out;
    for (const RaySceneResult& scene : results.scenes)
        std::ranges::move(claimsOf(scene), std::back_inserter(out));
    std::ranges::move(claimsOf(results.growth), std::back_inserter(out));
    return out;
}

} // namespace wedge::benchmark
