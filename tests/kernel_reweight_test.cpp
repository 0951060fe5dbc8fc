// Re-weighting of filter/sample_weights.cl alone, against its definition in double.
#include "tests/reweighting_oracle.h"
#include "tests/sample_weights_support.h"

#include <algorithm>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

Cascades lightOf(const Samples& samples, double exposure)
{
    Cascades out {};
    for (const StoredSample& sample : samples)
        if (isFinite(sample.radiance))
            addLight(out, exposure * brightness(sample), 1);
    return out;
}

Weighed reweightedOracle(const SampleField& field, int x, int y, double exposure, double kappa)
{
    Cascades around {};
    everyPixelOf({ x - 1, y - 1, x + 2, y + 2 }, [&](int u, int v) {
        if (!field.contains(u, v))
            return;
        const Cascades there = lightOf(field.at(u, v), exposure);
        for (std::size_t c = 0; c < cascades; ++c)
            around[c] += there[c];
    });
    Weighed out;
    const auto n = static_cast<double>(field.at(x, y).size());
    const Cascades trust = trustOf(lightOf(field.at(x, y), exposure), around, n, kappa, out.uncertain);
    for (const StoredSample& sample : field.at(x, y))
        out.weights.push_back(trustIn(trust, isFinite(sample.radiance) ? exposure * brightness(sample) : 0));
    return out;
}

} // namespace

TEST_CASE("keepReweighted: cascades of brightness are trusted by their samples and by the brightness below them")
{
    const SampleField field = someField(6);
    inEveryFrame("keepReweighted", [&](PassBench& bench, std::uint32_t firstPass) {
        for (const image::Window& window : { whole, image::Window { 5, 3, 20, 25 } })
            for (const float exposure : { 1.0f, 0.2f, 40.0f, 3000.0f })
                for (const float kappa : { 0.25f, 1.0f, 3.0f, 20.0f }) {
                    CAPTURE(exposure);
                    CAPTURE(kappa);
                    bench.value("kappa", kappa);
                    setExposure(bench, exposure);
                    const KeptPlanes found = keep(bench, field, window, 8, 40, firstPass);
                    checkKept(found, field, window, false, firstPass, 2e-5 * std::max(1.0f, 1 / kappa),
                        [&](int x, int y) { return reweightedOracle(field, x, y, exposure, kappa); });
                }
    });
}

TEST_CASE("keepReweighted: several samples of a brightness are kept for a small kappa, single ones are dimmed")
{
    std::mt19937 random(7);
    SampleField field(fieldWidth, fieldHeight);
    everyPixelOf(whole, [&](int x, int y) {
        for (int j = 0; j < 24; ++j)
            field.at(x, y).push_back(storedSample(
                (j % 6 == 0 ? 90 : 0.4) * std::exp(0.2 * uniform(random, -1, 1)) * glm::dvec3(1, 0.8, 0.5)));
        if (x % 6 == 0 && y % 6 == 0)
            field.at(x, y)[0] = storedSample({ 4e4, 3e4, 5e4 });
    });
    inEveryFrame("keepReweighted", [&](PassBench& bench, std::uint32_t) {
        setExposure(bench, 1);
        for (const float kappa : { 1e-3f, 1.0f }) {
            CAPTURE(kappa);
            bench.value("kappa", kappa);
            const KeptPlanes found = keep(bench, field, whole, 8, 40);
            everyPixelOf(whole, [&](int x, int y) {
                CAPTURE(x);
                CAPTURE(y);
                const double is = luminanceOf(keptMean(found, x, y)), was = luminanceOf(plainMean(field.at(x, y)));
                CAPTURE(is);
                CAPTURE(was);
                if (x % 6 == 0 && y % 6 == 0)
                    REQUIRE(is < 0.2 * was);
                else
                    REQUIRE(is == doctest::Approx(was).epsilon(1e-5));
            });
        }
    });
}
