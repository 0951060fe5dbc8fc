// multiple_effects: chapter 5 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/subjects/whole_image.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

BenchmarkScene lensScene(
    const char* name, generator::GeneratedScene (*make)(), double triangles, double rays, double overhead)
{
    // "About 4x": Fig. 5.12f.
    const Paper paper =
        paperOf({ .triangles = triangles, .raysPerPixel = rays, .overhead = overhead, .raysSaved = 4.0 });
    return { generatedScene(name, make), { { .bounces = {}, .paper = paper } },
        { { "rays_saved", 4 }, { "overhead", overhead } }, false, false, {} };
}

} // namespace

int main(int argc, char** argv)
{
    Benchmark benchmark = wholeImages("multiple_effects",
        "Measures lens, lights and indirect light together: Table 5.2, errors against rays.",
        [](const MeasurePlan& plan) -> std::shared_ptr<Subject> {
            return std::make_shared<WholeImage>("multiple_effects", plan);
        });
    benchmark.scenes = {
        lensScene("chess", generator::makeChess, 21e3, 138, 0.054),
        lensScene("still_life", generator::makeStillLife, 128e3, 178, 0.027),
        lensScene("toasters", generator::makeToasters, 2.5e3, 125, 0.055),
        lensScene("room", generator::makeRoom, 100e3, 181, 0.024),
    };
    return runBenchmark(argc, argv, benchmark);
}
