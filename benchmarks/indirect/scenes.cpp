#include "benchmarks/indirect/scenes.h"

namespace wedge::benchmark {
namespace {

constexpr PaperRow sponza { "Sponza", 262e3, 63, 181, 580, 761, 10, 55, 65, 826, 1.21, 1.31 };
constexpr PaperRow conference { "Conference", 331e3, 60, 87, 274, 361, 9, 46, 55, 416, 2.40, 2.77 };
constexpr PaperRow figure1 { "Cornell box, 1 bounce", 145e3, 56, 70, 291, 361, 9, 63, 72, 433, 2.31, 2.77 };
constexpr PaperRow figure2 { "Cornell box, 2 bounces", 145e3, 56, 70, 802, 872, 10, 62, 72, 944, 1.06, 1.14 };
constexpr PaperRow figure3 { "Cornell box, 3 bounces", 145e3, 56, 72, 1423, 1495, 10, 64, 74, 1569, 0.63, 0.67 };
constexpr PaperRow glossy1 { "Glossy Cornell box, 1 bounce", 16.7e3, 59, 70, 248, 318, 12, 49, 61, 379, 2.64, 3.14 };
constexpr PaperRow glossy2 { "Glossy Cornell box, 2 bounces", 16.7e3, 59, 68, 622, 690, 10, 57, 67, 757, 1.32, 1.44 };

// Equal-error samples of stratified path tracing over the method's: Figs. 4.1, 4.6, 4.7, 4.11.
constexpr double paperSponza = 324.0 / 63, paperConference = 440.0 / 60, paperFigure = 298.0 / 56,
                 paperGlossy = 361.0 / 59;

// Half of what the thesis' overheads are of its frames, about.
constexpr double cornellOverhead = 0.08;

// A quarter of the box.
constexpr float cornellAmbientDistance = 0.5f;

IndirectScene scene(SceneSource source, std::vector<BounceCase> cases, std::optional<double> goal,
    std::optional<double> paper, bool curves, bool bias)
{
    return { std::move(source), std::move(cases), goal, paper, curves, bias };
}

} // namespace

const std::vector<IndirectScene>& indirectScenes()
{
    static const std::vector<IndirectScene> scenes = {
        scene(generatedScene("cornell_glossy", generator::makeCornellGlossy),
            { { 1, &glossy1, cornellOverhead }, { 2, &glossy2, {}, false },
                { 0, nullptr, {}, true, cornellAmbientDistance } },
            5, paperGlossy, false, true),
        scene(generatedScene("cornell_figure", generator::makeCornellFigure),
            { { 1, &figure1, cornellOverhead }, { 2, &figure2, {}, false }, { 3, &figure3, 0.025, false } }, 5,
            paperFigure, true, false),
        scene(externalScene("aaf2013_cornell_bunny", "the authors' Cornell box with a bunny, from WEDGE_DATA",
                  "aaf2013_cornell_bunny/cornell_bunny.obj"),
            { { 1, nullptr, cornellOverhead } }, 9, {}, false, false),
        scene(externalScene("crytek_sponza", "Sponza, from WEDGE_DATA", "crytek_sponza/sponza.obj"),
            { { 1, &sponza, 0.04 } }, 5, paperSponza, false, false),
        scene(externalScene("conference", "the conference room, from WEDGE_DATA", "conference/conference.obj"),
            { { 1, &conference, 0.065 } }, 7, paperConference, true, false),
        // Fig. 4.12 shows ambient occlusion and has no figures. Under the open sky, then.
        scene(generatedScene("bench", generator::makeBench), { { 0, nullptr, {} } }, {}, {}, false, false),
        scene(generatedScene("spheres", generator::makeSpheres), { { 0, nullptr, {} } }, {}, {}, false, false),
    };
    return scenes;
}

} // namespace wedge::benchmark
