// indirect: chapter 4 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/common/measure_scenes.h"
#include "benchmarks/common/program.h"
#include "benchmarks/indirect/results.h"
#include "benchmarks/indirect/run.h"
#include "benchmarks/indirect/tables.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

int run(const Arguments& a)
{
    Plan plan = a.quick ? quickPlan() : Plan {};
    apply(a, plan, 2);
    SceneBenchmark<IndirectScene, SceneResult> benchmark;
    benchmark.program = "indirect";
    benchmark.scenes = indirectScenes();
    benchmark.measure = [&](const IndirectScene& source, const device::Device& device) {
        return measureScene(source, device, plan);
    };
    benchmark.plan = dataOf(plan);
    benchmark.claims = claimsOf;
    benchmark.data = [](const SceneResult& result) { return dataOf(result); };
    benchmark.tables = tablesOf;
    return measureScenes(benchmark, a, plan);
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser(
        "Measures indirect light: times of Table 4.1, errors of Figs. 4.9 and 4.10, samples saved.", "indirect");
    Arguments arguments;
    addOptions(parser, arguments, "Table 4.1", Plan {}, quickPlan(), "320x240 and fewer points: a look");
    return runProgram(parser, argc, argv, [&] { return run(arguments); });
}
