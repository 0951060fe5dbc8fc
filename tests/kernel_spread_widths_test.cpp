// Widths of filter/spread.cl that grow with what is left out, kernel by kernel, against their definitions in double.
#include "tests/spread_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Both kernels where widths grow, the first over all pixels that the second reads.
class GrowingSpread {
public:
    explicit GrowingSpread(const device::Device& device, bool parts)
        : frame_(spreadFrame(device, parts, 12))
        , widths_(frame_, "spreadSums")
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
        setLoss(excess_, lost, area, area.window, widest);
        excess_.plane("per", per());
        excess_.plane("width", width());
        return gainedBy(excess_, before);
    }
    /// What the second kernel makes of a crop where all that lies beyond the crop's reach is what was there before.
    Gained beside(const Lost& lost, const Area& crop, float widest, const Planes<float>& before)
    {
        Lost known = lost;
        Planes<float> share = per(), wide = width();
        const int reach = static_cast<int>(std::ceil(2 * widest));
        const image::Window made = { crop.window.x0 - reach, crop.window.y0 - reach, crop.window.x1 + reach,
            crop.window.y1 + reach };
        everyPixelOf({ 0, 0, crop.width, crop.height }, [&](int x, int y) {
            if (x >= made.x0 && x < made.x1 && y >= made.y0 && y < made.y1)
                return;
            const float any = (x + y) % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1e30f;
            known.excess.setVector(x, y, glm::dvec3(any));
            share.at(x, y) = (x + y) % 3 == 0 ? any : 1.0f;
            wide.at(x, y) = 100;
        });
        setLoss(excess_, known, crop, crop.window, widest);
        excess_.plane("per", share);
        excess_.plane("width", wide);
        return gainedBy(excess_, before);
    }
    Planes<float> per() const { return widths_.pixels<float>("per"); }
    Planes<float> width() const { return widths_.pixels<float>("width"); }

private:
    DeclaredFrame frame_;
    PassBench widths_, excess_;
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

} // namespace

TEST_CASE("spreadSums: the narrowest width at which a pixel gets back no more than a tenth of the mean around it")
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

TEST_CASE("spreadSums, spreadExcess: no object gains or loses light by widths that differ, a crop is the whole's")
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

TEST_CASE("spreadSums, spreadExcess: of twice the light twice as much, of light that is missing as wide")
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

TEST_CASE("spreadExcess: of a crop nothing is read that lies beyond its reach")
{
    std::mt19937 random(8);
    onEveryGrowingSpread([&](GrowingSpread& spread) {
        const Area &whole = areas()[0], &crop = areas()[1];
        const Lost lost = someLoss(spread.layout(), whole, random);
        const auto before = planesOf(spread.layout(), someNumbers(random, 4 * spread.layout().size, 0, 10));
        const Gained all = spread(lost, whole, 0.5f, 1, before), part = spread.beside(lost, crop, 1, before);
        everyPixelOf(crop.window, [&](int x, int y) { REQUIRE(part.sums.vector(x, y) == all.sums.vector(x, y)); });
    });
}
