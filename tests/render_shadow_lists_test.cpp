// Frames in which some things throw shadows in a style, and some have them.
#include "tests/styled_floor.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::floors;

namespace {

/// Two squares beside each other over the floor, and a third above the first.
scene::Scene squares()
{
    SceneBuilder b = underSun();
    b.scene.geometry.objectNames = { "floor/" };
    for (auto& id : b.scene.geometry.objectIds)
        id = 1;
    const auto square = [&](const char* name, glm::vec3 middle, float half) {
        b.scene.geometry.objectNames.emplace_back(name);
        b.quad(middle, { 0, 0, half }, { half, 0, 0 });
    };
    square("left/", { -0.6f, 2, 0 }, 0.3f);
    square("right/", { 0.6f, 2, 0 }, 0.3f);
    square("above/", { -0.3f, 3, 0 }, 0.2f);
    return b.scene;
}

/// The same without some objects.
scene::Scene without(const std::vector<std::uint32_t>& left)
{
    scene::Scene scene = squares();
    scene::Geometry& g = scene.geometry;
    for (std::size_t t = 0; t < g.objectIds.size(); ++t)
        for (std::size_t k = 0; std::ranges::count(left, g.objectIds[t]) > 0 && k < 3; ++k) {
            g.positions[3 * g.indices[3 * t + k] + 1] += 50; // beside the image
            g.positions[3 * g.indices[3 * t + k]] += 50;
        }
    return scene;
}

std::vector<double> sharesOf(
    const device::Device& device, const std::vector<std::string>& casters, scene::ShadowStyle style)
{
    style.casters = casters;
    return shares(rendered(device, squares(), style));
}

} // namespace

TEST_CASE("casters' shadows have the style, and what others throw its own edges: one times the other")
{
    onEveryDevice([](const device::Device& device) {
        const scene::ShadowStyle moved = style(0.1f, 0.1f, 0, 0.3f);
        const std::vector<double> some = sharesOf(device, { "left" }, moved);
        // The same of scenes that have but the one or but the others.
        const std::vector<double> alone = shares(rendered(device, without({ 3, 4 }), moved));
        const std::vector<double> plain = shares(rendered(device, without({ 2 }), style()));
        std::size_t dark = 0, dim = 0;
        for (std::size_t i = 0; i < some.size(); ++i) {
            REQUIRE(some[i] == doctest::Approx(alone[i] * plain[i]).epsilon(1e-4));
            dark += plain[i] == 0 ? 1 : 0;
            dim += plain[i] > 0.9 && some[i] < 0.4 ? 1 : 0;
        }
        CHECK(dark > 1000);
        CHECK(dim > 1000);
    });
}

TEST_CASE("behind 4096 surfaces a ray of casters is dark")
{
    onEveryDevice([](const device::Device& device) {
        const auto middleUnder = [&](int layers) {
            SceneBuilder b = underSun();
            b.scene.geometry.objectNames = { "floor/", "stack/" };
            for (int k = 0; k < layers; ++k)
                b.quad({ 0, 2 + 5e-4f * static_cast<float>(k), 0 }, { 0, 0, 0.3f }, { 0.3f, 0, 0 });
            scene::ShadowStyle s = style(0, 0, 0, 0.5f);
            s.casters = { "stack" };
            const std::vector<float> image = rendered(device, b.scene, s, settings(33, 25));
            return image[3 * (12 * 33 + 16)] / lit;
        };
        CHECK(middleUnder(4090) == doctest::Approx(0.5).epsilon(1e-4));
        CHECK(middleUnder(4100) == 0);
    });
}

TEST_CASE("lists of all things have the bits of none")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle s = style(0.1f, 0.1f, 0.05f, 0.3f);
        const std::vector<float> plain = rendered(device, squares(), s);
        s.casters = { "floor", "left", "right", "above" };
        CHECK(sameBits(rendered(device, squares(), s), plain));
        s.receivers = s.casters;
        CHECK(sameBits(rendered(device, squares(), s), plain));
        s.casters.clear();
        CHECK(sameBits(rendered(device, squares(), s), plain));
    });
}

TEST_CASE("what is no receiver has plain shadows")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.areaLights.clear();
        scene.directionalLights.push_back({ { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 } });
        scene.geometry.objectNames = { "floor/", "box/", "board/", "ball/", "bars/" };
        scene::ShadowStyle s = style(0.1f, 0.1f);
        s.receivers = { "floor" };
        const render::Settings small = settings(90, 70);
        const std::vector<float> some = rendered(device, scene, s, small);
        const std::vector<float> plain = rendered(device, scene, style(), small);
        s.receivers.clear();
        const std::vector<float> all = rendered(device, scene, s, small);
        scene.directionalLights.front().styles = { s };
        render::Renderer renderer(scene, device, renderOptions());
        renderPixels(renderer, small, true);
        const std::vector<std::uint32_t> objects =
            pixels(renderer, renderer.frame().counts("objectId"), { 0, 0, 90, 70 });
        std::size_t differ = 0, other = 0;
        for (std::size_t i = 0; i < objects.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t k = 3 * i + c;
                REQUIRE(some[k] == (objects[i] == 1 ? all[k] : plain[k]));
                differ += some[k] != all[k] ? 1 : 0;
                other += some[k] != plain[k] ? 1 : 0;
            }
        CHECK(differ > 30);
        CHECK(other > 300);
    });
}

TEST_CASE("styles of one light with casters of their own each draw their shadows, one times the other")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle one = style(0.1f, 0.1f), two = style(-0.05f, 0, 0, 0.5f), rest = style(0, 0.05f, 0, 0.25f);
        one.casters = { "left" };
        two.casters = { "right" };
        const auto sharesWith = [&](const scene::Scene& of, const std::vector<scene::ShadowStyle>& styles) {
            scene::Scene scene = of;
            scene.directionalLights.front().styles = styles;
            render::Renderer renderer(scene, device, renderOptions());
            return shares(renderPixels(renderer, settings()));
        };
        const std::vector<double> first = sharesWith(without({ 3, 4 }), { one }),
                                  second = sharesWith(without({ 2, 4 }), { two });
        const std::vector<double> third = sharesWith(without({ 2, 3 }), { rest });
        const std::vector<double> hard = sharesWith(without({ 2, 3 }), { style() });
        const std::vector<double> both = sharesWith(squares(), { one, two }),
                                  all = sharesWith(squares(), { one, rest, two });
        std::size_t inBoth = 0, dim = 0;
        for (std::size_t i = 0; i < both.size(); ++i) {
            REQUIRE(both[i] == doctest::Approx(first[i] * second[i] * hard[i]).epsilon(1e-4));
            // A style without casters is of all that no other style of the light names.
            REQUIRE(all[i] == doctest::Approx(first[i] * second[i] * third[i]).epsilon(1e-3));
            inBoth += first[i] < 0.9 && third[i] < 0.9 ? 1 : 0;
            dim += std::abs(second[i] - 0.5) < 1e-3 ? 1 : 0;
        }
        CHECK(inBoth > 100);
        CHECK(dim > 1000); // wholly in its style
        scene::Scene scene = squares();
        scene.directionalLights.front().styles = { one, two };
        render::Renderer renderer(scene, device, renderOptions());
        renderPixels(renderer, settings(), true);
        const Window whole { 0, 0, width, height };
        CHECK(pixels(renderer, "shadowMatte.1", whole) != pixels(renderer, "shadowMatte.1.2", whole));
        CHECK(pixels(renderer, "shadowDistance.1", whole) != pixels(renderer, "shadowDistance.1.2", whole));
    });
}
