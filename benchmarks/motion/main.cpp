// motion: appendix B of the thesis, measured; docs/benchmarks.md.
#include "benchmarks/distributed/distributed_program.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

DistributedScene movingScene(const char* name, generator::GeneratedScene (*make)(), std::optional<PaperFrame> paper)
{
    DistributedScene out;
    static_cast<SceneSource&>(out) = generatedScene(name, make);
    out.paper = paper;
    out.raysSavedGoal = 4.0;
    out.raysSavedAim = 8.0;
    return out;
}

} // namespace

int main(int argc, char** argv)
{
    return runDistributedBenchmark(argc, argv,
        { "motion", "Measures motion blur with soft shadows and indirect light, and a lens: errors against rays.",
            "Table 5.2",
            {
                movingScene("moving_cornell", generator::makeMovingCornell, PaperFrame { {}, 155, {}, 15.0, {} }),
                movingScene("moving_lens", generator::makeMovingLens, {}),
            } });
}
