#include "benchmarks/rays/scenes.h"

#include "benchmarks/common/synthetic_mesh.h"
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

RayScene generated(const std::string& name, generator::GeneratedScene (*make)(), bool quick)
{
    RayScene out;
    out.name = name;
    out.origin = "generated";
    out.load = [name, make] {
        const fs::path folder = fs::path(WEDGE_BENCHMARK_DATA) / "scenes";
        generator::writeScene(make(), folder);
        return scene::loadScene((folder / (name + ".toml")).string());
    };
    out.quick = quick;
    return out;
}

RayScene field(const std::string& name, std::size_t triangles, bool quick)
{
    RayScene out;
    out.name = name;
    out.origin = fmt::format("a field of {} triangles, made in memory", triangles);
    out.load = [triangles] { return syntheticScene(triangles); };
    out.quick = quick;
    out.full = !quick;
    return out;
}

RayScene conference()
{
    RayScene out;
    out.name = "conference";
    out.origin = "the conference room, from WEDGE_DATA";
    out.load = [] { return scene::loadScene((fs::path(WEDGE_SOURCE_DATA) / "external/conference.toml").string()); };
    out.mesh = "conference/conference.obj";
    return out;
}

} // namespace

const std::vector<RayScene>& rayScenes()
{
    static const std::vector<RayScene> scenes = {
        generated("grids", generator::makeGrids, true),
        generated("spheres", generator::makeSpheres, true),
        generated("tentacles", generator::makeTentacles, false),
        generated("bench", generator::makeBench, false),
        conference(),
        field("field_100k", 100'000, true),
        field("field_10m", 10'000'000, false),
    };
    return scenes;
}

bool available(const RayScene& source)
{
    const char* folder = std::getenv("WEDGE_DATA");
    std::error_code ignored;
    return source.mesh.empty() || (folder != nullptr && fs::is_regular_file(fs::path(folder) / source.mesh, ignored));
}

RayScene findRayScene(const std::string& nameOrPath)
{
    const auto& scenes = rayScenes();
    const auto known = std::ranges::find(scenes, nameOrPath, &RayScene::name);
    if (known != scenes.end())
        return *known;
    if (!fs::exists(nameOrPath)) {
        std::vector<std::string> names;
        std::ranges::transform(scenes, std::back_inserter(names), &RayScene::name);
        throw UsageError("scene", nameOrPath, fmt::format("name a scene file or one of {}", fmt::join(names, ", ")));
    }
    RayScene out;
    out.name = fs::path(nameOrPath).stem().string();
    out.origin = "scene file";
    out.load = [nameOrPath] { return scene::loadScene(nameOrPath); };
    return out;
}

} // namespace wedge::benchmark
