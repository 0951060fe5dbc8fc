// Progressive renders: samples stay and count, the error that they tell is the true one, and stopping leaves whole
// images.
#include "host/render/progressive.h"
#include "tests/lens_support.h"
#include "tests/render_support.h"

#include <array>
#include <atomic>
#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 64, height = 48;
const image::Window whole { 0, 0, width, height };

/// The small scene through a lens that is in focus behind the middle.
scene::Scene lensScene()
{
    scene::Scene scene = smallScene();
    scene.camera.apertureRadius = 0.06f;
    scene.camera.focusDistance = 3.6f;
    return scene;
}

render::Settings filtered(int spp)
{
    render::Settings s = sized(render::axisAligned(spp), width, height);
    s.seed = 5;
    return s;
}

render::Settings plain(int spp)
{
    render::Settings s = sized(render::monteCarlo(spp), width, height);
    s.seed = 5;
    return s;
}

struct Step {
    render::ProgressiveStep step;
    std::vector<float> image;
};

/// All steps of a render with their images.
std::vector<Step> steps(render::Renderer& renderer, const render::Settings& settings,
    const render::Control& control = {}, bool keepLayers = false)
{
    std::vector<Step> out;
    renderer.renderProgressively(
        settings, control,
        [&](const render::ProgressiveStep& step) {
            out.push_back({ step, pixels(renderer, "beauty", render::outputWindow(settings)) });
        },
        keepLayers);
    return out;
}

std::uint64_t raysOf(const render::FrameStatistics& s) { return s.primaryRays + s.shadowRays + s.indirectRays; }

/// Two images by plain Monte Carlo that know nothing of each other.
using References = std::array<std::vector<float>, 2>;
References references(render::Renderer& renderer, render::Settings settings)
{
    References out;
    for (std::vector<float>& image : out) {
        settings.seed += 90;
        image = renderPixels(renderer, settings);
    }
    return out;
}

/// Root of the mean squared error of an image: the noise of references has no part in the product of what it is away
/// from them.
double trueError(const std::vector<float>& image, const References& truth)
{
    double sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i)
        sum += (static_cast<double>(image[i]) - truth[0][i]) * (static_cast<double>(image[i]) - truth[1][i]);
    return std::sqrt(std::max(0.0, sum / static_cast<double>(image.size())));
}

/// The estimated over the true error of each step, and the true errors.
struct Honesty {
    std::vector<double> ratios, errors;
};
Honesty honesty(render::Renderer& renderer, const render::Settings& settings, const References& truth)
{
    Honesty out;
    for (const Step& s : steps(renderer, settings)) {
        REQUIRE(notFinite(s.image) == 0);
        out.errors.push_back(trueError(s.image, truth));
        out.ratios.push_back(s.step.error.rmse() / out.errors.back());
    }
    return out;
}

void checkHonesty(const device::Device& device, const scene::Scene& scene, const std::string& name)
{
    render::Renderer renderer(scene, device, renderOptions());
    const References truth = references(renderer, plain(512));
    for (const render::Settings& settings : { filtered(128), plain(128) }) {
        const Honesty h = honesty(renderer, settings, truth);
        REQUIRE(h.ratios.size() == 4);
        for (std::size_t i = 0; i < h.ratios.size(); ++i) {
            const std::string method = render::methodName(settings.method);
            CAPTURE(name);
            CAPTURE(method);
            CAPTURE(i);
            CAPTURE(h.errors[i]);
            MESSAGE(name << " " << method << " step " << i << ": error " << h.errors[i] << ", estimated over true "
                         << h.ratios[i]);
            CHECK(h.ratios[i] > 0.8);
            CHECK(h.ratios[i] < 1.25);
        }
        CHECK(h.errors.back() < 0.6 * h.errors.front());
    }
}

} // namespace

TEST_CASE("steps double their samples, up to the number asked for")
{
    CHECK(render::stepCounts(1) == std::vector<int> { 2 });
    CHECK(render::stepCounts(16) == std::vector<int> { 16 });
    CHECK(render::stepCounts(17) == std::vector<int> { 16 });
    CHECK(render::stepCounts(28) == std::vector<int> { 16, 28 });
    CHECK(render::stepCounts(128) == std::vector<int> { 16, 32, 64, 128 });
    CHECK(render::stepCounts(131) == std::vector<int> { 16, 32, 64, 128, 130 });
}

TEST_CASE("without layers a progressive render keeps less, and has the same image, error and counts, in fewer "
          "bits nearly")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = lensScene();
        scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
        render::Renderer renderer(scene, device, renderOptions());
        for (render::Settings settings : { filtered(64), plain(64) })
            for (const bool crop : { false, true }) {
                const std::string method = render::methodName(settings.method);
                CAPTURE(method);
                CAPTURE(crop);
                settings.bounces = 1;
                if (crop)
                    settings.crop = { 9, 5, 41, 30 };
                const std::vector<Step> less = steps(renderer, settings), all = steps(renderer, settings, {}, true);
                REQUIRE(less.size() == 3);
                REQUIRE(all.size() == 3);
                for (std::size_t i = 0; i < less.size(); ++i) {
                    REQUIRE(less[i].image.size() == all[i].image.size());
                    // What is filtered is kept in fewer bits: widths and counts change by roundings, and with them the
                    // image, by a part of its noise.
                    const bool rounds = settings.method == render::Method::AxisAligned;
                    const double near = rounds ? 0.02 : 1e-4, error = all[i].step.error.rmse();
                    double squares = 0;
                    for (std::size_t k = 0; k < less[i].image.size(); ++k) {
                        squares += std::pow(less[i].image[k] - all[i].image[k], 2);
                        REQUIRE((rounds || less[i].image[k] == doctest::Approx(all[i].image[k]).epsilon(1e-5)));
                    }
                    CAPTURE(error);
                    CHECK(std::sqrt(squares / static_cast<double>(less[i].image.size())) < 0.2 * error);
                    const render::FrameStatistics &a = less[i].step.statistics, &b = all[i].step.statistics;
                    CHECK(less[i].step.error.rmse() == doctest::Approx(error).epsilon(near));
                    const auto agrees = [rounds](auto one, auto other) {
                        return rounds
                            ? static_cast<double>(one) == doctest::Approx(static_cast<double>(other)).epsilon(0.01)
                            : one == other;
                    };
                    CHECK(agrees(a.primaryRays, b.primaryRays));
                    CHECK(agrees(a.shadowRays, b.shadowRays));
                    CHECK(agrees(a.indirectRays, b.indirectRays));
                    CHECK(agrees(a.directSpp, b.directSpp));
                    CHECK(agrees(a.indirectSpp, b.indirectSpp));
                    CHECK(a.memoryBytes < b.memoryBytes);
                    CHECK(a.indirectSpp > 1);
                }
            }
    });
}

TEST_CASE("an estimate whose bias comes out below 0 is that of the noise, and one of nothing is no number")
{
    CHECK(render::ErrorEstimate { 4, 5 }.rmse() == 3);
    CHECK(render::ErrorEstimate { 4, -1 }.rmse() == 2);
    const double none = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(render::ErrorEstimate { none, none }.rmse()));
}

TEST_CASE("samples of all steps count, and their widths are those of a frame with as many")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = lensScene();
        render::Renderer renderer(scene, device, renderOptions());
        const render::FrameStatistics once = renderer.render(filtered(64));
        const std::vector<Step> taken = steps(renderer, filtered(64));
        REQUIRE(taken.size() == 3);
        for (std::size_t i = 0; i < taken.size(); ++i) {
            const render::FrameStatistics& s = taken[i].step.statistics;
            CAPTURE(i);
            // Two lights and the camera: three rays a sample, none of which is taken twice.
            CHECK(static_cast<double>(raysOf(s))
                == doctest::Approx(3.0 * taken[i].step.spp * width * height).epsilon(0.2));
            CHECK(s.complete == (i == 2));
            if (i > 0) {
                CHECK(raysOf(s) > raysOf(taken[i - 1].step.statistics));
                CHECK(s.deviceMilliseconds > taken[i - 1].step.statistics.deviceMilliseconds);
            }
        }
        CHECK(static_cast<double>(raysOf(taken.back().step.statistics))
            == doctest::Approx(static_cast<double>(raysOf(once))).epsilon(0.1));
        CHECK(render::halfAt(filtered(64), 64).mu == render::axisAligned(64).mu);
        for (const int spp : { 16, 28, 40, 500 })
            CHECK(render::halfAt(filtered(64), spp).distributed.factoringError
                == doctest::Approx(render::axisAligned(spp).distributed.factoringError));
        CHECK(render::halfAt(filtered(64), 16).mu == doctest::Approx(render::axisAligned(16).mu));
        CHECK(render::halfAt(filtered(64), 16).indirect.mu == doctest::Approx(render::axisAligned(16).indirect.mu));
    });
}

TEST_CASE("no pixel's counts ever fall")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = lensScene();
        render::Renderer renderer(scene, device, renderOptions());
        std::vector<std::uint32_t> before;
        int fallen = 0, stuck = 0;
        renderer.renderProgressively(filtered(128), {}, [&](const render::ProgressiveStep& step) {
            const render::Frame& f = renderer.frame();
            const std::vector<std::uint32_t> taken = f.counts("primarySamples").downloadAll(renderer.queue());
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const std::size_t i = shared::pixelIndex(x, y, f.layout.stride);
                    fallen += !before.empty() && taken[i] < before[i] ? 1 : 0;
                    // Every pixel goes on, also where first samples saw no variance.
                    stuck += static_cast<int>(taken[i]) < step.spp / 4 ? 1 : 0;
                }
            before = taken;
        });
        CHECK(fallen == 0);
        CHECK(stuck == 0);
    });
}

TEST_CASE("the estimated error is the true one: through a lens")
{
    onEveryDevice([](const device::Device& device) { checkHonesty(device, lensScene(), "lens"); });
}

TEST_CASE("the estimated error is the true one: with a pinhole")
{
    onEveryDevice([](const device::Device& device) { checkHonesty(device, smallScene(), "pinhole"); });
}

TEST_CASE("the last image of a progressive render is about as good as one frame of as many samples")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = lensScene();
        render::Renderer renderer(scene, device, renderOptions());
        const References truth = references(renderer, plain(256));
        for (const render::Settings& settings : { filtered(64), plain(64) }) {
            const double once = trueError(renderPixels(renderer, settings), truth);
            const double last = trueError(steps(renderer, settings).back().image, truth);
            MESSAGE(render::methodName(settings.method) << ": progressive " << last << ", at once " << once);
            CHECK(last < 1.3 * once);
        }
    });
}

TEST_CASE("renders are repeatable, and depend on the seed")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = lensScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (render::Settings settings : { filtered(32), plain(32) }) {
            const std::vector<Step> first = steps(renderer, settings);
            renderer.render(filtered(16));
            const std::vector<Step> again = steps(renderer, settings);
            for (std::size_t i = 0; i < first.size(); ++i) {
                CHECK(sameBits(first[i].image, again[i].image));
                CHECK(first[i].step.error.noise == again[i].step.error.noise);
                CHECK(first[i].step.error.bias == again[i].step.error.bias);
            }
            ++settings.seed;
            CHECK_FALSE(sameBits(first.back().image, steps(renderer, settings).back().image));
        }
    });
}

TEST_CASE("a render stops at its target error, and not before")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<Step> all = steps(renderer, filtered(128));
        REQUIRE(all.size() == 4);
        render::Control control;
        control.targetError = 0.5 * (all[1].step.error.rmse() + all[2].step.error.rmse());
        const std::vector<Step> some = steps(renderer, filtered(128), control);
        REQUIRE(some.size() == 3);
        CHECK(some.back().step.statistics.complete);
        CHECK(sameBits(some.back().image, all[2].image));
    });
}

TEST_CASE("a stop within a step or between two leaves a whole image")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = lensScene();
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<Step> all = steps(renderer, filtered(64));
        std::atomic<bool> cancel { false };
        render::Control control;
        control.cancel = &cancel;
        // Between: asked for when the first step's image is there.
        std::vector<Step> some;
        const render::FrameStatistics between =
            renderer.renderProgressively(filtered(64), control, [&](const render::ProgressiveStep& step) {
                some.push_back({ step, pixels(renderer, "beauty", whole) });
                cancel = true;
            });
        CHECK_FALSE(between.complete);
        REQUIRE(some.size() == 1);
        CHECK(sameBits(some[0].image, all[0].image));
        // Within: asked for when so much is done.
        for (const double when : { 0.0, 0.1, 0.3, 0.8 }) {
            cancel = false;
            control.progress = [&](double done) { cancel = cancel || done >= when; };
            some = steps(renderer, filtered(64), control);
            REQUIRE(!some.empty());
            CAPTURE(when);
            CHECK_FALSE(some.back().step.statistics.complete);
            CHECK(notFinite(some.back().image) == 0);
            CHECK(raysOf(some.back().step.statistics) < raysOf(all.back().step.statistics));
            if (some.size() > 1)
                CHECK(rmse(some.back().image, all.back().image) < 2 * rmse(all[0].image, all.back().image));
        }
    });
}

TEST_CASE("ambient occlusion and indirect light are rendered progressively, too")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings ambient = filtered(64), indirect = filtered(64);
        ambient.integrator = render::Integrator::AmbientOcclusion;
        indirect.bounces = 1;
        for (const render::Settings& settings : { ambient, indirect }) {
            render::Settings reference = plain(192);
            reference.integrator = settings.integrator;
            reference.bounces = settings.bounces;
            const Honesty h = honesty(renderer, settings, references(renderer, reference));
            REQUIRE(h.ratios.size() == 3);
            for (std::size_t i = 0; i < h.ratios.size(); ++i) {
                MESSAGE("bounces " << settings.bounces << " step " << i << ": error " << h.errors[i]
                                   << ", estimated over true " << h.ratios[i]);
                CHECK(h.ratios[i] > 0.75);
                CHECK(h.ratios[i] < 1.45);
            }
        }
    });
}

TEST_CASE("ambient occlusion takes no samples for the edges of what emits, which it does not show")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = lensScene();
        render::Settings settings = filtered(64);
        settings.integrator = render::Integrator::AmbientOcclusion;
        const auto rendered = [&](glm::vec3 background) {
            scene.background = background;
            render::Renderer renderer(scene, device, renderOptions());
            return steps(renderer, settings);
        };
        const std::vector<Step> dark = rendered({ 0, 0, 0 }), bright = rendered({ 20, 10, 5 });
        REQUIRE(dark.size() == 3);
        REQUIRE(bright.size() == 3);
        for (std::size_t i = 0; i < dark.size(); ++i) {
            CHECK(raysOf(bright[i].step.statistics) == raysOf(dark[i].step.statistics));
            CHECK(sameBits(bright[i].image, dark[i].image));
        }
    });
}

TEST_CASE("the memory that is told is that of the step that takes most")
{
    const render::StepRange most = render::largestStep(70);
    CHECK(most.before == 32);
    CHECK(most.spp == 64);
    CHECK(render::largestStep(16).before == 0);
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        const auto planned = [&](int spp) {
            render::Settings settings = sized(render::axisAligned(spp), 24, 16);
            settings.progressive = true;
            return renderer.plan(settings).total();
        };
        // Waves of so small an image go by the samples of a step.
        CHECK(planned(4096) > planned(16));
        CHECK(planned(4098) == planned(4096));
    });
}
