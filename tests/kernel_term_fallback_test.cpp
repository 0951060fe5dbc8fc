// What a term falls back by: fallbackDifferences of it and termVariance; and unpackNumber: against the same in double.
// Of frames of one image, whose planes are packed, and of those with layers.
#include "tests/pass_bench.h"

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 37, height = 21;

render::Settings antialiased()
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.antialias = true;
    settings.bounces = 1;
    return settings;
}

/// A term's passes: of the lights there is one each, then that of indirect light.
struct TermKind {
    std::size_t nth;
    std::uint32_t values; ///< 1: a light's visibility is filtered; 3: radiance
};
constexpr TermKind kinds[] = { { 0, 1 }, { 2, 3 } };

/// Calls test(frame) for frames with and without layers.
template <class Test>
void inBothFrames(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const bool layers : { false, true }) {
            CAPTURE(layers);
            DeclaredFrame frame(device, smallScene(), antialiased(), layers);
            test(frame);
        }
    });
}

/// Colours of which some are black, or have one channel alone.
std::vector<float> someColours(std::mt19937& random, std::size_t count, double most)
{
    std::vector<float> out = someNumbers(random, 3 * count, 0, most);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            out[k * count + i] *= i % 11 == 3 || (i % 7 == 2 && k != i % 3) ? 0.0f : 1.0f;
    return out;
}

/// A pixel of a filtered value, of one channel or three.
glm::dvec3 filteredAt(const Planes<float>& planes, std::uint32_t values, int x, int y)
{
    return values == 3 ? planes.vector(x, y) : glm::dvec3(planes.at(x, y));
}

/// To the 8 bits that numbers of 16 bits have.
bool nearShort(double found, double expected)
{
    return std::fabs(found - expected) <= std::fabs(expected) / 256 + 1e-6;
}

} // namespace

TEST_CASE("fallbackDifferences of a term: what filters are off, and its noise, as luminances of what is seen")
{
    inBothFrames([](DeclaredFrame& frame) {
        for (const TermKind& kind : kinds) {
            CAPTURE(kind.nth);
            PassBench bench(frame, "fallbackDifferences", "fallback", kind.nth);
            REQUIRE(bench.own<std::uint32_t>("values") == kind.values);
            std::mt19937 random(1);
            const std::size_t size = frame.layout.size;
            bench.plane("texture", someColours(random, size, 0.9));
            bench.plane("noisy", someColours(random, size, 0.9));
            bench.plane("filtered", someNumbers(random, kind.values * size, 0, 0.9));
            bench.plane("deviation", someNumbers(random, size));
            bench.plane("beta", someNumbers(random, size));
            const bool gathered = bench.has("variance");
            if (gathered)
                bench.plane("variance", someNumbers(random, size, 0, 1));
            bench.run();
            const auto of = [&](const char* name) { return bench.pixels<float>(name); };
            const auto texture = of("texture"), noisy = of("noisy"), filtered = of("filtered"), beta = of("beta");
            const auto deviation = of("deviation"), found = of("differences");
            const auto variance = gathered ? of("variance") : Planes<float>(frame.layout, 1, 0.0f);
            everyPixel(frame.layout, [&](int x, int y) {
                const double counts = beta.at(x, y) >= 0 ? 1 : 0;
                const glm::dvec3 k = texture.vector(x, y), f = filteredAt(filtered, kind.values, x, y);
                const double v = luminanceOf(k) * deviation.at(x, y);
                REQUIRE(nearShort(found.at(x, y, 0), counts * luminanceOf(k * (noisy.vector(x, y) - f))));
                REQUIRE(nearShort(found.at(x, y, 1), counts * v * v));
                REQUIRE(nearShort(found.at(x, y, 2), counts * luminanceOf(k * f)));
                if (gathered)
                    REQUIRE(nearShort(found.at(x, y, 3), counts * luminanceOf(k) * luminanceOf(k) * variance.at(x, y)));
            });
        }
    });
}

TEST_CASE("termVariance: squares of deviations")
{
    inBothFrames([](DeclaredFrame& frame) {
        PassBench bench(frame, "termVariance");
        std::mt19937 random(3);
        bench.plane("deviation", someNumbers(random, frame.layout.size, -3, 3));
        bench.run();
        const auto deviation = bench.pixels<float>("deviation"), variance = bench.pixels<float>("variance");
        everyPixel(frame.layout, [&](int x, int y) {
            const double d = deviation.at(x, y);
            REQUIRE(variance.at(x, y) == doctest::Approx(d * d).epsilon(1e-6));
        });
    });
}

TEST_CASE("unpackNumber: a number of fewer bits as it is")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), antialiased());
        PassBench bench(frame, "unpackNumber");
        std::mt19937 random(4);
        bench.plane("in", someNumbers(random, frame.layout.size, -100, 100));
        bench.run();
        const auto in = bench.pixels<float>("in"), out = bench.pixels<float>("out");
        everyPixel(frame.layout, [&](int x, int y) { REQUIRE(out.at(x, y) == in.at(x, y)); });
    });
}

TEST_CASE("unpackImage: of distances that steps of a frame keep, the least and the sum of inverse ones")
{
    onEveryDevice([](const device::Device& device) {
        render::Settings steps = antialiased();
        steps.progressive = true;
        DeclaredFrame frame(device, smallScene(), steps);
        PassBench bench(frame, "unpackImage", "widths");
        std::mt19937 random(5);
        const std::vector<float> distances = someNumbers(random, 3 * frame.layout.size, 0, 100);
        bench.plane("in", distances);
        bench.run();
        const auto in = planesOf(frame.layout, distances), out = bench.pixels<float>("out");
        everyPixel(frame.layout, [&](int x, int y) {
            for (const std::size_t k : { 0, 2 }) {
                REQUIRE(out.at(x, y, k) == doctest::Approx(in.at(x, y, k)).epsilon(1.0 / 256));
            }
        });
    });
}
