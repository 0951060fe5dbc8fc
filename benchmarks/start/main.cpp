// start: seconds until the first picture where no kernel has been compiled yet, and with all of them;
// docs/benchmarks.md.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/statistics.h"
#include "benchmarks/start/run_program.h"
#include "host/device/device.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    int rounds = 3;
    std::string size = "640x480", device, json;
    std::vector<std::string> scenes;
};

// Compiled kernels of any picture take more.
constexpr std::uint64_t leastCompiled = 1 << 16;

/// 0 where there is no such folder.
std::uint64_t bytesIn(const std::filesystem::path& folder)
{
    std::uint64_t sum = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none)) {
        sum += entry.is_regular_file() ? entry.file_size() : 0;
    }
    return sum;
}

struct Started : SceneSource {
    std::optional<double> goal; ///< seconds
};

Started ofOurs(const std::string& name, double goal)
{
    Started out;
    out.name = name;
    out.origin = "of the program's own";
    out.file = [name] { return (std::filesystem::path(WEDGE_SOURCE_DATA) / "scenes" / (name + ".toml")).string(); };
    out.goal = goal;
    return out;
}

/// A box, something that moves, and a lens.
std::vector<Started> knownScenes()
{
    Started chess;
    static_cast<SceneSource&>(chess) = generatedScene("chess", generator::makeChess);
    chess.goal = 8;
    return { ofOurs("cornell", 4), ofOurs("motion", 8), chess };
}

int measureAll(const Arguments& a)
{
    const device::Device device = device::Device::open(a.device);
    Json all = resultSkeleton("start", device.info());
    std::vector<std::string> skipped;
    fmt::print("{:<10} {:>8} {:>8}\n", "scene", "cold s", "warm s");
    for (const Started& scene : chooseScenes(knownScenes(), a.scenes, skipped)) {
        const std::string file = scene.file();
        std::vector<double> cold, warm;
        for (int round = 0; round < a.rounds; ++round) {
            const TemporaryFolder folder;
            std::vector<std::string> call { "render", file, "--size", a.size, "--quiet", "-o",
                (folder.path() / "first.exr").string() };
            if (!a.device.empty()) {
                call.insert(call.end(), { "--device", a.device });
            }
            const std::filesystem::path cache = folder.path() / "cache";
            cold.push_back(secondsOf(WEDGE_PROGRAM, call, cache));
            if (bytesIn(cache / "wedge-pocl") < leastCompiled) {
                throw Error("cache of kernels", cache.string(),
                    "the driver keeps its kernels elsewhere, so that no start is known to be cold: choose a "
                    "device of PoCL");
            }
            warm.push_back(secondsOf(WEDGE_PROGRAM, call, cache));
        }
        ClaimList coldClaims("start", "cold"), warmClaims("start", "warm");
        coldClaims.add(scene.name + ".seconds", summarize(cold), "s", {}, scene.goal);
        warmClaims.add(scene.name + ".seconds", summarize(warm), "s");
        addClaims(all, coldClaims.claims);
        addClaims(all, warmClaims.claims);
        fmt::print("{:<10} {:>8.1f} {:>8.1f}\n", scene.name, summarize(cold).median, summarize(warm).median);
        std::fflush(stdout);
        if (!a.json.empty()) {
            writeJson(a.json, all);
        }
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures what the first picture takes, with an empty cache of kernels and a full one.", "start");
    Arguments a;
    parser.add_option("--scene", a.scenes, "cornell, motion, chess, or a scene file (all three)");
    parser.add_option("--rounds", a.rounds, "each with a cache of its own; medians count (3)")
        ->check(CLI::Range(1, 100));
    parser.add_option("--size", a.size, "WIDTHxHEIGHT of the pictures (640x480)");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
