// multiple_effects: chapter 5 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/distributed/distributed_program.h"

namespace {

using namespace wedge;
using namespace wedge::benchmark;

// "About 4x": Fig. 5.12f.
constexpr double paperRaysSaved = 4.0, raysSavedGoal = 4.0;

DistributedScene lensScene(
    const char* name, generator::GeneratedScene (*make)(), double triangles, double rays, double overhead)
{
    DistributedScene out;
    static_cast<SceneSource&>(out) = generatedScene(name, make);
    out.paper = PaperFrame { triangles, rays, overhead, {}, paperRaysSaved };
    out.raysSavedGoal = raysSavedGoal;
    out.overheadGoal = overhead;
    return out;
}

} // namespace

int main(int argc, char** argv)
{
    return runDistributedBenchmark(argc, argv,
        { "multiple_effects", "Measures lens, lights and indirect light together: Table 5.2, errors against rays.",
            "Table 5.2",
            {
                lensScene("chess", generator::makeChess, 21e3, 138, 0.054),
                lensScene("still_life", generator::makeStillLife, 128e3, 178, 0.027),
                lensScene("toasters", generator::makeToasters, 2.5e3, 125, 0.055),
                lensScene("room", generator::makeRoom, 100e3, 181, 0.024),
            } });
}
