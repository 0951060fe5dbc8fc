// filter/sample_weights.cl, kernel by kernel but for re-weighting, against their definitions in double.
#include "tests/sample_weights_support.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Indices in the order of brightness, those of equal ones in theirs.
std::vector<std::size_t> byBrightness(const Weights& values)
{
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    return order;
}

Weighed clampedOracle(const Samples& samples, double level, double exposure)
{
    Weighed out;
    for (const StoredSample& sample : samples)
        out.weights.push_back(std::min(1.0, level / (exposure * brightness(sample))));
    return out;
}

Weighed trimmedOracle(const Samples& samples, double share)
{
    Weights values;
    for (const StoredSample& sample : samples)
        values.push_back(brightness(sample));
    const std::vector<std::size_t> order = byBrightness(values);
    const std::size_t n = samples.size();
    const auto wanted = static_cast<std::size_t>(std::floor(share * static_cast<double>(n) + 1e-6));
    const std::size_t ends = std::min(wanted, (n - 1) / 2);
    Weighed out { Weights(n, 0) };
    for (std::size_t rank = ends; rank < n - ends; ++rank)
        out.weights[order[rank]] = 1;
    return out;
}

/// Means of groups, sample j being of group j mod m.
Weights groupMeans(const Samples& samples, std::size_t m)
{
    Weights sums(m, 0), counts(m, 0);
    for (std::size_t j = 0; j < samples.size(); ++j) {
        sums[j % m] += brightness(samples[j]);
        counts[j % m] += 1;
    }
    for (std::size_t g = 0; g < m; ++g)
        sums[g] /= counts[g];
    return sums;
}

/// Half the relative mean absolute difference.
double giniOf(const Weights& values)
{
    double differences = 0, sum = 0;
    for (const double a : values) {
        sum += a;
        for (const double b : values)
            differences += std::fabs(a - b);
    }
    return sum > 0 ? differences / (2 * static_cast<double>(values.size()) * sum) : 0;
}

/// Buisine et al. 2021: of m groups, Gini times (m - 1) / 2 of them at either end.
Weighed medianOracle(const Samples& samples, std::size_t groups)
{
    const std::size_t m = std::min(groups, samples.size());
    const Weights means = groupMeans(samples, m);
    const bool finite = std::ranges::all_of(means, [](double v) { return std::isfinite(v); });
    const std::size_t atEitherEnd = (m - 1) / 2;
    const auto most = static_cast<double>(atEitherEnd);
    const double exact = finite ? giniOf(means) * most : most;
    const auto ends = static_cast<std::size_t>(std::round(exact));
    const std::vector<std::size_t> order = byBrightness(means);
    Weighed out { Weights(samples.size(), 0) };
    out.uncertain = std::fabs(std::fabs(exact - std::floor(exact)) - 0.5) < 1e-4;
    for (std::size_t rank = ends; rank < m - ends; ++rank)
        for (std::size_t j = order[rank]; j < samples.size(); j += m)
            out.weights[j] = 1;
    return out;
}

} // namespace

TEST_CASE("keepClamped: what is brighter than the level is as bright as that, and what goes is not made up for")
{
    const SampleField field = someField(1);
    inEveryFrame("keepClamped", [&](PassBench& bench, std::uint32_t firstPass) {
        for (const image::Window& window : { whole, image::Window { 5, 3, 20, 25 } })
            for (const glm::vec2 of : { glm::vec2(1, 1), glm::vec2(0.25f, 0.4f), glm::vec2(10, 2) }) {
                CAPTURE(of.x);
                bench.value("level", of.x);
                setExposure(bench, of.y);
                const KeptPlanes found = keep(bench, field, window, 8, 40, firstPass);
                checkKept(found, field, window, false, firstPass, 1e-6,
                    [&](int x, int y) { return clampedOracle(field.at(x, y), of.x, of.y); });
            }
    });
}

TEST_CASE("keepClamped: single samples keep their hue, and no pixel gets brighter")
{
    SampleField one(fieldWidth, fieldHeight);
    std::mt19937 random(2);
    everyPixelOf(whole, [&](int x, int y) {
        one.at(x, y) = { storedSample(
            std::pow(10, uniform(random, -3, 4)) * glm::dvec3(uniform(random), uniform(random), uniform(random))) };
    });
    inEveryFrame("keepClamped", [&](PassBench& bench, std::uint32_t) {
        bench.value("level", 2.0f);
        setExposure(bench, 0.5f);
        const KeptPlanes found = keep(bench, one, whole, 8, 1);
        unsigned dimmed = 0;
        everyPixelOf(whole, [&](int x, int y) {
            const glm::dvec3 kept = keptMean(found, x, y), was = one.at(x, y)[0].radiance;
            REQUIRE(glm::length(glm::cross(kept, was)) <= 1e-6 * glm::length(kept) * glm::length(was));
            REQUIRE(luminanceOf(kept) <= std::min(luminanceOf(was), 4.0) * (1 + 1e-6));
            REQUIRE(luminanceOf(kept) >= std::min(luminanceOf(was), 4.0) * (1 - 1e-6));
            dimmed += luminanceOf(was) > 4 ? 1 : 0;
        });
        CHECK(dimmed > 100);
        CHECK(dimmed < 700);
    });
}

TEST_CASE("keepTrimmed: a share of the samples goes at either end of their luminances, at a half all but the median")
{
    const SampleField field = someField(3);
    inEveryFrame("keepTrimmed", [&](PassBench& bench, std::uint32_t firstPass) {
        for (const image::Window& window : { whole, image::Window { 5, 3, 20, 25 } })
            for (const float share : { 0.1f, 0.25f, 0.5f }) {
                CAPTURE(share);
                bench.value("share", share);
                const KeptPlanes found = keep(bench, field, window, 8, 40, firstPass);
                checkKept(found, field, window, true, firstPass, 0,
                    [&](int x, int y) { return trimmedOracle(field.at(x, y), share); });
            }
        bench.value("share", 0.5f);
        const KeptPlanes found = keep(bench, field, whole, 8, 40, firstPass);
        everyPixelOf(whole, [&](int x, int y) {
            Weights values;
            for (const StoredSample& sample : field.at(x, y))
                values.push_back(brightness(sample));
            std::ranges::sort(values);
            const std::size_t n = values.size();
            if (n == 0 || !std::isfinite(values[n / 2]))
                return;
            const double median = (values[(n - 1) / 2] + values[n / 2]) / 2;
            REQUIRE(luminanceOf(keptMean(found, x, y)) == doctest::Approx(median).epsilon(1e-5));
        });
    });
}

TEST_CASE("keepTrimmed: of equally bright samples the first are the darker ones")
{
    SampleField field(fieldWidth, fieldHeight);
    // Of the samples of one colour the first part has another number than the second, so that parts tell which goes.
    field.at(3, 3) = Samples(10, storedSample({ 1, 2, 3 }));
    field.at(3, 3)[9] = storedSample({ 5, 5, 5 });
    field.at(3, 3)[0] = storedSample({ 5, 5, 5 });
    inEveryFrame("keepTrimmed", [&](PassBench& bench, std::uint32_t firstPass) {
        bench.value("share", 0.1f);
        const KeptPlanes found = keep(bench, field, whole, 8, 40, firstPass);
        // Sample 1 is the darkest, sample 9 the brightest.
        const KeptOracle expected = keptOf(field.at(3, 3), { 1, 0, 1, 1, 1, 1, 1, 1, 1, 0 }, 0, true, firstPass);
        requireKept(found, 3, 3, 10, expected);
    });
}

TEST_CASE("keepMedianOfMeans: of groups' means as many go at either end as their Gini coefficient says")
{
    const SampleField field = someField(5);
    inEveryFrame("keepMedianOfMeans", [&](PassBench& bench, std::uint32_t firstPass) {
        for (const image::Window& window : { whole, image::Window { 5, 3, 20, 25 } })
            for (const std::uint32_t groups : { 3u, 9u, 15u, 63u }) {
                CAPTURE(groups);
                bench.value("groups", groups);
                const KeptPlanes found = keep(bench, field, window, 8, 40, firstPass);
                checkKept(found, field, window, true, firstPass, 0,
                    [&](int x, int y) { return medianOracle(field.at(x, y), groups); });
            }
    });
}

TEST_CASE("keepMedianOfMeans: equal means are all kept to the bit, and of one that has all light nothing is")
{
    SampleField field(fieldWidth, fieldHeight);
    everyPixelOf(whole, [&](int x, int y) {
        field.at(x, y) = Samples(27, storedSample({ 0.3, 0.2, 0.1 + 0.01 * x }));
        if (x % 2 == 1) {
            field.at(x, y) = Samples(27, storedSample({ 0, 0, 0 }));
            field.at(x, y)[static_cast<std::size_t>(y)] = storedSample({ 40, 50, 60 });
        }
    });
    inEveryFrame("keepMedianOfMeans", [&](PassBench& bench, std::uint32_t firstPass) {
        bench.value("groups", 9u);
        const KeptPlanes found = keep(bench, field, whole, 8, 40, firstPass);
        everyPixelOf(whole, [&](int x, int y) {
            glm::vec3 sum(0);
            for (const StoredSample& sample : field.at(x, y))
                sum += glm::vec3(sample.radiance);
            REQUIRE(found.sums.vector(x, y) == (x % 2 == 1 ? glm::dvec3(0) : glm::dvec3(sum)));
            REQUIRE((x % 2 == 1 || found.excess.vector(x, y) == glm::dvec3(0)));
        });
    });
}

TEST_CASE("keepTrimmed, keepMedianOfMeans: with fast maths, too, no sample is left out that is not to be")
{
    const SampleField field = someField(9);
    render::Options options = renderOptions();
    options.fastMath = true;
    for (const char* kernel : { "keepTrimmed", "keepMedianOfMeans" }) {
        const bool trimmed = std::string(kernel) == "keepTrimmed";
        inEveryFrame(
            kernel,
            [&](PassBench& bench, std::uint32_t firstPass) {
                const KeptPlanes found = keep(bench, field, whole, 8, 40, firstPass);
                checkKept(found, field, whole, true, firstPass, 0, [&](int x, int y) {
                    return trimmed ? trimmedOracle(field.at(x, y), 0.1) : medianOracle(field.at(x, y), 9);
                });
            },
            options);
    }
}

TEST_CASE("a power of two times the radiance, its exposure over that: so many times the sums, to the bit")
{
    const SampleField field = someField(8);
    for (const Product& product : products())
        inEveryFrame(product.kernel, [&](PassBench& bench, std::uint32_t firstPass) {
            setExposure(bench, 3.0f);
            const KeptPlanes plain = keep(bench, field, whole, 8, 40, firstPass);
            for (const double times : { 4096.0, 1.0 / 1024 }) {
                SampleField scaled = field;
                for (Samples& samples : scaled.pixels)
                    for (StoredSample& sample : samples)
                        sample.radiance *= times; // and the colours that the other exposure makes of it
                setExposure(bench, static_cast<float>(3 / times));
                const KeptPlanes found = keep(bench, scaled, whole, 8, 40, firstPass);
                everyPixelOf(whole, [&](int x, int y) {
                    if (field.at(x, y).empty())
                        return;
                    REQUIRE(found.sums.vector(x, y) == times * plain.sums.vector(x, y));
                    REQUIRE(found.sums.at(x, y, 3) == times * times * plain.sums.at(x, y, 3));
                    REQUIRE(found.excess.vector(x, y) == times * plain.excess.vector(x, y));
                    if (bench.has("parts"))
                        REQUIRE(found.parts.vector(x, y) == times * plain.parts.vector(x, y));
                });
            }
        });
}
