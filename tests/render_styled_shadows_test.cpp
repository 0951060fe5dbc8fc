// Frames whose lights' shadows have a style: closed forms, what leaves bits as they are, and what may have no effect.
#include "host/error.h"
#include "kernels/shared/styled_shadows.h"
#include "tests/styled_floor.h"

#include <atomic>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::floors;

TEST_CASE("a straight edge moves as far as its inflation says, either way")
{
    onEveryDevice([](const device::Device& device) {
        for (const float inflation : { 0.3f, -0.3f, 0.08f }) {
            CAPTURE(inflation);
            const std::vector<double> s = shares(rendered(device, halfPlane(), style(inflation, 0.1f)));
            CHECK(std::abs(edgeInRow(s, height / 2) - inflation) < 0.005 * std::abs(inflation));
        }
        // Without softness the edge is where a pixel is.
        const std::vector<double> hard = shares(rendered(device, halfPlane(), style(0.3f)));
        CHECK(std::abs(edgeInRow(hard, height / 2) - 0.3) < 0.51 * pixel);
        CHECK(std::ranges::all_of(hard, [](double v) { return v == 0 || v > 0.999; }));
    });
}

TEST_CASE("turned edges are as far away, and what they hide as large")
{
    onEveryDevice([](const device::Device& device) {
        for (const double turn : { 0.2, 0.55, std::numbers::pi / 4 }) {
            CAPTURE(turn);
            const std::vector<double> s = shares(rendered(device, halfPlane(turn), style(0.2f, 0.1f)));
            // The row's middle is half a pixel below that of the image.
            const double moved = edgeInRow(s, height / 2) * std::cos(turn) - 0.5 * pixel * std::sin(turn);
            CHECK(std::abs(moved - 0.2) < 0.01 * 0.2 + 0.2 * pixel);
        }
    });
}

TEST_CASE("distances to a circle are those of its closed form")
{
    onEveryDevice([](const device::Device& device) {
        const double radius = 0.45;
        scene::Scene scene = disk(static_cast<float>(radius));
        scene.directionalLights.front().styles = { style(0.15f, 0.1f) };
        render::Renderer renderer(scene, device, renderOptions());
        renderPixels(renderer, settings(), true);
        const std::vector<float> d = pixels(renderer, "shadowDistance.1", { 0, 0, width, height });
        const std::vector<float> v = pixels(renderer, "shadowMatte.1", { 0, 0, width, height });
        const double largest = 2 * (0.15 + 0.05);
        std::size_t compared = 0;
        double mean = 0, off = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                const double rho = std::hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height) * pixel;
                REQUIRE((d[i] < 0) == (v[i] < 0.5f));
                if (std::abs(rho - radius) < 4 * pixel)
                    continue;
                const double expected = std::min(toCircle(radius, rho), largest);
                off = std::max(off, std::abs(std::abs(d[i]) - expected));
                mean += std::abs(d[i]) / expected - 1;
                ++compared;
            }
        CHECK(compared > 10000);
        CHECK(off < 0.6 * pixel); // near the edge, which is known to a pixel
        CHECK(std::abs(mean / static_cast<double>(compared)) < 0.003);
        // What the moved edge encloses: the disk of the closed form's radius.
        double outer = radius + 0.01;
        while (toCircle(radius, outer) < 0.15)
            outer += 1e-5;
        const double area = areaInShadow(shares(rendered(device, disk(0.45f), style(0.15f, 0.02f))));
        CHECK(std::sqrt(area / std::numbers::pi) - radius == doctest::Approx(outer - radius).epsilon(0.005));
    });
}

TEST_CASE("as published, distances are means over the whole edge, which are less")
{
    onEveryDevice([](const device::Device& device) {
        const double radius = 0.45, length = 2 * std::numbers::pi * radius;
        scene::Scene scene = disk(static_cast<float>(radius));
        scene.directionalLights.front().styles = { style(0.15f, 0.1f) };
        render::Renderer renderer(scene, device, renderOptions());
        renderPixels(renderer, sized(render::asPublished(), width, height), true);
        const std::vector<float> d = pixels(renderer, "shadowDistance.1", { 0, 0, width, height });
        std::size_t compared = 0;
        double mean = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                const double rho = std::hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height) * pixel;
                if (std::abs(rho - radius) < 4 * pixel)
                    continue;
                // Of the sum, by what the other has made of it.
                const double constant = std::sqrt(std::numbers::pi) * std::tgamma(3.5) / std::tgamma(4.0);
                const double phi = constant * std::pow(toCircle(radius, rho), -7);
                const double expected = std::min(std::pow(phi / length, -1.0 / 8), 2 * (0.15 + 0.05));
                REQUIRE(std::abs(d[i]) == doctest::Approx(expected).epsilon(0.15));
                mean += std::abs(d[i]) / expected - 1;
                ++compared;
            }
        CHECK(compared > 10000);
        CHECK(std::abs(mean / static_cast<double>(compared)) < 0.005);
    });
}

TEST_CASE("a style that changes nothing has the bits of none, and so has a scene whose styles are left out")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool point : { false, true }) {
            scene::Scene scene = smallScene();
            scene.materials[0].specular = glm::vec3(0.3f);
            scene.materials[0].exponent = 20;
            const auto change = [&](const std::vector<scene::ShadowStyle>& styles) {
                if (point)
                    scene.pointLights = { { { 1, 3, 2 }, { 4, 3, 2 }, "lamp", styles } };
                else
                    scene.directionalLights = { { { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 }, "sun", styles } };
                return render::Renderer(scene, device, renderOptions());
            };
            render::Renderer plain = change({}), identity = change({ style() }), moved = change({ style(0.1f, 0.1f) });
            render::Settings s = settings(90, 70);
            const std::vector<float> expected = renderPixels(plain, s);
            CHECK(sameBits(renderPixels(identity, s), expected));
            CHECK_FALSE(sameBits(renderPixels(moved, s), expected));
            s.styles = false;
            CHECK(sameBits(renderPixels(moved, s), expected));
            s.antialias = true;
            CHECK(sameBits(renderPixels(moved, s), renderPixels(plain, s)));
        }
    });
}

TEST_CASE("shadows grow with inflation, and brightness is what is left in them")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.areaLights.clear();
        scene.directionalLights.push_back({ { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 } });
        std::vector<float> before;
        for (const float inflation : { -0.2f, -0.1f, -0.03f, 0.0f, 0.03f, 0.1f, 0.2f }) {
            CAPTURE(inflation);
            const std::vector<float> image = rendered(device, scene, style(inflation, 0.1f), settings(90, 70));
            std::size_t brighter = 0;
            for (std::size_t i = 0; i < before.size(); ++i)
                brighter += image[i] > before[i] + 2e-4f ? 1 : 0;
            CHECK(brighter == 0);
            CHECK(image != before);
            before = image;
        }
        const std::vector<double> dim = shares(rendered(device, halfPlane(), style(0, 0, 0, 0.25f)));
        CHECK(at(dim, 20, 20) == doctest::Approx(0.25).epsilon(1e-5));
        CHECK(at(dim, width - 20, 20) == doctest::Approx(1).epsilon(1e-5));
    });
}

TEST_CASE("several styles share a light, each with its colour")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = halfPlane();
        scene::ShadowStyle umbra = style(-0.2f), penumbra = style(0.2f);
        umbra.weight = 0.75f;
        penumbra.weight = 0.25f;
        penumbra.brightness = glm::vec3(0.2f, 0.4f, 0.8f);
        scene.directionalLights.front().styles = { umbra, penumbra };
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<float> image = renderPixels(renderer, settings());
        const auto share = [&](double x, std::size_t channel) {
            const auto column = static_cast<std::size_t>(x / pixel + 0.5 * width);
            return image[3 * (std::size_t { height / 2 } * width + column) + channel] / lit;
        };
        for (const std::size_t channel : { 0u, 1u, 2u }) {
            const double left = penumbra.brightness.constant[static_cast<int>(channel)];
            CHECK(share(-0.4, channel) == doctest::Approx(0.25 * left).epsilon(1e-5));
            CHECK(share(0, channel) == doctest::Approx(0.75 + 0.25 * left).epsilon(1e-5));
            CHECK(share(0.4, channel) == doctest::Approx(1).epsilon(1e-5));
        }
    });
}

TEST_CASE("a floor in shadow stays dark behind what is lit before it")
{
    onEveryDevice([](const device::Device& device) {
        // A board over all of the floor, with a hole whose light a plate just above the floor takes, all of it.
        constexpr float half = 0.4f, plate = half + 0.001f, board = 5;
        SceneBuilder b = underSun();
        const float middle = 0.5f * (board + half), side = 0.5f * (board - half);
        for (const float sign : { -1.0f, 1.0f }) {
            b.quad({ sign * middle, 2, 0 }, { 0, 0, board }, { side, 0, 0 });
            b.quad({ 0, 2, sign * middle }, { 0, 0, side }, { half, 0, 0 });
        }
        b.newObject();
        b.quad({ 0, 0.05f, 0 }, { 0, 0, plate }, { plate, 0, 0 });
        const std::vector<double> image = shares(rendered(device, b.scene, style(-0.05f, 0.2f)));
        const std::vector<double> plain = shares(rendered(device, b.scene, style()));
        std::size_t dark = 0, bright = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            dark += plain[i] == 0 ? 1 : 0;
            bright += plain[i] > 0.99 ? 1 : 0;
            CHECK((plain[i] != 0 || image[i] < 1e-3));
        }
        CHECK(dark > 10000);
        CHECK(bright > 1000);
    });
}

TEST_CASE("what is beyond a style's reach changes no bit")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene one = disk(0.2f, { -0.9f, 2, 0 });
        SceneBuilder b;
        b.scene = disk(0.2f, { -0.9f, 2, 0 });
        b.newObject();
        b.quad({ 1.1f, 2, 0.2f }, { 0, 0, 0.3f }, { 0.2f, 0, 0 });
        const scene::ShadowStyle s = style(0.1f, 0.1f);
        const std::vector<float> alone = rendered(device, one, s), beside = rendered(device, b.scene, s);
        // Three times the largest distance, which is twice 0.15, from the other's edge at x = 0.9.
        std::size_t compared = 0, shadowed = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if ((x + 1 - 0.5 * width) * pixel < 0.9 - 3 * 2 * 0.15 - 2 * pixel) {
                    const std::size_t i = 3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
                    REQUIRE(alone[i] == beside[i]);
                    ++compared;
                    shadowed += alone[i] < 0.9 * lit ? 1 : 0;
                }
        CHECK(compared > 10000);
        CHECK(shadowed > 500);
        CHECK(alone != beside);
    });
}

TEST_CASE("a crop has the bits of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.areaLights.clear();
        scene.directionalLights.push_back({ { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 } });
        for (const float abstraction : { 0.0f, 0.1f }) {
            scene.directionalLights.front().styles = { style(0.05f, 0.1f, abstraction) };
            render::Renderer renderer(scene, device, renderOptions());
            render::Settings s = settings(90, 70);
            const std::vector<float> whole = renderPixels(renderer, s);
            s.crop = { 21, 30, 58, 47 };
            renderer.render(s);
            const std::vector<float> crop = pixels(renderer, "beauty", s.crop);
            std::size_t i = 0;
            for (int y = s.crop.y0; y < s.crop.y1; ++y)
                for (int x = s.crop.x0; x < s.crop.x1; ++x)
                    for (int c = 0; c < 3; ++c, ++i)
                        REQUIRE(crop[i]
                            == whole[3 * (static_cast<std::size_t>(y) * 90 + static_cast<std::size_t>(x))
                                + static_cast<std::size_t>(c)]);
        }
    });
}

TEST_CASE("a smoothed shadow is as large as before, unless that is not wanted, and rounder")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b = underSun();
        b.quad({ 0, 2, 0 }, { 0, 0, 0.3f }, { 0.3f, 0, 0 });
        const double sharp = areaInShadow(shares(rendered(device, b.scene, style())));
        CHECK(sharp == doctest::Approx(0.36).epsilon(0.02));
        scene::ShadowStyle smooth = style(0, 0, 0.12f);
        const std::vector<double> kept = shares(rendered(device, b.scene, smooth));
        CHECK(areaInShadow(kept) == doctest::Approx(sharp).epsilon(0.005));
        smooth.keepArea = false;
        const double shrunk = areaInShadow(shares(rendered(device, b.scene, smooth)));
        CHECK(shrunk < 0.95 * sharp);
        CHECK(shrunk > 0.5 * sharp);
        // The corners are gone, and the sides are out.
        const auto lightAt = [&](double x, double y) {
            return at(kept, static_cast<int>(x / pixel + 0.5 * width), static_cast<int>(y / pixel + 0.5 * height));
        };
        CHECK(lightAt(0.28, 0.28) > 0.99);
        CHECK(lightAt(0.31, 0) == 0);
        CHECK(lightAt(0, -0.31) == 0);
    });
}

TEST_CASE("styles of pixels with several receivers are refused in a line")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = halfPlane();
        scene.directionalLights.front().styles = { style(0.1f) };
        scene.directionalLights.front().name = "sun";
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = settings(16, 16);
        s.antialias = true;
        CHECK_THROWS_WITH_AS(renderer.render(s),
            "styles of shadows are of frames through a pinhole where nothing moves, neither antialiased nor "
            "progressive: style of light sun: add --no-style, or leave out --antialias, --progressive, the lens and "
            "what moves",
            UsageError);
        s.antialias = false;
        s.integrator = render::Integrator::AmbientOcclusion; // which knows no lights
        CHECK_NOTHROW(renderer.render(s));
    });
}

TEST_CASE("a frame is stopped among distances to edges, and is one of numbers")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = disk(0.45f);
        scene.directionalLights.front().styles = { style(0.3f, 0.3f) };
        render::Renderer renderer(scene, device, renderOptions());
        renderer.queue().setTargetMilliseconds(0.05);
        std::atomic<bool> stop { false };
        render::Control control;
        control.cancel = &stop;
        control.progress = [&](double done) { stop = stop || done > 0.999; }; // all rays are traced
        CHECK_FALSE(renderer.render(settings(), control, true).complete);
        CHECK(stop);
        const Window all { 0, 0, width, height };
        const std::vector<float> matte = pixels(renderer, "shadowMatte.1", all);
        const std::vector<float> distance = pixels(renderer, "shadowDistance.1", all);
        CHECK(std::ranges::count_if(matte, [](float v) { return v == WEDGE_MATTE_SHADOW; }) > 1000);
        CHECK(std::ranges::count_if(matte, [](float v) { return v == WEDGE_MATTE_UNKNOWN; }) == 0);
        CHECK(std::ranges::count_if(distance, [](float v) { return v == 0; }) > 1000);
        CHECK(std::ranges::all_of(pixels(renderer, "beauty", all), [](float v) { return std::isfinite(v); }));
        CHECK(renderer.render(settings(), {}, true).complete);
        CHECK(std::ranges::count_if(pixels(renderer, "shadowDistance.1", all), [](float v) { return v == 0; }) == 0);
    });
}
