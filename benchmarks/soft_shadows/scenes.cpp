#include "benchmarks/soft_shadows/scenes.h"

#include "data/generator/lottery/lottery.h"

namespace wedge::benchmark {
namespace {

constexpr PaperRow grids { "Grids", 200, 14.2, 6.56, 13.8, 20.4, 3.70, 1.31, 5.01, 25.4, 39, 49 };
constexpr PaperRow bench { "Bench", 309e3, 28.0, 50.9, 374, 425, 3.51, 1.27, 4.78, 430, 2.3, 2.3 };
constexpr PaperRow tentacles { "Tentacles", 145e3, 26.3, 49.0, 239, 288, 3.50, 1.29, 4.79, 293, 3.4, 3.5 };
constexpr PaperRow spheres { "Spheres", 72e3, 33.8, 56.9, 285, 342, 3.70, 1.29, 4.99, 347, 2.9, 2.9 };

constexpr const char* gridsMesh = "aaf2012_grids/grids.obj";
constexpr const char* spheresMesh = "aaf2012_spheres/spheres.obj";

// Section 3.5.3: six times fewer samples on Grids. Fig. 3.9: Tentacles at 23 samples equals 200 unfiltered ones.
constexpr double paperGridsSaved = 6.0;
constexpr double paperTentaclesSaved = 200.0 / 23.0;

SceneSource authors(const std::string& name, const std::string& mesh)
{
    return externalScene(name, "the authors' mesh, from WEDGE_DATA", mesh);
}

} // namespace

const std::vector<ShadowScene>& shadowScenes()
{
    static const std::vector<ShadowScene> scenes = {
        { generatedScene("grids", generator::makeGrids), &grids, { 15, 6, 0.20, paperGridsSaved } },
        { generatedScene("bench", generator::makeBench), &bench, { 4, {}, 0.03, {} } },
        { generatedScene("tentacles", generator::makeTentacles), &tentacles, { 4, {}, 0.03, paperTentaclesSaved } },
        { generatedScene("spheres", generator::makeSpheres), &spheres, { 5, {}, 0.03, {} } },
        // What the chapter has not: lobes; open ground whose lights dip below horizons, under sharp highlights; clutter
        // under four lights. No goals: the lottery has those.
        { generatedScene("cornell_glossy", generator::makeCornellGlossy), nullptr, {}, false },
        { generatedScene("lottery_97", [] { return generator::makeLottery(97); }), nullptr, {}, false },
        { generatedScene("lottery_122", [] { return generator::makeLottery(122); }), nullptr, {}, false },
        { authors("aaf2012_grids_cut2", gridsMesh), &grids, { 15, 6, 0.20, paperGridsSaved } },
        { authors("aaf2012_spheres_cut2", spheresMesh), &spheres, { 5, {}, 0.03, {} }, false },
        // As their authors light them. No goal for the samples: light cut at 1 sigma is nearly uniform.
        { authors("aaf2012_grids", gridsMesh), &grids, { {}, {}, 0.20, paperGridsSaved }, false },
        { authors("aaf2012_spheres", spheresMesh), &spheres, { {}, {}, 0.03, {} }, false },
    };
    return scenes;
}

} // namespace wedge::benchmark
