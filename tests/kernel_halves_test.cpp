// frame/progressive.cl: what becomes of the two halves of a progressive frame, against the same in double.
#include "tests/pass_bench.h"

#include "kernels/shared/wave.h"

#include <cmath>
#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 37, height = 21;

render::Settings progressive()
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.progressive = true;
    return settings;
}

/// Primary samples of a half: of every third pixel none.
std::vector<std::uint32_t> samples(std::mt19937& random, std::size_t count)
{
    std::vector<std::uint32_t> out = someCounts(random, count, 300);
    for (std::uint32_t& n : out)
        n = n % 3 == 0 ? 0 : n;
    return out;
}

double shareOfFirst(std::uint32_t first, std::uint32_t second) { return second == 0 ? 1.0 : first == 0 ? 0.0 : 0.5; }

bool near(double found, double expected) { return std::fabs(found - expected) < 1e-6 * (1 + std::fabs(expected)); }

} // namespace

TEST_CASE("copyImage: the window's pixels, and no others")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive());
        PassBench bench(frame, "copyImage");
        std::mt19937 random(1);
        bench.plane("in", someNumbers(random, 3 * frame.layout.size));
        bench.plane("out", someNumbers(random, 3 * frame.layout.size));
        const auto in = bench.pixels<float>("in"), before = bench.pixels<float>("out");
        const Window window { 5, 3, 22, 20 };
        bench.window(window);
        bench.run();
        const auto out = bench.pixels<float>("out");
        Planes<float> expected = before;
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                expected.setVector(x, y, in.vector(x, y));
        CHECK(out.values == expected.values);
    });
}

TEST_CASE("meanOfHalves: the mean of both, or the one half that has samples")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive());
        PassBench bench(frame, "meanOfHalves");
        std::mt19937 random(2);
        for (const char* name : { "a", "b" })
            bench.plane(name, someNumbers(random, 3 * frame.layout.size));
        for (const char* name : { "takenA", "takenB" })
            bench.plane(name, samples(random, frame.layout.size));
        bench.run();
        const auto a = bench.pixels<float>("a"), b = bench.pixels<float>("b"), mean = bench.pixels<float>("mean");
        const auto takenA = bench.pixels<std::uint32_t>("takenA"), takenB = bench.pixels<std::uint32_t>("takenB");
        everyPixel(frame.layout, [&](int x, int y) {
            const double share = shareOfFirst(takenA.at(x, y), takenB.at(x, y));
            for (std::size_t k = 0; k < 3; ++k)
                REQUIRE(near(mean.at(x, y, k), share * a.at(x, y, k) + (1 - share) * b.at(x, y, k)));
        });
    });
}

TEST_CASE("joinObjects: the one that both see, or one of them and the other nothing; else mixed")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive());
        PassBench bench(frame, "joinObjects");
        std::mt19937 random(3);
        const auto objects = [&] {
            std::vector<std::uint32_t> out = someCounts(random, frame.layout.size, 5);
            for (std::uint32_t& id : out)
                id = id == 4 ? WEDGE_MIXED : id;
            return out;
        };
        bench.plane("objectA", objects());
        bench.plane("objectB", objects());
        bench.run();
        const auto a = bench.pixels<std::uint32_t>("objectA"), b = bench.pixels<std::uint32_t>("objectB");
        const auto object = bench.pixels<std::uint32_t>("object");
        everyPixel(frame.layout, [&](int x, int y) {
            std::set<std::uint32_t> seen { a.at(x, y), b.at(x, y) };
            seen.erase(0);
            REQUIRE(object.at(x, y) == (seen.empty() ? 0 : seen.size() == 1 ? *seen.begin() : WEDGE_MIXED));
        });
    });
}

TEST_CASE("joinSurfaces: means over the hits of both halves")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive(), true);
        PassBench bench(frame, "joinSurfaces");
        std::mt19937 random(4);
        const render::PlaneLayout& layout = frame.layout;
        for (const std::string half : { "A", "B" }) {
            bench.plane("hits" + half, samples(random, layout.size));
            const auto hits = bench.pixels<std::uint32_t>("hits" + half);
            Planes<float> normal(layout, 3, 0.0f), depth(layout, 1, std::numeric_limits<float>::infinity());
            everyPixel(layout, [&](int x, int y) {
                if (hits.at(x, y) > 0) {
                    normal.setVector(x, y, unitVector(random));
                    depth.at(x, y) = static_cast<float>(uniform(random, 1, 9));
                }
            });
            // Of both halves' the sum has no direction there.
            normal.setVector(7, 7, { 0, 0, half == "A" ? 1 : -1 });
            bench.plane("normal" + half, normal);
            bench.plane("depth" + half, depth);
            bench.plane("position" + half, someNumbers(random, 3 * layout.size));
            bench.plane("pixelSize" + half, someNumbers(random, layout.size, 0, 1));
        }
        for (const char* name : { "hitsA", "hitsB" }) {
            auto hits = bench.pixels<std::uint32_t>(name);
            hits.at(7, 7) = 4;
            bench.plane(name, hits);
        }
        bench.run();
        const auto of = [&](const char* name) { return bench.pixels<float>(name); };
        const auto positionA = of("positionA"), positionB = of("positionB"), position = of("position");
        const auto normalA = of("normalA"), normalB = of("normalB"), normal = of("normal");
        const auto sizeA = of("pixelSizeA"), sizeB = of("pixelSizeB"), size = of("pixelSize");
        const auto depthA = of("depthA"), depthB = of("depthB"), depth = of("depth");
        const auto hitsA = bench.pixels<std::uint32_t>("hitsA"), hitsB = bench.pixels<std::uint32_t>("hitsB");
        unsigned nothing = 0, infinite = 0;
        everyPixel(layout, [&](int x, int y) {
            const double a = hitsA.at(x, y), b = hitsB.at(x, y), n = a + b, share = n > 0 ? a / n : 0.5;
            const auto mean = [&](const auto& one, const auto& other) { return share * one + (1 - share) * other; };
            REQUIRE(glm::length(position.vector(x, y) - mean(positionA.vector(x, y), positionB.vector(x, y))) < 1e-6);
            const glm::dvec3 sum = a * normalA.vector(x, y) + b * normalB.vector(x, y);
            const bool known = glm::length(sum) > 0;
            REQUIRE(glm::length(normal.vector(x, y) - (known ? glm::normalize(sum) : glm::dvec3(0))) < 1e-5);
            REQUIRE(near(size.at(x, y), mean(double { sizeA.at(x, y) }, double { sizeB.at(x, y) })));
            nothing += known ? 0 : 1;
            if (n == 0) {
                infinite += 1;
                REQUIRE(std::isinf(depth.at(x, y)));
            } else {
                REQUIRE(near(
                    depth.at(x, y), (a > 0 ? a * depthA.at(x, y) : 0.0) / n + (b > 0 ? b * depthB.at(x, y) : 0.0) / n));
            }
        });
        CHECK(infinite > 20);
        CHECK(nothing == infinite + 1);
    });
}

TEST_CASE("sumOfHalves and sumOfLists: sums of pixels, and of lists to their ends")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive());
        std::mt19937 random(5);
        const auto summed = [&](const char* kernel) {
            PassBench bench(frame, kernel, "mean of halves");
            for (const char* name : { "a", "b" })
                bench.plane(name, someCounts(random, bench.elements(name), 1u << 30));
            bench.run();
            return bench;
        };
        const PassBench pixels = summed("sumOfHalves"), lists = summed("sumOfLists");
        const auto a = pixels.pixels<std::uint32_t>("a"), b = pixels.pixels<std::uint32_t>("b");
        const auto sum = pixels.pixels<std::uint32_t>("sum");
        everyPixel(frame.layout, [&](int x, int y) { REQUIRE(sum.at(x, y) == a.at(x, y) + b.at(x, y)); });
        const auto listA = lists.read<std::uint32_t>("a"), listB = lists.read<std::uint32_t>("b");
        auto expected = listA;
        for (std::size_t i = 0; i < expected.size(); ++i)
            expected[i] += listB[i];
        CHECK(expected.size() > 16);
        CHECK(lists.read<std::uint32_t>("sum") == expected);
    });
}

TEST_CASE("errorOfHalves: of the mean of two halves the variance, and the squared bias of what a filter did to each")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), progressive());
        PassBench bench(frame, "errorOfHalves");
        std::mt19937 random(6);
        for (const char* name : { "beautyA", "beautyB", "plainA", "plainB" })
            bench.plane(name, someNumbers(random, 3 * frame.layout.size, 0, 4));
        const auto of = [&](const char* name) { return bench.pixels<float>(name); };
        const auto fA = of("beautyA"), fB = of("beautyB"), nA = of("plainA"), nB = of("plainB");
        for (const std::uint32_t filtered : { 1u, 0u }) {
            CAPTURE(filtered);
            bench.value("filtered", filtered);
            bench.run();
            const auto noise = of("noise"), bias = of("bias");
            everyPixel(frame.layout, [&](int x, int y) {
                double variance = 0, squared = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double a = fA.at(x, y, k), b = fB.at(x, y, k), mean = 0.5 * (a + b);
                    // Half of the variance of one, by both.
                    variance += 0.5 * ((a - mean) * (a - mean) + (b - mean) * (b - mean)) / 3;
                    squared += (a - nA.at(x, y, k)) * (b - nB.at(x, y, k)) / 3;
                }
                REQUIRE(std::fabs(noise.at(x, y) - variance) < 1e-5);
                REQUIRE(std::fabs(bias.at(x, y) - (filtered != 0 ? squared : 0.0)) < 1e-5);
            });
        }
    });
}
