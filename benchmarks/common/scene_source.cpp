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

SceneSource externalScene(
    const std::string& name, const std::string& origin, const std::string& mesh, const std::string& map)
{
    const auto file = [name] { return (fs::path(WEDGE_SOURCE_DATA) / "external" / (name + ".toml")).string(); };
    return { name, origin, file, mesh, map };
}

SceneSource shippedScene(const std::string& name, const std::string& origin)
{
    const auto file = [name] { return (fs::path(WEDGE_SOURCE_DATA) / "scenes" / (name + ".toml")).string(); };
    return { name, origin, file, "" };
}

SceneSource writtenScene(const std::string& name, const std::string& origin,
    const std::function<std::string(const std::string& scenes)>& text, const std::string& map)
{
    const auto file = [name, text] {
        const fs::path folder = fs::path(WEDGE_BENCHMARK_DATA) / "scenes";
        std::error_code failed;
        fs::create_directories(folder, failed);
        if (failed) {
            throw Error("folder for scenes", folder.string(), failed.message());
        }
        const fs::path path = folder / (name + ".toml");
        generator::writeText(path, text((fs::path(WEDGE_SOURCE_DATA) / "scenes").string()));
        return path.string();
    };
    return { name, origin, file, "", map };
}

SceneSource sceneOfFile(const std::string& path, const std::vector<std::string>& known)
{
    if (!fs::exists(path)) {
        throw UsageError("scene", path, fmt::format("name a scene file or one of {}", fmt::join(known, ", ")));
    }
    return { fs::path(path).stem().string(), "scene file", [path] { return path; }, "" };
}

std::string missing(const SceneSource& source)
{
    const char* folder = std::getenv("WEDGE_DATA");
    std::error_code ignored;
    for (const std::string& file : { source.mesh, source.map }) {
        if (!file.empty() && (folder == nullptr || !fs::is_regular_file(fs::path(folder) / file, ignored))) {
            return file;
        }
    }
    return "";
}

std::string defaultReferenceFolder() { return WEDGE_BENCHMARK_DATA "/references"; }

} // namespace wedge::benchmark
