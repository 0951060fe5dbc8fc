// soft_shadows: chapter 3 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/common/measure_scenes.h"
#include "benchmarks/common/program.h"
#include "benchmarks/soft_shadows/results.h"
#include "benchmarks/soft_shadows/run.h"
#include "benchmarks/soft_shadows/tables.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

int run(const Arguments& a)
{
    Plan plan = a.quick ? quickPlan() : Plan {};
    apply(a, plan, 4); // two halves, of each of two references
    SceneBenchmark<ShadowScene, SceneResult> benchmark;
    benchmark.program = "soft_shadows";
    benchmark.scenes = shadowScenes();
    benchmark.measure = [&](const ShadowScene& source, const device::Device& device) {
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
    CLI::App parser("Measures soft shadows: times of Table 3.1, errors of Fig. 3.6c, samples saved.", "soft_shadows");
    Arguments arguments;
    addOptions(parser, arguments, "Table 3.1", Plan {}, quickPlan(), "320x240 and fewer points, about two minutes");
    return runProgram(parser, argc, argv, [&] { return run(arguments); });
}
