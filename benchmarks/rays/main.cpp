// rays: millions of rays a second beside Embree on the same rays; docs/benchmarks.md.
#include "benchmarks/common/program.h"
#include "benchmarks/rays/results.h"
#include "benchmarks/rays/tables.h"
#include "host/error.h"
#include "host/image/atomic_file.h"

#include <charconv>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    bool quick = false, list = false, cpuTime = false, noGrowth = false, growthOnly = false, noFrame = false;
    std::vector<std::string> scenes;
    std::string json, device, size;
    render::Traversal traversal = render::Traversal::Automatic;
    int repeats = 0, threads = 0, growthSteps = 0; ///< 0: the plan's
};

void addOptions(CLI::App& parser, Arguments& a)
{
    parser.add_flag("--quick", a.quick, "320x240, few repetitions, small scenes: a look");
    parser.add_option("--scene", a.scenes, "a scene's name or a scene file; again for more (all there are)")
        ->expected(1)
        ->take_all();
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--size", a.size, "WIDTHxHEIGHT of the image, multiples of 8 (640x480, quick 320x240)");
    parser.add_option("--repeats", a.repeats, "repetitions of everything (9, quick 3)")->check(CLI::Range(1, 1000));
    parser.add_option("--threads", a.threads, "threads of Embree (the device's compute units)")
        ->check(CLI::Range(1, 1024));
    parser.add_option("--traversal", a.traversal, "auto, wide or scalar: the family of our traversals")
        ->transform(
            CLI::CheckedTransformer(std::map<std::string, render::Traversal> { { "auto", render::Traversal::Automatic },
                { "wide", render::Traversal::Wide }, { "scalar", render::Traversal::Scalar } }));
    parser.add_flag("--cpu-time", a.cpuTime, "processor time over threads in place of wall time: for a busy machine");
    parser.add_flag("--no-frame", a.noFrame, "without whole frames");
    parser.add_flag("--no-growth", a.noGrowth, "without the growing field, which comes last where no scene is named");
    parser.add_flag("--growth-only", a.growthOnly, "the growing field alone");
    parser.add_option("--growth-steps", a.growthSteps, "half decades of triangles from 1000 on (9, quick 5)")
        ->check(CLI::Range(1, 9));
    parser.add_flag("--list", a.list, "list the scenes");
}

/// "64x48" into a plan's size.
void setSize(RayPlan& plan, const std::string& text)
{
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, plan.width);
    const bool split = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(split ? width.ptr + 1 : end, end, plan.height);
    const auto usable = [](int side) { return side >= tileSide && side <= 4096 && side % tileSide == 0; };
    if (!split || height.ec != std::errc() || height.ptr != end || !usable(plan.width) || !usable(plan.height))
        throw UsageError("--size", text, fmt::format("give WIDTHxHEIGHT, multiples of {} up to 4096", tileSide));
}

RayPlan planFor(const Arguments& a, const device::DeviceInfo& device, const HardwareCounters& counters)
{
    RayPlan plan;
    plan.quick = a.quick;
    plan.timing.repeats = 9;
    if (a.quick) {
        plan.width = 320;
        plan.height = 240;
        plan.timing.repeats = 3;
        plan.growthSteps = 5;
    }
    if (!a.size.empty())
        setSize(plan, a.size);
    if (a.repeats > 0)
        plan.timing.repeats = a.repeats;
    if (a.growthSteps > 0)
        plan.growthSteps = a.growthSteps;
    plan.growth = a.growthOnly || (!a.noGrowth && a.scenes.empty());
    plan.frame = !a.noFrame;
    plan.timing.cpuTime = a.cpuTime;
    plan.timing.threads = a.threads > 0 ? static_cast<unsigned>(a.threads) : device.computeUnits;
    plan.timing.counters = &counters;
    plan.timeStampHertz = timeStampFrequency();
    return plan;
}

/// The scenes asked for; those that need meshes which are not there go to `skipped`, unless named.
std::vector<RayScene> chooseScenes(const Arguments& a, std::vector<std::string>& skipped)
{
    std::vector<RayScene> chosen;
    for (const std::string& name : a.scenes) {
        chosen.push_back(findRayScene(name));
        if (!available(chosen.back()))
            throw Error("scene", name, "set WEDGE_DATA to the folder that holds " + chosen.back().mesh);
    }
    if (!a.scenes.empty() || a.growthOnly)
        return chosen;
    for (const RayScene& source : rayScenes()) {
        if (!(a.quick ? source.quick : source.full))
            continue;
        if (available(source))
            chosen.push_back(source);
        else
            skipped.push_back(source.name);
    }
    return chosen;
}

int run(const Arguments& a)
{
    if (a.list) {
        for (const RayScene& source : rayScenes())
            fmt::print("{:<24}{}\n", source.name, source.origin);
        return 0;
    }
    RayResults results;
    const std::vector<RayScene> sources = chooseScenes(a, results.skipped);
    if (!results.skipped.empty())
        progress(fmt::format("skipped {}: their meshes are not below WEDGE_DATA", fmt::join(results.skipped, ", ")));
    if (!a.json.empty())
        image::checkWritable(a.json);
    const HardwareCounters counters; // before any thread starts
    results.countersProblem = counters.problem();
    const device::Device device = device::Device::open(a.device);
    results.plan = planFor(a, device.info(), counters);
    const auto save = [&] {
        if (!a.json.empty())
            writeJson(a.json, resultsOf(results, device.info()));
    };
    fmt::print("wedge rays, {}x{}, {}, Embree {} on {} threads\n", results.plan.width, results.plan.height,
        device.info().name, EmbreeScene::version(), results.plan.timing.threads);
    std::fflush(stdout);
    WedgeTracer tracer(device, a.traversal);
    results.traversal = render::traversalName(tracer.traversal());
    Workers workers(results.plan.timing.threads);
    for (const RayScene& source : sources) {
        results.scenes.push_back(measureRayScene(source, tracer, workers, results.plan));
        save();
    }
    if (results.plan.growth)
        for (const std::size_t triangles : growthSizes(results.plan.growthSteps)) {
            results.growth.push_back(measureGrowth(triangles, tracer, workers, results.plan));
            save();
        }
    fmt::print("{}{}{}{}{}{}{}", throughputTables(results), ratioTable(results), modelTable(results),
        differenceTable(results), frameTable(results), growthTable(results), goalTable(results));
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures rays a second beside Embree on the same rays, and compares every hit.", "rays");
    Arguments arguments;
    addOptions(parser, arguments);
    return runProgram(parser, argc, argv, [&] { return run(arguments); });
}
