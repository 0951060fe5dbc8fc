// Colours, directions and numbers in fewer bits (kernels/shared/packed.h), as C++: how exact they are, and what has no
// place in them.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/packed.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace wedge::shared;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

Vec3 there(Vec3 colour)
{
    const PackedColour packed = packColour(colour);
    REQUIRE(packed.high < 1u << 16);
    return unpackColour(packed);
}

} // namespace

TEST_CASE("colours: exact to 1/8192 of the largest channel, over all magnitudes")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1), magnitude(-30, 30);
    for (int k = 0; k < 20000; ++k) {
        const float scale = std::pow(10.0f, magnitude(random));
        const Vec3 c = vec3(scale * unit(random), k % 3 == 0 ? 0.0f : scale * unit(random), scale * unit(random));
        const Vec3 found = there(c);
        const float allowed = std::max({ c.x, c.y, c.z }) / 8192.0f * 1.001f;
        REQUIRE(std::fabs(found.x - c.x) <= allowed);
        REQUIRE(std::fabs(found.y - c.y) <= allowed);
        REQUIRE(std::fabs(found.z - c.z) <= allowed);
        // Packing what was packed changes nothing: means that nothing is added to stay as they are.
        const Vec3 again = there(found);
        REQUIRE(again.x == found.x);
        REQUIRE(again.y == found.y);
        REQUIRE(again.z == found.z);
    }
}

TEST_CASE("colours: black, grey, powers of two and what is just below them")
{
    for (const float value : { 0.0f, 1.0f, 0.5f, 2.0f, 1024.0f, 0x1.fffffep0f, 0x1.fffffep-1f, 0x1p-20f }) {
        const Vec3 found = there(vec3(value, value, value));
        CHECK(found.x == doctest::Approx(value).epsilon(1.3e-4));
        CHECK(found.x == found.y);
        CHECK(found.y == found.z);
    }
    CHECK(there(vec3(1e-37f, 1e-36f, 0)).y == 0);
}

TEST_CASE("colours: what is negative or no number is 0, and what is infinite stays finite")
{
    const Vec3 found = there(vec3(-1.0f, notANumber, 0.25f));
    CHECK(found.x == 0);
    CHECK(found.y == 0);
    CHECK(found.z == doctest::Approx(0.25f));
    const Vec3 huge = there(vec3(infinity, 1.0f, 0.0f));
    CHECK(std::isfinite(huge.x));
    CHECK(huge.x > 2e38f);
}

TEST_CASE("numbers: 8 bits of precision, signs and the whole range")
{
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(1, 2), magnitude(-37, 37);
    for (int k = 0; k < 20000; ++k) {
        const float x = (k % 2 == 0 ? 1.0f : -1.0f) * unit(random) * std::pow(10.0f, magnitude(random));
        const float found = unpackShort(packShort(x));
        REQUIRE(std::fabs(found - x) <= std::fabs(x) / 256.0f);
        REQUIRE(unpackShort(packShort(found)) == found);
    }
    CHECK(unpackShort(packShort(0.0f)) == 0.0f);
    CHECK(unpackShort(packShort(-1.0f)) == -1.0f);
    CHECK(unpackShort(packShort(infinity)) == infinity);
}

TEST_CASE("a kind and an exponent: in one word to 1e-6, in 16 bits to 0.2 % or the ends of their range")
{
    std::mt19937 random(3);
    std::uniform_real_distribution<float> magnitude(-10, 22);
    for (std::uint32_t kind = 0; kind < WEDGE_MIRROR; ++kind) {
        for (int k = 0; k < 5000; ++k) {
            const float exponent = std::exp2(magnitude(random));
            const Gloss word = unpackGloss(packGloss(makeGloss(exponent, kind)));
            const Gloss half = unpackGlossShort(packGlossShort(makeGloss(exponent, kind)));
            REQUIRE(word.kind == kind);
            REQUIRE(half.kind == kind);
            const bool microfacets = kind == WEDGE_MICROFACETS;
            REQUIRE(std::fabs(word.exponent - exponent) <= (microfacets ? 6e-4f : 1e-6f) * exponent);
            REQUIRE(std::fabs(half.exponent - exponent) <= exponent / 500.0f);
            REQUIRE(packGlossShort(half) == packGlossShort(makeGloss(exponent, kind)));
        }
        for (const float whole : { 0.0f, 1.0f, 20.0f, 1000.0f, 1e6f })
            CHECK((kind == WEDGE_MICROFACETS || unpackGloss(packGloss(makeGloss(whole, kind))).exponent == whole));
        for (const float low : { 0.0f, 1e-30f, -5.0f, notANumber })
            CHECK(unpackGlossShort(packGlossShort(makeGloss(low, kind))).exponent == 0x1p-10f);
        for (const float high : { 5e6f, 1e30f, infinity }) {
            const Gloss found = unpackGlossShort(packGlossShort(makeGloss(high, kind)));
            CHECK(found.exponent == doctest::Approx(0x1p22f).epsilon(2e-3));
            CHECK(found.kind == kind);
        }
    }
}

TEST_CASE("mirrors and glass in one word: their own, which is of no lobe")
{
    for (const std::uint32_t kind : { WEDGE_MIRROR, WEDGE_GLASS })
        for (const std::uint32_t material : { 0u, 1u, 70000u, (1u << 28) - 1u }) {
            const std::uint32_t word = kind | WEDGE_MIRROR_BEHIND | material << WEDGE_MIRROR_BITS;
            CHECK(packGloss(makeGloss(3.0f, word)) == word);
            CHECK(WEDGE_IS_MIRROR(word));
            const Gloss found = unpackGloss(word);
            CHECK(found.kind == WEDGE_LAMBERT);
            CHECK(found.exponent == 1.0f);
        }
    for (const std::uint32_t kind : { WEDGE_LAMBERT, WEDGE_PHONG, WEDGE_BLINN_PHONG, WEDGE_MICROFACETS })
        CHECK(!WEDGE_IS_MIRROR(packGloss(makeGloss(12345.678f, kind))));
}

TEST_CASE("microfacets in one word: sharpness and Fresnel's rise to 0.1 %, never a larger rise")
{
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1), magnitude(-3, 15);
    for (int k = 0; k < 20000; ++k) {
        Gloss g = microfacetGloss(unit(random), vec3(0, 0, 0), vec3(0.5f, 0.5f, 0.5f));
        g.rise = std::exp2(magnitude(random));
        const Gloss found = unpackGloss(packGloss(g));
        REQUIRE(found.kind == WEDGE_MICROFACETS);
        REQUIRE(std::fabs(found.exponent - g.exponent) <= 6e-4f * g.exponent);
        REQUIRE(found.rise <= g.rise * 1.000001f);
        REQUIRE(found.rise + 1 >= (g.rise + 1) * 0.999f);
    }
    CHECK(unpackGloss(packGloss(microfacetGloss(0.5f, vec3(0, 0, 0), vec3(1, 1, 1)))).rise == 0);
    // Beyond what fits it is the most that does.
    CHECK(unpackGloss(packGloss(microfacetGloss(0.5f, vec3(0, 0, 0), vec3(1e-9f, 0, 0)))).rise > 6e4f);
    CHECK(fresnelRise(vec3(0, 0, 0), vec3(1e-39f, 0, 0)) < 65536.0f); // of next to no colour, too
    CHECK(fresnelRise(vec3(0.2f, 0.5f, 0), vec3(0.04f, 0.02f, 0)) == doctest::Approx(0.5 / 0.04 - 1));
    CHECK(fresnelRise(vec3(0.2f, 0.5f, 0), vec3(0.7f, 0, 0)) == 0);
    CHECK(fresnelRise(vec3(0, 0, 0), vec3(0, 0, 0)) == 0);
}

TEST_CASE("exponents of lobes as wide as each other: where both fall to a half near the mirrored view")
{
    CHECK(exponentAs(makeGloss(40, WEDGE_PHONG), WEDGE_PHONG) == 40);
    CHECK(exponentAs(makeGloss(40, WEDGE_BLINN_PHONG), WEDGE_BLINN_PHONG) == 40);
    CHECK(exponentAs(makeGloss(40, WEDGE_LAMBERT), WEDGE_PHONG) == 40);
    const Vec3 up = vec3(0, 0, 1);
    for (const float exponent : { 40.0f, 400.0f, 4000.0f }) {
        const float other = exponentAs(makeGloss(exponent, WEDGE_PHONG), WEDGE_BLINN_PHONG);
        CHECK(exponentAs(makeGloss(other, WEDGE_BLINN_PHONG), WEDGE_PHONG) == exponent);
        const float angle = std::acos(std::pow(0.5f, 1 / exponent));
        const Vec3 aside = vec3(std::sin(angle), 0, std::cos(angle));
        const auto fall = [&](float e, std::uint32_t kind) {
            return specularLobe(up, up, aside, e, kind) / specularLobe(up, up, up, e, kind);
        };
        CHECK(fall(exponent, WEDGE_PHONG) == doctest::Approx(0.5).epsilon(0.01));
        CHECK(fall(other, WEDGE_BLINN_PHONG) == doctest::Approx(0.5).epsilon(0.01));
    }
}

namespace {

/// Allowed difference of a fraction whose largest channel is that: half a unit of 9 bits, or of the least exponent.
float halfUnit(float largest) { return std::max(largest / 512.0f * 1.001f, 0x1p-25f); }

} // namespace

TEST_CASE("fractions: exact to 1/512 of the largest channel, down to the least unit")
{
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1), magnitude(-9, 4);
    for (int k = 0; k < 20000; ++k) {
        const float scale = k % 2 == 0 ? 1.0f : std::pow(10.0f, magnitude(random));
        const Vec3 c = vec3(scale * unit(random), k % 3 == 0 ? 0.0f : scale * unit(random), scale * unit(random));
        const Vec3 found = unpackFraction(packFraction(c));
        const float allowed = halfUnit(std::max({ c.x, c.y, c.z }));
        REQUIRE(std::fabs(found.x - c.x) <= allowed);
        REQUIRE(std::fabs(found.y - c.y) <= allowed);
        REQUIRE(std::fabs(found.z - c.z) <= allowed);
        const Vec3 again = unpackFraction(packFraction(found));
        REQUIRE(again.x == found.x);
        REQUIRE(again.y == found.y);
        REQUIRE(again.z == found.z);
    }
}

TEST_CASE("fractions: black and powers of two are exact, what is just below them is near, grey stays grey")
{
    for (const float value : { 0.0f, 1.0f, 0.5f, 0.25f, 2.0f, 0x1p-24f, 0x1p-10f, 32768.0f }) {
        const Vec3 found = unpackFraction(packFraction(vec3(value, value, value)));
        CHECK(found.x == value);
        CHECK(found.y == value);
        CHECK(found.z == value);
        for (const float below : { 0x1.fffffep-1f, 0.9995f, 0.999f, 0.998f }) {
            const float near = unpackFraction(packFraction(vec3(0, value * below, 0))).y;
            CHECK(std::fabs(near - value * below) <= halfUnit(value));
        }
    }
    CHECK(packFraction(vec3(0, 0, 0)) == 0);
    CHECK(unpackFraction(packFraction(vec3(1e-9f, 0, 1e-20f))).x == 0);
    const Vec3 mixed = unpackFraction(packFraction(vec3(1, 1e-5f, 0.5f)));
    CHECK(mixed.x == 1);
    CHECK(mixed.y == 0);
    CHECK(mixed.z == 0.5f);
}

TEST_CASE("fractions: what is negative or no number is 0, what is too large the largest there is")
{
    const Vec3 found = unpackFraction(packFraction(vec3(-1.0f, notANumber, 0.25f)));
    CHECK(found.x == 0);
    CHECK(found.y == 0);
    CHECK(found.z == 0.25f);
    for (const float huge : { 65408.0f, 65500.0f, 1e9f, infinity }) {
        CHECK(unpackFraction(packFraction(vec3(1, huge, 0))).y == 65408.0f);
    }
}

TEST_CASE("normals: each part to half a unit of 1/511, with its sign; no bits are no direction")
{
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    for (int k = 0; k < 20000; ++k) {
        const Vec3 v = vecNormalize(vec3(normal(random), normal(random), k % 5 == 0 ? 0.0f : normal(random)));
        const Vec3 found = unpackNormal(packNormal(v));
        const float allowed = 0.5001f / 511.0f;
        REQUIRE(std::fabs(found.x - v.x) <= allowed);
        REQUIRE(std::fabs(found.y - v.y) <= allowed);
        REQUIRE(std::fabs(found.z - v.z) <= allowed);
        REQUIRE(vecDot(found, v) > 0.998f);
        REQUIRE(packNormal(found) == packNormal(v));
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : { -1.0f, 1.0f }) {
            const Vec3 v = vec3(axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0);
            const Vec3 found = unpackNormal(packNormal(v));
            CHECK(found.x == v.x);
            CHECK(found.y == v.y);
            CHECK(found.z == v.z);
        }
    }
    CHECK(vecDot(unpackNormal(0), unpackNormal(0)) == 0);
}
