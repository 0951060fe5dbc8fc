// The frequency analysis of several effects in one frame against values worked out by hand, its limits, and inputs that
// are zero, infinite or no numbers. The shared maths as C++, no device.
#include "kernels/shared/defocus.h"
#include "kernels/shared/indirect.h"
#include "kernels/shared/wedge.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace wedge::shared;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float diffuse = WEDGE_DIFFUSE_BANDLIMIT;

/// Weight of a neighbour under the kernel of that covariance.
double weight(const Symmetric2& covariance, float x, float y)
{
    return std::exp(-static_cast<double>(quadraticForm(kernelExponent(covariance), x, y)));
}

} // namespace

TEST_CASE("circle of confusion (5.2): signs, the far limit, W and S of a whole camera")
{
    CHECK(circleOfConfusion(0.05f, 2, 2, 0.001f) == 0);
    CHECK(circleOfConfusion(0, 2, 0.5f, 0.001f) == 0);
    CHECK(circleOfConfusion(0, 2, 0, 0.001f) == 0);
    CHECK(circleOfConfusion(0.05f, 2, 1, 0.001f) == doctest::Approx(25));
    CHECK(circleOfConfusion(0.05f, 2, 4, 0.001f) == doctest::Approx(-12.5));
    CHECK(circleOfConfusion(0.05f, 2, infinity, 0.001f) == doctest::Approx(-25));
    CHECK(circleOfConfusion(0.05f, infinity, 5, 0.001f) == doctest::Approx(10));
    CHECK(circleOfConfusion(0.05f, infinity, infinity, 0.001f) == 0);
    // The thesis' own terms: half resolution W, half the focal plane S.
    const float a = 0.03f, f = 1.7f, z = 0.9f, halfResolution = 320, halfPlane = 1.1f;
    CHECK(circleOfConfusion(a, f, z, halfPlane / (halfResolution * f))
        == doctest::Approx(a * halfResolution / halfPlane * (f / z - 1)).epsilon(1e-5));
    for (const float depth : { 0.0f, -1.0f, 1e-30f, notANumber }) {
        CAPTURE(depth);
        CHECK(circleOfConfusion(0.05f, 2, depth, 1e-6f) == WEDGE_BLUR_MAX);
    }
}

TEST_CASE("bandlimits (5.7), (5.18), (5.22), (B.1) at values worked out by hand")
{
    CHECK(defocusBandlimit(0) == 0.5f);
    CHECK(defocusBandlimit(2) == 0.5f);
    CHECK(defocusBandlimit(8) == doctest::Approx(0.125));
    CHECK(defocusBandlimit(-8) == doctest::Approx(0.125));
    CHECK(shadowBandlimit(0.5f, 0.4f, 0.02f, 0) == doctest::Approx(0.1));
    CHECK(shadowBandlimit(0.5f, 0.4f, 0.02f, 20) == doctest::Approx(0.05));
    CHECK(shadowBandlimit(0, 0.4f, 0.02f, 0) == 0.5f);
    CHECK(lightBlur(1e-12f, 1, 0) == doctest::Approx(1e-3)); // sizes of 0 are 1e-9 m
    CHECK(directionBlur(1e-12f, 1, 0) == doctest::Approx(1e-3));
    CHECK(indirectBandlimit(0.56f, diffuse, 0.02f, 0) == doctest::Approx(0.1));
    CHECK(indirectBandlimit(0.56f, diffuse, 0.02f, 40) == doctest::Approx(0.025));
    CHECK(motionBandlimit(20) == doctest::Approx(0.1));
    CHECK(jointBandlimit(6, 16) == doctest::Approx(0.1));
    CHECK(scaledBandlimit(0.1f, 3) == doctest::Approx(0.3));
    CHECK(scaledBandlimit(0.1f, 1000) == 0.5f);
    // The kernel (5.33) at the pixel's bandlimit is not the identity: 7.5 % of the weight is the neighbours'.
    const double neighbour = std::exp(-0.5 / std::pow(kernelDeviation(0.5f, WEDGE_KERNEL_FACTOR), 2));
    CHECK(neighbour == doctest::Approx(std::exp(-4)).epsilon(1e-5));
    CHECK(std::pow(1 + 2 * neighbour, 2) == doctest::Approx(1.0746).epsilon(1e-4));
}

TEST_CASE("in focus one primary ray, of a point light as many shadow rays as primary ones")
{
    CHECK(primaryCount(defocusBandlimit(0), 0) == 1);
    CHECK(jointCount(jointBandlimit(0, 0), defocusBandlimit(0), 0, 0) == 1);
    for (const float rMin : { 0.0f, 1.0f, 5.0f })
        for (const float rMax : { 5.0f, 30.0f }) {
            const float lens = defocusBandlimit(rMin), shadow = shadowBandlimit(3, 0, 0.01f, rMin);
            CHECK(directCount(lens, rMax, 7, 0, 0.01f) == primaryCount(lens, rMax));
            CHECK(shadow == lens);
            // Reflectors at the surface itself: one direction is as good as all.
            CHECK(indirectRayCount(lens, rMax, 0, diffuse, 0.01f) == primaryCount(lens, rMax));
        }
}

TEST_CASE("counts (5.24) to (5.28) at values worked out by hand")
{
    CHECK(primaryCount(0.125f, 24) == doctest::Approx(0.625 * 0.625 * 16).epsilon(1e-5));
    CHECK(directCount(0.125f, 24, 2, 0.4f, 0.05f) == doctest::Approx(6.25 * 9).epsilon(1e-5));
    CHECK(indirectRayCount(0.125f, 24, 2.24f, diffuse, 0.05f) == doctest::Approx(6.25 * 9).epsilon(1e-5));
    CHECK(motionCountPrinted(0.125f, 48) == doctest::Approx(0.390625 * 16).epsilon(1e-5));
}

TEST_CASE("counts and bandlimits are monotone where they ought to be")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const float rMin = 20 * unit(random), rMax = rMin + 20 * unit(random), more = rMax * (1 + unit(random));
        const float sMin = 5 * unit(random), sMax = sMin + 5 * unit(random), zMin = unit(random),
                    zMax = zMin + unit(random);
        const float light = unit(random), pixel = 0.001f + 0.05f * unit(random), v = 40 * unit(random);
        const float lens = defocusBandlimit(rMin), shadow = shadowBandlimit(sMin, light, pixel, rMin);
        const float indirect = indirectBandlimit(zMin, diffuse, pixel, rMin);
        CHECK(defocusBandlimit(more) <= defocusBandlimit(rMax));
        CHECK(shadow <= lens);
        CHECK(lens <= 0.5f);
        CHECK(primaryCount(lens, more) >= primaryCount(lens, rMax));
        CHECK(directCount(shadow, rMax, sMax, light, pixel) <= directCount(lens, rMax, sMax, light, pixel));
        CHECK(indirectRayCount(indirect, rMax, zMax, diffuse, pixel)
            <= indirectRayCount(lens, rMax, zMax, diffuse, pixel));
        CHECK(directCount(lens, rMax, sMax, light, pixel) >= primaryCount(lens, rMax));
        // Motion narrows what the lens has to be sampled for.
        const float along = jointBandlimit(rMin, v);
        CHECK(along <= std::min(lens, motionBandlimit(v)));
        CHECK(along >= std::min(lens, motionBandlimit(v)) / 1.4143f);
        CHECK(jointCount(along, lens, rMax, v)
            <= primaryCount(lens, rMax) * packing(shutterBlur(v), motionBandlimit(v)) * 1.00001f);
        CHECK(jointCount(along, lens, rMax, v * 2) >= jointCount(along, lens, rMax, v));
    }
    // At one depth the count rises to r = 2 and falls back to 1: wide even blurs are the filter's.
    CHECK(primaryCount(defocusBandlimit(2), 2) == doctest::Approx(4));
    CHECK(primaryCount(defocusBandlimit(1000), 1000) == doctest::Approx(1).epsilon(5e-3));
}

TEST_CASE("(5.29) stops: counts at any mu stay below a bound")
{
    const float lens = defocusBandlimit(10);
    CHECK(primaryCount(scaledBandlimit(lens, 5), 12) == primaryCount(scaledBandlimit(lens, 1e6f), 12));
}

TEST_CASE("static and pinhole limits of lens and motion together")
{
    for (const float r : { 0.0f, 1.0f, 3.0f, 17.0f }) {
        CHECK(jointBandlimit(r, 0) == doctest::Approx(defocusBandlimit(r)).epsilon(1e-6));
        CHECK(jointCount(jointBandlimit(r, 0), defocusBandlimit(r), 2 * r, 0)
            == doctest::Approx(primaryCount(defocusBandlimit(r), 2 * r)).epsilon(1e-5));
    }
    for (const float v : { 0.0f, 1.0f, 10.0f, 60.0f }) {
        CHECK(jointBandlimit(0, v) == doctest::Approx(motionBandlimit(v)).epsilon(1e-6));
        // One axis of time and one of the image: the root of (B.3) as printed.
        CHECK(jointCount(jointBandlimit(0, v), defocusBandlimit(0), 0, v)
            == doctest::Approx(std::sqrt(motionCountPrinted(motionBandlimit(v), v))).epsilon(1e-5));
    }
}

TEST_CASE("pinhole limits: the kernels of chapters 3 and 4")
{
    // Chapter 3, sigma s / (k mu); here l_I s / sqrt 32. With l_I = sigma the same but for k mu / sqrt 32 = 1.06.
    const float sigma = 0.4f, pixel = 0.01f, k = 3, mu = 2;
    for (const float s : { 0.2f, 1.0f, 5.0f }) {
        const float ours = pixel * kernelDeviation(shadowBandlimit(s, sigma, pixel, 0), WEDGE_KERNEL_FACTOR);
        CHECK(ours / filterWidth(s, sigma, pixel, k, mu, 1) == doctest::Approx(k * mu / std::sqrt(32.0)).epsilon(1e-5));
    }
    // Chapter 4, with the authors' own standard deviation 1 / (2 Omega_r): a factor of 2, where (5.31) has 16.
    for (const float z : { 0.1f, 1.0f, 10.0f }) {
        const float band = indirectBandlimit(z, diffuse, pixel, 0);
        const float chapter4 = 0.5f / indirectBandwidth(z, diffuse, pixel, 1, 0);
        CHECK(pixel * kernelDeviation(band, 2) == doctest::Approx(chapter4).epsilon(1e-5));
        CHECK(pixel * kernelDeviation(band, WEDGE_KERNEL_FACTOR)
            == doctest::Approx(chapter4 / std::sqrt(8.0)).epsilon(1e-5));
    }
}

TEST_CASE("covariances: lens and motion add, kernels along any direction, identity without blur")
{
    const Symmetric2 none = blurCovariance(0, 0, 0, 0.2f, 0.1f);
    CHECK(weight(none, 0, 0) == 1);
    CHECK(weight(none, 1, 0) < 1e-20);
    CHECK(weight(none, 0, 1) < 1e-20);
    CHECK(gatheredPixels(none) == 1);
    const Symmetric2 round = blurCovariance(-10, 0, 0, 0.2f, 0.1f);
    CHECK(weight(round, 2, 0) == doctest::Approx(std::exp(-0.5)).epsilon(1e-5));
    CHECK(weight(round, 0, 2) == doctest::Approx(std::exp(-0.5)).epsilon(1e-5));
    CHECK(gatheredPixels(round) == doctest::Approx(4 * std::numbers::pi * 4).epsilon(1e-5));
    for (double angle = 0; angle < 6.3; angle += 0.37) {
        CAPTURE(angle);
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        const Symmetric2 line = blurCovariance(0, 30 * c, 30 * s, 0.2f, 0.1f);
        CHECK(weight(line, 3 * c, 3 * s) == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
        CHECK(weight(line, -0.3f * s, 0.3f * c) == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
        CHECK(gatheredPixels(line) == doctest::Approx(2 * std::sqrt(std::numbers::pi) * 3).epsilon(1e-3));
        const Symmetric2 both = blurCovariance(10, 30 * c, 30 * s, 0.2f, 0.1f);
        const double along = std::sqrt(13.0);
        CHECK(weight(both, static_cast<float>(along) * c, static_cast<float>(along) * s)
            == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
        CHECK(weight(both, -2 * s, 2 * c) == doctest::Approx(std::exp(-0.5)).epsilon(1e-3));
        CHECK(gatheredPixels(both) == doctest::Approx(4 * std::numbers::pi * 2 * along).epsilon(1e-3));
        // The joint bandlimit's kernel is the same one.
        const Symmetric2 printed = blurCovariance(10, 30 * c, 30 * s, WEDGE_KERNEL_WIDTH, WEDGE_KERNEL_WIDTH / 2);
        CHECK(std::sqrt(eigenvalue(printed, 1))
            == doctest::Approx(kernelDeviation(jointBandlimit(10, 30), 16)).epsilon(1e-3));
        CHECK(std::sqrt(eigenvalue(printed, -1))
            == doctest::Approx(kernelDeviation(defocusBandlimit(10), 16)).epsilon(1e-3));
    }
}

TEST_CASE("velocities of a pixel: one is common, opposite ones and one at rest are not")
{
    CHECK(commonSpeed(20, 20, 20, 0.1f) == 20);
    CHECK(commonSpeed(0, 10, 10, 0.1f) == 0);
    CHECK(commonSpeed(20, 20, 0, 0.1f) == doctest::Approx(3));
    CHECK(commonSpeed(20, 20, 19.95f, 0.1f) == 20); // 4 degrees: 1.4 pixels across, 0.14 of the kernel
    CHECK(commonSpeed(0, 0, 0, 0.1f) == 0);
    CHECK(commonSpeed(5, 5, 5.0001f, 0.1f) == 5); // rounding must not make it a root of something negative
}

TEST_CASE("no input makes anything but a number within its bounds")
{
    const std::array<float, 10> values = { 0, 1e-30f, 1e-6f, 0.5f, 3, 1e6f, 1e30f, infinity, notANumber, -1 };
    const auto inBand = [](float band) { return band >= 1 / (1.001f * WEDGE_BLUR_MAX) && band <= 0.5f; };
    for (const float a : values)
        for (const float b : values)
            for (const float c : values) {
                CAPTURE(a);
                CAPTURE(b);
                CAPTURE(c);
                REQUIRE(std::fabs(circleOfConfusion(0.1f, a, b, 0.001f)) <= WEDGE_BLUR_MAX);
                REQUIRE(inBand(defocusBandlimit(a)));
                REQUIRE(inBand(shadowBandlimit(a, 0.3f, b, c)));
                REQUIRE(inBand(indirectBandlimit(a, diffuse, b, c)));
                REQUIRE(inBand(jointBandlimit(a, b)));
                for (const float band : { defocusBandlimit(a), 0.5f }) {
                    REQUIRE(std::isfinite(directCount(band, a, b, 0.3f, c)));
                    REQUIRE(std::isfinite(indirectRayCount(band, a, b, diffuse, c)));
                    REQUIRE(std::isfinite(jointCount(band, band, b, c)));
                    REQUIRE(primaryCount(band, b) >= 0.25f);
                }
                REQUIRE(std::isfinite(commonSpeed(a, fmin(b, 1e6f), fmin(c, 1e6f), 0.1f)));
                const Symmetric2 covariance = blurCovariance(a, b, c, 0.2f, 0.1f), form = kernelExponent(covariance);
                REQUIRE(quadraticForm(form, 1, 0) >= 0);
                REQUIRE(quadraticForm(form, -3, 4) >= 0);
                REQUIRE(gatheredPixels(covariance) >= 1);
            }
}

TEST_CASE("the factoring identity (5.10): mean of a product, of random texture, light and lens weights")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    double largest = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const int n = 1 + trial;
        std::vector<std::array<double, 3>> samples; // texture, irradiance, weight
        double weights = 0;
        for (int i = 0; i < n; ++i) {
            samples.push_back({ unit(random), 10 * unit(random) * unit(random), unit(random) + 1e-3 });
            weights += samples.back()[2];
        }
        double texture = 0, light = 0, product = 0, rest = 0;
        for (const auto& [k, e, w] : samples) {
            texture += k * w / weights;
            light += e * w / weights;
            product += k * e * w / weights;
        }
        for (const auto& [k, e, w] : samples)
            rest += (k - texture) * (e - light) * w / weights;
        CHECK(product == doctest::Approx(texture * light + rest).epsilon(1e-12));
        largest = std::max(largest, std::fabs(rest));
        if (n == 1)
            CHECK(std::fabs(rest) < 1e-12);
    }
    CHECK(largest > 0.1); // the term that factoring drops is not always small
}
