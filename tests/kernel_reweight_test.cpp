// Re-weighting of filter/sample_weights.cl alone, against its definition in double.
#include "tests/sample_weights_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::size_t cascades = 6;
constexpr double base = 8;
using Cascades = std::array<double, cascades>;

/// How much of a sample of that luminance is in each cascade, in all 1: of base^j and base^(j+1) so much that the
/// inverses of the luminance and of these are in the same proportion; what is darker or brighter than all is in the
/// first or the last.
Cascades sharesOf(double luminance)
{
    Cascades out {};
    const double position = std::log(std::max(luminance, 1.0)) / std::log(base);
    const auto lower = static_cast<std::size_t>(std::floor(position + 1e-12));
    if (lower + 1 >= cascades) {
        out[cascades - 1] = 1;
        return out;
    }
    const double low = 1 / std::pow(base, lower), high = low / base, own = 1 / std::max(luminance, 1.0);
    out[lower] = (own - high) / (low - high);
    out[lower + 1] = 1 - out[lower];
    return out;
}

Cascades lightOf(const Samples& samples, double exposure)
{
    Cascades out {};
    for (const StoredSample& sample : samples) {
        if (!isFinite(sample.radiance))
            continue;
        const Cascades shares = sharesOf(exposure * brightness(sample));
        for (std::size_t c = 0; c < cascades; ++c)
            out[c] += shares[c] * exposure * brightness(sample);
    }
    return out;
}

/// Samples of the brightness of cascade c or of one beside it.
double samplesAt(const Cascades& light, std::size_t c)
{
    double sum = 0;
    for (std::size_t at = c == 0 ? 0 : c - 1; at < std::min(c + 2, cascades); ++at)
        sum += light[at] / std::pow(base, at);
    return sum;
}

/// How far cascades are trusted, Zirr et al. 2018: half the sum of what counts say, (samples - 1) / kappa, and of what
/// the pixel's brightness so far says, in samples of the cascade's over kappa, up to `base` times that where kappa is
/// large. Counts are the pixel's own where the 3x3 around it has one on average.
Cascades trustOf(const SampleField& field, int x, int y, double exposure, double kappa, bool& uncertain)
{
    Cascades around {}, trust {};
    everyPixelOf({ x - 1, y - 1, x + 2, y + 2 }, [&](int u, int v) {
        if (!field.contains(u, v))
            return;
        const Cascades there = lightOf(field.at(u, v), exposure);
        for (std::size_t c = 0; c < cascades; ++c)
            around[c] += there[c] / 9;
    });
    const Cascades own = lightOf(field.at(x, y), exposure);
    const auto n = static_cast<double>(field.at(x, y).size());
    const double error = std::clamp(1 / kappa, 0.0, 1.0);
    double brightest = 1, trusted = 0;
    for (std::size_t c = 0; c < cascades; ++c) {
        const double near = samplesAt(around, c), count = near < 1 ? near : samplesAt(own, c);
        uncertain |= std::fabs(near - 1) < 1e-4;
        brightest = std::max(brightest, trusted / n);
        const double colour = brightest * n / (kappa * std::pow(base, c)) * (base + (1 - base) * error);
        trust[c] = c == 0 ? 1 : std::clamp(((count - 1) / kappa + colour) / 2, 0.0, 1.0);
        trusted += trust[c] * own[c];
    }
    return trust;
}

Weighed reweightedOracle(const SampleField& field, int x, int y, double exposure, double kappa)
{
    Weighed out;
    const Cascades trust = trustOf(field, x, y, exposure, kappa, out.uncertain);
    for (const StoredSample& sample : field.at(x, y)) {
        const Cascades shares = sharesOf(isFinite(sample.radiance) ? exposure * brightness(sample) : 0);
        out.weights.push_back(std::inner_product(shares.begin(), shares.end(), trust.begin(), 0.0));
    }
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
