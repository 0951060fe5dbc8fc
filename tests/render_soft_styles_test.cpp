// Frames whose soft shadows have a style: against the same frames without one, moved; bits; and what is refused.
#include "host/error.h"
#include "tests/styled_floor.h"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::floors;

namespace {

constexpr int wide = 192, high = 48;
/// Metres along each side of a pixel on the floor.
const double softPixel = 2 * eyeHeight * std::tan(std::numbers::pi / 12) / high;

render::Settings filtered(int spp = 64) { return sized(render::axisAligned(spp), wide, high); }

/// A lamp of 0.6 m, 4 m above the floor; a board at half of that hides what has x < 0, with a penumbra of 0.6 m.
scene::Scene underLamp(const std::vector<scene::ShadowStyle>& styles, bool board = true, bool specular = false)
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = glm::vec3(0.8f);
    b.scene.materials[0].specular = glm::vec3(specular ? 0.2f : 0.0f);
    b.scene.materials[0].exponent = 8;
    b.quad({ 0, 0, 0 }, { 0, 0, 10 }, { 10, 0, 0 });
    b.newObject();
    if (board)
        b.quad({ -10, 2, 0 }, { 0, 0, 10 }, { 10, 0, 0 });
    b.newObject();
    b.camera({ 0, eyeHeight, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 30);
    scene::AreaLight& light = b.light({ 0, 4, 0 }, { 0.3f, 0, 0 }, { 0, 0, 0.3f }, scene::LightProfile::Uniform, 10);
    light.twoSided = true;
    light.styles = styles;
    return b.scene;
}

std::vector<float> frameOf(
    const device::Device& device, const scene::Scene& scene, const render::Settings& s = filtered())
{
    render::Renderer renderer(scene, device, renderOptions());
    return renderPixels(renderer, s);
}

/// What is seen of the light in each column, of one colour: the mean over its pixels.
std::vector<double> seenByColumn(
    const std::vector<float>& image, const std::vector<float>& open, std::size_t colour = 0)
{
    std::vector<double> out;
    for (std::size_t x = 0; x < wide; ++x) {
        double sum = 0, all = 0;
        for (std::size_t y = 0; y < high; ++y) {
            sum += double { image[3 * (y * wide + x) + colour] };
            all += double { open[3 * (y * wide + x) + colour] };
        }
        out.push_back(sum / all);
    }
    return out;
}

double between(const std::vector<double>& seen, double x)
{
    const double at = std::clamp(x, 0.0, wide - 1.001);
    const auto k = static_cast<std::size_t>(at);
    return seen[k] + (seen[k + 1] - seen[k]) * (at - static_cast<double>(k));
}

scene::ShadowStyle penumbra(float of, float inflation = 0)
{
    scene::ShadowStyle out = style(inflation);
    out.penumbra = of;
    return out;
}

} // namespace

TEST_CASE("a penumbra moves as far as its inflation says, with its profile")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, false));
        const std::vector<double> plain = seenByColumn(frameOf(device, underLamp({})), open);
        for (const float inflation : { 0.15f, -0.2f }) {
            CAPTURE(inflation);
            const std::vector<double> s = seenByColumn(frameOf(device, underLamp({ style(inflation) })), open);
            for (int x = 30; x < wide - 30; ++x) {
                CAPTURE(x);
                REQUIRE(std::abs(s[static_cast<std::size_t>(x)] - between(plain, x - inflation / softPixel))
                    < 0.016); // less than half a pixel
            }
        }
    });
}

TEST_CASE("a penumbra narrows about its middle to what is said, down to an edge")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, false)), image = frameOf(device, underLamp({}));
        const auto atMiddle = [&](float of, double v) { return std::clamp((v - 0.5) / double { of } + 0.5, 0.0, 1.0); };
        const auto narrow = [&](float of) { return frameOf(device, underLamp({ penumbra(of) })); };
        const std::vector<float> half = narrow(0.5f), none = narrow(0);
        std::size_t inside = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            const double v = double { image[i] } / open[i];
            REQUIRE(std::abs(double { half[i] } / open[i] - atMiddle(0.5f, v)) < 0.02); // where noise stays

            REQUIRE((std::abs(v - 0.5) < 0.02 || std::abs(double { none[i] } / open[i] - (v > 0.5 ? 1 : 0)) < 0.02));
            inside += v > 0.3 && v < 0.7 ? 1 : 0;
        }
        CHECK(inside > 300);
        // Moved as well, the edge is where half of the light is seen, and as much farther.
        const std::vector<double> s = seenByColumn(frameOf(device, underLamp({ penumbra(0, 0.2f) })), open);
        const std::vector<double> plain = seenByColumn(image, open);
        const auto edge = [](const std::vector<double>& v) {
            return static_cast<double>(std::ranges::find_if(v, [](double is) { return is >= 0.5; }) - v.begin());
        };
        CHECK(std::abs((edge(s) - edge(plain)) * softPixel - 0.2) < 1.01 * softPixel);
    });
}

TEST_CASE("softness and abstraction keep the middle of a straight penumbra, and what is left in shadow is a colour")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, false));
        const std::vector<double> plain = seenByColumn(frameOf(device, underLamp({})), open);
        const auto half = [](const std::vector<double>& v) {
            std::size_t x = 0;
            while (v[x + 1] < 0.5)
                ++x;
            return static_cast<double>(x) + (0.5 - v[x]) / (v[x + 1] - v[x]);
        };
        for (const scene::ShadowStyle& styled : { style(0, 0.5f), style(0, 0, 0.1f) }) {
            const std::vector<double> s = seenByColumn(frameOf(device, underLamp({ styled })), open);
            CHECK(std::abs(half(s) - half(plain)) < 1.0);
            if (styled.softness.constant > 0) // wider by its own width
                CHECK(s[96 + 14] < plain[96 + 14] - 0.02);
        }
        scene::ShadowStyle blue = style(0.1f);
        blue.brightness = glm::vec3(0.25f, 0, 0.5f);
        const std::vector<float> image = frameOf(device, underLamp({ blue }));
        for (std::size_t c = 0; c < 3; ++c) {
            const std::vector<double> s = seenByColumn(image, open, c);
            CHECK(s[20] == doctest::Approx(double { blue.brightness.constant[static_cast<int>(c)] }).epsilon(1e-3));
            CHECK(s[wide - 20] == doctest::Approx(1.0).epsilon(1e-3));
        }
    });
}

TEST_CASE("soft shadows grow with inflation, everywhere")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, false, true));
        std::vector<float> before;
        for (const float inflation : { -0.2f, -0.05f, 0.0f, 0.05f, 0.2f }) {
            const std::vector<float> image = frameOf(device, underLamp({ style(inflation, 0.01f) }, true, true));
            // In all by some of what they move by.
            const auto sum = [](const std::vector<float>& of) { return std::accumulate(of.begin(), of.end(), 0.0); };
            CHECK((before.empty() || sum(image) < sum(before) - 0.005 * sum(open)));
            for (std::size_t i = 0; i < before.size(); ++i)
                REQUIRE(image[i] <= before[i] + 0.02f * open[i]);
            CHECK(std::ranges::all_of(image, [](float v) { return std::isfinite(v) && v >= 0; }));
            before = image;
        }
    });
}

TEST_CASE("a soft style that changes nothing has the bits of none, on matt surfaces and with lobes")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle keys; // as it is now, and would be otherwise later
        keys.keys = { scene::ShadowStyle(), style(0.2f) };
        scene::ShadowStyle elsewhere = style(0.2f, 0.1f, 0.1f, 0.3f);
        elsewhere.receivers = { "object" };
        for (const bool specular : { false, true }) {
            CAPTURE(specular);
            const std::vector<float> plain = frameOf(device, underLamp({}, true, specular));
            scene::Scene others = underLamp({ elsewhere }, true, specular);
            others.geometry.objectNames = { "floor", "object" };
            CHECK(sameBits(frameOf(device, others), plain));
            for (const auto& styles : { std::vector { scene::ShadowStyle() }, { keys }, { keys, keys } }) {
                std::vector<scene::ShadowStyle> shared = styles;
                for (scene::ShadowStyle& each : shared)
                    each.weight = 1.0f / static_cast<float>(shared.size());
                CHECK(sameBits(frameOf(device, underLamp(shared, true, specular)), plain));
            }
            render::Settings without = filtered();
            without.styles = false;
            CHECK(sameBits(frameOf(device, underLamp({ style(0.2f) }, true, specular), without), plain));
        }
    });
}

TEST_CASE("a crop of a soft style has the bits of the whole, and weights share the light")
{
    onEveryDevice([](const device::Device& device) {
        scene::ShadowStyle first = style(0.1f, 0.05f, 0.05f), second = style(-0.1f, 0.1f);
        first.weight = 0.25f;
        second.weight = 0.75f;
        render::Renderer renderer(underLamp({ first, second }), device, renderOptions());
        const std::vector<float> whole = renderPixels(renderer, filtered(16));
        render::Settings part = filtered(16);
        part.crop = { 70, 10, 130, 40 };
        renderPixels(renderer, part);
        const std::vector<float> crop = pixels(renderer, "beauty", part.crop);
        std::size_t k = 0;
        for (int y = 10; y < 40; ++y)
            for (int x = 70; x < 130; ++x)
                for (int c = 0; c < 3; ++c, ++k)
                    REQUIRE(crop[k]
                        == whole[3 * (static_cast<std::size_t>(y) * wide + static_cast<std::size_t>(x))
                            + static_cast<std::size_t>(c)]);
        CHECK(k == crop.size());
        first.weight = second.weight = 1;
        const std::vector<float> a = frameOf(device, underLamp({ first }), filtered(16));
        const std::vector<float> b = frameOf(device, underLamp({ second }), filtered(16));
        for (std::size_t i = 0; i < whole.size(); ++i)
            REQUIRE(whole[i] == doctest::Approx(0.25 * double { a[i] } + 0.75 * double { b[i] }).epsilon(1e-3));
    });
}

TEST_CASE("soft styles are refused where what is seen is not filtered light by light")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = underLamp({ style(0.1f) });
        const auto refused = [&](const scene::Scene& of, const render::Settings& s) -> std::string {
            try {
                render::Renderer renderer(of, device, renderOptions());
                renderPixels(renderer, s);
            } catch (const UsageError& error) {
                return error.what();
            }
            return "";
        };
        const std::string alone = "styles of soft shadows are drawn of filtered shadows alone: style of light 'quad'";
        CHECK(refused(scene, sized(render::monteCarlo(4), wide, high)).find(alone) != std::string::npos);
        render::Settings s = filtered();
        s.filtering = render::Filtering::None;
        CHECK(refused(scene, s).find(alone) != std::string::npos);
        s = filtered();
        s.shading = render::Shading::Inside;
        s.sampling = render::Sampling::Uniform;
        CHECK(refused(scene, s).find(alone) != std::string::npos);
        s = filtered();
        s.antialias = true;
        CHECK(refused(scene, s).find("neither antialiased") != std::string::npos);
        s.styles = false;
        CHECK(refused(scene, s).empty());
        scene::Scene many = scene;
        for (int k = 0; k < 17; ++k) {
            many.areaLights.push_back(many.areaLights.front());
            many.areaLights.back().styles.clear();
            many.areaLights.back().radiance *= 2;
        }
        CHECK(refused(many, filtered()).find("only the 16 strongest area lights have styles") != std::string::npos);
    });
}
