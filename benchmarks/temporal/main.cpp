// temporal: the variance of each pixel, with and without the filter over time; docs/benchmarks.md.
#include "benchmarks/common/arguments.h"
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/statistics.h"
#include "filters/temporal/temporal.h"
#include "host/device/device.h"
#include "host/render/renderer.h"
#include "host/scene/load_scene.h"
#include "kernels/shared/bsdf.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    std::string size = "320x240", device, json;
    std::vector<std::string> scenes;
    int spp = 16, seeds = 8;
};

/// How a sequence's camera goes.
struct Path {
    const char* name;
    float degrees; ///< around what it looks at, from frame to frame
    double goal; ///< of the ratio of variances
};
constexpr Path paths[] = { { "still", 0.0f, 4.0 }, { "moving", 1.0f, 2.0 } };

/// A camera that has gone around what it looks at.
scene::Camera turned(scene::Camera camera, float degrees)
{
    const float angle = glm::radians(degrees);
    const glm::vec3 axis = glm::normalize(camera.up), from = camera.eye - camera.lookAt;
    const glm::vec3 along = axis * glm::dot(axis, from), across = from - along;
    camera.eye = camera.lookAt + along + std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across);
    return camera;
}

/// Sums over images of luminances of pixels.
struct Moments {
    explicit Moments(std::size_t pixels)
        : sum(pixels)
        , squares(pixels)
    {
    }

    void add(render::Renderer& renderer)
    {
        const render::Frame& frame = renderer.frame();
        const std::vector<float> planes = frame.beauty.downloadAll(renderer.queue());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const std::size_t at = shared::pixelIndex(static_cast<std::uint32_t>(i % frame.layout.width),
                static_cast<std::uint32_t>(i / frame.layout.width), frame.layout.stride);
            const double y = shared::luminance(
                shared::vec3(planes[at], planes[frame.layout.size + at], planes[2 * frame.layout.size + at]));
            sum[i] += y;
            squares[i] += y * y;
        }
    }
    double variance(std::size_t i, int images) const
    {
        return std::max(0.0, squares[i] - sum[i] * sum[i] / images) / (images - 1);
    }

    std::vector<double> sum, squares;
};

struct Measured {
    double ratio = 0; ///< of variances, of the sums over all pixels
    double medianRatio = 0; ///< of pixels that have noise
    Summary overhead, filterMilliseconds, frameMilliseconds;
    double memoryMebibytes = 0; ///< that the filter adds
};

Measured measure(const Arguments& a, const scene::Scene& start, const Path& path, const device::Device& device,
    const render::Settings& base)
{
    scene::Scene scene = start;
    render::Renderer renderer(scene, device);
    const auto pixels = static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height);
    Moments with(pixels), without(pixels);
    std::vector<double> overhead, filter, frame;
    Measured out;
    render::Settings settings = base;
    settings.temporal = render::Temporal::On;
    renderer.rehearse(settings, true);
    filters::TemporalFilter(device).rehearse(renderer, settings);
    constexpr std::uint32_t last = filters::temporalWindow - 1;
    for (int seed = 0; seed < a.seeds; ++seed) {
        filters::TemporalFilter temporal(device);
        settings.seed = static_cast<std::uint32_t>(seed);
        for (std::uint32_t number = 0; number <= last; ++number) {
            renderer.changeScene(
                {}, [&] { scene.camera = turned(start.camera, path.degrees * static_cast<float>(number)); });
            settings.frame = number;
            render::FrameStatistics statistics = renderer.render(settings, {}, true);
            if (number < last) {
                temporal.keep(renderer, settings, nullptr, statistics);
                continue;
            }
            without.add(renderer);
            const std::uint64_t before = statistics.memoryBytes;
            temporal.filter(renderer, settings, nullptr, statistics);
            with.add(renderer);
            overhead.push_back(statistics.overheadFraction());
            filter.push_back(statistics.milliseconds("filter over time"));
            frame.push_back(statistics.deviceMilliseconds);
            out.memoryMebibytes = static_cast<double>(statistics.memoryBytes - before) / (1 << 20);
        }
    }
    double sumWith = 0, sumWithout = 0;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double noisy = without.variance(i, a.seeds), filtered = with.variance(i, a.seeds);
        sumWith += filtered;
        sumWithout += noisy;
        const double mean = without.sum[i] / a.seeds;
        if (noisy > 1e-8 * mean * mean && filtered > 0) {
            ratios.push_back(noisy / filtered);
        }
    }
    out.ratio = sumWithout / sumWith;
    out.medianRatio = summarize(ratios).median;
    out.overhead = summarize(overhead);
    out.filterMilliseconds = summarize(filter);
    out.frameMilliseconds = summarize(frame);
    return out;
}

int measureAll(const Arguments& a)
{
    MeasurePlan plan;
    setSize(plan, a.size);
    const device::Device device = device::Device::open(a.device);
    Json all = resultSkeleton("temporal", device.info());
    all["size"] = { plan.width, plan.height };
    all["spp"] = a.spp;
    all["seeds"] = a.seeds;
    const std::vector<SceneSource> known { shippedScene("sky", "spheres, matt and glossy, under data/scenes' sky"),
        externalScene("uffizi_diffuse", "a matt dragon on a plane under uffizi, from WEDGE_DATA",
            "models/dragon/dragon_aaf.obj", "hdr/uffizi.hdr") };
    std::vector<std::string> skipped;
    fmt::print("{:<16} {:<7} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "scene", "camera", "ratio", "median", "overhead",
        "filter ms", "frame ms");
    for (const SceneSource& source : chooseScenes(known, a.scenes, skipped)) {
        const scene::Scene scene = scene::loadScene(source.file());
        render::Settings settings = render::axisAligned(a.spp);
        settings.width = plan.width;
        settings.height = plan.height;
        for (const Path& path : paths) {
            const Measured m = measure(a, scene, path, device, settings);
            ClaimList claims("environment", fmt::format("temporal.{}_{}", source.name, path.name));
            claims.add("variance_ratio", m.ratio, "1", {}, path.goal);
            claims.add("median_variance_ratio", m.medianRatio, "1");
            claims.add("overhead", m.overhead, "1", {}, 0.12);
            claims.add("filter_ms", m.filterMilliseconds, "ms");
            claims.add("memory", m.memoryMebibytes, "MiB");
            addClaims(all, claims.claims);
            fmt::print("{:<16} {:<7} {:>8.2f} {:>8.2f} {:>9.3f} {:>9.1f} {:>9.0f}\n", source.name, path.name, m.ratio,
                m.medianRatio, m.overhead.median, m.filterMilliseconds.median, m.frameMilliseconds.median);
            std::fflush(stdout);
            if (!a.json.empty()) {
                writeJson(a.json, all);
            }
        }
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures the variance of pixels with and without the filter over time.", "temporal");
    Arguments a;
    parser.add_option("--scene", a.scenes, "sky, uffizi_diffuse, or a scene file (all that are there)");
    parser.add_option("--spp", a.spp, "samples a pixel and term (16)")->check(CLI::Range(9, 4096));
    parser.add_option("--seeds", a.seeds, "sequences whose frames are compared (8)")->check(CLI::Range(2, 1000));
    parser.add_option("--size", a.size, "WIDTHxHEIGHT (320x240)");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
