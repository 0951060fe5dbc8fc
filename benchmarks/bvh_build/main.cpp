// bvh_build: times and memory of our hierarchies beside Embree's over the same meshes; docs/benchmarks.md.
#include "benchmarks/bvh_build/results.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/synthetic_mesh.h"
#include "benchmarks/rays/scenes.h"
#include "host/error.h"
#include "host/image/atomic_file.h"

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

/// A mesh to build over, made when its turn comes.
struct Source {
    std::string name;
    std::function<SceneBuilds(const BuildPlan&)> measure;
};

Source field(const std::string& name, std::size_t triangles)
{
    return { name, [=](const BuildPlan& plan) {
                const SyntheticMesh mesh = syntheticMesh(triangles);
                return measureBuilds(name, { mesh.positions, mesh.indices }, plan);
            } };
}

Source scene(const RayScene& source)
{
    return { source.name, [source](const BuildPlan& plan) {
                const scene::Scene loaded = source.load();
                return measureBuilds(source.name, { loaded.geometry.positions, loaded.geometry.indices }, plan);
            } };
}

struct Field {
    const char* name;
    std::size_t triangles;
    bool quick;
};
constexpr Field fields[] = { { "field_1k", 1'000, true }, { "field_10k", 10'000, true },
    { "field_100k", 100'000, true }, { "field_1m", 1'000'000, false }, { "field_10m", 10'000'000, false } };

/// The meshes asked for, by name or as scene files; those that need what is not below WEDGE_DATA are left out unless
/// named.
std::vector<Source> chooseSources(const std::vector<std::string>& names, bool quick, std::vector<std::string>& skipped)
{
    std::vector<Source> out;
    for (const std::string& name : names) {
        const Field* known = std::find_if(
            std::begin(fields), std::end(fields), [&](const Field& candidate) { return candidate.name == name; });
        if (known != std::end(fields)) {
            out.push_back(field(known->name, known->triangles));
            continue;
        }
        const RayScene found = findRayScene(name);
        if (!available(found))
            throw Error("scene", name, "set WEDGE_DATA to the folder that holds " + found.mesh);
        out.push_back(scene(found));
    }
    if (!names.empty())
        return out;
    for (const Field& candidate : fields)
        if (candidate.quick || !quick)
            out.push_back(field(candidate.name, candidate.triangles));
    for (const RayScene& source : rayScenes()) {
        if (source.name.starts_with("field") || !(quick ? source.quick : source.full))
            continue;
        if (available(source))
            out.push_back(scene(source));
        else
            skipped.push_back(source.name);
    }
    return out;
}

struct Arguments {
    bool quick = false;
    std::vector<std::string> scenes;
    std::vector<unsigned> threads;
    std::string json;
    int repeats = 0;
};

int run(const Arguments& a)
{
    BuildResults results;
    results.machine = describeMachine();
    results.plan.repeats = a.repeats > 0 ? a.repeats : a.quick ? 5 : 15;
    results.plan.secondsEach = a.quick ? 5 : 60;
    if (!a.threads.empty())
        results.plan.threads = a.threads;
    const std::vector<Source> sources = chooseSources(a.scenes, a.quick, results.skipped);
    if (!a.json.empty())
        image::checkWritable(a.json);
    for (const Source& source : sources) {
        results.scenes.push_back(source.measure(results.plan));
        fmt::print("{}", tableOf(results.scenes.back()));
        std::fflush(stdout);
        if (!a.json.empty())
            writeJson(a.json, resultsOf(results));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures the builds of hierarchies beside Embree's over the same meshes.", "bvh_build");
    Arguments arguments;
    parser.add_flag("--quick", arguments.quick, "small meshes, few repetitions: a look");
    parser
        .add_option(
            "--scene", arguments.scenes, "field_1k to field_10m, a scene's name or a scene file; again for more")
        ->expected(1)
        ->take_all();
    parser
        .add_option(
            "--threads", arguments.threads, "a number of threads; again for more (1 and 2), claims go by the last")
        ->expected(1)
        ->take_all()
        ->check(CLI::Range(1, 1024));
    parser.add_option("--repeats", arguments.repeats, "repetitions of everything (15, quick 5)")
        ->check(CLI::Range(1, 1000));
    parser.add_option("--json", arguments.json, "where the results go, rewritten after each mesh");
    return runProgram(parser, argc, argv, [&] { return run(arguments); });
}
