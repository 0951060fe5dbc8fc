// How radiance becomes pictures: the views' curves against their published equations, and what no picture may do.
#include "host/image/colour.h"
#include "host/image/png.h"
#include "host/image/view.h"

#include "tests/image_test_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace wedge::image;
using namespace wedge::image::test;

namespace {

using Rgb = std::array<float, 3>;

constexpr View views[] = { View::Srgb, View::Filmic, View::Agx };
constexpr float infinity = std::numeric_limits<float>::infinity();

float grey(View view, float value) { return applyView(view, { value, value, value })[0]; }

/// Hable's curve as he wrote it, in double precision, over that of his white.
double hablePublished(double value)
{
    const auto curve = [](double x) {
        const double a = 0.15, b = 0.5, c = 0.1, d = 0.2, e = 0.02, f = 0.3;
        return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
    };
    return std::clamp(curve(2 * value) / curve(11.2), 0.0, 1.0);
}

/// The fit of AgX as published, with its matrices (of columns), in double precision.
std::array<double, 3> agxPublished(const Rgb& rgb)
{
    const double inset[3][3] = { { 0.842479062253094, 0.0423282422610123, 0.0423756549057051 },
        { 0.0784335999999992, 0.878468636469772, 0.0784336 },
        { 0.0792237451477643, 0.0791661274605434, 0.879142973793104 } };
    const double outset[3][3] = { { 1.19687900512017, -0.0528968517574562, -0.0529716355144438 },
        { -0.0980208811401368, 1.15190312990417, -0.0980434501171241 },
        { -0.0990297440797205, -0.0989611768448433, 1.15107367264116 } };
    double curved[3];
    for (int i = 0; i < 3; ++i) {
        const double value = inset[0][i] * rgb[0] + inset[1][i] * rgb[1] + inset[2][i] * rgb[2];
        const double x = (std::clamp(std::log2(value), -12.47393, 4.026069) + 12.47393) / 16.499999;
        curved[i] = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3)
            + 0.4298 * x * x + 0.1191 * x - 0.00232;
    }
    std::array<double, 3> shown {};
    for (std::size_t i = 0; i < 3; ++i) {
        const double encoded = outset[0][i] * curved[0] + outset[1][i] * curved[1] + outset[2][i] * curved[2];
        shown[i] = std::pow(std::clamp(encoded, 0.0, 1.0), 2.2);
    }
    return shown;
}

/// Colours of all kinds, from 2^-14 to 2^8.
std::vector<Rgb> colours()
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-14, 8);
    std::vector<Rgb> all(2000);
    for (Rgb& each : all) {
        std::ranges::generate(each, [&] { return std::exp2(stops(random)); });
    }
    return all;
}

} // namespace

TEST_CASE("views keep black black, rise, and end in white")
{
    for (const View view : views) {
        CAPTURE(static_cast<int>(view));
        CHECK(grey(view, 0.0f) == 0.0f);
        CHECK(grey(view, -3.0f) == 0.0f);
        CHECK(grey(view, 1e-9f) < 1e-6f);
        float before = 0;
        for (int step = -2000; step < 2000; ++step) { // hundredths of a stop
            const float now = grey(view, std::exp2(0.01f * static_cast<float>(step)));
            REQUIRE(now >= before);
            REQUIRE(now <= 1.0f);
            before = now;
        }
        for (const float bright : { 20.0f, 1e4f, 1e38f, infinity }) {
            CHECK(encodeSrgb(grey(view, bright)) > 254.5f / 255.0f);
        }
        CHECK(grey(view, 0.18f) > 0.1f); // middle grey stays one
        CHECK(grey(view, 0.18f) < 0.25f);
    }
    CHECK(grey(View::Filmic, 1.0f) < 0.6f); // where sRGB has been white for long, there is room above
    CHECK(grey(View::Agx, 1.0f) < 0.7f);
}

TEST_CASE("greys stay neutral to the last bit")
{
    for (const View view : views) {
        for (int step = -500; step < 500; ++step) {
            const float value = std::exp2(0.03f * static_cast<float>(step));
            const Rgb shown = applyView(view, { value, value, value });
            REQUIRE(shown[0] == shown[1]);
            REQUIRE(shown[1] == shown[2]);
        }
    }
}

TEST_CASE("no values of any kind make other than 0 to 1")
{
    const float odd[] = { 0, -0.0f, -1, 1e-45f, 1e-38f, 1, 1e38f, infinity, -infinity,
        std::numeric_limits<float>::quiet_NaN() };
    for (const View view : views) {
        for (const float r : odd) {
            for (const float g : odd) {
                for (const float b : odd) {
                    for (const float value : applyView(view, { r, g, b })) {
                        REQUIRE(value >= 0.0f);
                        REQUIRE(value <= 1.0f);
                    }
                }
            }
        }
    }
}

TEST_CASE("filmic and AgX are their published equations")
{
    for (const Rgb& colour : colours()) {
        CAPTURE(colour[0]);
        CAPTURE(colour[1]);
        CAPTURE(colour[2]);
        const Rgb filmic = applyView(View::Filmic, colour), agx = applyView(View::Agx, colour);
        const std::array<double, 3> expected = agxPublished(colour);
        for (std::size_t c = 0; c < 3; ++c) {
            REQUIRE(filmic[c] == doctest::Approx(hablePublished(colour[c])).epsilon(1e-4));
            // Shares on the diagonals differ by 2e-4 at most; a tenth of a level of 8 bits is 4e-4.
            REQUIRE(std::fabs(std::pow(agx[c], 1 / 2.2) - std::pow(expected[c], 1 / 2.2)) < 5e-4);
        }
    }
    // Bright colours fade to white in AgX, channel by channel in the others.
    const Rgb red = { 50, 0.01f, 0.01f };
    CHECK(applyView(View::Agx, red)[1] > 0.2f);
    CHECK(applyView(View::Filmic, red)[1] < 0.02f);
}

TEST_CASE("pictures have the view and the exposure that are asked for, and without any the clipped values")
{
    const TempDirectory directory;
    RgbImage image { 2000, 1, {} };
    for (const Rgb& colour : colours()) {
        image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
    }
    for (const View view : views) {
        for (const float stops : { 0.0f, -1.5f, 2.0f }) {
            const std::string path = directory / "a.png";
            writePng(path, image, { .exposureStops = stops, .view = view });
            const RgbImage read = readPng(path);
            REQUIRE(read.rgb.size() == image.rgb.size());
            for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
                Rgb exposed = { image.rgb[i], image.rgb[i + 1], image.rgb[i + 2] };
                std::ranges::transform(exposed, exposed.begin(), [&](float v) { return v * std::exp2(stops); });
                const Rgb shown = view == View::Srgb
                    ? Rgb { clipToDisplay(exposed[0]), clipToDisplay(exposed[1]), clipToDisplay(exposed[2]) }
                    : applyView(view, exposed);
                for (std::size_t c = 0; c < 3; ++c) {
                    const float level = static_cast<float>(std::lround(255.0f * encodeSrgb(shown[c]))) / 255.0f;
                    REQUIRE(read.rgb[i + c] == doctest::Approx(decodeSrgb(level)).epsilon(1e-5));
                }
            }
        }
    }
    writePng(directory / "b.png", image);
    writePng(directory / "c.png", image, { .view = View::Srgb });
    CHECK(readBytes(directory / "b.png") == readBytes(directory / "c.png"));
}
