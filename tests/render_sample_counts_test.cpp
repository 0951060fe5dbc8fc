// What whole frames say of the samples and rays that they took.
#include "kernels/shared/indirect.h"
#include "kernels/shared/wedge.h"
#include "tests/render_support.h"

#include <algorithm>
#include <numeric>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 75, height = 53;

} // namespace

TEST_CASE("where no more samples are asked for than analyses take, nothing is shared out and no pass takes the rest")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        render::Renderer renderer(scene, device, renderOptions());
        const auto has = [](const render::FrameStatistics& frame, const char* pass) {
            return std::ranges::any_of(frame.passes, [&](const device::PassRecord& p) { return p.name == pass; });
        };
        for (const int bounces : { 0, 1 }) {
            const int first = bounces == 0 ? WEDGE_FIRST_PASS_RAYS : WEDGE_INDIRECT_FIRST_RAYS;
            for (const int spp : { first, first + 1 }) {
                CAPTURE(spp);
                render::Settings adaptive = sized(render::axisAligned(spp), width, height);
                adaptive.bounces = bounces;
                render::Settings uniform = adaptive;
                uniform.sampling = render::Sampling::Uniform;
                const render::FrameStatistics shared = renderer.render(adaptive), even = renderer.render(uniform);
                const char* rest = bounces == 0 ? "second pass" : "second paths";
                CHECK(has(shared, rest) == (spp > first));
                CHECK(has(even, rest) == (spp > first));
                CHECK((bounces == 0 ? shared.directSpp : shared.indirectSpp) == doctest::Approx(spp).epsilon(0.05));
                const std::uint64_t most = static_cast<std::uint64_t>(spp) * scene.areaLights.size() * width * height;
                CHECK(shared.shadowRays > 0);
                CHECK(shared.shadowRays <= most * (bounces == 0 ? 1 : 3));
                if (bounces == 0)
                    CHECK((renderPixels(renderer, adaptive) == renderPixels(renderer, uniform)) == (spp == first));
            }
        }
    });
}

TEST_CASE("what a frame counts is the same with layers and without, and is what its layers say")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.materials[0].specular = glm::vec3(0.2f);
        scene.materials[0].exponent = 8;
        scene.pointLights.push_back({ .position = { 0, 2, 1 }, .intensity = glm::vec3(3) });
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings settings = sized(render::axisAligned(28), 48, 32);
        settings.crop = { 5, 3, 31, 27 };
        for (const render::Method method : { render::Method::AxisAligned, render::Method::MonteCarlo })
            for (const int bounces : { 0, 2 }) {
                CAPTURE(bounces);
                settings.method = method;
                settings.bounces = bounces;
                const render::FrameStatistics image = renderer.render(settings, {}, false);
                const render::FrameStatistics layers = renderer.render(settings, {}, true);
                CHECK(image.shadowRays == layers.shadowRays);
                CHECK(image.indirectRays == layers.indirectRays);
                CHECK(image.sppMean == layers.sppMean);
                CHECK(image.directSpp == layers.directSpp);
                CHECK(image.indirectSpp == layers.indirectSpp);
                CHECK((image.indirectRays > 0) == (bounces > 0));
                CHECK(image.directSpp > 20);
                const std::uint32_t stride = renderer.frame().layout.stride;
                const auto sum = [&](const char* tally) {
                    const auto each = renderer.frame().planes<std::uint64_t>(tally).downloadAll(renderer.queue());
                    return std::accumulate(each.begin(), each.end(), std::uint64_t { 0 });
                };
                const auto within = [&](const char* counts, const image::Window& window) {
                    const std::vector<std::uint32_t> each =
                        renderer.frame().counts(counts).downloadAll(renderer.queue());
                    std::uint64_t all = 0;
                    for (int y = window.y0; y < window.y1; ++y)
                        for (int x = window.x0; x < window.x1; ++x)
                            all += each[shared::pixelIndex(
                                static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), stride)];
                    return all;
                };
                CHECK(within("samples", settings.crop) == sum("samplesTally"));
                // The whole image's rays, of which a crop has not all.
                render::Settings whole = settings;
                whole.crop = {};
                renderer.render(whole, {}, true);
                CHECK(within("rays", { 0, 0, 48, 32 })
                    == std::uint64_t { 48 } * 32 + sum("raysTally")); // the camera's, too
            }
    });
}

TEST_CASE("what a frame of several receivers counts is what its planes say, and with layers about the same as without")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.pointLights.push_back({ .position = { 0, 2, 1 }, .intensity = glm::vec3(3) });
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool progressive : { false, true })
            for (const image::Window& crop : { image::Window {}, image::Window { 5, 3, 31, 27 } }) {
                CAPTURE(progressive);
                render::Settings settings = sized(render::axisAligned(16), 48, 32);
                settings.antialias = true;
                settings.bounces = 1;
                settings.progressive = progressive;
                if (crop.x1 > 0)
                    settings.crop = crop;
                const auto rendered = [&](bool layers) {
                    return progressive ? renderer.renderProgressively(settings, {}, {}, layers)
                                       : renderer.render(settings, {}, layers);
                };
                const render::FrameStatistics image = rendered(false), layers = rendered(true);
                CHECK(image.shadedPixels == layers.shadedPixels);
                // Without layers pixels keep fewer bits of what demands are made of.
                CHECK(static_cast<double>(image.primaryRays)
                    == doctest::Approx(static_cast<double>(layers.primaryRays)).epsilon(2e-3));
                CHECK(image.primarySpp == doctest::Approx(layers.primarySpp).epsilon(2e-3));
                CHECK(image.directSpp == doctest::Approx(layers.directSpp).epsilon(2e-3));
                CHECK(image.indirectSpp == doctest::Approx(layers.indirectSpp).epsilon(2e-3));
                CHECK(static_cast<double>(image.shadowRays)
                    == doctest::Approx(static_cast<double>(layers.shadowRays)).epsilon(2e-3));
                CHECK(static_cast<double>(image.indirectRays)
                    == doctest::Approx(static_cast<double>(layers.indirectRays)).epsilon(2e-3));
                const auto planeOf = [&](const char* name) {
                    return planesOf(
                        renderer.frame().layout, renderer.frame().counts(name).downloadAll(renderer.queue()));
                };
                const auto objects = planeOf("objectId"), samples = planeOf("samples"),
                           indirect = planeOf("indirectSamples"), primary = planeOf("primarySamples"),
                           rays = planeOf("raysTraced"), paths = planeOf("pathRays"), all = planeOf("rays");
                std::uint64_t shaded = 0, taken = 0, takenIndirect = 0, primaries = 0, shown = 0, traced = 0,
                              traversed = 0;
                const image::Window output = render::outputWindow(settings);
                everyPixel(renderer.frame().layout, [&](int x, int y) {
                    primaries += primary.at(x, y);
                    traced += rays.at(x, y);
                    traversed += paths.at(x, y);
                    if (x < output.x0 || x >= output.x1 || y < output.y0 || y >= output.y1)
                        return;
                    shown += primary.at(x, y);
                    REQUIRE(all.at(x, y) == primary.at(x, y) + rays.at(x, y));
                    if (objects.at(x, y) == 0)
                        return;
                    ++shaded;
                    taken += samples.at(x, y);
                    takenIndirect += indirect.at(x, y);
                });
                const auto pixels = static_cast<double>(output.width()) * output.height();
                const auto each = static_cast<double>(shaded);
                CHECK(shaded > 0);
                CHECK(layers.shadedPixels == shaded);
                CHECK(layers.primaryRays == primaries);
                CHECK(layers.primarySpp == doctest::Approx(static_cast<double>(shown) / pixels).epsilon(1e-9));
                CHECK(layers.indirectRays == traversed);
                CHECK(layers.shadowRays == traced - traversed);
                CHECK(layers.indirectSpp == doctest::Approx(static_cast<double>(takenIndirect) / each).epsilon(1e-9));
                const double lights = static_cast<double>(scene.areaLights.size());
                CHECK(layers.directSpp
                    == doctest::Approx(static_cast<double>(taken - takenIndirect) / each / lights).epsilon(1e-9));
            }
    });
}
