#include "benchmarks/bvh_build/results.h"

#include <fstream>
#include <thread>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

double perTriangle(std::size_t bytes, const SceneBuilds& scene)
{
    return static_cast<double>(bytes) / static_cast<double>(scene.triangles);
}

void addRatio(std::vector<Claim>& claims, const std::string& id, const Summary& ratio, std::optional<double> goal)
{
    claims.push_back({ id, ratio.median, "1", ratio.spread(), {}, goal });
}

/// The quantities of a scene. Those of the most threads have no suffix, others end in the number of theirs.
std::vector<Claim> claimsOf(const SceneBuilds& scene)
{
    std::vector<Claim> claims;
    const std::string prefix = "bvh_build." + scene.name + ".";
    for (const BuildSet& set : scene.sets) {
        const bool most = &set == &scene.sets.back();
        const std::string suffix = most ? "" : fmt::format("_{}_thread{}", set.threads, set.threads == 1 ? "" : "s");
        const auto ratio = [&](const char* quantity, const char* name, const char* by, std::optional<double> goal) {
            addRatio(claims, fmt::format("{}{}{}", prefix, quantity, suffix), set.ratio(name, by, false), goal);
            addRatio(claims, fmt::format("{}{}_cpu{}", prefix, quantity, suffix), set.ratio(name, by, true), {});
        };
        ratio("build_vs_embree", "default", "embree_default", 1.0);
        ratio("fast_build_vs_embree_low", "fast", "embree_low", {});
        ratio("quality_build_vs_embree_high", "quality", "embree_high", 1.0);
        ratio("fast_build_vs_default", "fast", "default", {});
        ratio("quality_build_vs_default", "quality", "default", {});
        ratio("refit_vs_default", "refit", "default", {});
        if (!most)
            continue;
        for (const BuildTimes& times : set.builders) {
            if (times.name == "refit")
                continue;
            const std::string of = times.name == "default" ? "" : "_" + times.name;
            const bool own = !times.peer.empty();
            claims.push_back({ fmt::format("{}bytes_per_triangle{}", prefix, of), perTriangle(times.bytes, scene), "B",
                {}, {}, own ? std::optional(100.0) : std::nullopt });
            if (times.peakBytes)
                claims.push_back({ fmt::format("{}peak_bytes_per_triangle{}", prefix, of),
                    perTriangle(*times.peakBytes, scene), "B", {}, {}, {} });
        }
    }
    return claims;
}

Json json(const BuildTimes& times)
{
    return { { "name", times.name }, { "peer", times.peer }, { "wall_ms", json(summarize(times.wallMs)) },
        { "cpu_ms", json(summarize(times.cpuMs)) }, { "bytes", times.bytes },
        { "peak_bytes", times.peakBytes ? Json(*times.peakBytes) : Json(nullptr) } };
}

} // namespace

device::DeviceInfo describeMachine()
{
    device::DeviceInfo info;
    info.platform = "host";
    info.type = device::DeviceType::Cpu;
    info.computeUnits = std::max(1u, std::thread::hardware_concurrency());
    std::ifstream processors("/proc/cpuinfo");
    for (std::string line; std::getline(processors, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
            info.name = line.substr(line.find(": ") + 2);
            break;
        }
    return info;
}

Json resultsOf(const BuildResults& results)
{
    Json out = resultSkeleton("bvh_build", results.machine);
    out["repeats"] = results.plan.repeats;
    out["skipped"] = results.skipped;
    out["scenes"] = Json::array();
    for (const SceneBuilds& scene : results.scenes) {
        Json sets = Json::array();
        for (const BuildSet& set : scene.sets) {
            Json builders = Json::array();
            for (const BuildTimes& times : set.builders)
                builders.push_back(json(times));
            sets.push_back({ { "threads", set.threads }, { "builders", builders } });
        }
        out["scenes"].push_back({ { "name", scene.name }, { "triangles", scene.triangles }, { "sets", sets } });
        addClaims(out, claimsOf(scene));
    }
    return out;
}

std::string tableOf(const SceneBuilds& scene)
{
    std::string out = fmt::format("\n{}, {} triangles\n", scene.name, scene.triangles);
    for (const BuildSet& set : scene.sets) {
        out += fmt::format("  {:<18}{:>10}{:>10}{:>10}{:>10}{:>10}{:>12}\n", fmt::format("{} thread(s)", set.threads),
            "wall ms", "+-", "cpu ms", "B/tri", "peak B", "vs peer");
        for (const BuildTimes& times : set.builders) {
            const Summary wall = summarize(times.wallMs);
            out += fmt::format("  {:<18}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.1f}{:>10}{:>12}\n", times.name, wall.median,
                wall.spread(), summarize(times.cpuMs).median, perTriangle(times.bytes, scene),
                times.peakBytes ? fmt::format("{:.1f}", perTriangle(*times.peakBytes, scene)) : "-",
                times.peer.empty() ? "" : fmt::format("{:.2f}", set.ratio(times.name, times.peer, false).median));
        }
    }
    return out;
}

} // namespace wedge::benchmark
