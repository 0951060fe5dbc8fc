#include "benchmarks/distributed/distributed_program.h"

#include "benchmarks/common/measure_scenes.h"
#include "benchmarks/common/program.h"
#include "benchmarks/distributed/results.h"
#include "benchmarks/distributed/run.h"
#include "benchmarks/distributed/tables.h"

namespace wedge::benchmark {
namespace {

struct DistributedArguments : Arguments {
    bool errorsOnly = false;
    std::string maps;
};

DistributedPlan planOf(const DistributedArguments& a)
{
    DistributedPlan plan = a.quick ? quickDistributedPlan() : DistributedPlan {};
    apply(a, plan, 2);
    if (!a.size.empty()) {
        plan.timedWidth = plan.width;
        plan.timedHeight = plan.height;
    }
    plan.errorsOnly = a.errorsOnly;
    plan.maps = a.maps;
    return plan;
}

int measure(const DistributedBenchmark& of, const DistributedArguments& a)
{
    const DistributedPlan plan = planOf(a);
    SceneBenchmark<DistributedScene, DistributedResult> benchmark;
    benchmark.program = of.program;
    benchmark.scenes = of.scenes;
    benchmark.measure = [&](const DistributedScene& source, const device::Device& device) {
        return measureScene(of.program, source, device, plan);
    };
    benchmark.plan = dataOf(plan);
    benchmark.claims = claimsOf;
    benchmark.data = [](const DistributedResult& result) { return dataOf(result); };
    benchmark.tables = tablesOf;
    return measureScenes(benchmark, a, plan);
}

} // namespace

int runDistributedBenchmark(int argc, char** argv, const DistributedBenchmark& benchmark)
{
    CLI::App parser(benchmark.subject, benchmark.program);
    DistributedArguments arguments;
    addOptions(parser, arguments, benchmark.table, DistributedPlan {}, quickDistributedPlan(),
        "160x160 and fewer points: a look");
    parser.add_flag("--errors-only", arguments.errorsOnly, "no times")->excludes("--timing-only");
    parser.add_option("--maps", arguments.maps, "folder for pictures of counts and filter widths");
    return runProgram(parser, argc, argv, [&] { return measure(benchmark, arguments); });
}

} // namespace wedge::benchmark
