// Samples of pixels by their brightness (kernels/sinks/sample_bins.h), as accumulate.cl adds waves of receivers to
// them, against their definition in double.
#include "tests/sample_bins_support.h"

// Behind the others, whose parameters are called as its constants are.
#include "tests/accumulate_oracle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double leastTexture = 1e-6; ///< as accumulate.cl has it

using OfPoint = std::function<glm::dvec3(const SeenPoint&)>;

/// What waves find.
struct Found {
    OfPoint reflectance, irradiance;
};

glm::dvec3 diffuseOf(const SeenPoint& p) { return p.diffuse; }
glm::dvec3 black(const SeenPoint&) { return glm::dvec3(0); }

/// Irradiances over all bins. One in nine or so is no number.
glm::dvec3 wideIrradiance(const SeenPoint& p)
{
    const double decade = 3 * std::sin(1e3 * p.pixelSize + 7 * p.weight[0]);
    const glm::dvec3 out = (p.irradiance + 0.01) * std::pow(10, decade);
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    return p.rays == 3 ? glm::dvec3(nan, out.y, out.z) : p.rays == 4 ? glm::dvec3(out.x, out.y, infinity) : out;
}

/// One sample of a pixel's bins.
struct Binned {
    std::size_t bin;
    glm::dvec3 radiance;
    double weight;
};

/// What a pixel's bins are to hold.
struct ExpectedBins {
    std::vector<Binned> samples;
    std::uint32_t notFinite = 0; ///< samples of receivers whose mean is no number
    bool uncertain = false; ///< a sample is so near to the end of a bin that rounding decides

    /// Adds the mean of so many samples.
    void add(const glm::dvec3& radiance, std::uint32_t count, double exposure, double weight)
    {
        if (!isFinite(glm::dvec3(glm::vec3(radiance)))) {
            notFinite += count;
            return;
        }
        const double lightness = labOracle(exposure * radiance).x / 20;
        std::size_t bin = 0;
        for (const double end : binEnds) {
            bin += lightness >= end ? 1 : 0;
            uncertain |= std::fabs(lightness - end) < 1e-4 * end;
        }
        samples.push_back({ bin, radiance, weight });
    }
    Bin bin(std::size_t b) const
    {
        Bin out;
        double sum = 0;
        for (const Binned& sample : samples)
            if (sample.bin == b) {
                out.mean += sample.weight * sample.radiance;
                sum += sample.weight;
                ++out.count;
            }
        if (out.count > 0) {
            out.mean /= sum;
            out.weight = sum / out.count;
        }
        return out;
    }
    /// The largest number of a bin's means, and the largest weight.
    glm::dvec2 largest(std::size_t b) const
    {
        glm::dvec2 out(0);
        for (const Binned& sample : samples)
            if (sample.bin == b)
                out = glm::max(out,
                    glm::dvec2(std::max({ sample.radiance.x, sample.radiance.y, sample.radiance.z }), sample.weight));
        return out;
    }
};

/// Bins of an image while waves are added to them; `fill` is in all of them before.
class BinBench {
public:
    BinBench(const device::Device& device, Receivers kind, float exposed, const Bin& fill = {})
        : a(device, width, height, window, kind)
        , exposure(exposed)
        , expected(indexOf(0, height, width))
        , before_(a.waves.layout, binsOfPixel * numbersOfBin, elsewhere)
        , exposure_(a.waves.bench.buffer(std::vector<float> { exposed }))
        , bins_(buffer(fill))
        , notFinite_(a.waves.bench.buffer(std::vector<std::uint32_t>(a.waves.layout.size, countedBefore)))
    {
    }

    void add(const Rounds& rounds, TermCount count, const Found& found)
    {
        TermPixels term(a, count, leastTexture);
        SurfacePixels surfaces(a);
        for (const auto& upTo : rounds) {
            a.begin(upTo);
            term.begin(a);
            for (std::size_t r = 0; r < a.points.size(); ++r) {
                const std::uint32_t samples = a.shareOf(r, term.before, term.after);
                const glm::dvec3 texture = found.reflectance(a.points[r]);
                if (a.points[r].object != 0 && samples > 0)
                    at(a.lists.x(r), a.lists.y(r))
                        .add(found.irradiance(a.points[r]), samples, exposure,
                            a.published != 0 ? 1 : samples * luminanceOf(texture + leastTexture));
            }
            accumulatePaths(a, term, false, found.reflectance, found.irradiance,
                { plane("bins", bins_, render::sampleBins), plane("exposure", exposure_),
                    plane("notFinite", notFinite_) });
            accumulateSurfaces(a, surfaces);
        }
        const auto values = a.read(term.value);
        a.waves.everyPixel([&](int x, int y) { REQUIRE(isFinite(values.vector(x, y))); });
    }
    ExpectedBins& at(int x, int y) { return expected[indexOf(x, y, width)]; }
    Planes<std::uint16_t> read() { return a.read(bins_); }

    /// Checks all pixels that are certain, and that none beside the window has been touched.
    void check()
    {
        const Planes<std::uint16_t> found = read();
        const Planes<std::uint32_t> notFinite = a.read(notFinite_);
        int checked = 0, skipped = 0, filled = 0;
        everyPixelOf({ 0, 0, width, height }, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            if (x < window.x0 || x >= window.x1 || y < window.y0 || y >= window.y1) {
                for (std::size_t k = 0; k < binsOfPixel * numbersOfBin; ++k)
                    REQUIRE(found.at(x, y, k) == elsewhere);
                REQUIRE(notFinite.at(x, y) == countedBefore);
                return;
            }
            REQUIRE(notFinite.at(x, y) == countedBefore + at(x, y).notFinite);
            ++(at(x, y).uncertain ? skipped : checked);
            for (std::size_t b = 0; !at(x, y).uncertain && b < binsOfPixel; ++b)
                filled += checkBin(binsAt(found, x, y)[b], at(x, y), b) ? 1 : 0;
        });
        CHECK(checked > 350);
        CHECK(skipped < 10);
        CHECK(filled > 40);
    }

    Accumulation a;
    const double exposure;
    std::vector<ExpectedBins> expected;

private:
    static constexpr std::uint16_t elsewhere = 0x1234;
    static constexpr std::uint32_t countedBefore = 5;

    device::Buffer<std::uint16_t> buffer(const Bin& fill)
    {
        a.waves.everyPixel([&](int x, int y) {
            for (std::size_t k = 0; k < binsOfPixel * numbersOfBin; ++k) {
                before_.at(x, y, k) = coded(fill)[k % numbersOfBin];
            }
        });
        return a.waves.bench.buffer(before_.values);
    }
    /// Whether there are samples in it. Each one that is added rounds the mean and the weight once; what is rounded off
    /// before stays as far away, or comes nearer, and a wrong weight takes a mean off by a quarter of it at most.
    static bool checkBin(const Bin& found, const ExpectedBins& of, std::size_t b)
    {
        CAPTURE(b);
        const Bin bin = of.bin(b);
        const glm::dvec2 error = 1.25 * bin.count * roundingOfBins * of.largest(b);
        CAPTURE(bin.count);
        REQUIRE(found.count == bin.count);
        for (int k = 0; k < 3; ++k) {
            CAPTURE(bin.mean[k]);
            CAPTURE(found.mean[k]);
            REQUIRE(std::fabs(found.mean[k] - bin.mean[k]) <= error.x);
        }
        CAPTURE(bin.weight);
        CAPTURE(found.weight);
        REQUIRE(std::fabs(found.weight - bin.weight) <= error.y);
        return bin.count > 1;
    }

    Planes<std::uint16_t> before_;
    device::Buffer<float> exposure_;
    device::Buffer<std::uint16_t> bins_;
    device::Buffer<std::uint32_t> notFinite_;
};

} // namespace

TEST_CASE("accumulatePaths: of each bin count, weighted mean and mean weight, in one wave or in three; what is no "
          "number is in none, and counted")
{
    onEveryDevice([](const device::Device& device) {
        for (const std::uint32_t published : { 0u, 1u })
            for (const Receivers kind : { Receivers::All, Receivers::Related })
                for (const float exposure : { 1.0f, 0.03f })
                    for (const TermCount count : { more, oneEach, fewer, skipping })
                        for (const Rounds& rounds : { oneRound, threeRounds }) {
                            if (published != 0 && count != more)
                                continue;
                            CAPTURE(published);
                            CAPTURE(exposure);
                            CAPTURE(rounds.size());
                            CAPTURE(nameOf(count));
                            BinBench bins(device, kind, exposure);
                            bins.a.published = published;
                            bins.add(rounds, count, { diffuseOf, wideIrradiance });
                            bins.check();
                        }
    });
}

TEST_CASE("accumulatePaths: samples on black textures are in their bins, with next to no weight")
{
    onEveryDevice([](const device::Device& device) {
        BinBench bins(device, Receivers::LitSurfaces, 1);
        bins.add(threeRounds, more, { black, wideIrradiance });
        bins.check();
        const Planes<std::uint16_t> found = bins.read();
        bins.a.waves.everyPixel([&](int x, int y) {
            for (const Bin& bin : binsAt(found, x, y)) {
                REQUIRE(bin.weight <= 1e-5);
                REQUIRE((bin.weight > 0) == (bin.count > 0));
            }
        });
    });
}

TEST_CASE("accumulatePaths: all bins are filled, each end of them is where L* is")
{
    onEveryDevice([](const device::Device& device) {
        for (std::size_t b = 0; b < binsOfPixel; ++b)
            for (const double side : { -1e-3, 1e-3 }) {
                const double end = b + 1 < binsOfPixel ? binEnds[b] : 1e4;
                CAPTURE(end);
                CAPTURE(side);
                BinBench bins(device, Receivers::LitSurfaces, 0.5f);
                const glm::dvec3 colour = 2.0 * colourOf(end * (1 + side), { 0.9, 0.2, 0.5 });
                bins.add(oneRound, oneEach, { diffuseOf, [&](const SeenPoint&) { return colour; } });
                const Planes<std::uint16_t> found = bins.read();
                bins.a.waves.everyPixel([&](int x, int y) {
                    const std::size_t own = side < 0 || b + 1 == binsOfPixel ? b : b + 1;
                    const Bins all = binsAt(found, x, y);
                    REQUIRE(all[own].count == total(x, y));
                    REQUIRE(samplesIn(all) == total(x, y));
                });
            }
    });
}

TEST_CASE("accumulatePaths: where 16 bits count no more samples, all bins of the pixel have half of theirs")
{
    onEveryDevice([](const device::Device& device) {
        for (const std::uint32_t count : { mostInBin - 2, mostInBin - 1, mostInBin }) {
            CAPTURE(count);
            const Bin fill = binOf({ 2, 1, 0.5 }, 0.75, count);
            BinBench bins(device, Receivers::LitSurfaces, 1, fill);
            bins.add(threeRounds, oneEach, { diffuseOf, [](const SeenPoint&) { return glm::dvec3(2.1, 1, 0.5); } });
            const Planes<std::uint16_t> found = bins.read();
            int halved = 0, down = 0, up = 0;
            bins.a.waves.everyPixel([&](int x, int y) {
                CAPTURE(x);
                CAPTURE(y);
                // All of a wave's samples are added first, and odd numbers are halved by chance.
                const bool halves = count + total(x, y) > mostInBin;
                const std::uint32_t least = halves ? count / 2 : count, most = halves ? (count + 1) / 2 : count,
                                    owns = halves ? (count + total(x, y)) / 2 : count + total(x, y),
                                    ownsAtMost = halves ? mostInBin / 2 + 1 + total(x, y) : owns;
                halved += halves ? 1 : 0;
                int added = 0;
                for (const Bin& bin : binsAt(found, x, y)) {
                    down += halves && bin.count == least ? 1 : 0;
                    up += halves && bin.count == most ? 1 : 0;
                    const bool other = bin.count == least || bin.count == most;
                    added += other ? 0 : 1;
                    REQUIRE((other || (bin.count >= owns && bin.count <= ownsAtMost)));
                    REQUIRE(glm::length(bin.mean - fill.mean) <= 2 * (2 + total(x, y)) * roundingOfBins);
                    REQUIRE(std::fabs(bin.weight - fill.weight) <= (2 + total(x, y)) * roundingOfBins);
                }
                REQUIRE((added == 1 || owns <= most));
            });
            CHECK(halved > 200);
            CHECK(std::min(down, up) > 400);
        }
    });
}

TEST_CASE("accumulatePaths: means of thousands of samples are those of all, whatever most of them are like")
{
    onEveryDevice([](const device::Device& device) {
        const auto chance = [](const SeenPoint& p) { return std::fmod(std::fabs(p.position.x * 7919.123), 1.0); };
        const std::vector<OfPoint> irradiances { [&](const SeenPoint& p) {
                                                    return glm::dvec3(chance(p) < 0.05 ? 0.018 : 0);
                                                },
            [&](const SeenPoint& p) { return glm::dvec3(chance(p) < 0.01 ? 5000 : 50); },
            [&](const SeenPoint& p) { return glm::dvec3(60 * std::pow(chance(p) + 1e-4, -1 / 1.5)); } };
        for (const OfPoint& irradiance : irradiances)
            for (const std::uint32_t each : { 64u, 4096u }) {
                CAPTURE(&irradiance - irradiances.data());
                CAPTURE(each);
                BinBench bins(device, Receivers::LitSurfaces, 1);
                bins.add({ [each](int x, int y) { return x % 4 == 0 && y % 4 == 0 ? each : 0u; } }, oneEach,
                    { [](const SeenPoint&) { return glm::dvec3(0.5); }, irradiance });
                const Planes<std::uint16_t> found = bins.read();
                double sum = 0, worst = 0, pixels = 0;
                bins.a.waves.everyPixel([&](int x, int y) {
                    const Bins all = binsAt(found, x, y);
                    double light = 0, expected = 0;
                    for (std::size_t b = 0; b < binsOfPixel; ++b) {
                        const Bin bin = bins.at(x, y).bin(b);
                        light += all[b].mean.y * all[b].count;
                        expected += bin.mean.y * bin.count;
                    }
                    if (expected > 0) {
                        sum += light / expected - 1;
                        worst = std::max(worst, std::fabs(light / expected - 1));
                        ++pixels;
                    }
                });
                REQUIRE(pixels > 10);
                CHECK(std::fabs(sum / pixels) < 0.003);
                CHECK(worst < 0.03);
            }
    });
}

TEST_CASE("accumulatePaths: half the exposure of twice the radiance fills the same bins, to the bit")
{
    onEveryDevice([](const device::Device& device) {
        BinBench plain(device, Receivers::All, 1), brighter(device, Receivers::All, 0.5f);
        plain.add(threeRounds, more, { diffuseOf, wideIrradiance });
        brighter.add(threeRounds, more, { diffuseOf, [](const SeenPoint& p) { return 2.0 * wideIrradiance(p); } });
        const Planes<std::uint16_t> found = plain.read(), other = brighter.read();
        plain.a.waves.everyPixel([&](int x, int y) {
            const Bins bins = binsAt(found, x, y), others = binsAt(other, x, y);
            for (std::size_t b = 0; b < binsOfPixel; ++b) {
                REQUIRE(others[b].mean == 2.0 * bins[b].mean);
                REQUIRE(others[b].weight == bins[b].weight);
                REQUIRE(others[b].count == bins[b].count);
            }
        });
    });
}
