// Colours and numbers in fewer bits (kernels/shared/packed.h), as C++: how exact they are, and what has no place in them.
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
