// filter/exposure.cl, kernel by kernel, against their definitions in double.
#include "tests/stored_samples_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("probeCounts: sixteen samples of each fourth pixel of each fourth row that sees something")
{
    std::mt19937 random(4);
    onEveryDevice([&](const device::Device& device) {
        DeclaredFrame frame(
            device, smallScene(), keptSettings(render::monteCarlo(16), { "path-density", { 10, 2, 3, 3, 0, 0, 0 } }));
        PassBench bench(frame, "probeCounts");
        for (const image::Window& window :
            { image::Window { 0, 0, 29, 27 }, image::Window { 7, 3, 25, 20 }, image::Window { 0, 0, 1, 1 } }) {
            auto p = paramsOf(bench.layout);
            render::setRectangle(p, window);
            bench.value("p", p);
            bench.window(window);
            const auto objects = planesOf(bench.layout, someCounts(random, bench.layout.size, 3));
            bench.plane("objectId", objects);
            bench.plane("wanted", Planes<std::uint32_t>(bench.layout, 1, 99u));
            bench.run();
            const auto found = bench.pixels<std::uint32_t>("wanted");
            everyPixelOf(window, [&](int x, int y) {
                REQUIRE(found.at(x, y) == (x % 4 == 0 && y % 4 == 0 && objects.at(x, y) > 0 ? 16u : 0u));
            });
        }
    });
}

TEST_CASE("probeCounts: where it is not known what pixels see, of each fourth pixel of each fourth row")
{
    onEveryDevice([&](const device::Device& device) {
        render::Settings settings = keptSettings(render::monteCarlo(16), { "path-density", { 10, 2, 3, 3, 0, 0, 0 } });
        settings.antialias = true;
        DeclaredFrame frame(device, smallScene(), settings);
        PassBench bench(frame, "probeCounts");
        REQUIRE(!bench.has("objectId"));
        for (const image::Window& window :
            { image::Window { 0, 0, 29, 27 }, image::Window { 7, 3, 25, 20 }, image::Window { 0, 0, 1, 1 } }) {
            auto p = paramsOf(bench.layout);
            render::setRectangle(p, window);
            bench.value("p", p);
            bench.window(window);
            bench.plane("wanted", Planes<std::uint32_t>(bench.layout, 1, 99u));
            bench.run();
            const auto found = bench.pixels<std::uint32_t>("wanted");
            everyPixelOf(
                window, [&](int x, int y) { REQUIRE(found.at(x, y) == (x % 4 == 0 && y % 4 == 0 ? 16u : 0u)); });
        }
    });
}

namespace {

/// Sums of probes, and what the kernel makes of them.
struct Probes {
    Planes<float> sums;
    Planes<std::uint32_t> taken;
    int width, height;

    /// Luminances of pixels that light reaches, in order.
    std::vector<double> luminances() const
    {
        std::vector<double> out;
        for (int y = 0; y < height; y += 4)
            for (int x = 0; x < width; x += 4) {
                const double n = taken.at(x, y), l = luminanceOf(sums.vector(x, y)) / n;
                if (n > 0 && l >= 1e-30 && l <= 1e30)
                    out.push_back(l);
            }
        std::ranges::sort(out);
        return out;
    }
    float exposure(PassBench& bench) const
    {
        auto p = paramsOf(bench.layout);
        p.x1 = p.width = static_cast<std::uint32_t>(width);
        p.y1 = p.height = static_cast<std::uint32_t>(height);
        bench.value("p", p);
        bench.plane("sums", sums);
        bench.plane("taken", taken);
        bench.plane("bins", std::vector<std::uint32_t>(bench.elements("bins"), 3));
        bench.run();
        return bench.read<float>("exposure")[0];
    }
};

Probes someProbes(const render::PlaneLayout& layout, int width, int height, std::mt19937& random, double decades)
{
    Probes out { Planes<float>(layout, 4, 1e9f), Planes<std::uint32_t>(layout, 1, 1u), width, height };
    const float bad[] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity() };
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4) {
            out.taken.at(x, y) = random() % 6 == 0 ? 0 : 16;
            const double scale = random() % 8 == 0 ? 0 : std::pow(10, uniform(random, -decades / 2, decades / 2));
            for (std::size_t k = 0; k < 3; ++k)
                out.sums.at(x, y, k) = static_cast<float>(scale * uniform(random, 0.1, 1));
            if (random() % 10 == 0)
                out.sums.at(x, y, 1) = bad[random() % 2];
        }
    return out;
}

} // namespace

TEST_CASE("exposureOfProbes: the median luminance of lit probes is middle grey, to an eighth of an octave")
{
    std::mt19937 random(5);
    onEveryDevice([&](const device::Device& device) {
        DeclaredFrame frame(
            device, smallScene(), keptSettings(render::monteCarlo(16), { "path-density", { 10, 2, 3, 3, 0, 0, 0 } }));
        PassBench bench(frame, "exposureOfProbes");
        for (const glm::ivec2 size : { glm::ivec2(29, 27), glm::ivec2(17, 5), glm::ivec2(1, 1), glm::ivec2(29, 13) })
            for (const double decades : { 0.3, 4.0, 20.0 }) {
                CAPTURE(size.x);
                CAPTURE(size.y);
                CAPTURE(decades);
                Probes probes = someProbes(bench.layout, size.x, size.y, random, decades);
                const std::vector<double> values = probes.luminances();
                const float exposure = probes.exposure(bench);
                if (values.empty()) {
                    REQUIRE(exposure == 1);
                    continue;
                }
                const double shown = exposure * values[values.size() / 2];
                CAPTURE(shown);
                REQUIRE(std::fabs(std::log2(shown / 0.18)) <= 1.0 / 8);
                for (float& sum : probes.sums.values)
                    sum *= 2;
                REQUIRE(probes.exposure(bench) == exposure / 2);
            }
    });
}

TEST_CASE("exposureOfProbes: 1 where all is dark or nothing is known")
{
    onEveryDevice([&](const device::Device& device) {
        DeclaredFrame frame(
            device, smallScene(), keptSettings(render::monteCarlo(16), { "path-density", { 10, 2, 3, 3, 0, 0, 0 } }));
        PassBench bench(frame, "exposureOfProbes");
        for (const float dark : { 0.0f, 1e-38f, std::numeric_limits<float>::quiet_NaN() }) {
            const Probes probes { Planes<float>(bench.layout, 4, dark), Planes<std::uint32_t>(bench.layout, 1, 16u), 29,
                27 };
            CHECK(probes.exposure(bench) == 1);
        }
        const Probes unknown { Planes<float>(bench.layout, 4, 5.0f), Planes<std::uint32_t>(bench.layout, 1, 0u), 29,
            27 };
        CHECK(unknown.exposure(bench) == 1);
    });
}
