#include "benchmarks/common/scene_source.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {

namespace fs = std::filesystem;

SceneSource generatedScene(const std::string& name, generator::GeneratedScene (*make)())
{
    const auto file = [name, make] {
        const fs::path folder = fs::path(WEDGE_BENCHMARK_DATA) / "scenes";
        generator::writeScene(make(), folder);
        return (folder / (name + ".toml")).string();
    };
    return { name, "generated", file, "" };
}

SceneSource externalScene(const std::string& name, const std::string& origin, const std::string& mesh)
{
    const auto file = [name] { return (fs::path(WEDGE_SOURCE_DATA) / "external" / (name + ".toml")).string(); };
    return { name, origin, file, mesh };
}

SceneSource sceneOfFile(const std::string& path, const std::vector<std::string>& known)
{
    if (!fs::exists(path)) {
        throw UsageError("scene", path, fmt::format("name a scene file or one of {}", fmt::join(known, ", ")));
    }
    return { fs::path(path).stem().string(), "scene file", [path] { return path; }, "" };
}

bool available(const SceneSource& source)
{
    const char* folder = std::getenv("WEDGE_DATA");
    std::error_code ignored;
    return source.mesh.empty() || (folder != nullptr && fs::is_regular_file(fs::path(folder) / source.mesh, ignored));
}

std::string defaultReferenceFolder() { return WEDGE_BENCHMARK_DATA "/references"; }

} // namespace wedge::benchmark
