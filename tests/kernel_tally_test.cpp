// frame/tally.cl, frame/layers.cl and frame/sums.cl: what is added to a frame's sums, and what is shown.
// meanOfMirrored: means.
#include "tests/glass_support.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <numeric>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 53, height = 33;

scene::Scene mirrored()
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, addMaterial(b, mirror(glm::vec3(0.9f))));
    b.camera({ 0, 0, 3 }, { 0, 0, 0 });
    return b.scene;
}

} // namespace

TEST_CASE("addToTally: a rectangle's counts, past 32 bits, added to what was there")
{
    onEveryDevice([](const device::Device& device) {
        // More rows than there are sums, so that each adds several.
        render::Settings settings = sized(render::axisAligned(16), 3, 2 * WEDGE_TALLY_STRIPES + 77);
        DeclaredFrame frame(device, smallScene(), settings);
        PassBench bench(frame, "addToTally");
        std::mt19937 random(1);
        bench.plane("counts", someCounts(random, frame.layout.size, 0xffffffffu));
        const auto counts = bench.pixels<std::uint32_t>("counts");
        const std::vector<std::uint64_t> before(bench.elements("tally"), 1000);
        auto p = bench.own<shared::AnalysisParams>("p");
        REQUIRE(p.x1 == frame.layout.width);
        REQUIRE(p.y1 == frame.layout.height);
        for (const Window window : { frame.graph().image(), Window { 1, 9, 2, 2000 }, Window { 0, 5, 3, 6 } }) {
            render::setRectangle(p, window);
            bench.value("p", p);
            bench.plane("tally", before);
            bench.run();
            std::uint64_t expected = 1000 * before.size();
            for (int y = window.y0; y < window.y1; ++y)
                for (int x = window.x0; x < window.x1; ++x)
                    expected += counts.at(x, y);
            const auto tally = bench.read<std::uint64_t>("tally");
            CHECK(std::accumulate(tally.begin(), tally.end(), std::uint64_t { 0 }) == expected);
        }
    });
}

TEST_CASE("addToTally: nothing of pixels whose mask is 0")
{
    onEveryDevice([](const device::Device& device) {
        render::Settings settings = sized(render::axisAligned(16), width, height);
        settings.antialias = true;
        DeclaredFrame frame(device, smallScene(), settings);
        PassBench bench(frame, "addToTally"); // of samples
        REQUIRE(bench.has("mask"));
        std::mt19937 random(4);
        bench.plane("counts", someCounts(random, frame.layout.size, 0xffffffffu));
        bench.plane("mask", someCounts(random, frame.layout.size, 2));
        const auto counts = bench.pixels<std::uint32_t>("counts"), mask = bench.pixels<std::uint32_t>("mask");
        bench.run();
        std::uint64_t expected = 0, left = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            expected += mask.at(x, y) != 0 ? counts.at(x, y) : 0;
            left += mask.at(x, y) == 0 ? 1 : 0;
        });
        CHECK(left > 100);
        const auto tally = bench.read<std::uint64_t>("tally");
        CHECK(std::accumulate(tally.begin(), tally.end(), std::uint64_t { 0 }) == expected);
    });
}

TEST_CASE("addListToTally: all numbers of a list, past 32 bits")
{
    onEveryDevice([](const device::Device& device) {
        render::Settings settings = sized(render::axisAligned(16), width, height);
        settings.antialias = true;
        DeclaredFrame frame(device, smallScene(), settings);
        PassBench bench(frame, "addListToTally");
        std::mt19937 random(5);
        const std::vector<std::uint32_t> list = someCounts(random, bench.elements("list"), 0xffffffffu);
        REQUIRE(list.size() > WEDGE_TALLY_STRIPES); // so that some add several
        bench.plane("list", list);
        bench.plane("tally", std::vector<std::uint64_t>(WEDGE_TALLY_STRIPES, 1000));
        bench.run();
        const auto tally = bench.read<std::uint64_t>("tally");
        CHECK(std::accumulate(tally.begin(), tally.end(), std::uint64_t { 0 })
            == std::accumulate(list.begin(), list.end(), std::uint64_t { 1000 } * WEDGE_TALLY_STRIPES));
    });
}

TEST_CASE("countSurfaces: pixels of the rectangle that show something, and those of them without specular reflection")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), sized(render::axisAligned(16), width, height), true);
        PassBench bench(frame, "countSurfaces");
        std::mt19937 random(6);
        bench.plane("objectId", someCounts(random, frame.layout.size, 2));
        Planes<float> specular(frame.layout, 3, 0.0f);
        everyPixel(frame.layout, [&](int x, int y) {
            const auto channel = random() % 4; // of one channel alone, or none
            if (channel < 3)
                specular.at(x, y, channel) = 0.25f;
        });
        bench.plane("specular", specular);
        const auto objectId = bench.pixels<std::uint32_t>("objectId");
        auto p = bench.own<shared::AnalysisParams>("p");
        const Window window { 7, 2, 50, 30 };
        render::setRectangle(p, window);
        bench.value("p", p);
        for (const char* name : { "shaded", "matte" }) // of an earlier frame
            bench.plane(name, std::vector<std::uint64_t>(WEDGE_TALLY_STRIPES, 99));
        bench.run();
        std::uint64_t shaded = 0, matte = 0;
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const bool hit = objectId.at(x, y) != 0, dull = specular.vector(x, y) == glm::dvec3(0);
                shaded += hit ? 1 : 0;
                matte += hit && dull ? 1 : 0;
            }
        CHECK(matte > 100);
        const auto sumOf = [&](const char* name) {
            const auto tally = bench.read<std::uint64_t>(name);
            return std::accumulate(tally.begin(), tally.end(), std::uint64_t { 0 });
        };
        CHECK(sumOf("shaded") == shaded);
        CHECK(sumOf("matte") == matte);
    });
}

TEST_CASE("showWidths: metres and pixels of the surface, 0 where there is no filter or no surface")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), sized(render::axisAligned(16), width, height), true);
        PassBench bench(frame, "showWidths");
        std::mt19937 random(7);
        Planes<float> beta(frame.layout, 1, 0.0f), size(frame.layout, 1, 0.0f);
        everyPixel(frame.layout, [&](int x, int y) {
            beta.at(x, y) = random() % 4 == 0 ? -1.0f : static_cast<float>(uniform(random));
            size.at(x, y) = random() % 5 == 0 ? 0.0f : static_cast<float>(uniform(random, 0.001, 0.1));
        });
        bench.plane("beta", beta);
        bench.plane("pixelSize", size);
        bench.run();
        const auto widths = bench.pixels<float>("widths");
        everyPixel(frame.layout, [&](int x, int y) {
            const float metres = std::max(beta.at(x, y), 0.0f);
            REQUIRE(widths.at(x, y) == metres);
            const double pixels = size.at(x, y) > 0 ? static_cast<double>(metres) / size.at(x, y) : 0.0;
            REQUIRE(widths.at(x, y, 1) == doctest::Approx(pixels).epsilon(1e-5));
        });
    });
}

TEST_CASE("addCounts: pixel by pixel")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, mirrored(), sized(render::axisAligned(16), width, height));
        PassBench bench(frame, "addCounts");
        std::mt19937 random(2);
        for (const char* name : { "counts", "before" })
            bench.plane(name, someCounts(random, frame.layout.size, 1u << 31));
        bench.run();
        const auto counts = bench.pixels<std::uint32_t>("counts"), before = bench.pixels<std::uint32_t>("before");
        const auto sum = bench.pixels<std::uint32_t>("sum");
        everyPixel(frame.layout, [&](int x, int y) { REQUIRE(sum.at(x, y) == counts.at(x, y) + before.at(x, y)); });
    });
}

TEST_CASE("meanOfMirrored: means of sums, which stay where there are no samples or beside the window")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, mirrored(), sized(render::monteCarlo(4), width, height));
        PassBench bench(frame, "meanOfMirrored");
        std::mt19937 random(3);
        bench.plane("taken", someCounts(random, frame.layout.size, 4));
        bench.plane("sums", someNumbers(random, 3 * frame.layout.size));
        const auto taken = bench.pixels<std::uint32_t>("taken");
        const auto sums = bench.pixels<float>("sums");
        const Window window { 8, 3, 45, 29 };
        bench.window(window);
        bench.run();
        const auto means = bench.pixels<float>("sums");
        unsigned divided = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            const std::uint32_t n = taken.at(x, y);
            const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
            const bool divides = inside && n > 1;
            const glm::dvec3 mean = sums.vector(x, y) / (divides ? static_cast<double>(n) : 1.0);
            REQUIRE(glm::length(means.vector(x, y) - mean) < (divides ? 1e-6 : 1e-30));
            divided += divides ? 1 : 0;
        });
        CHECK(divided > 400);
    });
}

TEST_CASE("addChanging: the same sums in planes of their own, nothing beside the window")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene::ShadowStyle style;
        style.softness = 0.1f;
        style.keys = { style };
        scene.directionalLights.push_back({ { 0.36f, -0.8f, 0.48f }, { 2, 1, 3 }, "sun", { style } });
        DeclaredFrame frame(device, scene, sized(render::monteCarlo(1), width, height));
        PassBench bench(frame, "addChanging");
        std::mt19937 random(4);
        for (const char* name : { "radiance", "direct", "directNoisy", "sum", "sumNoisy" })
            bench.plane(name, someNumbers(random, 3 * frame.layout.size));
        const Window window { 8, 3, 45, 29 };
        bench.window(window);
        const auto radiance = bench.pixels<float>("radiance");
        for (const bool noisy : { false, true }) {
            CAPTURE(noisy);
            const std::string from = noisy ? "directNoisy" : "direct", to = noisy ? "sumNoisy" : "sum";
            const auto light = bench.pixels<float>(from), before = bench.pixels<float>(to);
            PassBench once = bench;
            once.run();
            const auto after = once.pixels<float>(to);
            everyPixel(frame.layout, [&](int x, int y) {
                const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
                const glm::dvec3 expected = inside ? light.vector(x, y) + radiance.vector(x, y) : before.vector(x, y);
                REQUIRE(glm::length(after.vector(x, y) - expected) < (inside ? 1e-6 : 1e-30));
            });
            CHECK(sameBits(once.read<float>(from), bench.read<float>(from)));
        }
    });
}

TEST_CASE("addUnfiltered: light to both images of direct light, nothing beside the window")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, mirrored(), sized(render::monteCarlo(4), width, height));
        PassBench bench(frame, "addUnfiltered");
        std::mt19937 random(4);
        for (const char* name : { "radiance", "direct", "directNoisy" })
            bench.plane(name, someNumbers(random, 3 * frame.layout.size));
        const Window window { 8, 3, 45, 29 };
        bench.window(window);
        const auto radiance = bench.pixels<float>("radiance");
        for (const char* name : { "direct", "directNoisy" }) {
            CAPTURE(name);
            const auto before = bench.pixels<float>(name);
            PassBench once = bench;
            once.run();
            const auto after = once.pixels<float>(name);
            everyPixel(frame.layout, [&](int x, int y) {
                const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
                const glm::dvec3 more = inside ? radiance.vector(x, y) : glm::dvec3(0);
                REQUIRE(glm::length(after.vector(x, y) - before.vector(x, y) - more) < (inside ? 1e-6 : 1e-30));
            });
        }
    });
}
