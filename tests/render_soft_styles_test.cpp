// Frames whose soft shadows have a style: against the same frames without one, moved; bits; and what is refused.
#include "host/error.h"
#include "tests/styled_floor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::floors;

namespace {

constexpr int wide = 192, high = 48;
/// Metres along each side of a pixel on the floor.
const double softPixel = 2 * eyeHeight * std::tan(std::numbers::pi / 12) / high;

render::Settings filtered(int spp = 64) { return sized(render::axisAligned(spp), wide, high); }

/// A board with sides along x and z.
struct Board {
    glm::vec3 centre { -10, 2, 0 };
    float half = 10; ///< of each side
};

/// A lamp of 0.6 m, 4 m above the floor; a board at half of that hides what has x < 0, with a penumbra of 0.6 m.
scene::Scene underLamp(
    const std::vector<scene::ShadowStyle>& styles, std::optional<Board> board = Board(), bool specular = false)
{
    SceneBuilder b;
    b.scene.materials[0].diffuse = glm::vec3(0.8f);
    b.scene.materials[0].specular = glm::vec3(specular ? 0.2f : 0.0f);
    b.scene.materials[0].exponent = 8;
    b.quad({ 0, 0, 0 }, { 0, 0, 10 }, { 10, 0, 0 });
    b.newObject();
    if (board)
        b.quad(board->centre, { 0, 0, board->half }, { board->half, 0, 0 });
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
        for (const auto profile : { scene::LightProfile::Uniform, scene::LightProfile::Gaussian }) {
            const auto of = [&](const std::vector<scene::ShadowStyle>& styles, std::optional<Board> board = Board()) {
                scene::Scene scene = underLamp(styles, board);
                scene.areaLights[0].profile = profile;
                scene.areaLights[0].twoSided = profile == scene::LightProfile::Uniform; // to the floor
                return frameOf(device, scene);
            };
            const std::vector<float> open = of({}, {});
            const std::vector<double> plain = seenByColumn(of({}), open);
            CHECK(plain[wide - 1] > 0.99);
            for (const float inflation : { 0.15f, -0.2f }) {
                CAPTURE(inflation);
                const std::vector<double> s = seenByColumn(of({ style(inflation) }), open);
                for (int x = 30; x < wide - 30; ++x) {
                    CAPTURE(x);
                    REQUIRE(std::abs(s[static_cast<std::size_t>(x)] - between(plain, x - inflation / softPixel))
                        < 0.016); // less than half a pixel
                }
            }
        }
    });
}

TEST_CASE("a penumbra narrows about its middle to what is said, down to an edge")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, {})), image = frameOf(device, underLamp({}));
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
        const std::vector<float> open = frameOf(device, underLamp({}, {}));
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

TEST_CASE("where half of the light is seen and no edge is near nothing moves")
{
    onEveryDevice([](const device::Device& device) {
        // Right under the lamp a board hides half of it from all of the floor.
        const auto scene = [](const std::vector<scene::ShadowStyle>& styles) {
            return underLamp(styles, Board { .centre = { -10, 3.98f, 0 } });
        };
        render::Settings s = filtered();
        s.styleMargin = 0; // with one, filters see more
        const std::vector<float> plain = frameOf(device, scene({}), s);
        const std::vector<double> seen = seenByColumn(plain, frameOf(device, underLamp({}, {})));
        CHECK(*std::ranges::min_element(seen) > 0.45);
        CHECK(*std::ranges::max_element(seen) < 0.55);
        CHECK(sameBits(frameOf(device, scene({ style(0.4f, 0.1f, 0.1f) }), s), plain));
    });
}

TEST_CASE("a smoothed soft shadow takes as much light as before, unless that is not wanted")
{
    onEveryDevice([](const device::Device& device) {
        const auto missing = [&](const std::vector<scene::ShadowStyle>& styles) {
            const std::vector<float> open = frameOf(device, underLamp({}, {}));
            const std::vector<float> image =
                frameOf(device, underLamp(styles, Board { .centre = { 0, 1, 0 }, .half = 0.15f }));
            return std::accumulate(open.begin(), open.end(), 0.0) - std::accumulate(image.begin(), image.end(), 0.0);
        };
        scene::ShadowStyle kept = style(0, 0, 0.12f), shrinks = kept;
        shrinks.keepArea = false;
        const double plain = missing({});
        CHECK(missing({ kept }) == doctest::Approx(plain).epsilon(0.08));
        CHECK(missing({ shrinks }) < 0.75 * plain);
    });
}

TEST_CASE("penumbras of one light share it, go over into each other, and leave what brightness says")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, {}));
        const auto shared = [&](scene::ShadowStyle a, scene::ShadowStyle b) {
            a.weight = b.weight = 0.5f;
            return frameOf(device, underLamp({ a, b }));
        };
        const auto most = [&](const std::vector<float>& a, const std::vector<float>& b) {
            double out = 0;
            for (std::size_t i = 0; i < a.size(); ++i)
                out = std::max(out, std::abs(double { a[i] } - double { b[i] }) / double { open[i] });
            return out;
        };
        const auto mixed = [](std::vector<float> a, const std::vector<float>& b, float share) {
            for (std::size_t i = 0; i < a.size(); ++i)
                a[i] += share * (b[i] - a[i]);
            return a;
        };
        // Of one inflation, so that both tell the same distances apart.
        const std::vector<float> wide = frameOf(device, underLamp({ penumbra(1, 0.1f) }));
        const std::vector<float> none = frameOf(device, underLamp({ penumbra(0, 0.1f) }));
        CHECK(most(wide, none) > 0.2);
        CHECK(most(shared(penumbra(1, 0.1f), penumbra(0, 0.1f)), mixed(wide, none, 0.5f)) < 1e-3);
        // Of several, as keys bring them together.
        const std::vector<float> same = shared(penumbra(0.5f, 0.3f), penumbra(0.5f, 0.02f));
        CHECK(most(same, shared(penumbra(0.5f, 0.3f), penumbra(0.5001f, 0.02f))) < 1e-3);
        scene::ShadowStyle left = penumbra(0.5f, 0.1f);
        left.brightness = glm::vec3(0.25f);
        CHECK(most(frameOf(device, underLamp({ left })),
                  mixed(frameOf(device, underLamp({ penumbra(0.5f, 0.1f) })), open, 0.25f))
            < 0.01);
    });
}

TEST_CASE("two lights have each their style")
{
    onEveryDevice([](const device::Device& device) {
        const scene::ShadowStyle first = style(0.15f), second = style(-0.1f, 0.2f);
        const auto both = [](const std::vector<scene::ShadowStyle>& a, const std::vector<scene::ShadowStyle>& b) {
            scene::Scene scene = underLamp(a);
            scene.areaLights.push_back(scene.areaLights[0]);
            scene.areaLights[1].centre.x = -0.4f;
            scene.areaLights[1].styles = b;
            return scene;
        };
        render::Settings s = filtered();
        s.styleMargin = 0; // with one, filters see more
        const std::vector<float> none = frameOf(device, both({}, {}), s);
        const std::vector<float> all = frameOf(device, both({ first }, { second }), s);
        const std::vector<float> one = frameOf(device, both({ first }, {}), s);
        const std::vector<float> other = frameOf(device, both({}, { second }), s);
        double moved = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double sum = double { one[i] } + double { other[i] } - double { none[i] };
            REQUIRE(double { all[i] } == doctest::Approx(sum).epsilon(1e-3));
            moved = std::max(moved, std::abs(double { other[i] } - double { none[i] }));
        }
        CHECK(moved > 0.005);
    });
}

TEST_CASE("layers show what is seen of a quad with a style, and how far it is to where that is half")
{
    onEveryDevice([](const device::Device& device) {
        const auto shown = [&](const scene::Scene& scene, const std::string& name) {
            render::Renderer renderer(scene, device, renderOptions());
            renderer.render(filtered(), {}, true);
            return std::pair(pixels(renderer, "shadowMatte." + name, { 0, 0, wide, high }),
                pixels(renderer, "shadowDistance." + name, { 0, 0, wide, high }));
        };
        const std::vector<double> seen =
            seenByColumn(frameOf(device, underLamp({})), frameOf(device, underLamp({}, {})));
        const auto [matte, distance] = shown(underLamp({ style(0.2f) }), "quad1");
        for (std::size_t x = 0; x < wide; ++x) {
            CAPTURE(x);
            CHECK(std::abs(double { matte[high / 2 * wide + x] } - seen[x]) < 0.05);
            const double d = (static_cast<double>(x) + 0.5 - wide / 2.0) * softPixel;
            if (std::abs(d) < 0.4) // farther away the edge, of which a metre is seen, ends too early
                CHECK(std::abs(double { distance[high / 2 * wide + x] } - d) < 0.03);
        }
        // By its name, if that is its own.
        scene::Scene named = underLamp({ style(0.2f) });
        named.areaLights[0].name = "lamp";
        CHECK(sameBits(shown(named, "lamp").first, matte));
        named.areaLights.push_back(named.areaLights[0]);
        CHECK(shown(named, "quad2").first.size() == matte.size());
    });
}

TEST_CASE("soft shadows grow with inflation, everywhere")
{
    onEveryDevice([](const device::Device& device) {
        const std::vector<float> open = frameOf(device, underLamp({}, {}, true));
        std::vector<float> before;
        for (const float inflation : { -0.2f, -0.05f, 0.0f, 0.05f, 0.2f }) {
            const std::vector<float> image = frameOf(device, underLamp({ style(inflation, 0.01f) }, Board(), true));
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
        render::Settings s = filtered();
        s.styleMargin = 0; // with one, filters see more
        for (const bool specular : { false, true }) {
            CAPTURE(specular);
            const std::vector<float> plain = frameOf(device, underLamp({}, Board(), specular), s);
            scene::Scene others = underLamp({ elsewhere }, Board(), specular);
            others.geometry.objectNames = { "floor", "object" };
            CHECK(sameBits(frameOf(device, others, s), plain));
            for (const auto& styles : { std::vector { scene::ShadowStyle() }, { keys }, { keys, keys } }) {
                std::vector<scene::ShadowStyle> shared = styles;
                for (scene::ShadowStyle& each : shared)
                    each.weight = 1.0f / static_cast<float>(shared.size());
                CHECK(sameBits(frameOf(device, underLamp(shared, Board(), specular), s), plain));
            }
            render::Settings without = filtered();
            without.styles = false;
            CHECK(sameBits(frameOf(device, underLamp({ style(0.2f) }, Board(), specular), without), plain));
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
