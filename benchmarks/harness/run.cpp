#include "benchmarks/common/arguments.h"
#include "benchmarks/common/program.h"
#include "benchmarks/harness/measure.h"
#include "benchmarks/harness/results.h"
#include "benchmarks/harness/tables.h"
#include "host/device/device.h"
#include "host/image/atomic_file.h"

#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {
namespace {

/// What a call asks for.
struct Call {
    bool quick = false, list = false;
    std::vector<std::string> scenes;
    std::string json, device, size;
    int referenceSpp = 0; ///< 0: the plan's
    MeasurePlan said; ///< what goes into the plan as it is
};

void addOptions(CLI::App& parser, Call& call, const Benchmark& benchmark)
{
    const MeasurePlan &plan = benchmark.plan, &quick = benchmark.quick;
    call.said.referenceFolder = defaultReferenceFolder();
    parser.add_flag("--quick", call.quick, benchmark.quickMeans);
    parser.add_option("--scene", call.scenes, "a scene's name or a scene file; again for more (all there are)")
        ->expected(1)
        ->take_all();
    parser.add_option("--json", call.json, "where the results go, rewritten after each scene");
    parser.add_option("--device", call.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--reference-dir", call.said.referenceFolder, "where references are kept (beside this program)");
    parser
        .add_option("--reference-spp", call.referenceSpp,
            fmt::format("samples of the references ({}, quick {})", plan.referenceSpp, quick.referenceSpp))
        ->check(CLI::Range(16, 1 << 20));
    parser.add_option("--size", call.size,
        fmt::format(
            "WIDTHxHEIGHT of the images ({}x{}, quick {}x{})", plan.width, plan.height, quick.width, quick.height));
    parser.add_flag("--timing-only", call.said.timingOnly, "only what " + benchmark.table + " has");
    parser.add_flag("--list", call.list, "list the scenes");
    if (benchmark.byRays) {
        parser.add_flag("--errors-only", call.said.errorsOnly, "no times")->excludes("--timing-only");
        parser.add_option("--maps", call.said.maps, "folder for pictures of counts and filter widths");
    }
}

/// Throws UsageError.
MeasurePlan planOf(const Benchmark& benchmark, const Call& call)
{
    MeasurePlan plan = call.quick ? benchmark.quick : benchmark.plan;
    plan.quick = call.quick;
    plan.timingOnly = call.said.timingOnly;
    plan.errorsOnly = call.said.errorsOnly;
    plan.referenceFolder = call.said.referenceFolder;
    plan.maps = call.said.maps;
    if (!call.size.empty()) {
        setSize(plan, call.size);
        plan.timedWidth = plan.timedHeight = 0;
    }
    if (call.referenceSpp > 0) {
        const int halves = 2 * benchmark.references;
        plan.referenceSpp = halves * ((call.referenceSpp + halves - 1) / halves);
    }
    return plan;
}

/// The whole result file.
Json resultsOf(const Benchmark& benchmark, const MeasurePlan& plan, const std::vector<SceneResult>& results,
    const std::vector<std::string>& skipped, const device::DeviceInfo& device)
{
    Json out = resultSkeleton(benchmark.program, device);
    out["plan"] = dataOf(benchmark, plan);
    out["skipped"] = skipped;
    out["scenes"] = Json::array();
    for (const SceneResult& result : results) {
        addClaims(out, claimsOf(benchmark, result));
        out["scenes"].push_back(dataOf(benchmark, result));
    }
    return out;
}

/// Lists the scenes, or measures those asked for, writing results after each, and prints tables. Returns the exit
/// status. Throws Error.
int measure(const Benchmark& benchmark, const Call& call)
{
    const MeasurePlan plan = planOf(benchmark, call);
    if (call.list) {
        for (const BenchmarkScene& source : benchmark.scenes) {
            fmt::print("{:<24}{}\n", source.name, source.origin);
        }
        return 0;
    }
    std::vector<std::string> skipped;
    const std::vector<BenchmarkScene> sources = chooseScenes(benchmark.scenes, call.scenes, skipped);
    if (!skipped.empty()) {
        progress(benchmark.program,
            fmt::format("skipped {}: what they need is not below WEDGE_DATA", fmt::join(skipped, ", ")));
    }
    if (!call.json.empty()) {
        image::checkWritable(call.json);
    }
    const device::Device device = device::Device::open(call.device);
    fmt::print("wedge {}, {}x{}, {}\n\n", benchmark.program, plan.width, plan.height, device.info().name);
    std::fflush(stdout);
    std::vector<SceneResult> results;
    for (const BenchmarkScene& source : sources) {
        results.push_back(measureScene(benchmark, source, device, plan));
        if (!call.json.empty()) {
            writeJson(call.json, resultsOf(benchmark, plan, results, skipped, device.info()));
        }
    }
    fmt::print("{}", tablesOf(benchmark, results));
    return 0;
}

} // namespace

int runBenchmark(int argc, char** argv, const Benchmark& benchmark)
{
    CLI::App parser(benchmark.about, benchmark.program);
    Call call;
    addOptions(parser, call, benchmark);
    return runProgram(parser, argc, argv, [&] { return measure(benchmark, call); });
}

} // namespace wedge::benchmark
