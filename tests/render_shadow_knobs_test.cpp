// Frames whose shadows go by how far away what throws them is: closed forms under a slanted board.
#include "tests/styled_floor.h"

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::floors;

namespace {

constexpr double least = 3, slope = 0.5;

/// In shadow is what has x < 0, under a board that is least + slope z above the floor.
scene::Scene underBoard()
{
    SceneBuilder b = underSun();
    b.quad({ -10, static_cast<float>(least), 0 }, { 0, static_cast<float>(10 * slope), 10 }, { 10, 0, 0 });
    return b.scene;
}

double at(const scene::Knob<float>& knob, double d)
{
    return double { knob.constant } + d * (double { knob.linear } + d * double { knob.square });
}

struct Compared {
    double worst = 0, mean = 0;
    unsigned pixels = 0;
};

/// Shares beside those of a straight edge, between them and the image's upper and lower border.
Compared compare(const std::vector<double>& image, const scene::ShadowStyle& style)
{
    Compared out;
    for (int y = height / 4; y < 3 * height / 4; ++y)
        for (int x = 0; x < width; ++x) {
            const double across = (x + 0.5 - 0.5 * width) * pixel;
            const double d = least + slope * (y + 0.5 - 0.5 * height) * pixel;
            if (std::abs(across) < 3 * pixel)
                continue;
            const double left =
                std::clamp(double { style.brightness.constant.x } + d * double { style.brightness.linear.x }, 0.0, 1.0);
            const double t = std::clamp((across - at(style.inflation, d)) / at(style.softness, d) + 0.5, 0.0, 1.0);
            const double expected = left + (1 - left) * t * t * (3 - 2 * t);
            const double off = floors::at(image, x, y) - expected;
            out.worst = std::max(out.worst, std::abs(off));
            out.mean += off;
            ++out.pixels;
        }
    out.mean /= out.pixels;
    return out;
}

} // namespace

TEST_CASE("a straight edge moves and softens with the distance of what throws it, as its closed form")
{
    onEveryDevice([](const device::Device& device) {
        for (const float sign : { 1.0f, -1.0f }) {
            CAPTURE(sign);
            scene::ShadowStyle s;
            s.inflation = { -0.1f * sign, 0.05f * sign, 0.02f * sign };
            s.softness = { 0.4f, -0.15f, 0.02f };
            s.brightness = { glm::vec3(0.9f), glm::vec3(-0.2f), glm::vec3(0) };
            const std::vector<double> image = shares(rendered(device, underBoard(), s));
            const Compared c = compare(image, s);
            CHECK(c.pixels > 20000);
            CHECK(c.worst < 0.02);
            CHECK(std::abs(c.mean) < 0.001);
            // The edge itself, in rows that are least and most away.
            for (const int y : { height / 4, height / 2, 3 * height / 4 }) {
                const double d = least + slope * (y + 0.5 - 0.5 * height) * pixel;
                scene::ShadowStyle dark = s;
                dark.brightness = glm::vec3(0.0f);
                const double moved = edgeInRow(shares(rendered(device, underBoard(), dark)), y);
                CHECK(moved == doctest::Approx(at(s.inflation, d)).epsilon(0.01));
            }
        }
    });
}

TEST_CASE("abstraction goes by the distance of what throws the shadow")
{
    onEveryDevice([](const device::Device& device) {
        // Two squares' shadows, of one size: the upper square's is smoothed, the lower one's is not.
        const auto squares = [](float lower) {
            SceneBuilder b = underSun();
            b.quad({ -0.6f, 4, 0 }, { 0, 0, 0.3f }, { 0.3f, 0, 0 });
            b.newObject();
            b.quad({ 0.6f, lower, 0 }, { 0, 0, 0.3f }, { 0.3f, 0, 0 });
            return b.scene;
        };
        scene::ShadowStyle s;
        s.abstraction = { -0.2f, 0.08f, 0 }; // 0.12 at 4 m, none below 2.5 m
        s.keepArea = false;
        const std::vector<double> image = shares(rendered(device, squares(2), s));
        const std::vector<double> plain = shares(rendered(device, squares(2), style()));
        double before[2] = {}, after[2] = {};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                before[x < width / 2 ? 0 : 1] += 1 - floors::at(plain, x, y);
                after[x < width / 2 ? 0 : 1] += 1 - floors::at(image, x, y);
            }
        CHECK(after[0] < 0.95 * before[0]);
        CHECK(after[1] == doctest::Approx(before[1]).epsilon(0.002));
    });
}

TEST_CASE("brightness alone goes by what hides each pixel's light, without edges")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle s;
        s.brightness = { glm::vec3(0.0f), glm::vec3(0.1f), glm::vec3(0) };
        const std::vector<double> image = shares(rendered(device, underBoard(), s));
        for (const int y : { 5, height / 2, height - 5 }) {
            const double d = least + slope * (y + 0.5 - 0.5 * height) * pixel;
            CHECK(floors::at(image, 10, y) == doctest::Approx(0.1 * d).epsilon(1e-3));
            CHECK(floors::at(image, width - 10, y) == doctest::Approx(1).epsilon(1e-5));
        }
    });
}

TEST_CASE("as published, edges move the farther the farther what throws them is")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle s;
        s.inflation = { 0, 0.05f, 0 };
        s.softness = 0.1f;
        const std::vector<double> image =
            shares(rendered(device, underBoard(), s, sized(render::asPublished(), width, height)));
        const double near = edgeInRow(image, height / 4), far = edgeInRow(image, 3 * height / 4);
        CHECK(near > 0.02);
        CHECK(far > 1.1 * near);
    });
}

TEST_CASE("a crop of shadows by distance has the bits of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = underBoard();
        scene::ShadowStyle s;
        s.inflation = { 0.1f, 0.02f, 0 };
        s.abstraction = { 0.0f, 0.01f, 0 };
        scene.directionalLights.front().styles = { s };
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings small = settings(90, 70);
        const std::vector<float> whole = renderPixels(renderer, small);
        small.crop = { 21, 30, 58, 47 };
        renderer.render(small);
        const std::vector<float> crop = pixels(renderer, "beauty", small.crop);
        std::size_t i = 0;
        for (int y = small.crop.y0; y < small.crop.y1; ++y)
            for (int x = small.crop.x0; x < small.crop.x1; ++x)
                for (int c = 0; c < 3; ++c, ++i)
                    REQUIRE(crop[i]
                        == whole[3 * (static_cast<std::size_t>(y) * 90 + static_cast<std::size_t>(x))
                            + static_cast<std::size_t>(c)]);
    });
}
