// An effect of this folder alone, a constant sky, against closed forms: by every method and kind of frame.
#include "tests/effects/constant_sky/constant_sky.h"
#include "tests/image_means.h"
#include "tests/render_support.h"

#include "host/render/layers.h"
#include "host/render/progressive.h"

#include <doctest/doctest.h>

namespace wedge::test {
namespace {

const glm::vec3 sky(0.4f, 0.6f, 0.9f);
const glm::vec3 reflectance(0.8f, 0.7f, 0.6f);

/// All that the camera sees is a floor.
SceneBuilder openFloor()
{
    registerSky();
    SceneBuilder b;
    b.scene.materials[0].diffuse = reflectance;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.camera({ 0, 2, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 40);
    setSky(b.scene, sky);
    return b;
}

render::Settings settings(bool filtered, int spp = 32)
{
    return sized(filtered ? render::axisAligned(spp) : render::monteCarlo(spp), 24, 24);
}

std::vector<float> beauty(render::Renderer& renderer, const render::Settings& settings)
{
    if (!settings.progressive) {
        return renderPixels(renderer, settings);
    }
    renderer.renderProgressively(settings, {}, [](const render::ProgressiveStep&) {});
    return pixels(renderer, "beauty", { 0, 0, settings.width, settings.height });
}

/// The layer's sum.
std::uint64_t raysOfPixels(render::Renderer& renderer, const render::Settings& settings)
{
    const std::vector<std::uint32_t> rays = renderer.frame().counts("rays").downloadAll(renderer.queue());
    std::uint64_t sum = 0;
    for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x)
            sum += rays[shared::pixelIndex(
                static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), renderer.frame().layout.stride)];
    return sum;
}

} // namespace

TEST_CASE("a floor under a constant sky reflects its reflectance of it in every kind of frame")
{
    // E = pi L.
    onEveryDevice([](const device::Device& device) {
        for (const bool lens : { false, true }) {
            SceneBuilder b = openFloor();
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const bool filtered : { false, true }) {
                for (const bool progressive : { false, true }) {
                    CAPTURE(lens);
                    CAPTURE(filtered);
                    CAPTURE(progressive);
                    render::Settings s = settings(filtered);
                    s.progressive = progressive;
                    s.bounces = 1; // a floor alone does not light itself
                    // Filters make neighbours alike: the image's mean has more noise than they seem to have.
                    checkMean(beauty(renderer, s), sky * reflectance, filtered && lens ? 0.01 : 1e-4);
                }
            }
        }
    });
}

TEST_CASE("directions that a floor reflects find all of the sky in each sample")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::Renderer renderer(b.scene, device, renderOptions());
        render::Settings s = settings(false, 4);
        s.lightSampling = render::LightSampling::Directions;
        const std::vector<float> image = renderPixels(renderer, s);
        for (std::size_t i = 0; i < image.size(); ++i) {
            const glm::vec3 expected = sky * reflectance;
            CHECK(image[i] == doctest::Approx(expected[static_cast<int>(i % 3)]).epsilon(1e-5));
        }
    });
}

TEST_CASE("where nothing absorbs, all is as bright as the sky")
{
    // The furnace: paths that leave the scene, after any number of bounces, and what the camera sees behind it.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].diffuse = glm::vec3(1.0f);
        b.box({ -0.6f, 0.1f, -0.3f }, { -0.1f, 0.8f, 0.4f });
        b.box({ 0.1f, 0.1f, -0.3f }, { 0.5f, 0.4f, 0.3f });
        b.camera({ 0, 1.5f, 4.5f }, { 0, 0.4f, 0 });
        for (const bool lens : { false, true }) {
            b.scene.camera.apertureRadius = lens ? 0.02f : 0.0f;
            render::Renderer renderer(b.scene, device, renderOptions());
            for (const bool filtered : { false, true }) {
                CAPTURE(lens);
                CAPTURE(filtered);
                render::Settings s = settings(filtered, 64);
                s.bounces = 64;
                checkMean(renderPixels(renderer, s), sky, filtered ? 0.01 : 1e-3);
            }
        }
    });
}

TEST_CASE("a wall takes its form factor of the sky")
{
    // Of an endless wall of height h at distance d: (1 - d / sqrt(d^2 + h^2)) / 2.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials.push_back(b.scene.materials[0]);
        b.scene.materials[1].diffuse = glm::vec3(0.0f);
        const float distance = 0.5f, height = 0.8f;
        b.quad({ -distance, 0.5f * height, 0 }, { 0, 0.5f * height, 0 }, { 0, 0, 1000 }, 1);
        b.camera({ 0, 2, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 0.05f);
        render::Renderer renderer(b.scene, device, renderOptions());
        const float open = 1.0f - 0.5f * (1.0f - distance / std::hypot(distance, height));
        for (const render::LightSampling sampling :
            { render::LightSampling::Both, render::LightSampling::Lights, render::LightSampling::Directions }) {
            CAPTURE(static_cast<int>(sampling));
            render::Settings s = settings(false, 64);
            s.lightSampling = sampling;
            checkMean(renderPixels(renderer, s), open * sky * reflectance, 2e-4);
        }
    });
}

TEST_CASE("points of the sky, directions of lobes, and both together tell the same")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.scene.materials[0].specular = glm::vec3(0.3f);
        b.scene.materials[0].exponent = 20.0f;
        b.box({ -0.5f, 0, -0.5f }, { 0.5f, 0.6f, 0.0f });
        b.camera({ 0, 1.2f, 3 }, { 0, 0.2f, 0 });
        render::Renderer renderer(b.scene, device, renderOptions());
        const auto image = [&](render::LightSampling sampling) {
            render::Settings s = settings(false, 256);
            s.lightSampling = sampling;
            s.bounces = 1;
            return renderPixels(renderer, s);
        };
        const std::vector<float> both = image(render::LightSampling::Both);
        for (const render::LightSampling one : { render::LightSampling::Lights, render::LightSampling::Directions }) {
            std::vector<float> difference = image(one);
            for (std::size_t i = 0; i < both.size(); ++i)
                difference[i] -= both[i];
            checkMean(difference, glm::vec3(0.0f));
        }
    });
}

TEST_CASE("rays to the sky count in every kind of frame")
{
    // All that is seen is a floor, and every direction of a technique is above it: each is a ray.
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const render::LightSampling sampling :
            { render::LightSampling::Both, render::LightSampling::Lights, render::LightSampling::Directions }) {
            for (const bool distributed : { false, true }) {
                CAPTURE(static_cast<int>(sampling));
                CAPTURE(distributed);
                render::Settings s = settings(false, 4);
                s.lightSampling = sampling;
                s.antialias = distributed;
                const render::FrameStatistics statistics = renderer.render(s, {}, true);
                const std::uint64_t techniques = sampling == render::LightSampling::Both ? 2 : 1;
                CHECK(statistics.shadowRays == 24u * 24u * 4u * techniques);
                CHECK(raysOfPixels(renderer, s) == statistics.primaryRays + statistics.shadowRays);
            }
        }
    });
}

TEST_CASE("the sky has a layer, and is seen where nothing is hit")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        b.camera({ 0, 1, 6 }, { 0, 1, 0 });
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            render::Settings s = settings(true);
            s.antialias = antialias;
            const std::vector<std::string> layers = render::selectLayers("all", s, renderer.scene());
            REQUIRE(std::ranges::count(layers, std::string("sky")) == 1);
            const std::vector<float> all = renderPixels(renderer, s, true);
            const image::Window whole { 0, 0, s.width, s.height };
            const std::vector<float> reflected = pixels(renderer, "sky", whole);
            const std::vector<float> emitted = pixels(renderer, "emission", whole);
            REQUIRE(reflected.size() == all.size());
            for (std::size_t i = 0; i < all.size(); ++i)
                CHECK(emitted[i] + reflected[i] == doctest::Approx(all[i]).epsilon(1e-4));
            // The upper left corner is sky.
            for (int channel = 0; channel < 3; ++channel)
                CHECK(all[static_cast<std::size_t>(channel)] == doctest::Approx(sky[channel]).epsilon(1e-5));
            CHECK(meanOf(reflected, 0).value > 0.01);
        }
        b.scene.extensions.clear();
        const render::PreparedScene without(b.scene);
        CHECK_THROWS(render::selectLayers("sky", settings(true), without));
        CHECK(std::ranges::count(render::selectLayers("all", settings(true), without), std::string("sky")) == 0);
    });
}

TEST_CASE("lights that are added as they are sampled add up, in crops, too, whatever lay in the memory")
{
    onEveryDevice([](const device::Device& device) {
        const auto floorUnder = [](bool lamp, const glm::vec3& above) {
            SceneBuilder b = openFloor();
            setSky(b.scene, above);
            if (lamp)
                b.scene.pointLights.push_back({ { 0.5f, 1, 0.5f }, { 2, 3, 4 } });
            return b.scene;
        };
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer lamp(floorUnder(true, glm::vec3(0)), device, renderOptions()),
            above(floorUnder(false, sky), device, renderOptions()), both(floorUnder(true, sky), device, poisoned);
        const image::Window whole { 0, 0, 24, 24 }, crop { 5, 3, 19, 22 };
        const auto shown = [&](render::Renderer& by, const char* plane, const image::Window& window) {
            render::Settings s = settings(false, 4);
            s.crop = window == whole ? image::Window {} : window;
            by.render(s, {}, true);
            return pixels(by, plane, window);
        };
        for (const image::Window& window : { whole, crop }) {
            CAPTURE(window.x0);
            const std::vector<float> ofLamp = shown(lamp, "direct", window), ofSky = shown(above, "direct", window);
            CHECK(meanOf(ofLamp, 0).value > 0.01);
            for (const char* image : { "direct", "directNoisy" }) {
                CAPTURE(image);
                const std::vector<float> sum = shown(both, image, window);
                REQUIRE(sum.size() == ofLamp.size());
                bool same = true;
                for (std::size_t i = 0; i < sum.size(); ++i)
                    same = same && sum[i] == ofLamp[i] + ofSky[i];
                CHECK(same);
            }
            CHECK(shown(both, "sky", window) == ofSky);
        }
        // Who tallies no path rays counts none.
        const render::FrameStatistics statistics = both.render(settings(false, 4), {}, true);
        CHECK(statistics.shadowRays == 24u * 24u * (4u * 2u + 1u));
        CHECK(statistics.indirectRays == 0);
    });
}

} // namespace wedge::test
