// emissive: noise of a mesh that emits beside a quad's, and what many lights cost beside one; docs/benchmarks.md.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/statistics.h"
#include "benchmarks/emissive/lamps.h"
#include "host/device/device.h"
#include "host/render/renderer.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    int width = 320, height = 240, spp = 28, seeds = 8;
    std::string device, json;
};

/// One scene, rendered again and again.
struct Lit {
    std::string name;
    std::unique_ptr<render::Renderer> renderer;
    std::vector<double> milliseconds; ///< device time of each frame
    std::vector<double> sum, squares; ///< of the images, number by number

    void take(render::Settings settings, std::uint32_t seed)
    {
        settings.seed = seed;
        const render::FrameStatistics frame = renderer->render(settings, {}, false);
        milliseconds.push_back(frame.deviceMilliseconds);
        const std::vector<float> image = renderer->frame().planes("beauty").downloadAll(renderer->queue());
        sum.resize(image.size());
        squares.resize(image.size());
        for (std::size_t i = 0; i < image.size(); ++i) {
            sum[i] += image[i];
            squares[i] += double { image[i] } * image[i];
        }
    }
    void forget()
    {
        milliseconds.clear();
        sum.clear();
        squares.clear();
    }
    /// RMS over the image of the standard deviation between the frames.
    double noise() const
    {
        const auto n = static_cast<double>(milliseconds.size());
        double total = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            total += std::max(squares[i] / n - (sum[i] / n) * (sum[i] / n), 0.0) * n / (n - 1);
        }
        return std::sqrt(total / static_cast<double>(sum.size()));
    }
};

/// Frames of all scenes in turns, so that what else the machine does falls on all of them.
void measure(std::vector<Lit>& scenes, const render::Settings& settings, int seeds)
{
    for (Lit& lit : scenes) {
        lit.take(settings, 1); // warms up
        lit.forget();
    }
    for (int seed = 1; seed <= seeds; ++seed) {
        for (Lit& lit : scenes) {
            lit.take(settings, static_cast<std::uint32_t>(seed));
        }
    }
}

int measureAll(const Arguments& a)
{
    const device::Device device = device::Device::open(a.device);
    std::vector<LampScene> sources = lampScenes();
    std::vector<Lit> scenes;
    scenes.reserve(sources.size());
    for (LampScene& source : sources) {
        scenes.push_back({ source.name, std::make_unique<render::Renderer>(source.scene, device), {}, {}, {} });
    }
    Json all = resultSkeleton("emissive", device.info());
    fmt::print("{:<10} {:<8} {:>10} {:>10} {:>10} {:>10}\n", "scene", "method", "ms", "of one", "noise", "of quad");
    for (const bool filtered : { false, true }) {
        render::Settings settings = filtered ? render::axisAligned(a.spp) : render::monteCarlo(a.spp);
        settings.width = a.width;
        settings.height = a.height;
        settings.bounces = 0;
        measure(scenes, settings, a.seeds);
        const double quadNoise = scenes[0].noise(), oneTime = summarize(scenes[1].milliseconds).median;
        for (const Lit& lit : scenes) {
            const Summary time = summarize(lit.milliseconds);
            const double noise = lit.noise();
            fmt::print("{:<10} {:<8} {:>10.1f} {:>10.2f} {:>10.6f} {:>10.2f}\n", lit.name, filtered ? "aaf" : "mc",
                time.median, time.median / oneTime, noise, noise / quadNoise);
            std::fflush(stdout);
            ClaimList claims("emissive", lit.name);
            const std::string kind = filtered ? "filtered_" : "";
            if (lit.name == "lamp") {
                claims.add(kind + "noise_vs_quad", noise / quadNoise, "1", {}, 1.3);
            } else if (lit.name != "quad") {
                const double goal = lit.name == "thousand" ? 3 : 64;
                claims.add(kind + "time_vs_one", time.median / oneTime, "1", {}, goal);
            }
            addClaims(all, claims.claims);
        }
    }
    if (!a.json.empty()) {
        writeJson(a.json, all);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures meshes that emit, and many lights.", "emissive");
    Arguments a;
    parser.add_option("--width", a.width, "pixels (320)")->check(CLI::Range(1, 4096));
    parser.add_option("--height", a.height, "pixels (240)")->check(CLI::Range(1, 4096));
    parser.add_option("--spp", a.spp, "samples a pixel and light (28)")->check(CLI::Range(9, 4096));
    parser.add_option("--seeds", a.seeds, "frames of each scene and method (8)")->check(CLI::Range(2, 1000));
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
