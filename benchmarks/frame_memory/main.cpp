// frame_memory: device memory that frames take besides the scene, as planned, and whether that is what is allocated;
// docs/benchmarks.md.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/frame_memory/allocations.h"
#include "benchmarks/frame_memory/frame_bytes.h"
#include "data/generator/cornell.h"
#include "host/device/device.h"
#include "host/render/progressive.h"
#include "host/render/renderer.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    int side = 1024;
    bool planOnly = false;
    std::string device, json, scene = "cornell_glossy";
};

struct Kind {
    const char* name;
    render::Settings settings;
    bool layers = false;
    std::optional<double> goal = {}; ///< MiB at 1024x1024; of direct light bytes a pixel
};

/// One bounce and the default method: through a pinhole, through a lens (or antialiased, which is the same), in steps,
/// with all layers; and direct light alone in 3840x2160.
std::vector<Kind> kindsOf(int side)
{
    render::Settings usual = render::axisAligned(28);
    usual.width = usual.height = side;
    usual.bounces = 1;
    render::Settings lens = usual, progressive = usual, direct = usual;
    lens.antialias = true;
    progressive.progressive = true;
    progressive.spp = 1024;
    direct.width = 3840;
    direct.height = 2160;
    direct.bounces = 0;
    return { { "pinhole", usual, false, 165 }, { "lens", lens, false, 150 }, { "progressive", progressive, false, 330 },
        { "layers", lens, true, 400 }, { "progressive_layers", progressive, true },
        { "direct_4k", direct, false, 150 } };
}

/// Bytes of scene and frame as planned, over the most that were allocated while one was rendered. Its sampling is ended
/// at once, since all memory is there before the first launch.
double plannedVsAllocated(const scene::Scene& scene, const device::Device& device, const Kind& kind)
{
    const std::uint64_t before = Allocations::current();
    Allocations::restart();
    render::Renderer renderer(scene, device);
    const auto planned = static_cast<double>(renderer.plan(kind.settings, kind.layers).total());
    const std::atomic<bool> cancel { true };
    render::Control control;
    control.cancel = &cancel;
    if (kind.settings.progressive) {
        renderer.renderProgressively(
            kind.settings, control, [](const render::ProgressiveStep&) {}, kind.layers);
    } else {
        renderer.render(kind.settings, control, kind.layers);
    }
    return planned / static_cast<double>(Allocations::largest() - before);
}

/// What frames take more with one light more, the first one's like.
std::vector<Claim> furtherLights(const scene::Scene& scene, const device::DeviceInfo& device, int side)
{
    if (scene.areaLights.size() != 1) {
        return {}; // of more the last ones share a term
    }
    scene::Scene more = scene;
    more.areaLights.push_back(more.areaLights.front());
    std::vector<Claim> out;
    for (const Kind& kind : kindsOf(side)) {
        if (kind.settings.width != side) {
            continue;
        }
        const auto bytes = [&](const scene::Scene& s) {
            return static_cast<double>(frameBytes(s, device, kind.settings, kind.layers));
        };
        ClaimList claims("frame_memory", kind.name);
        const double mebibytes = (bytes(more) - bytes(scene)) / (1 << 20);
        const bool hasGoal = side == 1024 && !kind.layers;
        claims.add("further_light_mebibytes", mebibytes, "MiB", {}, hasGoal ? std::optional(24.0) : std::nullopt);
        fmt::print("{:<18} {:>5}x{:<5} {:>10.1f} a further light\n", kind.name, side, side, mebibytes);
        out.push_back(claims.claims.front());
    }
    return out;
}

int measureAll(const Arguments& a)
{
    const device::Device device = device::Device::open(a.device);
    const std::vector<SceneSource> known { generatedScene("cornell_glossy", generator::makeCornellGlossy) };
    const scene::Scene scene = scene::loadScene(findScene(known, a.scene).file());
    Json all = resultSkeleton("frame_memory", device.info());
    fmt::print("{:<18} {:>11} {:>10} {:>14} {:>18}\n", "frame", "pixels", "MiB", "bytes a pixel", "planned/allocated");
    for (const Kind& kind : kindsOf(a.side)) {
        const auto bytes = static_cast<double>(frameBytes(scene, device.info(), kind.settings, kind.layers));
        const double pixels = static_cast<double>(kind.settings.width) * kind.settings.height;
        const double mebibytes = bytes / (1 << 20);
        ClaimList claims("frame_memory", kind.name);
        const bool perPixel = kind.settings.bounces == 0;
        const std::optional<double> goal = perPixel || a.side == 1024 ? kind.goal : std::nullopt;
        claims.add("mebibytes", mebibytes, "MiB", {}, perPixel ? std::nullopt : goal);
        claims.add("bytes_per_pixel", bytes / pixels, "B", {}, perPixel ? goal : std::nullopt);
        std::string ratio = "-";
        if (!a.planOnly) {
            claims.add("planned_vs_allocated", plannedVsAllocated(scene, device, kind), "1", {}, 1);
            ratio = fmt::format("{:.6f}", claims.claims.back().value);
        }
        fmt::print("{:<18} {:>5}x{:<5} {:>10.1f} {:>14.1f} {:>18}\n", kind.name, kind.settings.width,
            kind.settings.height, mebibytes, bytes / pixels, ratio);
        std::fflush(stdout);
        addClaims(all, claims.claims);
    }
    addClaims(all, furtherLights(scene, device.info(), a.side));
    if (!a.json.empty()) {
        writeJson(a.json, all);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures the device memory of frames.", "frame_memory");
    Arguments a;
    parser.add_option("--scene", a.scene, "cornell_glossy, or a scene file with one area light");
    parser.add_option("--size", a.side, "pixels a side (1024)")->check(CLI::Range(1, 32768));
    parser.add_flag("--plan-only", a.planOnly, "renders nothing, compares with nothing allocated");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
