#include "benchmarks/rendering_filters/stylized.h"

#include "benchmarks/rendering_filters/stylized_results.h"

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

void makeQuick(StylizedPlan& plan)
{
    plan.quick = true;
    plan.width = 160;
    plan.height = 120;
    plan.seeds = 1;
    plan.work = 2e7;
}

Json skeleton(const StylizedPlan& plan, const device::DeviceInfo& device)
{
    Json all = resultSkeleton("rendering_filters", device);
    all["subject"] = "stylized";
    all["plan"] = { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height },
        { "repeats", plan.seeds }, { "samples", plan.samples } };
    all["scenes"] = Json::array();
    return all;
}

} // namespace

CLI::App& addStylized(CLI::App& parser, StylizedCall& call)
{
    CLI::App& out =
        *parser.add_subcommand("stylized", "Measures shadows in a style: their passes' times, and distances.");
    // Before the others, which change what it leaves.
    out.add_flag_callback(
        "--quick", [&call] { makeQuick(call.plan); }, "160x120, one repeat: to see that it works, not to report");
    addCommonOptions(out, call, call.plan);
    out.add_option("--samples", call.plan.samples, "random pieces of edge a pixel (32,128,512)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1 << 20));
    return out;
}

int runStylized(const StylizedCall& call)
{
    StylizedPlan plan = call.plan;
    applyCommonOptions(call, plan);
    std::vector<std::string> skipped; // no scene needs data of others
    const std::vector<StylizedScene> sources = chooseScenes(stylizedScenes(), call.scenes, skipped);
    const device::Device device = device::Device::open(call.device);
    Json all = skeleton(plan, device.info());
    std::vector<Claim> claims;
    for (const StylizedScene& source : sources) {
        const StylizedResult scene = measureStyles(source, device, plan);
        const std::vector<Claim> ofScene = claimsOf(scene, plan);
        claims.insert(claims.end(), ofScene.begin(), ofScene.end());
        addClaims(all, ofScene);
        all["scenes"].push_back(dataOf(scene, plan));
        tellScene(call, all, tableOf(scene, plan));
    }
    tellScene(call, all, goalsTable(claims));
    return 0;
}

} // namespace wedge::benchmark
