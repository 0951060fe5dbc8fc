// CIELAB of kernels/shared/lab.h as C++, against CIE 15 in double. No device.
#include "kernels/shared/lab.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace {

using Colour = std::array<double, 3>;

/// Linear sRGB to CIE XYZ, IEC 61966-2-1, whose rows add up to the white D65.
constexpr double toXyz[3][3] = { { 0.4124564, 0.3575761, 0.1804375 }, { 0.2126729, 0.7151522, 0.0721750 },
    { 0.0193339, 0.1191920, 0.9503041 } };

Colour labOracle(const Colour& rgb)
{
    constexpr double knee = 6.0 / 29;
    Colour f {};
    for (std::size_t row = 0; row < 3; ++row) {
        const double* m = toXyz[row];
        const double t = (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
        f[row] = t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
    }
    return { 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2]) };
}

/// Checks a colour to 1e-3, or where it is brighter than white, to 1e-5 of its L*.
void checkColour(const Colour& rgb)
{
    const Colour exact = labOracle(rgb);
    const wedge::shared::Vec3 found = wedge::shared::labOf(
        wedge::shared::vec3(static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])));
    const double tolerance = 1e-3 * std::max(1.0, exact[0] / 100);
    CAPTURE(rgb[0]);
    CAPTURE(rgb[1]);
    CAPTURE(rgb[2]);
    const Colour is { found.x, found.y, found.z };
    for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(k);
        CAPTURE(is[k]);
        CAPTURE(exact[k]);
        REQUIRE(std::fabs(is[k] - exact[k]) <= tolerance);
    }
}

} // namespace

TEST_CASE("labOf: L*, a*, b* of colours as dark as black and far brighter than white")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> decade(-7, 4), channel(0, 1);
    for (int i = 0; i < 200000; ++i) {
        const double scale = std::pow(10, decade(random));
        checkColour({ scale * channel(random), scale * channel(random), scale * channel(random) });
    }
    for (const double scale : { 0.0, 1e-12, 0.008, 0.00885, 0.00886, 0.0089, 1.0, 1e3 })
        for (int channels = 0; channels < 8; ++channels)
            checkColour({ channels & 1 ? scale : 0, channels & 2 ? scale : 0, channels & 4 ? scale : 0 });
}

TEST_CASE("labOf: black is 0, white 100 without a hue, and greys have none")
{
    for (const float grey : { 0.0f, 1e-4f, 0.18f, 1.0f, 50.0f }) {
        const wedge::shared::Vec3 lab = wedge::shared::labOf(wedge::shared::vec3(grey, grey, grey));
        CHECK(std::fabs(lab.y) < 1e-3);
        CHECK(std::fabs(lab.z) < 1e-3);
    }
    CHECK(std::fabs(wedge::shared::labOf(wedge::shared::vec3(0, 0, 0)).x) < 1e-4);
    CHECK(wedge::shared::labOf(wedge::shared::vec3(1, 1, 1)).x == doctest::Approx(100).epsilon(1e-6));
    // Middle grey of photographers is half way to white.
    CHECK(wedge::shared::labOf(wedge::shared::vec3(0.18f, 0.18f, 0.18f)).x == doctest::Approx(49.496).epsilon(1e-4));
}
