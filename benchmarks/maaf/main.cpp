// maaf: several filters of a light's shadows against one, at equal error; docs/benchmarks.md.
#include "benchmarks/common/arguments.h"
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/savings.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/timing.h"
#include "data/generator/scene_writer.h"
#include "host/device/device.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    std::string size = "320x240", timedSize = "640x480", device, json, references = defaultReferenceFolder();
    std::vector<std::string> scenes;
    std::vector<int> spp = { 9, 16, 28 };
    int seeds = 3, frames = 5, referenceSpp = 4096;
};

/// Whole images of direct light, and what bounces as often as the scene says.
class Shadows : public Subject {
public:
    explicit Shadows(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }
    std::string program() const override { return "maaf"; }
    Integrand integrandOf(const render::Settings& settings) const override
    {
        render::Settings reference = render::monteCarlo(referenceSpp_);
        reference.shading = render::Shading::Ratio; // unshadowed light is known exactly
        reference.bounces = settings.bounces;
        return { "whole image", reference };
    }
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override
    {
        return static_cast<double>(frame.shadowRays + frame.indirectRays);
    }
    float muOf(const render::Settings& settings) const override { return settings.mu; }
    std::string describe(const render::Settings& s) const override
    {
        return render::methodName(s) + fmt::format(" {} spp, mu {:.2f}", s.spp, s.mu);
    }

private:
    int referenceSpp_;
};

/// One filter, in three forms.
struct SingleFilter {
    const char* name; ///< of claims: speedup_vs_<name>
    const char* meaning;
    render::Settings (*settings)(int spp);
};

render::Settings withoutLines(int spp)
{
    render::Settings s = render::axisAligned(spp);
    s.sheared = s.fitted = false;
    s.mu *= 2.0f / 1.5f; // what suited means
    return s;
}

render::Settings ofThesis(int spp)
{
    render::Settings s = render::asPublished();
    s.shading = render::Shading::Ratio; // what is compared is the filter
    s.sampling = render::Sampling::Uniform;
    s.spp = spp;
    return s;
}

constexpr SingleFilter rivals[] = { { "aaf", "method aaf", [](int spp) { return render::axisAligned(spp); } },
    { "means", "method aaf without gradients and lines, as it was before it had them", withoutLines },
    { "thesis", "the thesis's widths, with as many samples everywhere", ofThesis } };

/// What is measured of a scene at one count.
struct Row {
    double spp = 0, error = 0;
    Timing timing;
    std::vector<double> samples, speedup; ///< over each rival at equal error
};

std::vector<SceneSource> scenes()
{
    const auto authors = [](const char* name, const char* mesh) {
        return externalScene(name, "the authors' mesh, from WEDGE_DATA", mesh);
    };
    return { generatedScene("grids", generator::makeGrids), generatedScene("bench", generator::makeBench),
        generatedScene("tentacles", generator::makeTentacles), generatedScene("spheres", generator::makeSpheres),
        authors("aaf2012_grids_cut2", "aaf2012_grids/grids.obj"),
        authors("aaf2012_spheres_cut2", "aaf2012_spheres/spheres.obj"),
        shippedScene("penumbra", "boxes and a ball under a lamp") };
}

std::vector<TimingColumn> columns() { return withFrameColumns({ tracing(), widthsAndCounts() }); }

/// Pixels that the first light's filter gathers for, in the frame that was rendered last, of those that see something.
double filteredShare(render::Renderer& renderer)
{
    const render::Frame& frame = renderer.frame();
    const std::vector<float> beta = frame.planes("filterWidth").downloadAll(renderer.queue());
    const std::vector<std::uint32_t> objects = frame.counts("objectId").downloadAll(renderer.queue());
    double filtered = 0, seen = 0;
    for (std::uint32_t y = 0; y < frame.layout.height; ++y) {
        for (std::uint32_t x = 0; x < frame.layout.width; ++x) {
            const std::size_t i = shared::pixelIndex(x, y, frame.layout.stride);
            seen += objects[i] != 0 ? 1 : 0;
            filtered += objects[i] != 0 && beta[i] > 0 ? 1 : 0;
        }
    }
    return seen > 0 ? filtered / seen : 0.0;
}

render::Settings maafSettings(render::Maaf maaf, int spp) { return render::multipleAxisAligned(maaf, spp); }

Row measureRow(Lab& lab, int spp)
{
    const render::Settings settings = maafSettings(render::Maaf::TwoSlope, spp);
    const Method method = measureMethod(lab, "default", settings);
    Row out;
    out.spp = method.runs.front().spp;
    out.error = summarize(method.errors()).median;
    out.timing = timeFrames(lab, settings, columns(), fmt::format("maaf {} spp", spp));
    for (const SingleFilter& rival : rivals) {
        const Comparison compared = compareWith(lab, method, rival.name, rival.meaning, rival.settings);
        const double saved = summarize(compared.saved.samples).median, equal = saved * out.spp;
        // Filters that do not narrow may never get there.
        const bool gets = equal < 4.0 * lab.plan().largestBaseline;
        double speedup = std::numeric_limits<double>::infinity();
        out.samples.push_back(gets ? saved : speedup);
        if (gets) {
            const int count = std::max(render::leastSpp(settings, false), static_cast<int>(std::lround(equal)));
            const Timing time =
                timeFrames(lab, rival.settings(count), columns(), fmt::format("{} {} spp", rival.name, count));
            speedup = time["total"].median / out.timing["total"].median;
        }
        out.speedup.push_back(speedup);
    }
    return out;
}

int measureAll(const Arguments& a)
{
    MeasurePlan plan { .frames = a.frames,
        .seeds = a.seeds,
        .referenceSpp = a.referenceSpp,
        .largestBaseline = 1024,
        .subtractNoise = true,
        .baselineSpp = { 9, 16, 64 },
        .powersOfFour = true };
    setSize(plan, a.timedSize);
    plan.timedWidth = plan.width;
    plan.timedHeight = plan.height;
    setSize(plan, a.size);
    plan.referenceFolder = a.references;
    const device::Device device = device::Device::open(a.device);
    const Shadows subject(a.referenceSpp);
    Json all = resultSkeleton("maaf", device.info());
    all["size"] = { plan.width, plan.height };
    all["timed_size"] = { plan.timedWidth, plan.timedHeight };
    all["seeds"] = a.seeds;
    std::vector<std::string> skipped;
    fmt::print("{:<22} {:>4} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "scene", "spp", "rmse",
        "trace ms", "prefilt.", "filter", "overhead", "total", "x aaf", "x means", "x thesis");
    for (const SceneSource& source : chooseScenes(scenes(), a.scenes, skipped)) {
        const scene::Scene scene = scene::loadScene(source.file());
        Lab lab(scene, device, subject, plan, source.name);
        ClaimList claims("maaf", source.name);
        for (const int spp : a.spp) {
            const Row row = measureRow(lab, spp);
            const std::string suffix = spp == a.spp.front() ? "" : fmt::format("_{}", spp);
            const bool grids = source.name.find("grids") != std::string::npos;
            for (std::size_t i = 0; i < std::size(rivals); ++i) {
                const std::optional<double> goal =
                    i == 0 && suffix.empty() ? std::optional(grids ? 1.5 : 1.0) : std::nullopt;
                claims.add(fmt::format("speedup_vs_{}{}", rivals[i].name, suffix), row.speedup[i], "1", {}, goal);
                claims.add(fmt::format("samples_vs_{}{}", rivals[i].name, suffix), row.samples[i], "1");
            }
            claims.add("rmse" + suffix, row.error, "radiance");
            claims.add("overhead" + suffix, row.timing["overhead_fraction"], "1", {}, 0.1);
            fmt::print(
                "{:<22} {:>4.0f} {:>9.6f} {:>8.1f} {:>8.1f} {:>8.1f} {:>7.1f}% {:>8.1f} {:>8.2f} {:>8.2f} {:>8.2f}\n",
                source.name, row.spp, row.error, row.timing["tracing"].median, row.timing["widths_and_counts"].median,
                row.timing["filter"].median, 100 * row.timing["overhead_fraction"].median, row.timing["total"].median,
                row.speedup[0], row.speedup[1], row.speedup[2]);
            std::fflush(stdout);
        }
        // How much of a frame the filter of both slopes has, and what such a frame takes.
        render::Settings settings = maafSettings(render::Maaf::TwoSlope, a.spp.front());
        settings.width = plan.width;
        settings.height = plan.height;
        const double bytes = static_cast<double>(lab.renderer().render(settings, {}, true).memoryBytes);
        claims.add("filtered_share", filteredShare(lab.renderer()), "1");
        settings.maaf.reset();
        claims.add("memory_vs_aaf", bytes / static_cast<double>(lab.renderer().render(settings, {}, true).memoryBytes),
            "1", {}, 2.0);
        // Where components stand.
        const double aaf = summarize(measureMethod(lab, "aaf", render::axisAligned(a.spp.front())).errors()).median;
        for (const auto& [name, maaf] :
            { std::pair("refitted", render::Maaf::Refitted), { "printed", render::Maaf::Printed } }) {
            const double error = summarize(measureMethod(lab, name, maafSettings(maaf, a.spp.front())).errors()).median;
            claims.add(fmt::format("rmse_vs_aaf_{}", name), error / aaf, "1");
            fmt::print("{:<22} {:>4} {:>9.6f} {} components, error over aaf's {:.2f}\n", source.name, a.spp.front(),
                error, name, error / aaf);
        }
        addClaims(all, claims.claims);
        if (!a.json.empty()) {
            writeJson(a.json, all);
        }
    }
    for (const std::string& name : skipped) {
        progress("maaf", name + ": skipped: set WEDGE_DATA to the folder that has its files");
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures several filters of a light's shadows against one, at equal error.", "maaf");
    Arguments a;
    parser.add_option("--scene", a.scenes, "a scene's name or a scene file; again for more (all there are)");
    parser.add_option("--spp", a.spp, "samples a pixel and light, one or more (9 16 28)")->check(CLI::Range(9, 4096));
    parser.add_option("--seeds", a.seeds, "images of each (3)")->check(CLI::Range(1, 1000));
    parser.add_option("--frames", a.frames, "timed frames of each (5)")->check(CLI::Range(1, 1000));
    parser.add_option("--reference-spp", a.referenceSpp, "samples of references (4096)")
        ->check(CLI::Range(16, 1 << 20));
    parser.add_option("--reference-dir", a.references, "where references are kept (beside this program)");
    parser.add_option("--size", a.size, "WIDTHxHEIGHT of images whose errors are measured (320x240)");
    parser.add_option("--timed-size", a.timedSize, "WIDTHxHEIGHT of those that are timed (640x480)");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
