// Frames whose environment is lights: against directional lights, closed forms, plain sampling, and each other.
#include "effects/environment/suns.h"
#include "effects/shadow_lights/map_lights.h"
#include "host/error.h"
#include "tests/image_means.h"
#include "tests/shadow_frames.h"

#include <doctest/doctest.h>

#include <atomic>
#include <numbers>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

constexpr Shadows ways[] = { Shadows::Additive, Shadows::Subtractive, Shadows::Ratio };

} // namespace

TEST_CASE("texels of light on black light as directional lights do")
{
    onEveryDevice([](const device::Device& device) {
        auto map = even(glm::vec3(0), 128, 64);
        const glm::ivec2 bright[] = { { 10, 12 }, { 40, 20 }, { 64, 8 }, { 80, 26 }, { 120, 17 } };
        scene::Scene lamps = things(nullptr, 0.3f);
        for (const glm::ivec2& at : bright) {
            const int x = at.x, y = at.y;
            set(*map, x, y, { 600, 500, 400 });
            const double pi = std::numbers::pi, angle = 2 * pi * ((x + 0.5) / 128 - 0.5), down = pi * (y + 0.5) / 64;
            const glm::dvec3 towards(
                std::sin(down) * std::sin(angle), std::cos(down), -std::sin(down) * std::cos(angle));
            const double solidAngle = 2 * pi / 128 * (std::cos(pi * y / 64) - std::cos(pi * (y + 1) / 64));
            lamps.directionalLights.push_back(
                { -glm::vec3(towards), static_cast<float>(solidAngle) * glm::vec3(600, 500, 400) });
        }
        map->seen = false;
        render::Renderer byMap(things(map, 0.3f), device, renderOptions()), byLamps(lamps, device, renderOptions());
        const std::vector<float> a = renderPixels(byMap, with(Shadows::Additive, 5)),
                                 b = renderPixels(byLamps, sized(render::monteCarlo(1), width, height));
        std::size_t differ = 0, lit = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            differ += std::abs(a[i] - b[i]) > 2e-4f * (0.01f + b[i]) ? 1 : 0;
            lit += b[i] > 0.1f ? 1 : 0;
        }
        CHECK(lit > a.size() / 2);
        CHECK(differ <= 30); // rays through edges
    });
}

TEST_CASE("under an even map the whole light is its reflectance of it, and nothing hidden takes nothing")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const Shadows shadows : { Shadows::Subtractive, Shadows::Ratio })
            checkMean(renderPixels(renderer, with(shadows)), sky * reflectance, 2e-3);
        checkMean(renderPixels(renderer, with(Shadows::Additive, 600)), sky * reflectance, 0.02);
        checkMean(renderPixels(renderer, with(Shadows::Ratio, 600, WholeLight::Lights)), sky * reflectance, 0.02);
    });
}

TEST_CASE("where nothing is hidden all ways but the sum have the bits of the whole light, of every lobe")
{
    onEveryDevice([](const device::Device& device) {
        struct Lobe {
            scene::SpecularModel model;
            float exponent;
        };
        const Lobe models[] = { { scene::SpecularModel::Phong, 500 }, { scene::SpecularModel::BlinnPhong, 60 },
            { scene::SpecularModel::Ggx, 1 } };
        for (const Lobe& lobe : models) {
            CAPTURE(lobe.exponent);
            render::Renderer renderer(openGloss(spotted(), lobe.model, lobe.exponent), device, renderOptions());
            const std::vector<float> ratio = renderPixels(renderer, with(Shadows::Ratio));
            CHECK(sameBits(ratio, renderPixels(renderer, with(Shadows::Subtractive))));
            CHECK(sameBits(ratio, renderPixels(renderer, with(Shadows::Ratio, 7)))); // whatever the number of lights
            const std::vector<float> lights = renderPixels(renderer, with(Shadows::Additive));
            CHECK(sameBits(lights, renderPixels(renderer, with(Shadows::Ratio, 30, WholeLight::Lights))));
            CHECK(sameBits(lights, renderPixels(renderer, with(Shadows::Subtractive, 30, WholeLight::Lights))));
            CHECK_FALSE(sameBits(lights, ratio));
            // What plain sampling says.
            render::Settings plain = sized(render::monteCarlo(256), width, height);
            const double expected = meanOf(renderPixels(renderer, plain), 1).value;
            CHECK(meanOf(ratio, 1).value == doctest::Approx(expected).epsilon(0.05));
        }
    });
}

TEST_CASE("with the lights' own light for the whole all ways are one, within rounding")
{
    onEveryDevice([](const device::Device& device) {
        for (const float specular : { 0.0f, 0.3f }) {
            render::Renderer renderer(things(spotted(), specular), device, renderOptions());
            const std::vector<float> additive = renderPixels(renderer, with(Shadows::Additive));
            for (const Shadows shadows : { Shadows::Subtractive, Shadows::Ratio }) {
                const std::vector<float> other = renderPixels(renderer, with(shadows, 30, WholeLight::Lights));
                double most = 0;
                for (std::size_t i = 0; i < other.size(); ++i)
                    most = std::max(most, std::abs(double { other[i] } - additive[i]));
                CHECK(most <= 4 * std::numeric_limits<float>::epsilon() * *std::ranges::max_element(additive));
            }
        }
    });
}

TEST_CASE("many lights converge to plain sampling, suns of their own included")
{
    onEveryDevice([](const device::Device& device) {
        auto map = even({ 0.6f, 0.7f, 0.9f }, 64, 32);
        for (int x = 0; x < 64; ++x)
            for (int y = 16; y < 32; ++y)
                set(*map, x, y, glm::vec3(0.2f));
        for (int x = 20; x < 28; ++x)
            set(*map, x, 9, { 8, 6, 4 });
        set(*map, 44, 8, { 2000, 1800, 1500 });
        render::separateSuns(*map);
        REQUIRE(map->suns.size() == 1);
        scene::Scene scene = things(map, 0.2f, 30);
        for (const scene::AreaLight& sun : render::sunLights(*map, scene::sceneBounds(scene)))
            scene.areaLights.push_back(sun);
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings plain = sized(render::monteCarlo(512), width, height);
        const std::vector<float> truth = renderPixels(renderer, plain);
        struct Way {
            Shadows shadows;
            int lights;
            double error;
        };
        for (const Way& way : { Way { Shadows::Additive, 1500, 0.02 }, Way { Shadows::Subtractive, 300, 0.05 },
                 Way { Shadows::Ratio, 300, 0.03 }, Way { Shadows::Ratio, 40, 0.05 } }) {
            CAPTURE(way.lights);
            render::Settings s = with(way.shadows, way.lights);
            s.spp = 512; // of the sun
            const std::vector<float> image = renderPixels(renderer, s);
            for (const std::size_t channel : { 0u, 2u })
                CHECK(meanOf(image, channel).value == doctest::Approx(meanOf(truth, channel).value).epsilon(way.error));
            CHECK(rmse(image, truth) < 3 * way.error * meanOf(truth, 1).value);
        }
    });
}

TEST_CASE("crops have the bits of the whole, whatever lay in the memory, filtered or not")
{
    onEveryDevice([](const device::Device& device) {
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        const scene::Scene scene = things(spotted(), 0.3f);
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, poisoned);
        const image::Window crop { 7, 5, 31, 22 };
        for (const bool filtered : { false, true })
            for (const Shadows shadows : ways) {
                CAPTURE(filtered);
                render::Settings s = with(shadows);
                if (filtered) {
                    const render::EnvironmentSettings environment = s.environment;
                    s = sized(render::axisAligned(16), width, height);
                    s.environment.shadows = environment.shadows;
                }
                renderPixels(renderer, s);
                const std::vector<float> whole = pixels(renderer, "beauty", crop);
                s.crop = crop;
                other.render(s);
                const std::vector<float> part = pixels(other, "beauty", crop);
                CHECK(notFinite(part) == 0);
                CHECK(sameBits(whole, part));
            }
    });
}

TEST_CASE("no light is below 0 but where that is asked for, and pixels that would be are counted")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(things(spotted(), 0.5f, 300), device, renderOptions());
        const auto least = [](const std::vector<float>& image) { return *std::ranges::min_element(image); };
        const image::Window whole { 0, 0, width, height };
        const render::FrameStatistics clamped = renderer.render(with(Shadows::Subtractive, 12));
        CHECK(clamped.clampedPixels.value_or(0) > 0);
        CHECK(least(pixels(renderer, "beauty", whole)) >= 0);
        const std::vector<float> kept = pixels(renderer, "beauty", whole);
        const render::FrameStatistics open = renderer.render(with(Shadows::Subtractive, 12, WholeLight::Map, false));
        CHECK_FALSE(open.clampedPixels);
        const std::vector<float> below = pixels(renderer, "beauty", whole);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < below.size(); i += 3) {
            bool any = false;
            for (std::size_t c = 0; c < 3; ++c) {
                REQUIRE(below[i + c] <= kept[i + c]);
                any |= below[i + c] < kept[i + c];
            }
            differ += any ? 1 : 0;
        }
        CHECK(differ == clamped.clampedPixels.value_or(0));
        CHECK_FALSE(renderer.render(with(Shadows::Ratio, 12)).clampedPixels);
    });
}

TEST_CASE("a ray is traced for each light in front of a surface, and counted")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const int lights : { 11, 150 }) { // in one launch, and in two
            std::uint64_t above = 0;
            for (const render::MapLight& light : render::mapLights(*spotted(), static_cast<std::size_t>(lights)))
                above += light.towards.y > 0 ? 1 : 0;
            const render::FrameStatistics statistics = renderer.render(with(Shadows::Additive, lights));
            CHECK(statistics.shadowRays == above * width * height);
        }
    });
}

TEST_CASE("what is not direct light of the map stays as it was, and so do frames without these lights")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = things(spotted(), 0.3f);
        scene.pointLights.push_back({ { 0.5f, 1.5f, 1 }, { 2, 3, 4 } });
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings sampled = with(Shadows::Sampled), lights = with(Shadows::Ratio);
        sampled.bounces = lights.bounces = 1;
        sampled.spp = lights.spp = 4;
        const image::Window whole { 0, 0, width, height };
        renderer.render(sampled, {}, true);
        const std::vector<float> direct = pixels(renderer, "direct", whole),
                                 indirect = pixels(renderer, "indirect", whole);
        renderer.render(lights, {}, true);
        CHECK(sameBits(indirect, pixels(renderer, "indirect", whole)));
        CHECK_FALSE(sameBits(direct, pixels(renderer, "direct", whole)));
        // The rest of the settings has no say where they are not chosen.
        render::Settings other = sampled;
        other.environment.shadows = { Shadows::Sampled, 9, WholeLight::Lights, false, 3, 4 };
        renderer.render(other, {}, true);
        CHECK(sameBits(direct, pixels(renderer, "direct", whole)));
    });
}

TEST_CASE("a frame that is stopped has the lights that were taken")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(things(spotted(), 0.3f), device, renderOptions());
        for (const Shadows shadows : ways) {
            const render::Settings settings = with(shadows, 600);
            const std::vector<float> whole = renderPixels(renderer, settings);
            std::size_t lit = 0, darker = 0;
            for (const double share : { 0.0, 0.3, 0.5, 0.7 }) {
                std::atomic<bool> stop = false;
                render::Control control;
                control.cancel = &stop;
                control.progress = [&](double done) { stop = stop || done >= share; };
                if (renderer.render(settings, control).complete)
                    continue;
                CHECK(notFinite(pixels(renderer, "beauty", { 0, 0, width, height })) == 0);
                const std::vector<float> part = pixels(renderer, "beauty", { 0, 0, width, height });
                for (std::size_t i = 0; i < part.size(); ++i) {
                    REQUIRE(part[i] >= 0);
                    lit += part[i] > 0 ? 1 : 0;
                    if (shadows != Shadows::Additive)
                        continue;
                    REQUIRE(part[i] <= whole[i] * 1.0001f + 1e-5f);
                    darker += part[i] < 0.99f * whole[i] ? 1 : 0;
                }
            }
            CHECK(lit > 0);
            if (shadows == Shadows::Additive)
                CHECK(darker > 0);
        }
    });
}

TEST_CASE("frames of several receivers a pixel have no such lights, and neither do too many")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = things(spotted());
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = with(Shadows::Ratio);
        s.antialias = true;
        CHECK_THROWS_WITH_AS(renderer.render(s),
            "shadows of lights are of frames through a pinhole where nothing moves, neither antialiased nor "
            "progressive: --shadows ratio: leave it out, or leave out --antialias, --progressive, the lens and what "
            "moves",
            UsageError);
        for (const int chosen : { -1, 31, 65 }) {
            render::Settings chooses = with(Shadows::Ratio, chosen == 65 ? 100 : 30);
            chooses.environment.shadows.chosen = chosen;
            CHECK_THROWS_AS(renderer.render(chooses), UsageError);
        }
        for (const int side : { 0, 3, 8, 64 }) {
            render::Settings few = with(Shadows::Ratio);
            few.environment.shadows.blockSide = side;
            CHECK_THROWS_AS(renderer.render(few), UsageError);
        }
        for (const int lights : { 0, -1, 4097 })
            CHECK_THROWS_AS(renderer.render(with(Shadows::Ratio, lights)), UsageError);
        CHECK_THROWS_AS(renderer.render(with(Shadows::Ratio, 2049)), UsageError); // 64 x 32 places
        scene.camera.apertureRadius = 0.1f;
        render::Renderer lens(scene, device, renderOptions());
        CHECK_THROWS_AS(lens.render(with(Shadows::Additive)), UsageError);
        // Without an environment there is nothing to do.
        scene = things(nullptr);
        render::Renderer nothing(scene, device, renderOptions());
        CHECK(meanOf(renderPixels(nothing, with(Shadows::Ratio)), 0).value == 0);
    });
}
