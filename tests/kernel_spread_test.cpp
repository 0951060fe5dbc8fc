// filter/spread.cl, kernel by kernel, against their definitions in double.
#include "tests/stored_samples_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

/// An image, no larger than the frame, and the pixels of it that are made.
struct Area {
    int width, height;
    image::Window window;
};

const std::vector<Area>& areas()
{
    static const std::vector<Area> all { { 29, 27, { 0, 0, 29, 27 } }, { 29, 27, { 7, 3, 25, 20 } },
        { 1, 1, { 0, 0, 1, 1 } }, { 29, 2, { 0, 0, 29, 2 } } };
    return all;
}

/// What pixels lose and the surfaces that they see. Beside images, what would get and give light if it were looked at.
struct Lost {
    explicit Lost(const render::PlaneLayout& layout)
        : objectId(layout, 1, 1u)
        , taken(layout, 1, 1u)
        , normal(layout, 3, 0.0f)
        , excess(layout, 3, 1e3f)
    {
        std::fill_n(normal.values.begin() + static_cast<std::ptrdiff_t>(2 * layout.size), layout.size, 1.0f);
    }
    Planes<std::uint32_t> objectId, taken;
    Planes<float> normal, excess;
};

/// Objects in patches, each with faces whose normals are 20, 30 and more degrees apart; pixels that lose nothing, and
/// pixels without samples.
Lost someLoss(const render::PlaneLayout& layout, const Area& area, std::mt19937& random)
{
    Lost out(layout);
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        const double angle = std::numbers::pi / 180 * (std::array { 0, 20, 50, 24, 51 })[random() % 5];
        out.objectId.at(x, y) = 1 + static_cast<std::uint32_t>(x / 8 + y / 10) % 3;
        out.normal.setVector(x, y, { std::sin(angle), 0, std::cos(angle) });
        out.taken.at(x, y) = random() % 9 == 0 ? 0 : 1 + static_cast<std::uint32_t>(random()) % 30;
        out.excess.setVector(x, y,
            random() % 3 == 0
                ? glm::dvec3(0)
                : glm::dvec3(uniform(random), uniform(random), uniform(random)) * std::pow(10, uniform(random, -2, 2)));
    });
    return out;
}

/// Whether what one pixel loses may go to another.
bool spreads(const Lost& of, glm::ivec2 from, glm::ivec2 to)
{
    const glm::dvec3 a = of.normal.vector(from.x, from.y), b = of.normal.vector(to.x, to.y);
    return of.taken.at(from.x, from.y) > 0 && of.taken.at(to.x, to.y) > 0
        && of.objectId.at(from.x, from.y) == of.objectId.at(to.x, to.y) && glm::dot(a, b) >= 0.9;
}

/// The weight of two pixels, a Gaussian that ends at two standard deviations, either way.
double gaussianOf(glm::ivec2 a, glm::ivec2 b, double sigma)
{
    const int reach = static_cast<int>(std::ceil(2 * sigma));
    const glm::dvec2 d(a - b);
    if (std::abs(a.x - b.x) > reach || std::abs(a.y - b.y) > reach)
        return 0;
    return std::exp(-glm::dot(d, d) / (2 * sigma * sigma));
}

/// Calls visit(to, share) for all pixels that get some of what a pixel loses; shares add up to 1.
template <class Visit>
void sharesOf(const Lost& of, const Area& area, glm::ivec2 from, double sigma, const Visit& visit)
{
    double sum = 0;
    std::vector<std::pair<glm::ivec2, double>> weights;
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        const double weight = spreads(of, from, { x, y }) ? gaussianOf(from, { x, y }, sigma) : 0;
        if (weight > 0)
            weights.emplace_back(glm::ivec2(x, y), weight);
        sum += weight;
    });
    for (const auto& to : weights)
        visit(to.first, to.second / sum);
}

/// What pixels get.
struct Gained {
    Planes<float> sums, parts;
};

/// Hands a kernel what it has of a loss.
void setLoss(PassBench& bench, const Lost& lost, const Area& area, const image::Window& window, float sigma)
{
    auto p = paramsOf(bench.layout);
    p.width = static_cast<std::uint32_t>(area.width);
    p.height = static_cast<std::uint32_t>(area.height);
    render::setRectangle(p, window);
    bench.value("p", p);
    bench.window(window);
    bench.value("sigma", sigma);
    bench.plane("objectId", lost.objectId);
    bench.plane("normal", lost.normal);
    bench.plane("taken", lost.taken);
    bench.plane("excess", lost.excess);
}

/// Both kernels, the first over all pixels that the second reads.
class Spread {
public:
    explicit Spread(const device::Device& device, bool parts)
        : frame_(device, smallScene(),
            keptSettings(parts ? render::axisAligned(16) : render::monteCarlo(16),
                { "path-density", { 10, 2, 3, 3, 0, 0, 0, 0 } }))
        , sums_(frame_, "spreadSums")
        , excess_(frame_, "spreadExcess")
    {
        REQUIRE(excess_.has("parts") == parts);
    }
    const render::PlaneLayout& layout() const { return sums_.layout; }

    Gained operator()(const Lost& lost, const Area& area, float sigma, const Planes<float>& before)
    {
        setLoss(sums_, lost, area, { 0, 0, area.width, area.height }, sigma);
        sums_.plane("per", Planes<float>(layout(), 1, untouched));
        sums_.run();
        setLoss(excess_, lost, area, area.window, sigma);
        excess_.plane("per", sums_.pixels<float>("per"));
        excess_.plane("sums", before);
        if (excess_.has("parts"))
            excess_.plane("parts", Planes<float>(layout(), 3, 1.0f));
        excess_.run();
        return { excess_.pixels<float>("sums"),
            excess_.has("parts") ? excess_.pixels<float>("parts") : Planes<float>(layout(), 0, 0) };
    }
    Planes<float> per() const { return sums_.pixels<float>("per"); }

private:
    DeclaredFrame frame_;
    PassBench sums_, excess_;
};

/// The kernels of widths that grow, likewise.
class GrowingSpread {
public:
    explicit GrowingSpread(const device::Device& device, bool parts)
        : frame_(device, smallScene(),
            keptSettings(parts ? render::axisAligned(16) : render::monteCarlo(16),
                { "path-density", { 10, 2, 3, 3, 0, 0, 0, 12 } }))
        , widths_(frame_, "spreadWidths")
        , blocks_(frame_, "spreadBlocks")
        , excess_(frame_, "spreadExcess")
    {
        REQUIRE(excess_.has("parts") == parts);
        REQUIRE(excess_.own<float>("sigma") == 12);
        REQUIRE(widths_.own<float>("sigma") == 3);
    }
    const render::PlaneLayout& layout() const { return widths_.layout; }

    /// Widths are sigma, twice that and so on, up to `widest`, which is one of them.
    Gained operator()(const Lost& lost, const Area& area, float sigma, float widest, const Planes<float>& before)
    {
        const image::Window whole { 0, 0, area.width, area.height };
        setLoss(widths_, lost, area, whole, sigma);
        widths_.value("widest", widest);
        widths_.plane("sums", before);
        widths_.plane("per", Planes<float>(layout(), 1, untouched));
        widths_.plane("width", Planes<float>(layout(), 1, untouched));
        widths_.run();
        auto p = paramsOf(layout());
        p.width = static_cast<std::uint32_t>(area.width);
        p.height = static_cast<std::uint32_t>(area.height);
        render::setRectangle(p, whole);
        blocks_.value("p", p);
        blocks_.window(whole);
        blocks_.plane("width", width());
        blocks_.plane("widths", Planes<float>(layout(), 1, untouched));
        blocks_.run();
        setLoss(excess_, lost, area, area.window, widest);
        excess_.plane("per", per());
        excess_.plane("width", width());
        excess_.plane("widths", largest());
        excess_.plane("sums", before);
        if (excess_.has("parts"))
            excess_.plane("parts", Planes<float>(layout(), 3, 1.0f));
        excess_.run();
        return { excess_.pixels<float>("sums"),
            excess_.has("parts") ? excess_.pixels<float>("parts") : Planes<float>(layout(), 0, 0) };
    }
    Planes<float> per() const { return widths_.pixels<float>("per"); }
    Planes<float> width() const { return widths_.pixels<float>("width"); }
    Planes<float> largest() const { return blocks_.pixels<float>("widths"); }

private:
    DeclaredFrame frame_;
    PassBench widths_, blocks_, excess_;
};

template <class Test>
void onEveryGrowingSpread(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const bool parts : { false, true }) {
            CAPTURE(parts);
            GrowingSpread spread(device, parts);
            test(spread);
        }
    });
}

double luminanceOf(glm::dvec3 v) { return glm::dot(v, glm::dvec3(0.2126, 0.7152, 0.0722)); }

/// The widths that a pixel's loss may be spread by: the narrowest at which what the pixel gets of it is at most a tenth
/// of the mean around it, weighted alike. More than one where that is too close to tell in floats.
std::vector<double> widthsOf(
    const Lost& of, const Area& area, glm::ivec2 from, double sigma, double widest, const Planes<float>& kept)
{
    const double loss = std::abs(luminanceOf(of.excess.vector(from.x, from.y)));
    std::vector<double> out;
    for (int doubled = 0; std::ldexp(sigma, doubled) < widest; ++doubled) {
        const double width = std::ldexp(sigma, doubled);
        double own = 0, mean = 0;
        sharesOf(of, area, from, width, [&](glm::ivec2 to, double share) {
            own += to == from ? share : 0;
            mean += share * luminanceOf(kept.vector(to.x, to.y)) / static_cast<double>(of.taken.at(to.x, to.y));
        });
        const double over = loss * own - 0.1 * mean, unsure = 1e-5 * mean;
        if (over <= unsure)
            out.push_back(width);
        if (over < -unsure)
            return out;
    }
    out.push_back(widest);
    return out;
}

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

/// What pixels of an area gain, in double; sigmaOf(x, y): by what each one's loss is spread.
template <class SigmaOf>
std::vector<glm::dvec3> gainsOf(const Lost& lost, const Area& area, const SigmaOf& sigmaOf)
{
    std::vector<glm::dvec3> out(static_cast<std::size_t>(area.width * area.height), glm::dvec3(0));
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        if (lost.taken.at(x, y) == 0 || lost.excess.vector(x, y) == glm::dvec3(0))
            return;
        sharesOf(lost, area, { x, y }, sigmaOf(x, y), [&](glm::ivec2 to, double share) {
            out[indexOf(to.x, to.y, area.width)] += share * lost.excess.vector(x, y);
        });
    });
    return out;
}

/// Holds what is found against sums before and gains in double.
void checkGains(const Gained& found, const Lost& lost, const Area& area, const Planes<float>& before,
    const std::vector<glm::dvec3>& gains)
{
    everyPixelOf(area.window, [&](int x, int y) {
        CAPTURE(x);
        CAPTURE(y);
        const glm::dvec3 gain = gains[indexOf(x, y, area.width)];
        const double n = lost.taken.at(x, y);
        for (int k = 0; k < 3; ++k) {
            const double expected = before.vector(x, y)[k] + n * gain[k];
            REQUIRE(found.sums.vector(x, y)[k] == doctest::Approx(expected).epsilon(1e-5));
            if (!found.parts.values.empty())
                REQUIRE(std::fabs(found.parts.vector(x, y)[k] - (1 + gain[k]))
                    <= 2e-4 * (1 + std::max({ gain.x, gain.y, gain.z })));
        }
        REQUIRE(found.sums.at(x, y, 3) == before.at(x, y, 3));
    });
}

/// Whether each object has what its pixels lose; found: of sums that were 0.
void checkBalance(const Gained& found, const Lost& lost, const Area& area, const Planes<float>& per)
{
    std::map<std::uint32_t, glm::dvec3> balance, all;
    everyPixelOf(area.window, [&](int x, int y) {
        const std::uint32_t n = lost.taken.at(x, y), object = lost.objectId.at(x, y);
        if (n == 0) {
            REQUIRE(found.sums.vector(x, y) == glm::dvec3(0));
            REQUIRE(per.at(x, y) == 0);
            return;
        }
        REQUIRE((per.at(x, y) > 0) == (lost.excess.vector(x, y) != glm::dvec3(0)));
        balance[object] += found.sums.vector(x, y) / double { static_cast<double>(n) } - lost.excess.vector(x, y);
        all[object] += lost.excess.vector(x, y);
    });
    CHECK(all.size() == 3);
    for (const auto& object : all)
        REQUIRE(glm::length(balance[object.first]) <= 1e-5 * glm::length(object.second));
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

TEST_CASE("spreadWidths: the narrowest width at which a pixel gets back no more than a tenth of the mean around it")
{
    std::mt19937 random(4);
    onEveryGrowingSpread([&](GrowingSpread& spread) {
        for (const Area& area : areas())
            for (const float sigma : { 0.5f, 3.0f }) {
                CAPTURE(&area - areas().data());
                CAPTURE(sigma);
                const float widest = 8 * sigma;
                const Lost lost = someLoss(spread.layout(), area, random);
                const auto before = planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10));
                const Gained found = spread(lost, area, sigma, widest, before);
                const Planes<float> width = spread.width(), per = spread.per();
                std::map<float, int> pixels;
                everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    const float chosen = width.at(x, y);
                    ++pixels[chosen];
                    REQUIRE((chosen > 0) == (per.at(x, y) > 0));
                    if (lost.taken.at(x, y) == 0 || lost.excess.vector(x, y) == glm::dvec3(0)) {
                        REQUIRE(chosen == 0);
                        return;
                    }
                    const std::vector<double> may = widthsOf(lost, area, { x, y }, sigma, widest, before);
                    REQUIRE(std::ranges::find(may, chosen) != may.end());
                });
                if (area.height > 20)
                    CHECK(pixels.size() == 5); // none and four widths
                checkGains(found, lost, area, before,
                    gainsOf(lost, area, [&](int x, int y) { return double { width.at(x, y) }; }));
            }
    });
}

TEST_CASE("spreadWidths, spreadExcess: no object gains or loses light by widths that differ, a crop is the whole's")
{
    std::mt19937 random(5);
    onEveryGrowingSpread([&](GrowingSpread& spread) {
        const Area &whole = areas()[0], &crop = areas()[1];
        const Lost lost = someLoss(spread.layout(), whole, random);
        const Planes<float> none(spread.layout(), 4, 0.0f);
        const Gained gained = spread(lost, whole, 3, 24, none);
        checkBalance(gained, lost, whole, spread.per());
        const auto before = planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10));
        const Gained all = spread(lost, whole, 0.5f, 4, before), part = spread(lost, crop, 0.5f, 4, before);
        everyPixelOf(crop.window, [&](int x, int y) { REQUIRE(part.sums.vector(x, y) == all.sums.vector(x, y)); });
    });
}

TEST_CASE("spreadWidths, spreadExcess: of twice the light twice as much, of light that is missing as wide")
{
    std::mt19937 random(6);
    onEveryGrowingSpread([&](GrowingSpread& spread) {
        const Area& area = areas()[0];
        Lost lost = someLoss(spread.layout(), area, random);
        auto before = planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10));
        const Gained once = spread(lost, area, 0.5f, 4, before);
        const std::vector<float> width = spread.width().values;
        const auto scale = [](Planes<float>& planes, float by) {
            for (float& value : planes.values)
                value *= by;
        };
        scale(lost.excess, 2);
        scale(before, 2);
        const Gained twice = spread(lost, area, 0.5f, 4, before);
        CHECK(spread.width().values == width);
        everyPixelOf(
            area.window, [&](int x, int y) { REQUIRE(twice.sums.vector(x, y) == 2.0 * once.sums.vector(x, y)); });
        scale(lost.excess, -1);
        spread(lost, area, 0.5f, 4, before);
        CHECK(spread.width().values == width);
    });
}

TEST_CASE("spreadBlocks: the largest width of the pixels right of and below a pixel, of eight by eight")
{
    std::mt19937 random(7);
    onEveryGrowingSpread([&](GrowingSpread& spread) {
        for (const Area& area : areas()) {
            const Lost lost = someLoss(spread.layout(), area, random);
            spread(
                lost, area, 0.5f, 4, planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10)));
            const Planes<float> width = spread.width(), largest = spread.largest();
            everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
                float expected = 0;
                everyPixelOf({ x, y, std::min(x + 8, area.width), std::min(y + 8, area.height) },
                    [&](int u, int v) { expected = std::max(expected, width.at(u, v)); });
                REQUIRE(largest.at(x, y) == expected);
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
