#include "benchmarks/rendering_filters/call.h"

#include "benchmarks/common/arguments.h"
#include "benchmarks/common/scene_source.h"
#include "host/image/atomic_file.h"

#include <cstdio>

#include <fmt/format.h>

namespace wedge::benchmark {

void addCommonOptions(CLI::App& parser, CommonCall& call, MeasurePlan& plan)
{
    parser.add_option("--scene", call.scenes, "a scene's name or a scene file; again for more (all there are)")
        ->expected(1)
        ->take_all();
    parser
        .add_option(
            "--repeats", plan.seeds, fmt::format("images of each setting, with seeds of their own ({})", plan.seeds))
        ->check(CLI::Range(1, 1000));
    parser.add_option("--size", call.size, fmt::format("WxH ({}x{})", plan.width, plan.height));
    parser.add_option("--device", call.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", call.json, "where the results go, rewritten after each scene");
}

void addReferenceOptions(CLI::App& parser, MeasurePlan& plan)
{
    plan.referenceFolder = defaultReferenceFolder();
    parser
        .add_option(
            "--reference-spp", plan.referenceSpp, fmt::format("samples of the references ({})", plan.referenceSpp))
        ->check(CLI::Range(2, 1 << 20));
    parser.add_option("--reference-dir", plan.referenceFolder, "where references are kept (beside this program)");
}

void applyCommonOptions(const CommonCall& call, MeasurePlan& plan)
{
    plan.referenceSpp = plan.referenceSpp / 2 * 2;
    if (!call.size.empty()) {
        setSize(plan, call.size);
    }
    if (!call.json.empty()) {
        image::checkWritable(call.json);
    }
}

std::string goalsTable(const std::vector<Claim>& claims)
{
    std::string out;
    for (const Claim& claim : claims) {
        if (claim.goal) {
            out += fmt::format("{:<64} {:>8.3f}  at most {:<5} {}\n", claim.id, claim.value, *claim.goal,
                claim.value <= *claim.goal ? "reached" : "not reached");
        }
    }
    return out;
}

void tellScene(const CommonCall& call, const Json& results, const std::string& table)
{
    fmt::print("{}\n", table);
    std::fflush(stdout);
    if (!call.json.empty()) {
        writeJson(call.json, results);
    }
}

} // namespace wedge::benchmark
