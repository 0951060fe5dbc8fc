#include "benchmarks/soft_shadows/scenes.h"

#include "data/generator/scene_writer.h"
#include "host/error.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr PaperRow grids { "Grids", 200, 14.2, 6.56, 13.8, 20.4, 3.70, 1.31, 5.01, 25.4, 39, 49 };
constexpr PaperRow bench { "Bench", 309e3, 28.0, 50.9, 374, 425, 3.51, 1.27, 4.78, 430, 2.3, 2.3 };
constexpr PaperRow tentacles { "Tentacles", 145e3, 26.3, 49.0, 239, 288, 3.50, 1.29, 4.79, 293, 3.4, 3.5 };
constexpr PaperRow spheres { "Spheres", 72e3, 33.8, 56.9, 285, 342, 3.70, 1.29, 4.99, 347, 2.9, 2.9 };

constexpr const char* gridsMesh = "aaf2012_grids/grids.obj";
constexpr const char* spheresMesh = "aaf2012_spheres/spheres.obj";

// Section 3.5.3: six times fewer samples on Grids. Fig. 3.9: Tentacles at 23 samples equals 200 unfiltered ones.
constexpr double paperGridsSaved = 6.0;
constexpr double paperTentaclesSaved = 200.0 / 23.0;

SceneSource generated(
    const std::string& name, generator::GeneratedScene (*make)(), const PaperRow& paper, const Goals& goals)
{
    SceneSource source;
    source.name = name;
    source.origin = "generated";
    source.file = [name, make] {
        const fs::path folder = fs::path(WEDGE_BENCHMARK_DATA) / "scenes";
        generator::writeScene(make(), folder);
        return (folder / (name + ".toml")).string();
    };
    source.paper = &paper;
    source.goals = goals;
    return source;
}

SceneSource external(
    const std::string& name, const std::string& mesh, const PaperRow& paper, const Goals& goals, bool curves)
{
    SceneSource source;
    source.name = name;
    source.origin = "the authors' mesh, from WEDGE_DATA";
    source.file = [name] { return (fs::path(WEDGE_SOURCE_DATA) / "external" / (name + ".toml")).string(); };
    source.paper = &paper;
    source.goals = goals;
    source.curves = curves;
    source.mesh = mesh;
    return source;
}

} // namespace

const std::vector<SceneSource>& knownScenes()
{
    static const std::vector<SceneSource> scenes = {
        generated("grids", generator::makeGrids, grids, { 15, 6, 0.20, paperGridsSaved }),
        generated("bench", generator::makeBench, bench, { 4, {}, 0.03, {} }),
        generated("tentacles", generator::makeTentacles, tentacles, { 4, {}, 0.03, paperTentaclesSaved }),
        generated("spheres", generator::makeSpheres, spheres, { 5, {}, 0.03, {} }),
        external("aaf2012_grids_cut2", gridsMesh, grids, { 15, 6, 0.20, paperGridsSaved }, true),
        external("aaf2012_spheres_cut2", spheresMesh, spheres, { 5, {}, 0.03, {} }, false),
        // As their authors light them. No goal for the samples: light cut at 1 sigma is nearly uniform.
        external("aaf2012_grids", gridsMesh, grids, { {}, {}, 0.20, paperGridsSaved }, false),
        external("aaf2012_spheres", spheresMesh, spheres, { {}, {}, 0.03, {} }, false),
    };
    return scenes;
}

bool available(const SceneSource& source)
{
    const char* folder = std::getenv("WEDGE_DATA");
    std::error_code ignored;
    return source.mesh.empty() || (folder != nullptr && fs::is_regular_file(fs::path(folder) / source.mesh, ignored));
}

SceneSource findScene(const std::string& nameOrPath)
{
    const auto& scenes = knownScenes();
    const auto known = std::ranges::find(scenes, nameOrPath, &SceneSource::name);
    if (known != scenes.end()) {
        return *known;
    }
    if (!fs::exists(nameOrPath)) {
        std::vector<std::string> names;
        std::ranges::transform(scenes, std::back_inserter(names), &SceneSource::name);
        throw UsageError("scene", nameOrPath, fmt::format("name a scene file or one of {}", fmt::join(names, ", ")));
    }
    SceneSource source;
    source.name = fs::path(nameOrPath).stem().string();
    source.origin = "scene file";
    source.file = [nameOrPath] { return nameOrPath; };
    return source;
}

} // namespace wedge::benchmark
