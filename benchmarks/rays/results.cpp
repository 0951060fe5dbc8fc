#include "benchmarks/rays/results.h"

#include <algorithm>

namespace wedge::benchmark {
namespace {

constexpr std::size_t listedDisagreements = 20;

Json runsJson(const Runs& runs, const ClassResult& result, const RayPlan& plan)
{
    std::vector<double> nanoseconds, cycles, instructions, counted;
    const double rays = static_cast<double>(result.rays);
    for (const double seconds : runs.seconds) {
        nanoseconds.push_back(1e9 * seconds / rays);
        cycles.push_back(seconds * plan.timing.threads * plan.timeStampHertz / rays);
    }
    for (const double n : runs.instructions)
        instructions.push_back(n / rays);
    for (const double n : runs.cycles)
        counted.push_back(n / rays);
    Json out = { { "name", runs.name }, { "ours", runs.ours },
        { "mrays_s", json(summarize(result.megarays(runs.name))) }, { "ns_per_ray", json(summarize(nanoseconds)) },
        { "cycles_per_ray", plan.timeStampHertz > 0 ? json(summarize(cycles)) : Json(nullptr) },
        { "core_cycles_per_ray", counted.empty() ? Json(nullptr) : json(summarize(counted)) },
        { "instructions_per_ray", instructions.empty() ? Json(nullptr) : json(summarize(instructions)) } };
    if (!runs.ours)
        out["ours_over_this"] = json(summarize(result.ratios(result.chosen(), runs.name)));
    return out;
}

Json hitJson(const shared::Hit& hit)
{
    if (hit.triangle == WEDGE_NO_TRIANGLE)
        return nullptr;
    return { { "t", number(hit.t) }, { "triangle", hit.triangle } };
}

Json comparisonJson(const Comparison& comparison)
{
    Json kinds, listed = Json::array();
    for (const std::string& kind : disagreementKinds())
        kinds[kind] = comparison.count(kind);
    // Those that rounding does not explain come first.
    std::vector<const Disagreement*> order;
    for (const Disagreement& d : comparison.disagreements)
        order.push_back(&d);
    std::ranges::stable_sort(order, {}, [](const Disagreement* d) { return d->kind != "unexplained"; });
    for (std::size_t i = 0; i < std::min(order.size(), listedDisagreements); ++i) {
        const Disagreement& d = *order[i];
        listed.push_back({ { "ray", d.ray }, { "kind", d.kind }, { "right", d.right }, { "ours", hitJson(d.ours) },
            { "embree", hitJson(d.theirs) }, { "edge_ulps", number(d.edgeUlps) }, { "true_t", number(d.trueT) } });
    }
    return { { "rays", comparison.rays }, { "differ", comparison.disagreements.size() }, { "kinds", kinds },
        { "right",
            { { "ours", comparison.right("ours") }, { "embree", comparison.right("embree") },
                { "both", comparison.right("both") } } },
        { "listed", listed } };
}

Json classJson(const ClassResult& result, const RayPlan& plan)
{
    Json contenders = Json::array();
    for (const Runs& runs : result.runs)
        contenders.push_back(runsJson(runs, result, plan));
    const double limit = portCycles(result.counts);
    const double cycles =
        plan.timeStampHertz * plan.timing.threads * 1e-6 / summarize(result.megarays(wedgeColumn(false, ""))).median;
    return { { "name", result.name }, { "any_hit", result.anyHit }, { "coherent", result.coherent },
        { "rays", result.rays }, { "chosen", result.chosen() }, { "embree_best", result.embreeBest() },
        { "contenders", contenders },
        { "model",
            { { "nodes_per_ray", number(result.counts.nodes) }, { "blocks_per_ray", number(result.counts.blocks) },
                { "port_cycles", number(limit) },
                { "single_over_port", plan.timeStampHertz > 0 ? number(cycles / limit) : Json(nullptr) } } },
        { "difference", comparisonJson(result.difference) },
        { "difference_from_robust", comparisonJson(result.differenceFromRobust) },
        { "packets_differ_from_single", result.packetMismatches } };
}

Json frameJson(const FrameResult& frame)
{
    Json runs = Json::array();
    for (const Runs& r : frame.runs)
        runs.push_back({ { "name", r.name }, { "seconds", json(summarize(r.ours ? frame.ourSeconds() : r.seconds)) } });
    return { { "runs", runs }, { "vs_embree_single", json(summarize(frame.ratios("embree frame single"))) },
        { "vs_embree_packet", json(summarize(frame.ratios("embree frame packets high"))) },
        { "rmse", number(frame.rmse) }, { "mean", number(frame.mean) }, { "different_pixels", frame.differentPixels } };
}

Json sceneJson(const RaySceneResult& scene, const RayPlan& plan)
{
    Json builds = Json::array(), classes = Json::array();
    for (const BuildResult& b : scene.builds)
        builds.push_back(
            { { "name", b.name }, { "seconds", b.seconds }, { "bytes_per_triangle", b.bytesPerTriangle } });
    for (const ClassResult& c : scene.classes)
        classes.push_back(classJson(c, plan));
    return { { "name", scene.name }, { "origin", scene.origin }, { "triangles", scene.triangles }, { "builds", builds },
        { "classes", classes }, { "frame", scene.frame ? frameJson(*scene.frame) : Json(nullptr) },
        { "no_frame", scene.noFrame } };
}

Json growthJson(const GrowthPoint& point)
{
    Json classes;
    for (const ClassResult& c : point.classes) {
        Json columns;
        for (const Runs& r : c.runs) {
            std::vector<double> nanoseconds;
            for (const double seconds : r.seconds)
                nanoseconds.push_back(1e9 * seconds / static_cast<double>(c.rays));
            columns[r.name] = json(summarize(nanoseconds));
        }
        classes[c.name] = { { "rays", c.rays }, { "nodes_per_ray", number(c.counts.nodes) },
            { "blocks_per_ray", number(c.counts.blocks) }, { "ns_per_ray", columns } };
    }
    return { { "triangles", point.triangles }, { "classes", classes } };
}

} // namespace

Json resultsOf(const RayResults& results, const device::DeviceInfo& device)
{
    Json out = resultSkeleton("rays", device);
    addClaims(out, claimsOf(results));
    const RayPlan& plan = results.plan;
    out["plan"] = { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height },
        { "shadow_samples", plan.shadowSamples }, { "ambient_samples", plan.ambientSamples },
        { "repeats", plan.timing.repeats }, { "clock", plan.timing.cpuTime ? "processor" : "wall" },
        { "threads", plan.timing.threads }, { "traversal", results.traversal },
        { "time_stamp_hz", number(plan.timeStampHertz) },
        { "counters", results.countersProblem.empty() ? "counted" : results.countersProblem },
        { "embree", EmbreeScene::version() } };
    out["skipped"] = results.skipped;
    out["scenes"] = Json::array();
    for (const RaySceneResult& scene : results.scenes)
        out["scenes"].push_back(sceneJson(scene, plan));
    out["growth"] = Json::array();
    for (const GrowthPoint& point : results.growth)
        out["growth"].push_back(growthJson(point));
    return out;
}

} // namespace wedge::benchmark
