// Frames whose shadows' edges move see beyond their border: against the middle of larger ones, and bits.
#include "host/render/filter_call.h"
#include "host/render/layers.h"
#include "tests/styled_floor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

using namespace wedge;
using namespace wedge::test;
using floors::style;

namespace {

constexpr int wide = 128, high = 96; ///< their margin has 16 pixels
constexpr int more = 24; ///< pixels that a larger frame has beyond each border: other parts of it than a margin has
/// Metres along each side of a pixel on the floor.
const double pixel = 2 * floors::eyeHeight * std::tan(std::numbers::pi / 6) / high;

/// The scene as a camera sees it whose image has `more` pixels beyond each border, and else the same pixels.
scene::Scene wider(scene::Scene scene, int height = high)
{
    const double half = std::tan(glm::radians(0.5 * double { scene.camera.verticalFov }));
    scene.camera.verticalFov = static_cast<float>(glm::degrees(2 * std::atan(half * (height + 2 * more) / height)));
    return scene;
}

/// That middle of a larger frame.
std::vector<float> middleOf(const std::vector<float>& image, int width, int height)
{
    std::vector<float> out;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                out.push_back(image[3
                        * (static_cast<std::size_t>(y + more) * static_cast<std::size_t>(width + 2 * more)
                            + static_cast<std::size_t>(x + more))
                    + static_cast<std::size_t>(c)]);
    return out;
}

/// Hard shadows: the share of light in each pixel.
std::vector<double> hard(const device::Device& device, const scene::Scene& scene, const scene::ShadowStyle& style,
    float margin = render::Settings().styleMargin)
{
    render::Settings s = floors::settings(wide, high);
    s.styleMargin = margin;
    return floors::shares(floors::rendered(device, scene, style, s));
}

std::vector<double> hardMiddle(const device::Device& device, const scene::Scene& scene, const scene::ShadowStyle& style)
{
    const render::Settings s = floors::settings(wide + 2 * more, high + 2 * more);
    return floors::shares(middleOf(floors::rendered(device, wider(scene), style, s), wide, high));
}

double farthestApart(const std::vector<double>& a, const std::vector<double>& b)
{
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

/// A lamp above a board, whose edge is turned and leaves the image on both sides.
scene::Scene underLamp(const std::vector<scene::ShadowStyle>& styles)
{
    SceneBuilder b = floors::underSun();
    b.scene.directionalLights.clear();
    const glm::vec3 along(0.6f, 0, 0.8f), across(0.8f, 0, -0.6f);
    b.quad(glm::vec3(0, 2, 0) - 10.0f * across, 10.0f * along, 10.0f * across);
    b.light({ 0, 4, 0 }, { 0.15f, 0, 0 }, { 0, 0, 0.15f }, scene::LightProfile::Uniform, 40).twoSided = true;
    b.scene.areaLights.front().styles = styles;
    return b.scene;
}

} // namespace

TEST_CASE("edges that leave the image are where a larger image has them")
{
    onEveryDevice([](const device::Device& device) {
        const float right = static_cast<float>(0.5 * wide * pixel), low = static_cast<float>(0.5 * high * pixel);
        const scene::Scene scenes[] = { floors::halfPlane(0.55), floors::halfPlane(-1.2),
            floors::disk(0.4f, { right - 0.1f, 2, low - 0.15f }) };
        for (const scene::Scene& scene : scenes) {
            for (const scene::ShadowStyle& of : { style(0.1f, 0.05f), style(-0.08f, 0.1f) }) {
                const std::vector<double> expected = hardMiddle(device, scene, of);
                CHECK(farthestApart(hard(device, scene, of), expected) < 0.01);
                CHECK(farthestApart(hard(device, scene, of, 0), expected) > 0.1);
            }
        }
        // The blur, too, takes in what lies beyond.
        scene::ShadowStyle smooth = style(0.05f, 0.1f, 0.05f);
        smooth.keepArea = false; // which goes by all that is known
        const std::vector<double> expected = hardMiddle(device, scenes[0], smooth);
        CHECK(farthestApart(hard(device, scenes[0], smooth), expected) < 0.02);
        CHECK(farthestApart(hard(device, scenes[0], smooth, 0), expected) > 0.05);
    });
}

TEST_CASE("a shadow beside the image grows into it, as far as its closed form says")
{
    onEveryDevice([](const device::Device& device) {
        const double radius = 0.2, border = 0.5 * wide * pixel, middle = border + radius + 0.04;
        const scene::Scene beside = floors::disk(static_cast<float>(radius), { static_cast<float>(middle), 2, 0 });
        const std::vector<double> s = hard(device, beside, style(0.16f, 0.05f));
        double outer = radius;
        while (floors::toCircle(radius, outer + 1e-6) < 0.16)
            outer += 1e-5;
        CHECK(middle - outer < border - 3 * pixel);
        // Along the row above the middle: where half of the light is left.
        const std::size_t row = std::size_t { high / 2 - 1 } * wide;
        std::size_t x = wide - 1;
        REQUIRE(s[row + x] < 0.5);
        while (s[row + x - 1] < 0.5)
            --x;
        const double part = (0.5 - s[row + x]) / (s[row + x - 1] - s[row + x]);
        const double edge = (static_cast<double>(x) - part + 0.5 - 0.5 * wide) * pixel;
        CHECK(std::abs(std::hypot(edge - middle, 0.5 * pixel) - outer) < 0.2 * pixel);
        // Unknown, it has no say.
        CHECK(std::ranges::all_of(hard(device, beside, style(0.16f, 0.05f), 0), [](double v) { return v > 0.999; }));
    });
}

TEST_CASE("where no edge moves there is no margin, and where one does numbers stay what they are")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = glossyScene();
        scene.directionalLights.push_back({ { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 } });
        std::vector<scene::ShadowStyle>& styles = scene.directionalLights.front().styles;
        const auto frame = [&](const render::Settings& s) {
            render::Renderer renderer(scene, device, renderOptions());
            const std::vector<float> image = renderPixels(renderer, s);
            CHECK(renderer.frame().layout.margin % WEDGE_BLOCK_PIXELS == 0);
            return std::pair(image, renderer.frame().layout.margin);
        };
        for (render::Settings s : { floors::settings(90, 70), sized(render::axisAligned(16), 90, 70) }) {
            s.bounces = 1;
            for (const auto& unmoved : { std::vector<scene::ShadowStyle> {}, { style(0, 0, 0, 0.3f) } }) {
                styles = unmoved;
                CHECK(frame(s).second == 0);
            }
            styles = { style(0.02f, 0.02f) };
            s.integrator = render::Integrator::AmbientOcclusion;
            s.bounces = 0;
            CHECK(frame(s).second == 0);
        }
        // Random numbers of a pixel go by where it is in the image. Far from the border all else is alike.
        styles = { style(0.02f, 0.02f) };
        render::Settings s = sized(render::monteCarlo(4), 90, 70), without = s;
        s.bounces = without.bounces = 1;
        without.styleMargin = 0;
        // So is the exposure that filters of samples go by, which is of the image.
        for (const bool clamps : { false, true }) {
            CAPTURE(clamps);
            if (clamps)
                s.filters = without.filters = { render::filterCall("--add-filter", "clamp:level=0.3") };
            const auto [image, margin] = frame(s);
            CHECK(margin == 16);
            const std::vector<float> plain = frame(without).first;
            for (int y = 20; y < 50; ++y)
                for (int i = 3 * (y * 90 + 20); i < 3 * (y * 90 + 70); ++i)
                    REQUIRE(image[static_cast<std::size_t>(i)] == plain[static_cast<std::size_t>(i)]);
        }
    });
}

TEST_CASE("a crop at the border has the bits of the whole, and layers and counts are of the image")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = glossyScene();
        scene.directionalLights.push_back(
            { { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 }, "sun", { style(0.05f, 0.1f, 0.1f) } });
        for (render::Settings s : { sized(render::monteCarlo(4), 90, 70), sized(render::axisAligned(16), 90, 70) }) {
            s.bounces = 1;
            render::Options poisoned = renderOptions();
            poisoned.poison = true;
            render::Renderer renderer(scene, device, poisoned);
            const render::FrameStatistics all = renderer.render(s, {}, true);
            CHECK(all.primaryRays == (90 + 32) * (70 + 32));
            CHECK(all.sppMean == doctest::Approx(s.spp).epsilon(0.1));
            CHECK(all.shadedPixels <= 90 * 70);
            const image::LayeredImage layers = render::readLayers(renderer, s, all, { "depth", "shadowMatte" });
            CHECK(layers.width == 90);
            CHECK(layers.window == Window { 0, 0, 90, 70 });
            CHECK(layers.channels.front().values.size() == 90 * 70);
            const std::vector<float> whole = pixels(renderer, "beauty", { 0, 0, 90, 70 });
            for (std::size_t i = 0; i < layers.channels.front().values.size(); ++i)
                REQUIRE(layers.channels.front().values[i] == whole[3 * i]);
            for (const Window& crop : { Window { 0, 0, 30, 20 }, Window { 61, 40, 90, 70 } }) {
                s.crop = crop;
                renderer.render(s);
                const std::vector<float> part = pixels(renderer, "beauty", crop);
                std::size_t k = 0;
                for (int y = crop.y0; y < crop.y1; ++y)
                    for (int i = 3 * (y * 90 + crop.x0); i < 3 * (y * 90 + crop.x1); ++i, ++k)
                        REQUIRE(part[k] == whole[static_cast<std::size_t>(i)]);
            }
        }
    });
}

TEST_CASE("soft shadows at the border are those of a larger image, but for noise")
{
    onEveryDevice([](const device::Device& device) {
        const scene::ShadowStyle moved = style(0.15f);
        const auto frame = [&](const scene::Scene& scene, int w, int h, float margin) {
            render::Settings s = sized(render::axisAligned(32), w, h);
            s.styleMargin = margin;
            render::Renderer renderer(scene, device, renderOptions());
            return renderPixels(renderer, s);
        };
        const scene::Scene scene = underLamp({ moved });
        const std::vector<float> expected =
            middleOf(frame(wider(scene), wide + 2 * more, high + 2 * more, 0.125f), wide, high);
        const float brightest = *std::ranges::max_element(expected);
        // RMS difference up to 6 pixels from the border, and of all else.
        const auto apart = [&](const std::vector<float>& image, bool near) {
            double sum = 0, count = 0;
            for (int y = 0; y < high; ++y)
                for (int x = 0; x < wide; ++x) {
                    const int from = std::min({ x, y, wide - 1 - x, high - 1 - y });
                    const std::size_t i = 3 * (static_cast<std::size_t>(y) * wide + static_cast<std::size_t>(x));
                    const double off = double { image[i] } - expected[i];
                    sum += (from < 6) == near ? off * off : 0;
                    count += (from < 6) == near ? 1 : 0;
                }
            return std::sqrt(sum / count) / brightest;
        };
        const std::vector<float> image = frame(scene, wide, high, 0.125f), cut = frame(scene, wide, high, 0);
        MESSAGE("RMS differences near the border and elsewhere: ", apart(image, true), " ", apart(image, false),
            ", without a margin: ", apart(cut, true), " ", apart(cut, false));
        CHECK(apart(image, true) < 1.5 * apart(image, false) + 0.002);
        CHECK(apart(cut, true) > 3 * apart(image, true));
    });
}
