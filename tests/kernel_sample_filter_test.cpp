// filter/path_density.cl alone against its definition in double: isolations by all samples of all pixels.
#include "tests/stored_samples_support.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::size_t mostNearest = 50; ///< of those that are looked for

/// Of each sample the mean distances to the 1, 2, ... nearest others: |dx| + |dLab| / 20, not above 4. What there is
/// not is as far as that.
using Isolations = std::vector<std::vector<double>>; ///< of a pixel's samples, by k - 1

/// Distances of a sample to all others of the image.
std::vector<double> distancesOf(const SampleField& field, int x, int y, std::size_t index)
{
    const glm::dvec3 own = field.at(x, y)[index].colour;
    std::vector<double> out;
    everyPixelOf({ 0, 0, field.width, field.height }, [&](int u, int v) {
        const double apart = std::hypot(u - x, v - y);
        const std::vector<StoredSample>& there = field.at(u, v);
        for (std::size_t j = 0; j < there.size(); ++j)
            if (u != x || v != y || j != index)
                out.push_back(std::min(4.0, apart + glm::length(there[j].colour - own)));
    });
    return out;
}

Isolations isolationsOf(const SampleField& field, int x, int y)
{
    Isolations out;
    for (std::size_t index = 0; index < field.at(x, y).size(); ++index) {
        std::vector<double> distances = distancesOf(field, x, y, index), means;
        distances.resize(std::max(distances.size(), mostNearest), 4.0);
        std::partial_sort(distances.begin(), distances.begin() + mostNearest, distances.end());
        double sum = 0;
        for (std::size_t k = 0; k < mostNearest; ++k) {
            sum += distances[k];
            means.push_back(sum / static_cast<double>(k + 1));
        }
        out.push_back(std::move(means));
    }
    return out;
}

std::vector<Isolations> allIsolations(const SampleField& field)
{
    std::vector<Isolations> out;
    everyPixelOf({ 0, 0, field.width, field.height }, [&](int x, int y) { out.push_back(isolationsOf(field, x, y)); });
    return out;
}

struct Thresholds {
    std::uint32_t k;
    double low, high;
};

constexpr double rounding = 2e-5; ///< of isolations

/// Weights of a pixel's samples.
struct Weighed {
    std::vector<double> weights;
    double sum = 0; ///< of what is a number
    double least = 1e30; ///< isolation
    bool uncertain = false; ///< a step that rounding may take
};

bool isStep(const Thresholds& of) { return of.high - of.low < 1e-3; }

Weighed weigh(const std::vector<StoredSample>& samples, const Isolations& isolations, const Thresholds& of)
{
    Weighed out;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        const double isolation = isolations[j][of.k - 1];
        out.weights.push_back(std::clamp((of.high - isolation) / (of.high - of.low), 0.0, 1.0));
        out.uncertain |= isStep(of) && std::fabs(isolation - of.low) < 1e-4;
        if (isFinite(samples[j].radiance)) {
            out.sum += out.weights.back();
            out.least = std::min(out.least, isolation);
        }
    }
    return out;
}

/// Weights where one sample is kept: the least isolated one. Of those that rounding does not tell apart, such as two
/// that are each other's nearest, the one that has been found.
std::vector<double> plainestAlone(const std::vector<StoredSample>& samples, const Isolations& isolations,
    std::uint32_t k, double least, const glm::dvec3& found)
{
    std::vector<double> out(samples.size(), 0);
    std::size_t nearest = samples.size();
    const auto off = [&](std::size_t j) { return glm::length(samples[j].radiance - found); };
    for (std::size_t j = 0; j < samples.size(); ++j)
        if (isFinite(samples[j].radiance) && isolations[j][k - 1] <= least + rounding)
            nearest = nearest == samples.size() || off(j) < off(nearest) ? j : nearest;
    out[nearest] = 1;
    return out;
}

/// Means of what a pixel keeps, and of all.
glm::dvec3 keptMean(const KeptPlanes& found, int x, int y)
{
    return found.sums.vector(x, y) / static_cast<double>(found.taken.at(x, y));
}
glm::dvec3 plainMean(const std::vector<StoredSample>& samples)
{
    glm::dvec3 sum(0);
    for (const StoredSample& sample : samples)
        sum += sample.radiance;
    return sum / static_cast<double>(samples.size());
}

/// How many samples have gone, have been kept and what is between, and how many pixels have kept one alone.
struct Seen {
    unsigned whole = 0, between = 0, gone = 0, alone = 0, skipped = 0;
};

/// Checks a pixel; one whose outcome hangs on rounding is left out.
void checkPixel(const KeptPlanes& found, const SampleField& field, int x, int y, const Isolations& isolations,
    const Thresholds& of, std::size_t firstPass, Seen& seen)
{
    const std::vector<StoredSample>& samples = field.at(x, y);
    Weighed weighed = weigh(samples, isolations, of);
    if ((weighed.sum > 0 && weighed.sum < 0.01) || weighed.uncertain) {
        ++seen.skipped;
        return;
    }
    for (const double weight : weighed.weights)
        ++(weight == 1 ? seen.whole : weight == 0 ? seen.gone : seen.between);
    if (weighed.sum == 0 && weighed.least < 1e30) {
        ++seen.alone;
        weighed.weights = plainestAlone(samples, isolations, of.k, weighed.least, keptMean(found, x, y));
    }
    const double error = isStep(of) ? 0 : rounding / (of.high - of.low);
    requireKept(found, x, y, samples.size(), keptOf(samples, weighed.weights, error, true, firstPass));
}

void checkDensity(const KeptPlanes& found, int x, int y, const Isolations& isolations, std::uint32_t k)
{
    double sum = 0;
    for (const std::vector<double>& of : isolations)
        sum += of[k - 1];
    CAPTURE(x);
    CAPTURE(y);
    CAPTURE(k);
    CAPTURE(found.density.at(x, y));
    REQUIRE(found.density.at(x, y) == doctest::Approx(sum / static_cast<double>(isolations.size())).epsilon(2e-5));
}

void set(PassBench& bench, const Thresholds& of)
{
    bench.value("k", of.k);
    bench.value("low", static_cast<float>(of.low));
    bench.value("high", static_cast<float>(of.high));
}

/// As many samples of each pixel, all stored at once.
render::Settings evenly(int spp)
{
    render::Settings s = render::axisAligned(spp);
    s.indirect.counts = render::IndirectCounts::Uniform;
    return s;
}

/// A frame with path density and what it is asked for besides.
struct Kind {
    render::Settings settings;
    bool layers;
    std::uint32_t firstPass;
};

std::vector<Kind> kinds()
{
    const render::ChosenFilter filter { "path-density", { 10, 2, 3, 3, 0, 0, 0 } };
    return { { keptSettings(render::monteCarlo(70), filter), false, 0 },
        { keptSettings(render::monteCarlo(70), filter), true, 0 }, { keptSettings(evenly(70), filter), false, 16 } };
}

/// Calls test(bench) for the kernel of every kind of frame on every device.
template <class Test>
void inEveryFrame(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const Kind& kind : kinds()) {
            CAPTURE(kind.layers);
            CAPTURE(kind.firstPass);
            DeclaredFrame frame(device, smallScene(), kind.settings, kind.layers);
            PassBench bench(frame, "keepByDensity");
            REQUIRE(bench.has("density") == kind.layers);
            REQUIRE(bench.has("parts") == (kind.firstPass > 0));
            test(bench, kind);
        }
    });
}

} // namespace

namespace {

/// Checks samples of a field of 29x27 pixels by these thresholds, in bands and windows of any rows.
Seen checkField(const SampleField& field, const std::vector<Thresholds>& thresholds)
{
    const std::vector<Isolations> isolations = allIsolations(field);
    Seen seen;
    inEveryFrame([&](PassBench& bench, const Kind& kind) {
        for (const Thresholds& of : thresholds)
            for (const image::Window& window : { image::Window { 0, 0, 29, 27 }, image::Window { 3, 5, 26, 22 } })
                for (const int rows : { 8, 32 }) {
                    CAPTURE(of.k);
                    CAPTURE(of.low);
                    CAPTURE(rows);
                    set(bench, of);
                    const KeptPlanes found = keep(bench, field, window, rows, 70, kind.firstPass);
                    everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
                        const bool inside = x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
                        const Isolations& own = isolations[indexOf(x, y, 29)];
                        if (!inside || own.empty()) {
                            requireUntouched(found, x, y);
                            return;
                        }
                        checkPixel(found, field, x, y, own, of, kind.firstPass, seen);
                        if (kind.layers)
                            checkDensity(found, x, y, own, of.k);
                    });
                }
    });
    return seen;
}

} // namespace

TEST_CASE("keepByDensity: samples go by their mean distance to the k nearest of all, in bands and windows of any rows")
{
    std::mt19937 random(1);
    const Seen seen = checkField(someSamples(random, 29, 27, 70),
        { { 1, 0.25, 0.75 }, { 10, 1, 2 }, { 10, 2, 3 }, { 10, 1.5, 1.5 + 1e-6 }, { 50, 2, 3.5 } });
    CHECK(std::min({ seen.whole, seen.between, seen.gone }) > 5000);
    CHECK(seen.alone > 100);
    CHECK(seen.skipped < 300);
}

TEST_CASE("keepByDensity: by distances of RGB")
{
    std::mt19937 random(7);
    const Seen seen = checkField(someSamples(random, 29, 27, 70, Space::Rgb), { { 1, 0.25, 0.75 }, { 10, 2, 3 } });
    CHECK(std::min({ seen.whole, seen.between, seen.gone }) > 2000);
    CHECK(seen.alone > 100);
    CHECK(seen.skipped < 120);
}

namespace {

/// Sums of a pixel's isolations, true ones.
double sumOf(const Isolations& isolations, std::uint32_t k)
{
    double sum = 0;
    for (const std::vector<double>& of : isolations)
        sum += of[k - 1];
    return sum;
}

/// What has been found of approximate neighbours.
struct Approximate {
    unsigned farther = 0; ///< pixels whose isolation is not the true one
    unsigned whole = 0; ///< that are sure to keep all
};

/// Checks a pixel's isolation to be the true one or up to `stretch` times as large; and where no layer asks for it,
/// that what is kept is what such isolations say.
void checkApproximate(const KeptPlanes& found, int x, int y, const Isolations& own, const Thresholds& of,
    double stretch, Approximate& seen)
{
    CAPTURE(x);
    CAPTURE(y);
    CAPTURE(of.k);
    CAPTURE(stretch);
    if (!found.density.values.empty()) {
        const double exact = sumOf(own, of.k) / static_cast<double>(own.size()), is = found.density.at(x, y);
        CAPTURE(exact);
        REQUIRE(is >= exact * (1 - rounding) - rounding);
        REQUIRE(is <= stretch * exact * (1 + rounding) + rounding);
        seen.farther += is > exact * 1.001 + 0.001 ? 1 : 0;
    }
    const bool whole = std::ranges::all_of(
        own, [&](const std::vector<double>& each) { return stretch * each[of.k - 1] < of.low - rounding; });
    seen.whole += whole ? 1 : 0;
    if (whole)
        REQUIRE(glm::length(found.excess.vector(x, y)) <= 1e-5 * glm::length(keptMean(found, x, y)));
}

} // namespace

TEST_CASE("keepByDensity: isolations by approximate neighbours are at most 1 + epsilon times the true ones")
{
    std::mt19937 random(8);
    const SampleField field = someSamples(random, 29, 27, 70);
    const std::vector<Isolations> isolations = allIsolations(field);
    for (const float stretch : { 1.25f, 2.0f, 5.0f }) {
        Approximate seen;
        inEveryFrame([&](PassBench& bench, const Kind& kind) {
            for (const Thresholds& of : { Thresholds { 1, 2, 3 }, Thresholds { 10, 2, 3 }, Thresholds { 50, 3, 4 } }) {
                set(bench, of);
                bench.value("stretch", stretch);
                const KeptPlanes found = keep(bench, field, { 0, 0, 29, 27 }, 8, 70, kind.firstPass);
                everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
                    const Isolations& own = isolations[indexOf(x, y, 29)];
                    if (!own.empty())
                        checkApproximate(found, x, y, own, of, stretch, seen);
                });
            }
        });
        CAPTURE(stretch);
        CHECK(seen.farther > 100);
        CHECK(seen.whole > 20);
    }
}

TEST_CASE("keepByDensity: the kth approximate neighbour is at most 1 + epsilon times as far as the true one")
{
    // Ten times the same sample a pixel: nine others at no distance, so that ten times the isolation is that of the
    // tenth.
    constexpr std::uint32_t k = 10;
    std::mt19937 random(9);
    SampleField field(29, 27);
    everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
        const double grey = std::exp(uniform(random, -2, 2));
        field.at(x, y).assign(k, storedSample(grey * glm::dvec3(1, uniform(random, 0.5, 1), uniform(random, 0.2, 1))));
    });
    const std::vector<Isolations> isolations = allIsolations(field);
    inEveryFrame([&](PassBench& bench, const Kind& kind) {
        for (const float stretch : { 1.0f, 1.5f, 3.0f, 5.0f }) {
            if (!kind.layers)
                continue;
            set(bench, { k, 2, 3 });
            bench.value("stretch", stretch);
            const KeptPlanes found = keep(bench, field, { 0, 0, 29, 27 }, 8, 70, kind.firstPass);
            unsigned farther = 0;
            everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
                const double exact = k * isolations[indexOf(x, y, 29)].front()[k - 1];
                const double is = k * double { found.density.at(x, y) };
                CAPTURE(x);
                CAPTURE(y);
                CAPTURE(stretch);
                CAPTURE(exact);
                REQUIRE(is >= exact - k * rounding);
                REQUIRE(is <= stretch * exact + k * rounding);
                farther += is > exact + 0.001 ? 1 : 0;
            });
            CAPTURE(stretch);
            CHECK((farther > 100) == (stretch > 1));
        }
    });
}

TEST_CASE("keepByDensity: in images smaller than what is looked at, k beyond all samples counts as 4")
{
    std::mt19937 random(2);
    for (const glm::ivec2 size : { glm::ivec2(1, 1), glm::ivec2(2, 3), glm::ivec2(13, 1), glm::ivec2(1, 20) }) {
        const SampleField field = someSamples(random, size.x, size.y, 5);
        const std::vector<Isolations> isolations = allIsolations(field);
        Seen seen;
        inEveryFrame([&](PassBench& bench, const Kind& kind) {
            for (const Thresholds& of : { Thresholds { 1, 1, 2 }, Thresholds { 10, 2, 4 }, Thresholds { 50, 3, 4 } }) {
                CAPTURE(of.k);
                CAPTURE(size.x);
                CAPTURE(size.y);
                set(bench, of);
                const KeptPlanes found = keep(bench, field, { 0, 0, size.x, size.y }, 8, 5, kind.firstPass);
                everyPixelOf({ 0, 0, size.x, size.y }, [&](int x, int y) {
                    const Isolations& own = isolations[indexOf(x, y, size.x)];
                    if (own.empty())
                        return requireUntouched(found, x, y);
                    checkPixel(found, field, x, y, own, of, kind.firstPass, seen);
                    if (kind.layers)
                        checkDensity(found, x, y, own, of.k);
                });
            }
        });
        CHECK(seen.whole + seen.between + seen.gone + seen.alone > 5);
    }
}

TEST_CASE("keepByDensity: single bright samples go, all of them, and of the noise nothing, to the bit")
{
    std::mt19937 random(3);
    SampleField plain(29, 27), spiked(29, 27);
    unsigned spikes = 0;
    everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
        for (int j = 0; j < 12; ++j)
            plain.at(x, y).push_back(storedSample(glm::dvec3(0.5, 0.4, 0.3) * std::exp(0.3 * uniform(random, -1, 1))));
        spiked.at(x, y) = plain.at(x, y);
        if (x % 5 == 0 && y % 5 == 0) {
            spiked.at(x, y).push_back(storedSample(glm::dvec3(300, 250, 400)));
            ++spikes;
        }
    });
    inEveryFrame([&](PassBench& bench, const Kind& kind) {
        set(bench, { 10, 2, 3 });
        const image::Window all { 0, 0, 29, 27 };
        const KeptPlanes without = keep(bench, plain, all, 8, 16, kind.firstPass);
        const KeptPlanes with = keep(bench, spiked, all, 8, 16, kind.firstPass);
        unsigned removed = 0;
        everyPixelOf(all, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            glm::vec3 sum(0); // in the order in which they were taken
            for (const StoredSample& sample : plain.at(x, y))
                sum += glm::vec3(sample.radiance);
            REQUIRE(without.sums.vector(x, y) == glm::dvec3(sum));
            REQUIRE(without.excess.vector(x, y) == glm::dvec3(0));
            if (spiked.at(x, y).size() == 12) {
                REQUIRE(with.sums.vector(x, y) == glm::dvec3(sum));
                REQUIRE(with.excess.vector(x, y) == glm::dvec3(0));
                return;
            }
            ++removed;
            const glm::dvec3 expected = glm::dvec3(sum) / 12.0;
            REQUIRE(glm::length(keptMean(with, x, y) - expected) < 1e-5);
            REQUIRE(glm::length(with.excess.vector(x, y) - (plainMean(spiked.at(x, y)) - expected)) < 1e-4);
        });
        CHECK(removed == spikes);
    });
}

TEST_CASE("keepByDensity: two lights with many samples each are both kept, where a trimmed mean is not the mean")
{
    std::mt19937 random(4);
    SampleField field(29, 27);
    everyPixelOf({ 0, 0, 29, 27 }, [&](int x, int y) {
        // Few samples of a strong blue light among many of a weak red one.
        for (int j = 0; j < 20; ++j) {
            const double noise = std::exp(0.1 * uniform(random, -1, 1));
            field.at(x, y).push_back(
                storedSample((j < 17 ? glm::dvec3(0.2, 0.1, 0.05) : glm::dvec3(2, 4, 20)) * noise));
        }
        std::shuffle(field.at(x, y).begin(), field.at(x, y).end(), random);
    });
    const image::Window all { 0, 0, 29, 27 };
    inEveryFrame([&](PassBench& bench, const Kind& kind) {
        set(bench, { 10, 2, 3 });
        const KeptPlanes found = keep(bench, field, all, 8, 20, kind.firstPass);
        everyPixelOf(all, [&](int x, int y) {
            const glm::dvec3 plain = plainMean(field.at(x, y));
            REQUIRE(glm::length(keptMean(found, x, y) - plain) < 1e-5 * glm::length(plain));
            REQUIRE(found.excess.vector(x, y) == glm::dvec3(0));
        });
    });
    onEveryDevice([&](const device::Device& device) {
        const render::ChosenFilter trim { "trim", { 0.1f, 0 } };
        DeclaredFrame frame(device, smallScene(), keptSettings(render::monteCarlo(20), trim));
        PassBench bench(frame, "keepTrimmed");
        const KeptPlanes found = keep(bench, field, all, 8, 20);
        everyPixelOf(all, [&](int x, int y) {
            REQUIRE(luminanceOf(keptMean(found, x, y)) < 0.6 * luminanceOf(plainMean(field.at(x, y))));
        });
    });
}

TEST_CASE("keepByDensity: where all of a pixel's samples are isolated the least isolated one is left, and no other")
{
    // Alone in the image, a pixel of three samples: two of about the same colour and one of another; then a pixel of
    // one; then one of nothing but what are no numbers.
    SampleField field(29, 27);
    const auto nan = std::numeric_limits<double>::quiet_NaN();
    field.at(4, 4) = { storedSample({ 30, 30, 30 }), storedSample({ nan, 0, 0 }), storedSample({ 0.5, 0.1, 0.1 }),
        storedSample({ 0.5, 0.1, 0.12 }), storedSample({ 0.45, 0.1, 0.1 }) };
    field.at(14, 4) = { storedSample({ 1, 2, 3 }) };
    field.at(14, 14) = { storedSample({ nan, 2, 3 }), storedSample({ 1, nan, 3 }) };
    inEveryFrame([&](PassBench& bench, const Kind& kind) {
        set(bench, { 10, 2, 2.5 });
        const KeptPlanes found = keep(bench, field, { 0, 0, 29, 27 }, 8, 8, kind.firstPass);
        const Isolations isolations = isolationsOf(field, 4, 4);
        std::size_t least = 2;
        for (const std::size_t j : { 0, 2, 3, 4 })
            least = isolations[j][9] < isolations[least][9] ? j : least;
        REQUIRE(isolations[least][9] > 2.5);
        CHECK(found.sums.vector(4, 4) == glm::dvec3(5.0f * glm::vec3(field.at(4, 4)[least].radiance)));
        CHECK(found.sums.vector(14, 4) == field.at(14, 4)[0].radiance);
        CHECK(glm::length(found.excess.vector(14, 4)) < 1e-6);
        CHECK(found.sums.vector(14, 14) == glm::dvec3(0));
        CHECK(found.excess.vector(14, 14) == glm::dvec3(0));
        CHECK(found.taken.at(14, 14) == 2);
        CHECK(found.notFinite.at(14, 14) == 2);
        CHECK(found.notFinite.at(4, 4) == 1);
        CHECK(found.notFinite.at(14, 4) == 0);
    });
}
