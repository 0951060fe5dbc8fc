// Distributed frames: counts that grow with what is asked for, and frames that keep little.
#include "tests/lens_scene.h"
#include "tests/lens_support.h"

#include <atomic>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

enum class Moves { Nothing, Camera, Geometry };

/// Through a lens, while the shutter is open.
scene::Scene movingWall(Moves moves)
{
    scene::Scene scene = wallInFocus();
    scene.camera.apertureRadius = 0.1f;
    scene.camera.focusDistance = 2.5f;
    const glm::vec3 shift(0.3f, 0.1f, 0);
    if (moves == Moves::Camera) {
        scene.cameraAtClose = scene.camera;
        scene.cameraAtClose->eye += shift;
        scene.cameraAtClose->lookAt += shift;
    } else if (moves == Moves::Geometry) {
        scene::Geometry& g = scene.geometry;
        g.positionsAtClose = g.positions;
        g.normalsAtClose = g.normals;
        for (std::size_t i = 0; i < g.positions.size(); ++i)
            g.positionsAtClose[i] += shift[static_cast<int>(i % 3)];
    }
    return scene;
}

/// A wall as wide as it takes, with a light before it, that moves to the left by so many pixels of an image of that
/// height.
scene::Scene racingWall(int height, float pixels)
{
    SceneBuilder b;
    std::vector<std::uint32_t> stripes;
    stripes.reserve(64);
    std::mt19937 random(1);
    for (int k = 0; k < 64; ++k)
        stripes.push_back(static_cast<std::uint32_t>(random()) & 0xffffffu);
    b.scene.textures.push_back({ "", 64, 1, stripes });
    b.scene.materials[0].diffuseTexture = 0;
    constexpr float distance = 3, fov = 4;
    const float pixel = 2 * distance * std::tan(0.5f * fov * 3.14159265f / 180) / static_cast<float>(height);
    b.quad({ 0, 0, 0 }, { 20, 0, 0 }, { 0, 2, 0 });
    b.newObject();
    b.quad({ -3, 0, 2 }, { 8, 0, 0 }, { 0, 0, 0.3f });
    b.light({ -2, 1, 3 }, { 0, 0.5f, 0 }, { 0.5f, 0, 0 }, scene::LightProfile::Gaussian, 60);
    b.camera({ 0, 0, distance }, { 0, 0, 0 }, { 0, 1, 0 }, fov);
    displace(b.scene, { -pixels * pixel, 0, 0 });
    return b.scene;
}

/// Renders the crop and the whole image, and compares the bits of the window.
void requireCropOfWhole(
    render::Renderer& renderer, render::Settings settings, const image::Window& window, bool keepLayers)
{
    const auto part = [&](std::uint32_t seed, const image::Window& crop) {
        settings.seed = seed;
        settings.crop = crop;
        renderer.render(settings, {}, keepLayers);
        return pixels(renderer, "beauty", window);
    };
    const std::vector<float> whole = part(3, {});
    // Another seed in between, so that what is left over from the whole image does not help.
    CHECK_FALSE(sameBits(part(4, {}), whole));
    CHECK(sameBits(part(3, window), whole));
}

/// A wall, red on the left and green on the right, as bright as each other, under a light on the left that a fin on the
/// border between them hides from the green: the camera sees the fin edge on.
scene::Scene twoColours()
{
    SceneBuilder b;
    constexpr std::uint32_t red = 0x3f3ff3u, green = 0x7c913fu; // bytes of blue, green and red
    std::vector<std::uint32_t> halves(512, red);
    halves.resize(1024, green);
    b.scene.textures.push_back({ "", 1024, 1, halves });
    b.scene.materials[0].diffuseTexture = 0;
    b.quad({ 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 });
    b.quad({ 0, 0, 0.5f }, { 0, 0, 0.5f }, { 0, 3, 0 });
    b.light({ -2, 0, 2 }, { 0, 0.3f, 0 }, { 0.2f, 0, 0.2f }, scene::LightProfile::Gaussian, 60);
    b.camera({ 0, 0, 3 }, { 0, 0, 0 });
    return b.scene;
}

} // namespace

TEST_CASE("a pixel of two colours of which one is in the shadow has the other")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = twoColours();
        render::Renderer renderer(scene, device, renderOptions());
        constexpr int width = 21, height = 15, seeds = 8;
        const auto border = [&](render::Settings settings) {
            glm::dvec3 sum(0);
            settings.antialias = true;
            for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
                settings.seed = seed;
                const std::vector<float> image = renderPixels(renderer, sized(settings, width, height));
                for (int y = 4; y < height - 4; ++y)
                    for (int c = 0; c < 3; ++c)
                        sum[c] +=
                            image[3 * static_cast<std::size_t>(y * width + width / 2) + static_cast<std::size_t>(c)];
            }
            return sum / (1.0 * seeds * (height - 8));
        };
        const glm::dvec3 filtered = border(render::axisAligned(28)), plain = border(render::monteCarlo(256));
        CAPTURE(filtered.x);
        CAPTURE(filtered.y);
        CAPTURE(plain.x);
        CAPTURE(plain.y);
        CHECK(plain.x > 5 * plain.y);
        for (int c = 0; c < 3; ++c)
            CHECK(std::fabs(filtered[c] - plain[c]) < 0.04 * plain.x);
    });
}

TEST_CASE("more samples asked for are taken: where the first ones saw little, and under point lights alone")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool pointLights : { false, true }) {
            CAPTURE(pointLights);
            scene::Scene scene = wallInFocus();
            scene.camera.apertureRadius = 0.1f;
            scene.camera.focusDistance = 2.5f;
            scene.materials[0].emission = glm::vec3(0);
            (pointLights ? scene.areaLights.clear() : scene.pointLights.clear());
            render::Renderer renderer(scene, device, renderOptions());
            const render::Settings truth = sized(render::monteCarlo(400), 40, 30);
            const std::vector<float> expected = renderPixels(renderer, truth);
            double errors[2] = {}, primary[2] = {};
            for (const int k : { 0, 1 }) {
                render::Settings settings = sized(render::axisAligned(k == 0 ? 16 : 128), 40, 30);
                settings.seed = 5;
                const render::FrameStatistics frame = renderer.render(settings);
                primary[k] = frame.primarySpp;
                const std::vector<float> found = pixels(renderer, "beauty", { 0, 0, 40, 30 });
                for (std::size_t i = 0; i < found.size(); ++i)
                    errors[k] += (found[i] - expected[i]) * (found[i] - expected[i]);
            }
            CHECK(primary[1] > 4 * primary[0]);
            // Of squares.
            CHECK(errors[1] < 0.5 * errors[0]);
        }
    });
}

TEST_CASE("a frame of the image alone, in fewer bits, is the one with all of its layers but for rounding")
{
    onEveryDevice([](const device::Device& device) {
        struct Case {
            Moves moves;
            bool filtered;
        };
        for (const Case& c : { Case { Moves::Nothing, false }, { Moves::Nothing, true }, { Moves::Camera, true },
                 { Moves::Geometry, true } }) {
            CAPTURE(static_cast<int>(c.moves));
            CAPTURE(c.filtered);
            const scene::Scene scene = movingWall(c.moves);
            render::Renderer renderer(scene, device, renderOptions());
            render::Settings settings = sized(c.filtered ? render::axisAligned(16) : render::monteCarlo(16), 61, 43);
            settings.bounces = 1;
            const image::Window all { 0, 0, 61, 43 };
            const render::FrameStatistics full = renderer.render(settings, {}, true);
            const std::vector<float> layered = pixels(renderer, "beauty", all);
            const render::FrameStatistics lean = renderer.render(settings);
            const std::vector<float> alone = pixels(renderer, "beauty", all);
            CHECK(lean.memoryBytes < full.memoryBytes);
            double squares = 0, sum = 0;
            for (std::size_t i = 0; i < alone.size(); ++i) {
                squares += (alone[i] - layered[i]) * (alone[i] - layered[i]);
                sum += layered[i];
            }
            const double count = static_cast<double>(alone.size());
            // Statistics of 8 bits change a few counts by one; sums are added up in another order.
            CHECK(std::sqrt(squares / count) < (c.filtered ? 0.01 : 1e-5) * sum / count);
            CHECK(sum / count > 0.05);
        }
    });
}

TEST_CASE("a stop within the first pass leaves the pixels that it has come to, unfiltered")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = wallInFocus(); // which shines by itself: no pixel is black
        scene.camera.apertureRadius = 0.1f;
        scene.camera.focusDistance = 2.5f;
        constexpr int across = 200, down = 150, first = 8;
        REQUIRE(across * down * first > static_cast<int>(render::WaveSchedule::capacity));
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<float> reference = renderPixels(renderer, sized(render::monteCarlo(16), across, down));
        const std::atomic<bool> stop { true };
        render::Control control;
        control.cancel = &stop;
        for (const bool keepLayers : { false, true }) {
            CAPTURE(keepLayers);
            const render::FrameStatistics frame =
                renderer.render(sized(render::axisAligned(16), across, down), control, keepLayers);
            CHECK_FALSE(frame.complete);
            const std::vector<float> found = pixels(renderer, "beauty", { 0, 0, across, down });
            CHECK(notFinite(found) == 0);
            const auto taken = planesOf(
                renderer.frame().layout, renderer.frame().counts("primarySamples").downloadAll(renderer.queue()));
            double sampled = 0, sum = 0, expected = 0;
            std::size_t wrong = 0;
            for (int y = 0; y < down; ++y)
                for (int x = 0; x < across; ++x) {
                    const std::size_t i = 3 * (static_cast<std::size_t>(y) * across + static_cast<std::size_t>(x));
                    const bool isSampled = taken.at(x, y) > 0;
                    wrong += isSampled == (found[i] > 0) && (!isSampled || taken.at(x, y) == first) ? 0 : 1;
                    sampled += isSampled ? 1 : 0;
                    for (std::size_t c = i; isSampled && c < i + 3; ++c) {
                        sum += found[c];
                        expected += reference[c];
                    }
                }
            CHECK(wrong == 0);
            CHECK(sampled > 0.4 * across * down);
            CHECK(sampled < 0.6 * across * down);
            CHECK(frame.primarySpp == doctest::Approx(first * sampled / (across * down)));
            CHECK(sum == doctest::Approx(expected).epsilon(0.02));
        }
    });
}

TEST_CASE("a crop of a filtered frame has the bits of the whole one, with layers and without")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.materials[0].specular = { 0.1f, 0.2f, 0.1f };
        scene.materials[0].exponent = 15;
        scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
        scene.camera.apertureRadius = 0.3f; // blurs widely, over what terms' filters reach themselves
        constexpr int across = 170, down = 130; // beyond the reach of all filters
        render::Renderer renderer(scene, device, renderOptions());
        struct Case {
            bool published, keepLayers;
            int bounces;
        };
        for (const Case& c : { Case { false, false, 1 }, { false, true, 0 }, { true, true, 0 }, { true, false, 0 } }) {
            CAPTURE(c.published);
            CAPTURE(c.keepLayers);
            render::Settings settings =
                sized(c.published ? render::asPublished() : render::axisAligned(12), across, down);
            settings.bounces = c.bounces;
            requireCropOfWhole(renderer, settings, { 3, 2, 33, 22 }, c.keepLayers);
        }
    });
}

TEST_CASE(
    "where the pixels of a tile want more than a wave has room for, the image is as good, and a crop of the same bits")
{
    onEveryDevice([](const device::Device& device) {
        // A small light out of focus before nothing: a few tiles have all that there is of noise.
        SceneBuilder b;
        b.scene.materials[0].diffuse = glm::vec3(0.01f);
        b.quad({ 0, 5, 0 }, { 1, 0, 0 }, { 0, 0, 1 });
        b.light({ 0, 0, 0 }, { 0.1f, 0, 0 }, { 0, 0.1f, 0 }, scene::LightProfile::Uniform, 100);
        b.camera({ 0, 0, 3 }, { 0, 0, 0 });
        b.scene.areaLights[0].visible = true;
        b.scene.camera.apertureRadius = 0.2f;
        b.scene.camera.focusDistance = 1.5f;
        render::Renderer renderer(b.scene, device, renderOptions());
        const render::Settings settings = sized(render::axisAligned(600), 64, 48);
        REQUIRE(renderer.render(settings, {}, true).complete);
        const Planes<std::uint32_t> taken =
            planesOf(renderer.frame().layout, renderer.frame().counts("primarySamples").downloadAll(renderer.queue()));
        std::uint32_t most = 0, largest = 0;
        for (int ty = 0; ty < 48; ty += 8)
            for (int tx = 0; tx < 64; tx += 8) {
                std::uint32_t sum = 0;
                for (int y = ty; y < ty + 8; ++y)
                    for (int x = tx; x < tx + 8; ++x) {
                        sum += taken.at(x, y);
                        most = std::max(most, taken.at(x, y));
                    }
                largest = std::max(largest, sum);
            }
        MESSAGE("most samples of a pixel " << most << ", of a tile " << largest);
        CHECK(most > 2048);
        CHECK(largest > 100000);
        // And those of the first pass.
        CHECK(largest <= WEDGE_WAVE_RECEIVERS + 64 * static_cast<std::uint32_t>(settings.distributed.firstPaths));
        requireCropOfWhole(renderer, settings, { 27, 20, 38, 29 }, false);
    });
}

TEST_CASE("a crop of a frame filtered along long motions has the bits of the whole one, with layers and without")
{
    onEveryDevice([](const device::Device& device) {
        // Beyond the reach of filters along motions and of a term after them, from a crop at its left.
        constexpr int across = 340, down = 12;
        const scene::Scene scene = racingWall(down, 600);
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool keepLayers : { false, true }) {
            CAPTURE(keepLayers);
            const render::Settings settings = sized(render::axisAligned(10), across, down);
            requireCropOfWhole(renderer, settings, { 3, 2, 33, 10 }, keepLayers);
        }
    });
}

TEST_CASE(
    "a frame of the image alone takes less than 150 MB at 1024x1024 with an area light and a bounce, 150 MiB in motion")
{
    onEveryDevice([](const device::Device& device) {
        for (const Moves moves : { Moves::Nothing, Moves::Camera, Moves::Geometry }) {
            CAPTURE(static_cast<int>(moves));
            scene::Scene scene = movingWall(moves);
            scene.pointLights.clear();
            scene.materials[0].emission = glm::vec3(0);
            render::Settings settings = sized(render::axisAligned(16), 1024, 1024);
            settings.bounces = 1;
            render::Renderer renderer(scene, device, renderOptions());
            // Motions and deviations together are above the goal of 150 MB (docs/multiple-effects.md).
            const std::uint64_t goal = moves == Moves::Nothing ? 150'000'000u : 150u << 20;
            const bool turns = device.info().failsWithParts; // whole buffers hold more than is in them
            CHECK(renderer.plan(settings).total() < (turns ? goal + goal / 4 : goal));
            CHECK(renderer.plan(settings, true).total() > 300'000'000);
        }
    });
}
