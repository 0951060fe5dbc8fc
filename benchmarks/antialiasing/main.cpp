// antialiasing: pixels that sample their squares against images of four times the size, which the thesis renders;
// docs/benchmarks.md.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/lab.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/references.h"
#include "benchmarks/common/scene_source.h"
#include "data/generator/cornell.h"
#include "data/generator/shapes.h"
#include "data/generator/textured.h"
#include "host/image/metrics.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

constexpr int equalSpp = 28; ///< of the frame of pixel centres whose error is to be reached
constexpr int rayPricedSpp = 64; ///< of both frames of plain Monte Carlo
constexpr std::uint32_t referenceSeed = 0x2e5eed;

struct Arguments {
    std::vector<std::string> scenes;
    int side = 256, referenceSpp = 512;
    std::vector<int> spp { 16, 32, 64 }, largeSpp { 16, 28 };
    bool costs = false;
    std::string device, json, references = defaultReferenceFolder();
};

/// One image: rays a pixel of the small image, RMS error of what is shown of it (radiance up to 1) against the
/// antialiased reference, whose own noise is in it.
struct Point {
    int spp;
    double rays, error, milliseconds;
};

struct Curve {
    const char* name;
    const char* meaning;
    std::vector<Point> points;
};

/// What antialiasing costs, as factors of device time.
struct Cost {
    double ofPlain; ///< plain Monte Carlo of as many samples, over pixel centres
    double atEqualError; ///< the default setting at the error of pixel centres, each against its own reference
    bool beyond; ///< that error was not reached: the factor is of the largest count, a lower bound
};

/// The mean of each square of 2x2 pixels.
image::RgbImage halved(const image::RgbImage& large)
{
    image::RgbImage small { large.width / 2, large.height / 2, {} };
    for (int y = 0; y < small.height; ++y) {
        for (int x = 0; x < small.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const auto at = [&](int dx, int dy) {
                    return large.rgb[(static_cast<std::size_t>(2 * y + dy) * static_cast<std::size_t>(large.width)
                                         + static_cast<std::size_t>(2 * x + dx))
                            * 3
                        + static_cast<std::size_t>(c)];
                };
                small.rgb.push_back(0.25f * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)));
            }
        }
    }
    return small;
}

/// Edges of lights, which are many times as bright as what is shown, would else be all of the error.
image::RgbImage shown(image::RgbImage image)
{
    for (float& value : image.rgb) {
        value = std::min(value, 1.0f);
    }
    return image;
}

/// Mean squared error of a reference where it is shown as it is.
double shownNoise(const Reference& reference)
{
    double sum = 0;
    for (std::size_t i = 0; i < reference.image.rgb.size(); ++i) {
        const double off = reference.image.rgb[i] < 1.0f ? reference.deviation.rgb[i] : 0.0f;
        sum += off * off;
    }
    return sum / static_cast<double>(reference.image.rgb.size());
}

class Comparison {
public:
    Comparison(const SceneSource& source, const device::Device& device, const Arguments& a)
        : arguments_(a)
        , scene_(scene::loadScene(source.file()))
        , renderer_(scene_, device)
        , name_(source.name)
        , reference_(obtainReference(renderer_, sized(render::monteCarlo(a.referenceSpp), a.side, referenceSeed, true),
              a.references, name_ + "_antialiased"))
    {
    }

    std::vector<Curve> curves()
    {
        Curve sampled { "antialiased", "--antialias", {} };
        Curve large { "four_times", "four times the size, pixel centres, the mean of 2x2 pixels", {} };
        Curve plain { "unfiltered", "--antialias, unfiltered, Owen-scrambled Sobol", {} };
        for (const int spp : arguments_.spp) {
            sampled.points.push_back(measure(render::axisAligned(spp), true, spp));
            plain.points.push_back(measure(render::monteCarlo(spp), true, spp));
        }
        for (const int spp : arguments_.largeSpp) {
            large.points.push_back(measure(render::axisAligned(spp), false, spp));
        }
        return { sampled, large, plain };
    }

    double noise() const { return reference_.noise; }

    /// Of scenes whose pixels need not have several rays.
    std::optional<Cost> cost()
    {
        const render::Settings centre = sized(render::axisAligned(equalSpp), arguments_.side, 1, false);
        if (render::isDistributed(centre, scene_)) {
            return std::nullopt;
        }
        const Reference ofCentres = obtainReference(renderer_,
            sized(render::monteCarlo(arguments_.referenceSpp), arguments_.side, referenceSeed, false),
            arguments_.references, name_ + "_centres");
        const Timed wanted = timed(centre, ofCentres);
        const auto plain = [&](bool antialias) {
            return timed(sized(render::monteCarlo(rayPricedSpp), arguments_.side, 1, antialias),
                antialias ? reference_ : ofCentres)
                .milliseconds;
        };
        Cost cost { plain(true) / plain(false), 0, true };
        Timed before {};
        for (const int spp : { 8, 16, 28, 64, 128, 256 }) {
            const Timed now = timed(sized(render::axisAligned(spp), arguments_.side, 1, true), reference_);
            if (now.error <= wanted.error) {
                // Straight in logarithms between two counts.
                const double part =
                    before.error > 0 ? std::log(before.error / wanted.error) / std::log(before.error / now.error) : 1.0;
                const double from = before.error > 0 ? before.milliseconds : now.milliseconds;
                cost.atEqualError = from * std::pow(now.milliseconds / from, part) / wanted.milliseconds;
                cost.beyond = false;
                break;
            }
            before = now;
            cost.atEqualError = now.milliseconds / wanted.milliseconds;
        }
        return cost;
    }

private:
    render::Settings sized(render::Settings s, int side, std::uint32_t seed, bool antialias) const
    {
        s.width = s.height = side;
        s.seed = seed;
        s.antialias = antialias;
        s.bounces = scene_.settings.bounces.value_or(0);
        return s;
    }

    struct Timed {
        double error = 0; ///< RMS, the reference's noise taken out
        double milliseconds = 0; ///< the median of three
    };

    Timed timed(const render::Settings& settings, const Reference& reference)
    {
        renderer_.rehearse(settings);
        std::array<double, 3> milliseconds {};
        render::FrameStatistics frame;
        for (double& one : milliseconds) {
            frame = renderer_.render(settings);
            one = frame.deviceMilliseconds;
        }
        std::ranges::sort(milliseconds);
        const double rmse = image::rmse(shown(imageOf(renderer_, settings, frame)), shown(reference.image));
        progress("antialiasing",
            fmt::format("{}: {}, {} spp: rmse {:.5f}, {:.0f} ms", name_, settings.antialias ? "squares" : "centres",
                settings.spp, rmse, milliseconds[1]));
        return { std::sqrt(std::max(rmse * rmse - shownNoise(reference), 0.01 * rmse * rmse)), milliseconds[1] };
    }

    Point measure(const render::Settings& wanted, bool antialias, int spp)
    {
        const render::Settings settings =
            sized(wanted, antialias ? arguments_.side : 2 * arguments_.side, 1, antialias);
        renderer_.rehearse(settings);
        const render::FrameStatistics frame = renderer_.render(settings);
        const image::RgbImage found = imageOf(renderer_, settings, frame);
        const double rmse = image::rmse(shown(antialias ? found : halved(found)), shown(reference_.image));
        const double pixels = static_cast<double>(arguments_.side) * arguments_.side;
        const double rays = static_cast<double>(frame.primaryRays + frame.shadowRays + frame.indirectRays) / pixels;
        const Point out { spp, rays, rmse, frame.deviceMilliseconds };
        progress("antialiasing",
            fmt::format("{}: {} pixels a side, {} spp: rmse {:.5f}", name_, settings.width, spp, out.error));
        return out;
    }

    const Arguments& arguments_;
    scene::Scene scene_;
    render::Renderer renderer_;
    std::string name_;
    Reference reference_;
};

Json dataOf(const Curve& curve)
{
    Json out { { "name", curve.name }, { "meaning", curve.meaning } };
    for (const Point& p : curve.points) {
        out["points"].push_back(
            { { "spp", p.spp }, { "rays_per_pixel", p.rays }, { "rmse", p.error }, { "device_ms", p.milliseconds } });
    }
    return out;
}

std::vector<SceneSource> knownScenes()
{
    return { generatedScene("cornell_figure", generator::makeCornellFigure),
        generatedScene("tentacles", generator::makeTentacles), generatedScene("chess", generator::makeChess),
        generatedScene("room", generator::makeRoom), generatedScene("grids", generator::makeGrids),
        generatedScene("bench", generator::makeBench), generatedScene("cornell_glossy", generator::makeCornellGlossy),
        externalScene("conference", "the conference room, from WEDGE_DATA", "conference/conference.obj") };
}

void store(const Arguments& a, const Json& all)
{
    if (!a.json.empty()) {
        writeJson(a.json, all);
    }
}

int measureAll(const Arguments& a)
{
    const device::Device device = device::Device::open(a.device);
    Json all = resultSkeleton("antialiasing", device.info());
    all["device"] = device.info().name;
    all["schema"] = 1;
    all["side"] = a.side;
    all["reference_spp"] = a.referenceSpp;
    std::vector<std::string> skipped;
    for (const SceneSource& source : chooseScenes(knownScenes(), a.scenes, skipped)) {
        Comparison comparison(source, device, a);
        ClaimList claims("antialiasing", source.name);
        bool beyond = false;
        if (const std::optional<Cost> cost = comparison.cost()) {
            beyond = cost->beyond;
            claims.add("time_vs_pinhole", cost->ofPlain, "1", {}, 1.5);
            claims.add("time_at_equal_error", cost->atEqualError, "1", {}, 1.15);
            fmt::print("{:<16} plain sampling {:.2f} times the time of pixel centres, at equal error {}{:.2f}\n",
                source.name, cost->ofPlain, cost->beyond ? "more than " : "", cost->atEqualError);
        }
        addClaims(all, claims.claims);
        if (a.costs) {
            all["scenes"].push_back({ { "name", source.name }, { "beyond", beyond } });
            store(a, all);
            continue;
        }
        const std::vector<Curve> curves = comparison.curves();
        Json data { { "name", source.name }, { "reference_noise", comparison.noise() } };
        for (const Curve& curve : curves) {
            data["curves"].push_back(dataOf(curve));
            for (const Point& p : curve.points) {
                fmt::print("{:<16} {:<12} {:4} spp {:7.1f} rays a pixel  rmse {:.5f} {:8.0f} ms\n", source.name,
                    curve.name, p.spp, p.rays, p.error, p.milliseconds);
            }
        }
        all["scenes"].push_back(data);
        store(a, all);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures antialiasing against images of four times the size.", "antialiasing");
    Arguments a;
    parser.add_option("--scene", a.scenes, "a scene's name or a scene file; again for more (all there are)");
    parser.add_flag("--costs", a.costs, "only what antialiasing costs against pixel centres, no curves");
    parser.add_option("--size", a.side, "pixels a side (256)")->check(CLI::Range(8, 4096));
    parser.add_option("--spp", a.spp, "samples a pixel of antialiased images (16 32 64)")->check(CLI::Range(1, 2048));
    parser.add_option("--large-spp", a.largeSpp, "samples a pixel of images of four times the size (16 28)")
        ->check(CLI::Range(1, 2048));
    parser.add_option("--reference-spp", a.referenceSpp, "samples of the references (512)")
        ->check(CLI::Range(16, 1 << 20));
    parser.add_option("--reference-dir", a.references, "where references are kept (beside this program)");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
