// temporal: the variance of each pixel, with and without the filter over time; docs/benchmarks.md.
#include "benchmarks/common/arguments.h"
#include "benchmarks/common/claims.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/common/statistics.h"
#include "filters/temporal/temporal.h"
#include "host/device/device.h"
#include "host/render/renderer.h"
#include "host/scene/sequence.h"
#include "kernels/shared/bsdf.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Arguments {
    std::string size = "320x240", device, json;
    std::vector<std::string> scenes;
    int spp = 16, seeds = 8, referenceSpp = 1024;
    bool published = false; ///< chapter 6's filter
};

/// How a sequence's camera goes.
struct Path {
    const char* name;
    float degrees; ///< around what it looks at, from frame to frame
    double goal; ///< of the ratio of variances
};
constexpr Path paths[] = { { "still", 0.0f, 4.0 }, { "moving", 1.0f, 2.0 } };

constexpr std::uint32_t last = filters::temporalWindow - 1; ///< the frame that is measured

/// A camera that has gone around what it looks at.
scene::Camera turned(scene::Camera camera, float degrees)
{
    const float angle = glm::radians(degrees);
    const glm::vec3 axis = glm::normalize(camera.up), from = camera.eye - camera.lookAt;
    const glm::vec3 along = axis * glm::dot(axis, from), across = from - along;
    camera.eye = camera.lookAt + along + std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across);
    return camera;
}

/// A scene file and the camera's way: the scene at any frame.
class Course {
public:
    Course(const std::string& file, float degrees)
        : sequence_(file)
        , scene_(sequence_.takeScene())
        , degrees_(degrees)
    {
        if (sequence_.at(0.0).geometry) {
            tracker_.emplace(scene_.geometry);
            places_ = std::make_shared<const filters::ObjectPlaces>(tracker_->placesIn(scene_.geometry));
        }
    }

    /// At frame 0.
    const scene::Scene& scene() const { return scene_; }
    std::shared_ptr<const filters::ObjectPlaces> places() const { return places_; }

    void moveTo(std::uint32_t frame, render::Renderer& renderer)
    {
        scene::Moment moment = sequence_.at(frame / renderer.scene().framesPerUnit);
        moment.camera = turned(moment.camera, degrees_ * static_cast<float>(frame));
        const scene::Change change = scene::changeTo(moment, renderer.scene());
        renderer.changeScene(change, [&](scene::Scene& scene) { scene::apply(std::move(moment), change, scene); });
        if (tracker_ && change.geometry) {
            places_ = std::make_shared<const filters::ObjectPlaces>(tracker_->placesIn(renderer.scene().geometry));
        }
    }

private:
    scene::Sequence sequence_;
    scene::Scene scene_;
    float degrees_;
    std::optional<filters::ObjectTracker> tracker_;
    std::shared_ptr<const filters::ObjectPlaces> places_;
};

/// Where a frame's planes have pixel i, rows from the top.
std::size_t planeIndex(const render::PlaneLayout& layout, std::size_t i)
{
    return shared::pixelIndex(
        static_cast<std::uint32_t>(i % layout.width), static_cast<std::uint32_t>(i / layout.width), layout.stride);
}

/// The luminance of each pixel.
std::vector<double> luminances(render::Renderer& renderer, std::size_t pixels)
{
    const render::Frame& frame = renderer.frame();
    const std::vector<float> planes = frame.planes("beauty").downloadAll(renderer.queue());
    std::vector<double> out(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t at = planeIndex(frame.layout, i);
        out[i] = shared::luminance(
            shared::vec3(planes[at], planes[frame.layout.size + at], planes[2 * frame.layout.size + at]));
    }
    return out;
}

/// Sums over images of luminances of pixels.
struct Moments {
    explicit Moments(std::size_t pixels)
        : sum(pixels)
        , squares(pixels)
        , errors(pixels)
    {
    }

    /// reference: of each pixel, or none.
    void add(const std::vector<double>& image, const std::vector<double>& reference)
    {
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += image[i];
            squares[i] += image[i] * image[i];
            const double error = reference.empty() ? 0.0 : image[i] - reference[i];
            errors[i] += error * error;
        }
    }
    double variance(std::size_t i, int images) const
    {
        return std::max(0.0, squares[i] - sum[i] * sum[i] / images) / (images - 1);
    }

    std::vector<double> sum, squares, errors;
};

struct Measured {
    double ratio = 0; ///< of variances, of the sums over all pixels
    double medianRatio = 0; ///< of pixels that have noise
    double errorRatio = 0; ///< RMS error over all pixels with the filter by that without; 0: no reference
    double uncoveredErrorRatio = 0; ///< the same, of pixels that showed another object before
    double uncovered = 0; ///< those, of all pixels
    Summary overhead, filterMilliseconds, frameMilliseconds;
    double memoryMebibytes = 0; ///< that the filter adds
};

/// What all pixels of the last frame should show.
std::vector<double> referenceOf(
    Course& course, render::Renderer& renderer, const render::Settings& base, int spp, std::size_t pixels)
{
    render::Settings settings = render::monteCarlo(spp);
    settings.width = base.width;
    settings.height = base.height;
    settings.seed = 1000000; // no frame's
    course.moveTo(last, renderer);
    renderer.render(settings, {}, true);
    return luminances(renderer, pixels);
}

/// The RMS error of pixels with the filter by that without.
double errorRatioOf(const Moments& with, const Moments& without, const std::vector<bool>& counts)
{
    double filtered = 0, noisy = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i]) {
            filtered += with.errors[i];
            noisy += without.errors[i];
        }
    }
    return noisy > 0 ? std::sqrt(filtered / noisy) : 0.0;
}

Measured measure(const Arguments& a, const std::string& file, const Path& path, const device::Device& device,
    const render::Settings& base)
{
    Course course(file, path.degrees);
    render::Renderer renderer(course.scene(), device);
    const auto pixels = static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height);
    Moments with(pixels), without(pixels);
    std::vector<double> overhead, filter, frame;
    Measured out;
    const std::vector<double> reference =
        a.referenceSpp > 0 ? referenceOf(course, renderer, base, a.referenceSpp, pixels) : std::vector<double>();
    render::Settings settings = base;
    settings.temporal = a.published ? render::Temporal::Published : render::Temporal::On;
    const std::uint32_t first = filters::firstOfWindow(last, settings.temporal);
    std::vector<std::vector<std::uint32_t>> objects(filters::temporalWindow);
    auto temporal = std::make_shared<filters::TemporalFilter>(device);
    renderer.filterFrames(temporal);
    renderer.rehearse(settings);
    for (int seed = 0; seed < a.seeds; ++seed) {
        temporal = std::make_shared<filters::TemporalFilter>(device);
        renderer.filterFrames(temporal);
        settings.seed = static_cast<std::uint32_t>(seed);
        for (std::uint32_t number = first; number <= last; ++number) {
            course.moveTo(number, renderer);
            settings.frame = number;
            temporal->next(course.places(), false);
            renderer.render(settings);
            if (seed == 0) {
                objects[number] = renderer.frame().counts("objectId").downloadAll(renderer.queue());
            }
            if (number < last) {
                continue;
            }
            without.add(luminances(renderer, pixels), reference);
            temporal->next(course.places());
            const render::FrameStatistics statistics = renderer.render(settings);
            with.add(luminances(renderer, pixels), reference);
            overhead.push_back(statistics.overheadFraction());
            filter.push_back(statistics.milliseconds("filter over time"));
            frame.push_back(statistics.deviceMilliseconds);
            render::Settings single = settings;
            single.temporal = render::Temporal::Off;
            const std::uint64_t before = renderer.planUnbacked(single).total();
            out.memoryMebibytes = static_cast<double>(statistics.memoryBytes - before) / (1 << 20);
        }
    }
    double sumWith = 0, sumWithout = 0;
    std::vector<double> ratios;
    std::vector<bool> uncovered(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double noisy = without.variance(i, a.seeds), filtered = with.variance(i, a.seeds);
        sumWith += filtered;
        sumWithout += noisy;
        const double mean = without.sum[i] / a.seeds;
        if (noisy > 1e-8 * mean * mean && filtered > 0) {
            ratios.push_back(noisy / filtered);
        }
        const std::size_t at = planeIndex(renderer.frame().layout, i);
        uncovered[i] = std::any_of(
            objects.begin() + first, objects.end(), [&](const auto& ids) { return ids[at] != objects[last][at]; });
    }
    out.ratio = sumWithout / sumWith;
    out.medianRatio = summarize(ratios).median;
    out.errorRatio = errorRatioOf(with, without, std::vector<bool>(pixels, true));
    out.uncoveredErrorRatio = errorRatioOf(with, without, uncovered);
    out.uncovered = static_cast<double>(std::ranges::count(uncovered, true)) / static_cast<double>(pixels);
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
            "models/dragon/dragon_aaf.obj", "hdr/uffizi.hdr"),
        shippedScene("sky_rolling", "a ball that rolls past another one under data/scenes' sky"),
        shippedScene("sky_lamp", "a lamp that moves over spheres under data/scenes' sky") };
    std::vector<std::string> skipped;
    fmt::print("{:<16} {:<7} {:>8} {:>8} {:>8} {:>10} {:>9} {:>9} {:>9}\n", "scene", "camera", "ratio", "median",
        "error", "uncovered", "overhead", "filter ms", "frame ms");
    for (const SceneSource& source : chooseScenes(known, a.scenes, skipped)) {
        const std::string file = source.file();
        render::Settings settings = render::axisAligned(a.spp);
        settings.width = plan.width;
        settings.height = plan.height;
        for (const Path& path : paths) {
            const Measured m = measure(a, file, path, device, settings);
            ClaimList claims("environment",
                fmt::format("temporal.{}_{}{}", source.name, path.name, a.published ? "_published" : ""));
            const auto ofDefault = [&](double goal) { return a.published ? std::nullopt : std::optional(goal); };
            claims.add("variance_ratio", m.ratio, "1", {}, ofDefault(path.goal));
            claims.add("median_variance_ratio", m.medianRatio, "1");
            if (a.referenceSpp > 0) {
                claims.add("error_ratio", m.errorRatio, "1", {}, ofDefault(1.0));
                claims.add("uncovered_pixels", m.uncovered, "1");
                if (m.uncovered > 0) {
                    claims.add("uncovered_error_ratio", m.uncoveredErrorRatio, "1", {}, ofDefault(1.0));
                }
            }
            claims.add("overhead", m.overhead, "1", {}, ofDefault(0.12));
            claims.add("filter_ms", m.filterMilliseconds, "ms");
            claims.add("memory", m.memoryMebibytes, "MiB");
            addClaims(all, claims.claims);
            fmt::print("{:<16} {:<7} {:>8.2f} {:>8.2f} {:>8.3f} {:>10} {:>9.3f} {:>9.1f} {:>9.0f}\n", source.name,
                path.name, m.ratio, m.medianRatio, m.errorRatio,
                m.uncovered > 0 ? fmt::format("{:.3f}", m.uncoveredErrorRatio) : "-", m.overhead.median,
                m.filterMilliseconds.median, m.frameMilliseconds.median);
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
    parser.add_option(
        "--scene", a.scenes, "sky, uffizi_diffuse, sky_rolling, sky_lamp, or a scene file (all that are there)");
    parser.add_option("--spp", a.spp, "samples a pixel and term (16)")->check(CLI::Range(9, 4096));
    parser.add_option("--seeds", a.seeds, "sequences whose frames are compared (8)")->check(CLI::Range(2, 1000));
    parser
        .add_option(
            "--reference-spp", a.referenceSpp, "samples of what errors are held against; 0 measures no errors (1024)")
        ->check(CLI::Range(0, 1 << 20));
    parser.add_flag("--published", a.published, "measures --temporal published");
    parser.add_option("--size", a.size, "WIDTHxHEIGHT (320x240)");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
