// filter/spread.cl, kernel by kernel, against their definitions in double.
#include "tests/spread_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

/// Both kernels, the first over all pixels that the second reads.
class Spread {
public:
    explicit Spread(const device::Device& device, bool parts)
        : frame_(spreadFrame(device, parts, 0))
        , sums_(frame_, "spreadSums")
        , excess_(frame_, "spreadExcess")
    {
        REQUIRE(excess_.has("parts") == parts);
        REQUIRE(!sums_.has("width"));
    }
    const render::PlaneLayout& layout() const { return sums_.layout; }

    Gained operator()(const Lost& lost, const Area& area, float sigma, const Planes<float>& before)
    {
        setLoss(sums_, lost, area, { 0, 0, area.width, area.height }, sigma);
        sums_.value("widest", sigma);
        sums_.plane("per", Planes<float>(layout(), 1, untouched));
        sums_.run();
        setLoss(excess_, lost, area, area.window, sigma);
        excess_.plane("per", sums_.pixels<float>("per"));
        return gainedBy(excess_, before);
    }
    Planes<float> per() const { return sums_.pixels<float>("per"); }

private:
    DeclaredFrame frame_;
    PassBench sums_, excess_;
};

template <class Test>
void onEverySpread(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const bool parts : { false, true }) {
            CAPTURE(parts);
            Spread spread(device, parts);
            test(spread);
        }
    });
}

} // namespace

TEST_CASE("spreadSums, spreadExcess: what is lost goes to pixels of the same object that face about the same way")
{
    std::mt19937 random(1);
    onEverySpread([&](Spread& spread) {
        for (const Area& area : areas())
            for (const float sigma : { 0.4f, 1.0f, 3.0f, 8.0f }) {
                CAPTURE(&area - areas().data());
                CAPTURE(sigma);
                const Lost lost = someLoss(spread.layout(), area, random);
                const auto before = planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10));
                const Gained found = spread(lost, area, sigma, before);
                const std::vector<glm::dvec3> gains = gainsOf(lost, area, [&](int, int) { return sigma; });
                checkGains(found, lost, area, before, gains);
            }
    });
}

TEST_CASE("spreadSums, spreadExcess: no object gains or loses light, and what has no samples has no part in it")
{
    std::mt19937 random(2);
    onEverySpread([&](Spread& spread) {
        const Area& area = areas()[0];
        for (const float sigma : { 0.7f, 3.0f, 8.0f }) {
            CAPTURE(sigma);
            const Lost lost = someLoss(spread.layout(), area, random);
            const Planes<float> none(spread.layout(), 4, 0.0f);
            const Gained found = spread(lost, area, sigma, none);
            checkBalance(found, lost, area, spread.per());
        }
    });
}

TEST_CASE("spreadSums, spreadExcess: the same loss everywhere is the same gain inside, and an edge is no way out")
{
    onEverySpread([&](Spread& spread) {
        const Area& area = areas()[0];
        constexpr float sigma = 1.5f;
        constexpr int twice = 2 * 3;
        for (const bool byNormal : { false, true }) {
            CAPTURE(byNormal);
            Lost lost(spread.layout());
            everyPixelOf(area.window, [&](int x, int y) {
                const bool left = x < 20;
                lost.objectId.at(x, y) = byNormal || left ? 1 : 2;
                // 27 degrees between both sides, where 25.8 are the limit.
                const double angle = byNormal && !left ? std::numbers::pi / 180 * 27 : 0;
                lost.normal.setVector(x, y, { 0, std::sin(angle), std::cos(angle) });
                lost.excess.setVector(x, y, left ? glm::dvec3(0.5, 2, 3) : glm::dvec3(0));
                lost.taken.at(x, y) = 4;
            });
            const Gained found = spread(lost, area, sigma, Planes<float>(spread.layout(), 4, 0.0f));
            everyPixelOf(area.window, [&](int x, int y) {
                CAPTURE(x);
                CAPTURE(y);
                const glm::dvec3 gain = found.sums.vector(x, y) / 4.0;
                if (x >= 20)
                    REQUIRE(gain == glm::dvec3(0));
                const bool inside = x >= twice && x < 20 - twice && y >= twice && y < area.height - twice;
                if (inside)
                    REQUIRE(glm::length(gain - glm::dvec3(0.5, 2, 3)) <= 1e-5);
            });
        }
    });
}

TEST_CASE("meanOfKept: sums over samples, and black without")
{
    std::mt19937 random(3);
    onEveryDevice([&](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(),
            keptSettings(render::monteCarlo(16), { "path-density", { 10, 2, 3, 3, 0, 0, 0, 0 } }));
        PassBench bench(frame, "meanOfKept");
        for (const Area& area : areas()) {
            auto p = paramsOf(bench.layout);
            render::setRectangle(p, area.window);
            bench.value("p", p);
            bench.window(area.window);
            const auto sums = planesOf(bench.layout, someNumbers(random, 4 * bench.layout.size, 0, 10));
            const auto taken = planesOf(bench.layout, someCounts(random, bench.layout.size, 5));
            bench.plane("sums", sums);
            bench.plane("taken", taken);
            bench.plane("mean", Planes<float>(bench.layout, 3, untouched));
            bench.run();
            const auto found = bench.pixels<float>("mean");
            everyPixelOf(area.window, [&](int x, int y) {
                const std::uint32_t n = taken.at(x, y);
                for (int k = 0; k < 3; ++k)
                    REQUIRE(found.vector(x, y)[k]
                        == doctest::Approx(n == 0 ? 0 : sums.vector(x, y)[k] / static_cast<double>(n)).epsilon(1e-6));
            });
        }
    });
}
