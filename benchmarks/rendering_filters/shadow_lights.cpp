#include "benchmarks/rendering_filters/shadow_lights.h"

#include "benchmarks/common/lab.h"
#include "benchmarks/rendering_filters/shadow_results.h"

#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {
namespace {

void makeQuick(ShadowPlan& plan)
{
    plan.quick = true;
    plan.width = 120;
    plan.height = 90;
    plan.referenceSpp = 512;
    plan.seeds = 1;
    plan.lights = { 15, 40, 100 };
}

Json skeleton(const ShadowPlan& plan, const std::vector<ShadowWay>& ways, const std::vector<std::string>& skipped,
    const device::DeviceInfo& device)
{
    Json all = resultSkeleton("rendering_filters", device);
    all["subject"] = "shadow-lights";
    all["plan"] = { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height },
        { "lights", plan.lights }, { "aaf_spp", plan.spp }, { "seeds", plan.seeds },
        { "reference_spp", plan.referenceSpp }, { "reference_lights", plan.referenceLights } };
    all["ways"] = Json::array();
    for (const ShadowWay& way : ways) {
        all["ways"].push_back(way.name);
    }
    all["skipped"] = skipped;
    all["scenes"] = Json::array();
    return all;
}

ShadowedScene measured(
    const ShadowScene& source, const device::Device& device, const ShadowPlan& plan, const std::vector<ShadowWay>& ways)
{
    ShadowLab lab(source, device, plan);
    return { source, lab.truth().reference().noise, lab.truth().exposure(), claimedLights(plan), lab.measureAll(ways) };
}

} // namespace

CLI::App& addShadowLights(CLI::App& parser, ShadowCall& call)
{
    CLI::App& out = *parser.add_subcommand("shadow-lights",
        "Measures an environment's direct light by lights that stand for its map, in place of filters.");
    // Before the others, which change what it leaves.
    out.add_flag_callback(
        "--quick", [&call] { makeQuick(call.plan); },
        "120x90, three counts, small references, one repeat: to see that it works, not to report");
    addCommonOptions(out, call, call.plan);
    addReferenceOptions(out, call.plan);
    out.add_option("--way", call.ways, "a way of the table; again for more (all in the table)")
        ->expected(1)
        ->take_all();
    out.add_option("--lights", call.plan.lights, "counts of lights (15,25,40,60,100)")
        ->delimiter(',')
        ->check(CLI::Range(1, render::mostShadowLights));
    return out;
}

int runShadowLights(const ShadowCall& call)
{
    ShadowPlan plan = call.plan;
    applyCommonOptions(call, plan);
    const std::vector<ShadowWay> ways = shadowWays(call.ways);
    std::vector<std::string> skipped;
    const std::vector<ShadowScene> sources = chooseScenes(shadowScenes(), call.scenes, skipped);
    if (!skipped.empty()) {
        fmt::print("skipped, since their maps are not below WEDGE_DATA: {}\n", fmt::join(skipped, " "));
    }
    const device::Device device = device::Device::open(call.device);
    Json all = skeleton(plan, ways, skipped, device.info());
    std::vector<ShadowedScene> scenes;
    std::vector<Claim> claims;
    for (const ShadowScene& source : sources) {
        const ShadowedScene& scene = scenes.emplace_back(measured(source, device, plan, ways));
        const std::vector<Claim> ofScene = claimsOf(scene);
        claims.insert(claims.end(), ofScene.begin(), ofScene.end());
        addClaims(all, ofScene);
        all["scenes"].push_back(dataOf(scene));
        tellScene(call, all, tableOf(scene));
    }
    const std::vector<Claim> means = meanClaims(scenes);
    claims.insert(claims.end(), means.begin(), means.end());
    addClaims(all, means);
    tellScene(call, all, goalsTable(claims));
    return 0;
}

} // namespace wedge::benchmark
