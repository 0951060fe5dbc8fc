// soft_shadows: chapter 3 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/common/program.h"
#include "benchmarks/soft_shadows/results.h"
#include "benchmarks/soft_shadows/run.h"
#include "benchmarks/soft_shadows/tables.h"
#include "host/error.h"
#include "host/image/atomic_file.h"

#include <charconv>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    bool quick = false, list = false, timingOnly = false;
    std::vector<std::string> scenes;
    std::string json, device, size;
    std::string references = WEDGE_BENCHMARK_DATA "/references";
    int referenceSpp = 0; ///< 0: the plan's
};

void addOptions(CLI::App& parser, Arguments& a)
{
    parser.add_flag("--quick", a.quick, "320x240 and fewer points, about two minutes");
    parser.add_option("--scene", a.scenes, "a scene's name or a scene file; again for more (all there are)")
        ->expected(1)
        ->take_all();
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--reference-dir", a.references, "where references are kept (beside this program)");
    parser.add_option("--reference-spp", a.referenceSpp, "samples of the references (2048, quick 256)")
        ->check(CLI::Range(16, 1 << 20));
    parser.add_option("--size", a.size, "WIDTHxHEIGHT of the images (640x480, quick 320x240)");
    parser.add_flag("--timing-only", a.timingOnly, "only what Table 3.1 has");
    parser.add_flag("--list", a.list, "list the scenes");
}

/// "64x48" into a plan's size.
void setSize(Plan& plan, const std::string& text)
{
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, plan.width);
    const bool split = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(split ? width.ptr + 1 : end, end, plan.height);
    if (!split || height.ec != std::errc() || height.ptr != end || plan.width < 8 || plan.height < 8
        || plan.width > scene::maxImageSide || plan.height > scene::maxImageSide) {
        throw UsageError("--size", text, fmt::format("give WIDTHxHEIGHT, each from 8 to {}", scene::maxImageSide));
    }
}

Plan planFor(const Arguments& a)
{
    Plan plan = a.quick ? quickPlan() : Plan {};
    plan.timingOnly = a.timingOnly;
    plan.referenceFolder = a.references;
    if (!a.size.empty()) {
        setSize(plan, a.size);
    }
    if (a.referenceSpp > 0) {
        plan.referenceSpp = 4 * ((a.referenceSpp + 3) / 4); // two halves, of each of two references
    }
    return plan;
}

/// The scenes asked for; those that need meshes which are not there go to `skipped`, unless named.
std::vector<SceneSource> chooseScenes(const Arguments& a, std::vector<std::string>& skipped)
{
    std::vector<SceneSource> chosen;
    for (const std::string& name : a.scenes) {
        chosen.push_back(findScene(name));
        if (!available(chosen.back())) {
            throw Error("scene", name, "set WEDGE_DATA to the folder that holds " + chosen.back().mesh);
        }
    }
    if (!a.scenes.empty()) {
        return chosen;
    }
    for (const SceneSource& source : knownScenes()) {
        if (!available(source)) {
            skipped.push_back(source.name);
        } else {
            chosen.push_back(source);
        }
    }
    return chosen;
}

int run(const Arguments& a)
{
    if (a.list) {
        for (const SceneSource& source : knownScenes()) {
            fmt::print("{:<24}{}\n", source.name, source.origin);
        }
        return 0;
    }
    const Plan plan = planFor(a);
    std::vector<std::string> skipped;
    const std::vector<SceneSource> sources = chooseScenes(a, skipped);
    if (!skipped.empty()) {
        progress(fmt::format("skipped {}: their meshes are not below WEDGE_DATA", fmt::join(skipped, ", ")));
    }
    if (!a.json.empty()) {
        image::checkWritable(a.json);
    }
    const device::Device device = device::Device::open(a.device);
    fmt::print("wedge soft_shadows, {}x{}, {}\n\n", plan.width, plan.height, device.info().name);
    std::fflush(stdout);
    std::vector<SceneResult> results;
    for (const SceneSource& source : sources) {
        results.push_back(measureScene(source, device, plan));
        if (!a.json.empty()) {
            writeJson(a.json, resultsOf(results, skipped, plan, device.info()));
        }
    }
    fmt::print("{}{}{}", timingTable(results), errorTable(results), goalTable(results));
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures soft shadows: times of Table 3.1, errors of Fig. 3.6c, samples saved.", "soft_shadows");
    Arguments arguments;
    addOptions(parser, arguments);
    return runProgram(parser, argc, argv, [&] { return run(arguments); });
}
