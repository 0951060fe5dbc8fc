// Frames whose environment is lights, where pixels trace rays to few of them, or few pixels do.
#include "effects/shadow_lights/map_lights.h"
#include "tests/image_means.h"
#include "tests/shadow_frames.h"

#include <doctest/doctest.h>

#include <atomic>
#include <bit>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

render::Settings few(Shadows shadows, int lights, int chosen, int side)
{
    render::Settings s = with(shadows, lights);
    s.environment.shadows.chosen = chosen;
    s.environment.shadows.blockSide = side;
    return s;
}

/// Whose shadows are those of things, on surfaces that gloss.
scene::Scene shiny() { return things(spotted(), 0.3f); }

} // namespace

TEST_CASE("where nothing is hidden the whole light is the same to the bit, whatever pixels and lights are traced")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(openGloss(spotted(), scene::SpecularModel::Phong, 60), device, renderOptions());
        const std::vector<float> all = renderPixels(renderer, with(Shadows::Ratio));
        for (const Shadows shadows : { Shadows::Subtractive, Shadows::Ratio }) {
            CHECK(sameBits(all, renderPixels(renderer, few(shadows, 50, 6, 1))));
            for (const int side : { 2, 4, 32 }) {
                CAPTURE(side);
                CHECK(sameBits(all, renderPixels(renderer, few(shadows, 30, 0, side))));
                CHECK(sameBits(all, renderPixels(renderer, few(shadows, 30, 5, side))));
            }
        }
    });
}

TEST_CASE("few pixels or lights take as many rays, which are counted once")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = openFloor();
        render::setEnvironment(b.scene, spotted());
        render::Renderer renderer(b.scene, device, renderOptions());
        std::uint64_t above = 0;
        for (const render::MapLight& light : render::mapLights(*spotted(), 110))
            above += light.towards.y > 0 ? 1 : 0;
        REQUIRE(above > 20);
        const auto rays = [&](int chosen, int side) {
            render::Settings s = few(Shadows::Ratio, 110, chosen, side);
            const std::uint64_t counted = renderer.render(s, {}, true).shadowRays;
            double shown = 0;
            for (const float n : pixels(renderer, "rays", { 0, 0, width, height }))
                shown += std::bit_cast<std::uint32_t>(n);
            CHECK(shown == doctest::Approx(static_cast<double>(counted) + width * height));
            return counted;
        };
        CHECK(rays(0, 2) == above * 20 * 15);
        CHECK(rays(0, 4) == above * 10 * 8);
        CHECK(rays(7, 1) == 7u * width * height);
        CHECK(rays(7, 4) == 7u * 10 * 8);
        CHECK(rays(64, 1) == std::min<std::uint64_t>(above, 64) * width * height);
    });
}

TEST_CASE("few pixels say about what all do, and what they know nothing of is traced")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(shiny(), device, renderOptions());
        for (const Shadows shadows : { Shadows::Subtractive, Shadows::Ratio }) {
            const std::vector<float> all = renderPixels(renderer, few(shadows, 30, 0, 1));
            const double mean = meanOf(all, 1).value;
            double before = 0;
            CHECK(notFinite(renderPixels(renderer, few(shadows, 30, 0, 32))) == 0); // two pixels of this image
            for (const int side : { 2, 4 }) {
                CAPTURE(side);
                const std::vector<float> some = renderPixels(renderer, few(shadows, 30, 0, side));
                CHECK(notFinite(some) == 0);
                CHECK(meanOf(some, 1).value == doctest::Approx(mean).epsilon(0.05));
                const double error = rmse(some, all);
                CHECK(error < 0.3 * mean);
                CHECK(error > before);
                before = 0.5 * error;
            }
        }
    });
}

TEST_CASE("the lights that bring most take the most of the light that is hidden")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(shiny(), device, renderOptions());
        const std::vector<float> all = renderPixels(renderer, with(Shadows::Ratio, 60));
        double before = 1e9;
        for (const int chosen : { 4, 12, 50 }) {
            const double error = rmse(renderPixels(renderer, few(Shadows::Ratio, 60, chosen, 1)), all);
            CHECK(error < before);
            before = 0.7 * error;
        }
    });
}

TEST_CASE("black things choose lights, too: what lies beside them goes by what they see")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene lit = things(spotted()), dark = lit;
        dark.materials[0].diffuse = glm::vec3(0);
        render::Renderer bright(lit, device, renderOptions()), black(dark, device, renderOptions());
        const render::Settings s = few(Shadows::Ratio, 30, 5, 1);
        CHECK(bright.render(s).shadowRays == black.render(s).shadowRays);
        CHECK(black.render(s).shadowRays > 1000);
    });
}

TEST_CASE("crops of few pixels and lights have the bits of the whole, whatever lay in the memory")
{
    onEveryDevice([](const device::Device& device) {
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(shiny(), device, renderOptions()), other(shiny(), device, poisoned);
        const image::Window crop { 7, 5, 31, 22 };
        for (const int side : { 1, 2, 4, 32 }) {
            CAPTURE(side);
            render::Settings s = few(Shadows::Ratio, 30, side == 2 ? 0 : 6, side);
            renderPixels(renderer, s);
            const std::vector<float> whole = pixels(renderer, "beauty", crop);
            s.crop = crop;
            other.render(s);
            CHECK(sameBits(whole, pixels(other, "beauty", crop)));
        }
    });
}

TEST_CASE("a frame of few pixels that is stopped has finite light")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(shiny(), device, renderOptions());
        for (const int chosen : { 0, 8 })
            for (const double share : { 0.0, 0.4, 0.6, 0.9 }) {
                std::atomic<bool> stop = false;
                render::Control control;
                control.cancel = &stop;
                control.progress = [&](double done) { stop = stop || done >= share; };
                renderer.render(few(Shadows::Ratio, 400, chosen, 4), control);
                const std::vector<float> part = pixels(renderer, "beauty", { 0, 0, width, height });
                CHECK(notFinite(part) == 0);
                CHECK(*std::ranges::min_element(part) >= 0);
            }
    });
}
