// What filters of images are on (host/render/filter_chain.h): terms, direct and indirect light, over whole frames.
#include "host/render/filter_chain.h"
#include "host/render/progressive.h"
#include "tests/filtered_frames.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 34;
constexpr std::size_t pixelCount = std::size_t { width } * height;

std::size_t indexOf(int x, int y, int rowLength)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rowLength) + static_cast<std::size_t>(x);
}

/// Filtered or plain, of one receiver a pixel or of several.
render::Settings frameOf(bool filtered, bool antialias)
{
    render::Settings s = sized(filtered ? render::axisAligned(18) : render::monteCarlo(4), width, height);
    s.bounces = 2;
    s.antialias = antialias;
    return s;
}

render::ChosenFilter colour(float gain, const std::vector<std::string>& on)
{
    return { "colour", { gain, gain, gain, 1 }, on };
}

std::vector<float> shown(render::Renderer& renderer, const std::string& plane)
{
    return pixels(renderer, plane, { 0, 0, width, height });
}

/// Emission, direct and indirect light, and the image of them all.
struct Parts {
    std::vector<float> emission, direct, indirect, beauty;
};
Parts partsOf(render::Renderer& renderer, const render::Settings& settings)
{
    renderPixels(renderer, settings, true);
    return { shown(renderer, "emission"), shown(renderer, "direct"), shown(renderer, "indirect"),
        shown(renderer, "beauty") };
}

/// That much of the light.
std::vector<float> times(const std::vector<float>& values, float gain)
{
    std::vector<float> out;
    std::ranges::transform(values, std::back_inserter(out), [gain](float v) { return gain * v; });
    return out;
}

void requireNear(const std::vector<float>& found, const std::vector<float>& expected, double tolerance)
{
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(i);
        CAPTURE(found[i]);
        CAPTURE(expected[i]);
        REQUIRE(std::fabs(found[i] - expected[i]) <= tolerance * (0.01 + std::fabs(expected[i])));
    }
}

/// Calls test() with frames of each kind of a scene with matt and glossy surfaces, textures and two lights.
template <class Test>
void inEveryFrame(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool filtered : { false, true })
            for (const bool antialias : { false, true }) {
                CAPTURE(filtered);
                CAPTURE(antialias);
                test(renderer, frameOf(filtered, antialias));
            }
    });
}

} // namespace

TEST_CASE("a filter on direct light changes that part of the image alone, with layers and without")
{
    inEveryFrame([](render::Renderer& renderer, const render::Settings& s) {
        const Parts before = partsOf(renderer, s), after = partsOf(renderer, with(s, colour(0.25f, { "direct" })));
        CHECK(sameBits(after.emission, before.emission));
        CHECK(sameBits(after.indirect, before.indirect));
        CHECK(sameBits(after.direct, times(before.direct, 0.25f)));
        std::vector<float> sum;
        for (std::size_t i = 0; i < before.beauty.size(); ++i)
            sum.push_back(before.emission[i] + 0.25f * before.direct[i] + before.indirect[i]);
        requireNear(after.beauty, sum, 1e-6);
        // Without layers filtered pixels of several receivers keep less, and are another image: but for what is
        // emitted.
        const bool lean = s.antialias && s.method == render::Method::AxisAligned;
        if (lean) {
            const auto dark = rendered(renderer, with(s, colour(0, { "direct", "indirect" })));
            CHECK(sumOf(dark) == doctest::Approx(sumOf(before.emission)).epsilon(0.02));
            CHECK(sumOf(rendered(renderer, with(s, colour(0.25f, { "direct" }))))
                == doctest::Approx(sumOf(sum)).epsilon(0.01));
        } else {
            CHECK(sameBits(rendered(renderer, with(s, colour(0.25f, { "direct" }))), after.beauty));
        }
        // And of both parts all but what is emitted.
        const Parts both = partsOf(renderer, with(s, colour(0.5f, { "direct", "indirect" })));
        CHECK(sameBits(both.emission, before.emission));
        CHECK(sameBits(both.direct, times(before.direct, 0.5f)));
        CHECK(sameBits(both.indirect, times(before.indirect, 0.5f)));
    });
}

TEST_CASE("a filter on the image is what it is where nobody says")
{
    inEveryFrame([](render::Renderer& renderer, const render::Settings& s) {
        const render::ChosenFilter median { "median", { 1 } }, ofImage { "median", { 1 }, { "image" } };
        CHECK(sameBits(rendered(renderer, with(s, ofImage)), rendered(renderer, with(s, median))));
    });
}

TEST_CASE("filters on terms change what arrives, and surfaces reflect that")
{
    inEveryFrame([](render::Renderer& renderer, render::Settings s) {
        const Parts before = partsOf(renderer, s);
        s.fallback = false; // of pixels, the sum of terms falls back, and not each
        const Parts plain = partsOf(renderer, s);
        const Parts diffuse = partsOf(renderer, with(s, colour(0.5f, { "indirectDiffuse" })));
        const Parts glossy = partsOf(renderer, with(s, colour(0.5f, { "indirectGlossy" })));
        const Parts both = partsOf(renderer, with(s, colour(0.5f, { "indirectDiffuse", "indirectGlossy" })));
        for (const Parts* parts : { &diffuse, &glossy, &both }) {
            CHECK(sameBits(parts->direct, plain.direct));
            CHECK(sameBits(parts->emission, before.emission));
        }
        requireNear(both.indirect, times(plain.indirect, 0.5f), 1e-5);
        CHECK(sumOf(diffuse.indirect) < 0.999 * sumOf(plain.indirect));
        CHECK(sumOf(glossy.indirect) < 0.999 * sumOf(plain.indirect));
        std::vector<float> taken;
        for (std::size_t i = 0; i < plain.indirect.size(); ++i)
            taken.push_back(diffuse.indirect[i] + glossy.indirect[i] - plain.indirect[i]);
        requireNear(both.indirect, taken, 1e-4);
    });
}

TEST_CASE("where pixels have several receivers each term falls back before its filters")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = scene::loadScene(WEDGE_SOURCE_DATA "/scenes/mirrors.toml");
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = frameOf(true, true);
        const Parts before = partsOf(renderer, s);
        const auto after = partsOf(renderer, with(s, colour(0.5f, { "indirectDiffuse", "indirectGlossy" })));
        requireNear(after.indirect, times(before.indirect, 0.5f), 1e-5);
        s.fallback = false;
        CHECK_FALSE(sameBits(partsOf(renderer, s).indirect, before.indirect));
    });
}

TEST_CASE("a blur of what arrives leaves textures sharp, and knows nothing of pixels without a surface")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = scene::loadScene(WEDGE_SOURCE_DATA "/scenes/cornell.toml");
        scene.camera.verticalFov *= 1.3f; // pixels beyond the box see nothing
        render::Renderer renderer(scene, device, renderOptions());
        const render::Settings s = frameOf(false, false);
        renderer.render(s, {}, true);
        const std::vector<float> albedo = shown(renderer, "albedo"), indirect = shown(renderer, "indirect");
        const auto objects = [&] {
            std::vector<std::uint32_t> out(pixelCount);
            const device::Buffer<std::uint32_t> ids = renderer.frame().counts("objectId");
            const std::vector<std::uint32_t> all = ids.downloadAll(renderer.queue());
            const std::uint32_t stride = renderer.frame().layout.stride;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    out[indexOf(x, y, width)] =
                        all[shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), stride)];
            return out;
        }();
        constexpr int radius = 2;
        renderer.render(with(s, { "box", { radius }, { "indirectDiffuse" } }), {}, true);
        const std::vector<float> found = shown(renderer, "indirect");
        std::size_t compared = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t i = 3 * indexOf(x, y, width) + c;
                    double sum = 0, count = 0;
                    bool known = albedo[i] > 0;
                    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
                        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); ++u) {
                            const std::size_t at = indexOf(u, v, width);
                            if (objects[at] == 0)
                                continue;
                            known = known && albedo[3 * at + c] > 0; // black surfaces do not show what arrives
                            sum += indirect[3 * at + c] / albedo[3 * at + c];
                            count += 1;
                        }
                    if (known) {
                        ++compared;
                        CAPTURE(x);
                        CAPTURE(y);
                        REQUIRE(found[i] == doctest::Approx(albedo[i] * sum / count).epsilon(1e-4));
                    }
                }
        CHECK(compared > pixelCount);
        CHECK(std::ranges::count(objects, 0u) > 100);
    });
}

TEST_CASE("a crop has the bits of the whole image, whatever filters are on")
{
    inEveryFrame([](render::Renderer& renderer, render::Settings s) {
        s.filters = { { "gaussian", { 1.5f }, { "indirectDiffuse" } }, { "median", { 1 }, { "indirectGlossy" } },
            { "box", { 2 }, { "direct", "indirect" } }, { "gaussian", { 0.7f }, { "image" } } };
        const std::vector<float> whole = rendered(renderer, s);
        const image::Window crop { 11, 7, 31, 22 };
        s.crop = crop;
        const std::vector<float> part = rendered(renderer, s);
        bool same = true;
        for (int y = crop.y0; y < crop.y1; ++y)
            for (int x = crop.x0; x < crop.x1; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    same = same
                        && part[3 * indexOf(x - crop.x0, y - crop.y0, crop.width()) + c]
                            == whole[3 * indexOf(x, y, width) + c];
        CHECK(same);
    });
}

TEST_CASE("values that change nothing leave the bits, of parts and of terms")
{
    inEveryFrame([](render::Renderer& renderer, const render::Settings& s) {
        const Parts before = partsOf(renderer, s);
        for (const char* target : { "direct", "indirectDiffuse" }) {
            CAPTURE(target);
            const Parts after = partsOf(renderer, with(s, { "gaussian", { 0 }, { target } }));
            CHECK(sameBits(after.beauty, before.beauty));
            CHECK(sameBits(after.indirect, before.indirect));
            CHECK(sameBits(after.direct, before.direct));
        }
    });
}

TEST_CASE("a filter of samples may be on one of its terms")
{
    inEveryFrame([](render::Renderer& renderer, const render::Settings& s) {
        const auto rejected = [&](const std::vector<std::string>& on) {
            renderer.render(with(s, { "clamp", { 0.05f, 0, 1 }, on }), {}, true);
            const auto sum = [&](const char* layer) {
                return renderer.frame().has(layer) ? sumOf(shown(renderer, layer)) : 0.0;
            };
            return std::pair(sum("rejectedIndirect"), sum("rejectedGlossy"));
        };
        const auto all = rejected({});
        CHECK(all.first > 0);
        CHECK(all.second > 0);
        CHECK(rejected({ "indirect" }) == all);
        CHECK(rejected({ "indirectDiffuse" }).second == 0);
        CHECK(rejected({ "indirectGlossy" }).first == 0);
        CHECK(rejected({ "indirectGlossy" }).second > 0);
    });
}

TEST_CASE("the error that progressive frames tell is that of filters of terms, too")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = sized(render::monteCarlo(1024), width, height);
        s.bounces = 2;
        renderPixels(renderer, s);
        const std::vector<float> truth = shown(renderer, "beauty");
        s.spp = 64;
        s.progressive = true;
        render::ErrorEstimate told {};
        renderer.renderProgressively(
            with(s, colour(0, { "indirectDiffuse" })), {},
            [&](const render::ProgressiveStep& step) { told = step.error; }, false);
        const double error = rmse(shown(renderer, "beauty"), truth);
        CAPTURE(told.rmse());
        CAPTURE(error);
        CHECK(told.bias > told.noise);
        CHECK(std::abs(told.rmse() - error) < 0.3 * error);
    });
}

TEST_CASE("a progressive image is filtered once its halves are one")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = frameOf(false, false);
        s.progressive = true;
        const Parts before = partsOf(renderer, s), after = partsOf(renderer, with(s, colour(0.25f, { "direct" })));
        CHECK(sameBits(after.indirect, before.indirect));
        CHECK(sameBits(after.direct, times(before.direct, 0.25f)));
        const Parts arrives = partsOf(renderer, with(s, colour(0.5f, { "indirectDiffuse", "indirectGlossy" })));
        requireNear(arrives.indirect, times(before.indirect, 0.5f), 1e-5);
    });
}
