// Filters over samples that are known by their brightness alone, kernel by kernel (path_density.cl, sample_weights.cl),
// against their definitions in double.
#include "tests/reweighting_oracle.h"
#include "tests/sample_bins_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double reach = 4; ///< no two samples are farther apart
constexpr double rounding = 3e-4; ///< of isolations: of Lab, whose curve is exact to 1e-6 of colours of up to 30 pixels

/// Of a bin's samples, all of which have the same.
struct Distances {
    std::vector<std::pair<double, std::uint32_t>> nearest; ///< distance and how many, nearest first
    double isolation(std::uint32_t k) const
    {
        double sum = 0;
        std::uint32_t left = k;
        for (const auto& each : nearest) {
            const std::uint32_t n = std::min(left, each.second);
            sum += n * std::min(each.first, reach);
            left -= n;
        }
        return (sum + left * reach) / k;
    }
};
using PixelDistances = std::array<Distances, binsOfPixel>;

/// Of all bins of all pixels, of whatever distance.
std::vector<PixelDistances> distancesOf(const BinField& field, double exposure)
{
    std::vector<std::array<glm::dvec3, binsOfPixel>> colours(field.pixels.size());
    for (std::size_t i = 0; i < colours.size(); ++i)
        for (std::size_t b = 0; b < binsOfPixel; ++b)
            colours[i][b] = labOracle(exposure * field.pixels[i][b].mean) / 20.0;
    std::vector<PixelDistances> out(field.pixels.size());
    const auto visit = [&](int x, int y, std::size_t b, Distances& to) {
        everyPixelOf({ 0, 0, field.width, field.height }, [&](int u, int v) {
            const double apart = std::hypot(u - x, v - y);
            for (std::size_t c = 0; c < binsOfPixel && apart < reach; ++c) {
                const bool self = u == x && v == y && c == b;
                const std::uint32_t count = field.at(u, v)[c].count - (self ? 1u : 0u);
                const glm::dvec3 between =
                    colours[indexOf(u, v, field.width)][c] - colours[indexOf(x, y, field.width)][b];
                if (field.at(u, v)[c].count > 0)
                    to.nearest.emplace_back(self ? 0 : apart + glm::length(between), count);
            }
        });
        std::ranges::sort(to.nearest);
    };
    everyPixelOf({ 0, 0, field.width, field.height }, [&](int x, int y) {
        for (std::size_t b = 0; b < binsOfPixel; ++b)
            if (field.at(x, y)[b].count > 0)
                visit(x, y, b, out[indexOf(x, y, field.width)][b]);
    });
    return out;
}

struct Thresholds {
    std::uint32_t k;
    double low, high;
};

void set(PassBench& bench, const Thresholds& of)
{
    bench.value("k", of.k);
    bench.value("low", static_cast<float>(of.low));
    bench.value("high", static_cast<float>(of.high));
}

/// What has been checked of shares and pixels.
struct Seen {
    unsigned whole = 0, between = 0, gone = 0, alone = 0, skipped = 0;
};

/// A pixel's shares by its isolations, and the least and the most that rounding makes of them.
struct ExpectedShares {
    std::array<double, binsOfPixel> share {}, least {}, most {}, isolation {};
    double leastKept = 0, mostKept = 0, leastIsolation = 1e30, isolations = 0;

    ExpectedShares(const Bins& bins, const PixelDistances& distances, const Thresholds& of)
    {
        const auto ramp = [&](double meanDistance) {
            return std::clamp((of.high - meanDistance) / (of.high - of.low), 0.0, 1.0);
        };
        for (std::size_t b = 0; b < binsOfPixel; ++b) {
            share[b] = least[b] = most[b] = 1;
            if (bins[b].count == 0)
                continue;
            isolation[b] = distances[b].isolation(of.k);
            share[b] = ramp(isolation[b]);
            least[b] = ramp(isolation[b] + rounding);
            most[b] = ramp(isolation[b] - rounding);
            leastKept += least[b] * bins[b].count;
            mostKept += most[b] * bins[b].count;
            leastIsolation = std::min(leastIsolation, isolation[b]);
            isolations += isolation[b] * bins[b].count;
        }
    }
};

/// Checks a pixel's shares. Where hardly any sample is kept, of bins whose isolation is the same but for rounding any
/// may be the one that is.
void checkShares(const Planes<float>& found, int x, int y, const Bins& bins, const ExpectedShares& of, Seen& seen)
{
    if (of.leastKept < 1e-3 && of.mostKept >= 1e-3) {
        ++seen.skipped; // rounding decides whether one is alone
        return;
    }
    const bool alone = samplesIn(bins) > 0 && of.mostKept < 1e-3;
    unsigned wholes = 0;
    for (std::size_t b = 0; b < binsOfPixel; ++b) {
        CAPTURE(b);
        CAPTURE(bins[b].count);
        CAPTURE(of.isolation[b]);
        CAPTURE(of.share[b]);
        const double share = found.at(x, y, b);
        CAPTURE(share);
        if (bins[b].count == 0) {
            REQUIRE(share == 1);
            continue;
        }
        if (alone && share == 1 && of.isolation[b] <= of.leastIsolation + 2 * rounding) {
            ++wholes;
            continue;
        }
        REQUIRE(share >= of.least[b] * (1 - roundingOfShorts) - 1e-6);
        REQUIRE(share <= of.most[b] * (1 + roundingOfShorts) + 1e-6);
        ++(share == 1 ? seen.whole : share == 0 ? seen.gone : seen.between);
    }
    REQUIRE(wholes == (alone ? 1u : 0u));
    seen.alone += wholes;
}

/// Shares of a field, of all thresholds.
void checkDensity(PassBench& bench, const BinField& field, const BinArea& area, double exposure, Seen& seen)
{
    const std::vector<PixelDistances> distances = distancesOf(field, exposure);
    for (const Thresholds& of : { Thresholds { 1, 0.25, 0.75 }, Thresholds { 10, 2, 3 }, Thresholds { 10, 1.5, 1.5001 },
             Thresholds { 50, 2, 3.5 }, Thresholds { 256, 0.5, 1.5 } }) {
        CAPTURE(of.k);
        CAPTURE(of.low);
        CAPTURE(area.width);
        CAPTURE(area.height);
        CAPTURE(exposure);
        set(bench, of);
        const Planes<float> found = sharesMade(bench, field, area, static_cast<float>(exposure));
        const auto densities =
            bench.has("density") ? bench.pixels<float>("density") : Planes<float>(bench.layout, 0, 0);
        everyPixelOf(area.window, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const Bins& bins = field.at(x, y);
            const ExpectedShares expected(bins, distances[indexOf(x, y, field.width)], of);
            checkShares(found, x, y, bins, expected, seen);
            if (densities.values.empty())
                return;
            const double samples = std::max<double>(1, static_cast<double>(samplesIn(bins)));
            const double density = densities.at(x, y);
            CAPTURE(density);
            REQUIRE(std::fabs(density - expected.isolations / samples) <= rounding);
        });
    }
}

/// Calls test(bench) for the kernel in a frame with layers, which measures density, and in one without.
template <class Test>
void inEveryFrame(const std::string& kernel, const render::ChosenFilter& filter, const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const bool layers : { false, true }) {
            CAPTURE(layers);
            DeclaredFrame frame(device, smallScene(), binnedSettings(render::monteCarlo(16), filter), layers);
            PassBench bench(frame, kernel);
            REQUIRE(bench.has("density") == (layers && kernel == "keepBinsByDensity"));
            test(bench);
        }
    });
}

const render::ChosenFilter byDensity { "path-density", { 10, 2, 3, 3, 1, 0, 0 } },
    reweighting { "reweight", { 1, 0, 1 } }, clamping { "clamp", { 10, 0, 1 } };

} // namespace

TEST_CASE("keepBinsByDensity: samples go by their mean distance to the k nearest of all, those of their bin included")
{
    Seen seen;
    inEveryFrame("keepBinsByDensity", byDensity, [&](PassBench& bench) {
        for (const BinArea& area : binAreas())
            for (const double exposure : { 1.0, 0.125 }) {
                BinField field = someBins(1, area.width, area.height);
                for (Bins& bins : field.pixels)
                    for (Bin& bin : bins)
                        bin.mean /= exposure; // samples are in bins of their exposed radiance
                checkDensity(bench, field, area, exposure, seen);
            }
    });
    CHECK(std::min({ seen.whole, seen.between, seen.gone }) > 3000);
    CHECK(seen.alone > 100);
    CHECK(seen.skipped < 50);
}

TEST_CASE("keepBinsByDensity: isolations by approximate neighbours are at most 1 + epsilon times the true ones")
{
    constexpr std::uint32_t k = 10;
    unsigned farther = 0;
    inEveryFrame("keepBinsByDensity", byDensity, [&](PassBench& bench) {
        if (!bench.has("density"))
            return;
        for (const BinArea& area : binAreas()) {
            const BinField field = someBins(1, area.width, area.height);
            const std::vector<PixelDistances> distances = distancesOf(field, 1);
            for (const float stretch : { 1.25f, 2.0f, 5.0f }) {
                set(bench, { k, 2, 3 });
                bench.value("stretch", stretch);
                sharesMade(bench, field, area, 1);
                const Planes<float> densities = bench.pixels<float>("density");
                everyPixelOf(area.window, [&](int x, int y) {
                    const Bins& bins = field.at(x, y);
                    const ExpectedShares expected(bins, distances[indexOf(x, y, field.width)], { k, 2, 3 });
                    const double samples = std::max<double>(1, static_cast<double>(samplesIn(bins)));
                    const double exact = expected.isolations / samples, is = densities.at(x, y);
                    CAPTURE(x);
                    CAPTURE(y);
                    CAPTURE(stretch);
                    CAPTURE(exact);
                    REQUIRE(is >= exact - rounding);
                    REQUIRE(is <= stretch * exact + rounding);
                    farther += is > exact + 0.001 ? 1 : 0;
                });
            }
        }
    });
    CHECK(farther > 100);
}

TEST_CASE("keepBinsByDensity: of one pixel alone k counts the other samples of its bin, and what there is not is 4 off")
{
    const BinArea one { 1, 1, { 0, 0, 1, 1 } };
    inEveryFrame("keepBinsByDensity", byDensity, [&](PassBench& bench) {
        set(bench, { 10, 1, 3 });
        for (const std::uint32_t count : { 1u, 4u, 6u, 10u, 11u, mostInBin }) {
            CAPTURE(count);
            BinField field(1, 1);
            field.at(0, 0)[2] = binOf({ 0.2, 0.2, 0.2 }, 1, count);
            const Planes<float> found = sharesMade(bench, field, one, 1);
            const double isolation = 4 - 0.4 * std::min(count - 1u, 10u);
            // With no sample kept the only bin is kept whole.
            const double share = isolation >= 3 ? 1 : std::clamp((3 - isolation) / 2, 0.0, 1.0);
            REQUIRE(found.at(0, 0, 2) == doctest::Approx(share).epsilon(roundingOfShorts));
            if (bench.has("density"))
                REQUIRE(bench.pixels<float>("density").at(0, 0) == doctest::Approx(isolation));
        }
    });
}

TEST_CASE(
    "keepBinsByDensity, keepBinsReweighted, keepBinsClamped: more radiance and as much less exposure, same shares")
{
    const auto check = [](PassBench& bench) {
        for (const BinArea& area : binAreas())
            requireSameOfScaled(bench, someBins(2, area.width, area.height), area, 3);
    };
    inEveryFrame("keepBinsByDensity", byDensity, check);
    inEveryFrame("keepBinsReweighted", reweighting, check);
    inEveryFrame("keepBinsClamped", clamping, check);
}

namespace {

Cascades lightOf(const Bins& bins, double exposure)
{
    Cascades out {};
    for (const Bin& bin : bins)
        if (bin.count > 0)
            addLight(out, exposure * luminanceOf(bin.mean), bin.count);
    return out;
}

/// Trust of a pixel's cascades by bins whose samples are all as bright as their mean.
Cascades trustAt(const BinField& field, int x, int y, double exposure, double kappa, bool& uncertain)
{
    Cascades around {};
    everyPixelOf({ x - 1, y - 1, x + 2, y + 2 }, [&](int u, int v) {
        if (!field.contains(u, v))
            return;
        const Cascades there = lightOf(field.at(u, v), exposure);
        for (std::size_t c = 0; c < cascades; ++c)
            around[c] += there[c];
    });
    const double n = std::max<double>(1, static_cast<double>(samplesIn(field.at(x, y))));
    return trustOf(lightOf(field.at(x, y), exposure), around, n, kappa, uncertain);
}

} // namespace

TEST_CASE("keepBinsReweighted: cascades of brightness are trusted by their samples and by the brightness below them")
{
    unsigned whole = 0, dimmed = 0, uncertain = 0;
    inEveryFrame("keepBinsReweighted", reweighting, [&](PassBench& bench) {
        for (const BinArea& area : binAreas())
            for (const float exposure : { 1.0f, 0.05f, 300.0f })
                for (const float kappa : { 0.25f, 1.0f, 20.0f }) {
                    CAPTURE(area.width);
                    CAPTURE(exposure);
                    CAPTURE(kappa);
                    const BinField field = someBins(3, area.width, area.height);
                    bench.value("kappa", kappa);
                    const Planes<float> found = sharesMade(bench, field, area, exposure);
                    everyPixelOf(area.window, [&](int x, int y) {
                        CAPTURE(x);
                        CAPTURE(y);
                        bool rounded = false;
                        const Cascades trust = trustAt(field, x, y, exposure, kappa, rounded);
                        uncertain += rounded ? 1 : 0;
                        for (std::size_t b = 0; !rounded && b < binsOfPixel; ++b) {
                            CAPTURE(b);
                            const Bin& bin = field.at(x, y)[b];
                            const double share = bin.count > 0 ? trustIn(trust, exposure * luminanceOf(bin.mean)) : 1;
                            const double error = roundingOfShorts * share + 2e-5 * std::max(1.0f, 1 / kappa);
                            REQUIRE(std::fabs(found.at(x, y, b) - share) <= error);
                            REQUIRE((bin.count > 0 || found.at(x, y, b) == 1));
                            ++(found.at(x, y, b) == 1 ? whole : dimmed);
                        }
                    });
                }
    });
    CHECK(whole > 3000);
    CHECK(dimmed > 3000);
    CHECK(uncertain < 100);
}

TEST_CASE("keepBinsReweighted: several samples of a brightness are kept for a small kappa, a single one is dimmed")
{
    BinField field(29, 27);
    everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
        field.at(x, y)[3] = binOf({ 0.4, 0.3, 0.2 }, 1, 20);
        field.at(x, y)[7] = binOf({ 90, 80, 50 }, 1, 4);
        if (x % 6 == 0 && y % 6 == 0)
            field.at(x, y)[7] = binOf({ 4e4, 3e4, 5e4 }, 1, 1);
    });
    inEveryFrame("keepBinsReweighted", reweighting, [&](PassBench& bench) {
        for (const float kappa : { 1e-3f, 1.0f }) {
            bench.value("kappa", kappa);
            const Planes<float> found = sharesMade(bench, field, binAreas()[0], 1);
            everyPixelOf(binAreas()[0].window, [&](int x, int y) {
                REQUIRE(found.at(x, y, 3) == 1);
                const bool single = x % 6 == 0 && y % 6 == 0;
                REQUIRE((single ? found.at(x, y, 7) < 0.2 : found.at(x, y, 7) == 1));
            });
        }
    });
}

TEST_CASE("keepBinsClamped: of samples brighter than the level as much is kept as makes them as bright as it")
{
    unsigned whole = 0, dimmed = 0;
    inEveryFrame("keepBinsClamped", clamping, [&](PassBench& bench) {
        for (const BinArea& area : binAreas())
            for (const glm::vec2 of : { glm::vec2(1, 1), glm::vec2(0.25f, 0.4f), glm::vec2(10, 2) }) {
                CAPTURE(of.x);
                const BinField field = someBins(4, area.width, area.height);
                bench.value("level", of.x);
                const Planes<float> found = sharesMade(bench, field, area, of.y);
                everyPixelOf(area.window, [&](int x, int y) {
                    for (std::size_t b = 0; b < binsOfPixel; ++b) {
                        const double brightness = of.y * luminanceOf(field.at(x, y)[b].mean);
                        const double share = std::min(1.0, of.x / std::max(brightness, 1e-30));
                        REQUIRE(std::fabs(found.at(x, y, b) - share) <= roundingOfShorts * share);
                        REQUIRE((brightness > of.x * (1 - 1e-5) || found.at(x, y, b) == 1));
                        ++(brightness > of.x ? dimmed : whole);
                    }
                });
            }
    });
    CHECK(whole > 3000);
    CHECK(dimmed > 1000);
}
