// What holds of filters of samples where pixels have several receivers, over whole frames (host/render/sample_bins.h).
#include "host/render/filter_chain.h"
#include "host/render/progressive.h"
#include "tests/filtered_frames.h"
#include "tests/image_means.h"
#include "tests/lens_support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 34;
const image::Window whole { 0, 0, width, height };
const render::ChosenFilter density { "path-density", { 10, 2, 3, 3, 0, 0, 0 } };
/// Leaves out more.
const render::ChosenFilter strict { "path-density", { 10, 0.3f, 0.9f, 2, 0, 0, 0 } };
/// Has all samples by their brightness, and keeps them.
const render::ChosenFilter kept { "clamp", { 1e8f, 0, 0 } };

/// Frames whose pixels have several receivers: their squares, a lens, things that move.
struct Kind {
    const char* name;
    scene::Scene scene;
    bool antialias;
};

std::vector<Kind> kinds()
{
    std::vector<Kind> out { { "antialiased", richScene(), true }, { "lens", richScene(), false },
        { "moving", richScene(), false } };
    out[1].scene.camera.apertureRadius = 0.08f;
    out[1].scene.camera.focusDistance = 3;
    out[2].scene.camera.apertureRadius = 0.05f;
    out[2].scene.camera.focusDistance = 3;
    displace(out[2].scene, { 0.1f, 0, 0.05f });
    return out;
}

render::Settings of(const Kind& kind, render::Settings settings, int bounces)
{
    render::Settings s = sized(std::move(settings), width, height);
    s.bounces = bounces;
    s.antialias = kind.antialias;
    return s;
}

/// By plain Monte Carlo, and filtered with counts of their own.
std::vector<render::Settings> methods(const Kind& kind)
{
    return { of(kind, render::monteCarlo(21), 2), of(kind, render::axisAligned(20), 2) };
}

/// Calls test(device, kind, settings).
template <class Test>
void onEveryKind(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const Kind& kind : kinds())
            for (const render::Settings& settings : methods(kind)) {
                CAPTURE(std::string(kind.name));
                CAPTURE(settings.method == render::Method::MonteCarlo);
                test(device, kind, settings);
            }
    });
}

} // namespace

TEST_CASE("samples that are known by their brightness and all kept make the image that they make otherwise, to the bit")
{
    onEveryKind([](const device::Device& device, const Kind& kind, const render::Settings& settings) {
        render::Renderer renderer(kind.scene, device, renderOptions());
        for (const bool layers : { false, true })
            CHECK(sameBits(rendered(renderer, with(settings, kept), "beauty", layers),
                rendered(renderer, settings, "beauty", layers)));
    });
}

TEST_CASE("a filter by brightness changes indirect light alone, and traces no more than its probes")
{
    onEveryDevice([](const device::Device& device) {
        for (const Kind& kind : kinds()) {
            CAPTURE(std::string(kind.name));
            const render::Settings settings = of(kind, render::monteCarlo(12), 2);
            render::Renderer renderer(kind.scene, device, renderOptions());
            const auto shown = [&](const render::Settings& s) {
                const render::FrameStatistics statistics = renderer.render(s, {}, true);
                std::vector<float> out;
                for (const char* plane : { "direct", "emission", "albedo" }) {
                    const std::vector<float> more = pixels(renderer, plane, whole);
                    out.insert(out.end(), more.begin(), more.end());
                }
                return std::pair(out, statistics);
            };
            const auto before = shown(settings);
            const std::vector<float> indirect = pixels(renderer, "indirect", whole);
            render::ChosenFilter given = strict;
            given.values[4] = 1; // the exposure
            const auto after = shown(with(settings, given));
            CHECK_FALSE(sameBits(pixels(renderer, "indirect", whole), indirect));
            CHECK(sameBits(after.first, before.first));
            CHECK(after.second.indirectRays == before.second.indirectRays);
            CHECK(after.second.shadowRays == before.second.shadowRays);
            const auto probed = shown(with(settings, strict));
            CHECK(sameBits(probed.first, before.first));
            // One sample in the mean over pixels.
            const auto rays = static_cast<double>(before.second.indirectRays);
            const double more = static_cast<double>(probed.second.indirectRays) - rays;
            CHECK(more > 0);
            CHECK(more < 2 * rays / 12);
        }
    });
}

TEST_CASE("a crop has the bits of the whole, whatever lay in the memory")
{
    onEveryKind([](const device::Device& device, const Kind& kind, const render::Settings& settings) {
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(kind.scene, device, renderOptions()), other(kind.scene, device, poisoned);
        render::Settings s = with(settings, strict);
        const std::vector<float> image = rendered(renderer, s);
        CHECK(notFinite(image) == 0);
        s.crop = { 17, 11, 30, 23 };
        const std::vector<float> crop = rendered(other, s);
        std::size_t differ = 0, k = 0;
        for (int y = s.crop.y0; y < s.crop.y1; ++y)
            for (int x = s.crop.x0; x < s.crop.x1; ++x)
                for (std::size_t c = 0; c < 3; ++c, ++k)
                    differ +=
                        crop[k] == image[3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) + c]
                        ? 0u
                        : 1u;
        CHECK(differ == 0);
        CHECK(k == crop.size());
    });
}

TEST_CASE("twice the light is twice the image, exactly")
{
    onEveryDevice([](const device::Device& device) {
        for (const Kind& kind : kinds()) {
            CAPTURE(std::string(kind.name));
            scene::Scene brighter = kind.scene;
            for (scene::AreaLight& light : brighter.areaLights)
                light.radiance *= 2;
            for (scene::PointLight& light : brighter.pointLights)
                light.intensity *= 2;
            for (scene::DirectionalLight& light : brighter.directionalLights)
                light.irradiance *= 2;
            brighter.background *= 2;
            render::Renderer renderer(kind.scene, device, renderOptions()), other(brighter, device, renderOptions());
            const render::Settings s = with(of(kind, render::monteCarlo(9), 2), strict);
            std::vector<float> image = rendered(renderer, s);
            for (float& v : image)
                v *= 2;
            CHECK(sameBits(rendered(other, s), image));
        }
    });
}

TEST_CASE("light that is spread is not lost, and less is left without")
{
    onEveryKind([](const device::Device& device, const Kind& kind, const render::Settings& settings) {
        render::Renderer renderer(kind.scene, device, renderOptions());
        render::ChosenFilter lossy = strict, spread = strict;
        lossy.values[3] = 0;
        spread.values[3] = 3;
        const double all = sumOf(rendered(renderer, settings, "indirectNoisy", true));
        const double lost = sumOf(rendered(renderer, with(settings, lossy), "indirectNoisy", true));
        const double found = sumOf(rendered(renderer, with(settings, spread), "indirectNoisy", true));
        CHECK(lost < 0.99 * all);
        CHECK(std::abs(found - all) < 0.35 * (all - lost));
    });
}

TEST_CASE("layers show what is lost and how alone samples are, and do not change the image")
{
    onEveryKind([](const device::Device& device, const Kind& kind, const render::Settings& settings) {
        render::Renderer renderer(kind.scene, device, renderOptions());
        const render::Settings s = with(settings, strict);
        const std::vector<float> image = rendered(renderer, s, "beauty", true);
        const std::vector<float> isolation = pixels(renderer, "pathDensityIndirect", whole);
        const std::vector<float> rejected = pixels(renderer, "rejectedIndirect", whole);
        CHECK(std::ranges::all_of(isolation, [](float x) { return x >= 0 && x <= 4; }));
        CHECK(std::ranges::any_of(isolation, [](float x) { return x > 0; }));
        CHECK(sumOf(rejected) > 0);
        // Sums of other parts are rounded otherwise; and method aaf keeps less in fewer bits.
        const std::vector<float> alone = rendered(renderer, s);
        CHECK(rmse(alone, image) < (settings.method == render::Method::MonteCarlo ? 1e-6 : 1e-2));
    });
}

TEST_CASE("progressive frames keep of all samples what one frame of as many keeps, and go on with the rest")
{
    onEveryDevice([](const device::Device& device) {
        const Kind kind = kinds()[0];
        render::Renderer renderer(kind.scene, device, renderOptions());
        const auto last = [&](const render::Settings& s, bool layers) {
            std::vector<float> image;
            int steps = 0;
            renderer.renderProgressively(
                s, {},
                [&](const render::ProgressiveStep&) {
                    image = pixels(renderer, "beauty", whole);
                    ++steps;
                },
                layers);
            CHECK(steps > 1);
            return image;
        };
        for (const bool adaptive : { false, true }) {
            CAPTURE(adaptive);
            render::Settings s = of(kind, adaptive ? render::axisAligned(64) : render::monteCarlo(64), 2);
            s.progressive = true;
            const std::vector<float> plain = last(s, false), image = last(with(s, strict), false);
            CHECK(notFinite(image) == 0);
            CHECK_FALSE(sameBits(image, plain));
            CHECK(sameBits(last(with(s, kept), false), plain));
            CHECK(sameBits(last(with(s, strict), false), image));
            CHECK(rmse(last(with(s, strict), true), image) < (adaptive ? 1e-2 : 1e-6)); // formats, as above
            CHECK(std::ranges::all_of(
                pixels(renderer, "pathDensityIndirect", whole), [](float x) { return x >= 0 && x <= 4; }));
        }
    });
}

TEST_CASE("as many pixels are filtered as without a filter of samples, however much it leaves out")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(scene::loadScene(WEDGE_SOURCE_DATA "/scenes/mirrors.toml"), device, renderOptions());
        const auto unfiltered = [&](const render::Settings& s) {
            renderer.render(s, {}, true);
            const std::vector<float> widths = widthsOf(renderer, "Indirect");
            return static_cast<double>(std::ranges::count_if(widths, [](float width) { return !(width > 0); }));
        };
        render::Settings s = sized(render::axisAligned(32), width, height);
        s.bounces = 2;
        s.antialias = true;
        const double without = unfiltered(s);
        for (const render::ChosenFilter& filter : { density, strict }) {
            CAPTURE(without);
            CHECK(std::abs(unfiltered(with(s, filter)) - without) < 0.05 * without);
        }
    });
}

TEST_CASE("the error that progressive frames tell is that of what the filter takes away, too")
{
    onEveryDevice([](const device::Device& device) {
        const Kind kind = kinds()[0];
        render::Renderer renderer(kind.scene, device, renderOptions());
        const render::ChosenFilter dark { "clamp", { 0.01f, 0, 1 } };
        for (const bool layers : { false, true }) {
            render::Settings s = of(kind, render::monteCarlo(64), 2);
            const std::vector<float> truth = rendered(renderer, of(kind, render::monteCarlo(2048), 2));
            s.progressive = true;
            render::ErrorEstimate told {};
            renderer.renderProgressively(
                with(s, dark), {}, [&](const render::ProgressiveStep& step) { told = step.error; }, layers);
            const double error = rmse(pixels(renderer, "beauty", whole), truth);
            CAPTURE(told.rmse());
            CAPTURE(error);
            CHECK(told.bias > 2 * told.noise);
            CHECK(std::abs(told.rmse() - error) < 0.2 * error);
        }
    });
}

TEST_CASE("means of many samples lose less and less: what is left out vanishes")
{
    onEveryDevice([](const device::Device& device) {
        const Kind kind = kinds()[0];
        render::Renderer renderer(kind.scene, device, renderOptions());
        const auto lost = [&](int spp) {
            render::Settings s = with(of(kind, render::monteCarlo(spp), 2), density);
            return sumOf(rendered(renderer, s, "rejectedIndirect", true));
        };
        CHECK(lost(512) < 0.3 * lost(8));
    });
}
