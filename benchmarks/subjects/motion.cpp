// motion: appendix B of the thesis, measured; docs/benchmarks.md.
#include "benchmarks/subjects/whole_image.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

BenchmarkScene movingScene(const char* name, generator::GeneratedScene (*make)(), Paper paper)
{
    return { generatedScene(name, make), { { .bounces = {}, .paper = std::move(paper) } }, { { "rays_saved", 4 } },
        false, false, 8.0 };
}

} // namespace

int main(int argc, char** argv)
{
    Benchmark benchmark = wholeImages("motion",
        "Measures motion blur with soft shadows and indirect light, and a lens: errors against rays.",
        [](const MeasurePlan& plan) -> std::shared_ptr<Subject> {
            return std::make_shared<WholeImage>("motion", plan);
        });
    benchmark.scenes = {
        movingScene("moving_cornell", generator::makeMovingCornell, paperOf({ .raysPerPixel = 155, .seconds = 15.0 })),
        movingScene("moving_lens", generator::makeMovingLens, {}),
    };
    return runBenchmark(argc, argv, benchmark);
}
