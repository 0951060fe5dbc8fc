#pragma once

#include "benchmarks/common/arguments.h"
#include "benchmarks/common/claims.h"
#include "benchmarks/common/lab.h"
#include "benchmarks/common/scene_source.h"
#include "host/device/device.h"
#include "host/image/atomic_file.h"

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {

/// A benchmark as measureScenes() runs it. Source: a SceneSource and more; Result: all that is measured of a scene.
template <class Source, class Result>
struct SceneBenchmark {
    std::string program;
    std::vector<Source> scenes;
    std::function<Result(const Source&, const device::Device&)> measure;
    Json plan; ///< as it is written
    std::function<std::vector<Claim>(const Result&)> claims;
    std::function<Json(const Result&)> data;
    std::function<std::string(const std::vector<Result>&)> tables;
};

/// The whole result file.
template <class Source, class Result>
Json resultsOf(const SceneBenchmark<Source, Result>& benchmark, const std::vector<Result>& results,
    const std::vector<std::string>& skipped, const device::DeviceInfo& device)
{
    Json out = resultSkeleton(benchmark.program, device);
    out["plan"] = benchmark.plan;
    out["skipped"] = skipped;
    out["scenes"] = Json::array();
    for (const Result& result : results) {
        for (const Claim& claim : benchmark.claims(result)) {
            out["claims"].push_back(json(claim));
        }
        out["scenes"].push_back(benchmark.data(result));
    }
    return out;
}

/// Lists the scenes, or measures those asked for, writing results after each, and prints tables. Returns the exit
/// status. Throws Error.
template <class Source, class Result>
int measureScenes(const SceneBenchmark<Source, Result>& benchmark, const Arguments& a, const MeasurePlan& plan)
{
    if (a.list) {
        for (const Source& source : benchmark.scenes) {
            fmt::print("{:<24}{}\n", source.name, source.origin);
        }
        return 0;
    }
    std::vector<std::string> skipped;
    const std::vector<Source> sources = chooseScenes(benchmark.scenes, a.scenes, skipped);
    if (!skipped.empty()) {
        progress(benchmark.program,
            fmt::format("skipped {}: their meshes are not below WEDGE_DATA", fmt::join(skipped, ", ")));
    }
    if (!a.json.empty()) {
        image::checkWritable(a.json);
    }
    const device::Device device = device::Device::open(a.device);
    fmt::print("wedge {}, {}x{}, {}\n\n", benchmark.program, plan.width, plan.height, device.info().name);
    std::fflush(stdout);
    std::vector<Result> results;
    for (const Source& source : sources) {
        results.push_back(benchmark.measure(source, device));
        if (!a.json.empty()) {
            writeJson(a.json, resultsOf(benchmark, results, skipped, device.info()));
        }
    }
    fmt::print("{}", benchmark.tables(results));
    return 0;
}

} // namespace wedge::benchmark
