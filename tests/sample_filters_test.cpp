// What holds of filters of samples, over whole frames (host/render/stored_samples.h).
#include "host/render/filter_chain.h"
#include "tests/filtered_frames.h"
#include "tests/image_means.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 34;
const render::ChosenFilter density { "path-density", { 10, 2, 3, 3, 0, 0, 0 } };
/// Stores samples, and keeps all of them.
const render::ChosenFilter kept { "clamp", { 1e8f, 0, 0 } };

render::Settings plain(int spp)
{
    render::Settings s = sized(render::monteCarlo(spp), width, height);
    s.bounces = 2;
    return s;
}

render::Settings uniform(int spp)
{
    render::Settings s = sized(render::axisAligned(spp), width, height);
    s.bounces = 2;
    s.sampling = render::Sampling::Uniform;
    s.indirect.counts = render::IndirectCounts::Uniform;
    return s;
}

} // namespace

TEST_CASE("samples that are stored and all kept make the image that they make otherwise, to the bit")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        // So many samples that memory has but a few rows at a time, and is used over and over.
        for (const render::Settings& s : { plain(3), plain(1100), uniform(16) }) {
            CAPTURE(s.spp);
            CHECK(sameBits(rendered(renderer, with(s, kept)), rendered(renderer, s)));
        }
    });
}

TEST_CASE("a filter of samples changes indirect light alone, and traces no more than its probes")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (const render::Settings& s : { plain(12), uniform(24) }) {
            CAPTURE(s.spp);
            const auto of = [&](const render::Settings& settings) {
                const render::FrameStatistics statistics = renderer.render(settings, {}, true);
                std::vector<float> out;
                for (const char* plane : { "direct", "directNoisy", "emission", "albedo" }) {
                    const std::vector<float> shown = pixels(renderer, plane, { 0, 0, width, height });
                    out.insert(out.end(), shown.begin(), shown.end());
                }
                return std::pair(out, statistics);
            };
            const auto before = of(s);
            const std::vector<float> indirect = pixels(renderer, "indirect", { 0, 0, width, height });
            render::ChosenFilter given = density;
            given.values[4] = 1.0f; // the exposure: then there are no probes
            const auto after = of(with(s, given));
            CHECK_FALSE(sameBits(pixels(renderer, "indirect", { 0, 0, width, height }), indirect));
            CHECK(sameBits(after.first, before.first));
            CHECK(after.second.indirectRays == before.second.indirectRays);
            CHECK(after.second.shadowRays == before.second.shadowRays);
            const auto probed = of(with(s, density));
            CHECK(sameBits(probed.first, before.first));
            CHECK(probed.second.indirectRays > before.second.indirectRays);
            // Sixteen samples of each sixteenth pixel, of both terms.
            CHECK(static_cast<double>(probed.second.indirectRays)
                < static_cast<double>(before.second.indirectRays) * (1.0 + 1.5 / s.spp));
        }
    });
}

TEST_CASE("early exits are exact: with the layers, which ask for whole isolations, the image is the same")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (const render::Settings& s : { with(plain(20), density), with(uniform(16), density) }) {
            const std::vector<float> image = rendered(renderer, s);
            CHECK(sameBits(rendered(renderer, s, "beauty", true), image));
            const std::vector<float> isolation = pixels(renderer, "pathDensityIndirect", { 0, 0, width, height });
            CHECK(std::ranges::all_of(isolation, [](float x) { return x >= 0.0f && x <= 4.0f; }));
            CHECK(std::ranges::any_of(isolation, [](float x) { return x > 0.0f; }));
        }
    });
}

TEST_CASE("a crop has the bits of the whole, of one band and of several, whatever lay in the memory")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, poisoned);
        const auto adaptive = [](int spp) {
            render::Settings s = sized(render::axisAligned(spp), width, height);
            s.bounces = 1;
            return s;
        };
        struct Kind {
            render::Settings settings;
            float spread, widest;
        };
        for (const Kind& kind : { Kind { plain(700), 2, 0 }, Kind { uniform(20), 0.5f, 8 }, Kind { adaptive(16), 2, 0 },
                 Kind { adaptive(40), 0.5f, 2 } }) {
            CAPTURE(kind.settings.spp);
            render::Settings s =
                with(kind.settings, { "path-density", { 10, 0.5f, 1.5f, kind.spread, 0, 0, 0, kind.widest } });
            const std::vector<float> whole = rendered(renderer, s);
            CHECK(notFinite(whole) == 0);
            s.crop = { 17, 11, 30, 23 };
            const std::vector<float> crop = rendered(other, s);
            std::size_t differ = 0, k = 0;
            for (int y = s.crop.y0; y < s.crop.y1; ++y)
                for (int x = s.crop.x0; x < s.crop.x1; ++x)
                    for (int c = 0; c < 3; ++c, ++k)
                        differ += crop[k]
                                == whole[3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))
                                    + static_cast<std::size_t>(c)]
                            ? 0u
                            : 1u;
            CHECK(differ == 0);
        }
    });
}

TEST_CASE("counts that go by noise are shared out by what is kept, and are what was asked for in the mean")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = sized(render::axisAligned(64), width, height);
        s.bounces = 2;
        const double without = renderer.render(s).indirectSpp;
        const double filtered = renderer.render(with(s, density)).indirectSpp;
        CHECK(std::abs(filtered - without) < 0.1 * without);
        const std::vector<float> image = pixels(renderer, "beauty", { 0, 0, width, height });
        const std::vector<float> even = rendered(renderer, with(uniform(64), density));
        CHECK(notFinite(image) == 0);
        CHECK(std::abs(sumOf(image) - sumOf(even)) < 0.02 * sumOf(even));
    });
}

TEST_CASE("light that is spread is not lost, and less is left without")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        const render::Settings s = plain(16);
        render::ChosenFilter lossy { "path-density", { 10, 0.3f, 0.6f, 0, 0, 0, 0 } }, spread = lossy;
        spread.values[3] = 3.0f;
        const double all = sumOf(rendered(renderer, s, "indirect", true));
        const double lost = sumOf(rendered(renderer, with(s, lossy), "indirect", true));
        const double found = sumOf(rendered(renderer, with(s, spread), "indirect", true));
        CHECK(lost < 0.99 * all);
        // What surfaces reflect of it differs from pixel to pixel.
        CHECK(std::abs(found - all) < 0.2 * (all - lost));
    });
}

TEST_CASE("a frame that is stopped shows the rows that are done, and no number that is none")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings adaptive = sized(render::axisAligned(200), width, height);
        adaptive.bounces = 2;
        renderer.queue().setTargetMilliseconds(0.05);
        struct Stop {
            render::Settings settings;
            int looks; ///< at what has been done, before it is asked to stop
        };
        for (const Stop& stop : { Stop { with(plain(1100), density), 1 }, Stop { with(plain(1100), density), 6 },
                 Stop { with(adaptive, density), 20 }, Stop { with(adaptive, density), 200 } }) {
            CAPTURE(stop.settings.spp);
            CAPTURE(stop.looks);
            const std::size_t size = static_cast<std::size_t>(width) * height * 3;
            std::atomic<bool> cancel { false };
            int looks = 0;
            render::Control control;
            control.cancel = &cancel;
            control.progress = [&](double) { cancel = ++looks >= stop.looks; };
            renderer.render(stop.settings, control);
            const std::vector<float> part = pixels(renderer, "beauty", { 0, 0, width, height });
            CHECK(notFinite(part) == 0);
            CHECK(part.size() == size);
            CHECK(std::ranges::all_of(part, [](float x) { return x >= 0.0f; }));
        }
    });
}

TEST_CASE("two filters of samples, ones after filters of images, and ones of other frames are refused by name")
{
    const render::ChosenFilter median { "median", { 1 } };
    CHECK_THROWS_WITH_AS(render::inStages({ density }, { kept }),
        "two filters of samples: path-density and clamp: leave one out, a scene's with --no-filters: frames have one",
        UsageError);
    const auto wrong = render::wrongOrder({ median, density }, "--add-filter");
    REQUIRE(wrong);
    CHECK(wrong->value == "--add-filter median --add-filter path-density");
    CHECK(wrong->remedy == "give path-density before median");
    CHECK(render::inStages({ median }, { density }) == std::vector<render::ChosenFilter> { density, median });
    CHECK_FALSE(render::wrongOrder({ density, median }, "--add-filter"));
    render::Settings s = with(plain(4), { "trim", { 0.1f, 0 } });
    CHECK_NOTHROW(render::validate(s, false));
    CHECK_THROWS_WITH_AS(render::validate(s, true),
        "this filter of samples is of frames through a pinhole where nothing moves, neither antialiased nor "
        "progressive: trim: choose path-density, clamp or reweight, or leave it out, a scene's with --no-filters",
        UsageError);
    s.filters = { { "trim", { 0, 0 } } }; // keeps all
    CHECK_NOTHROW(render::validate(s, true));
    for (const render::ChosenFilter& filter : { density, kept, render::ChosenFilter { "reweight", { 1, 0, 0 } } })
        CHECK_NOTHROW(render::validate(with(plain(4), filter), true));
    render::Settings published = with(render::axisAligned(16), density);
    published.bounces = 1;
    published.distributed.published = true;
    CHECK_THROWS_AS(render::validate(published, true), UsageError);
}
