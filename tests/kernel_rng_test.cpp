// kernels/shared/rng.h as C++: what every sample of a light is made of.
#include "kernels/shared/rng.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace wedge::shared;

namespace {

/// Chi-square of counts that should all be equal, as standard deviations from its mean.
double chiSquareDeviation(const std::vector<unsigned>& counts)
{
    double total = 0;
    for (const unsigned c : counts)
        total += c;
    const double expected = total / static_cast<double>(counts.size());
    double chi = 0;
    for (const unsigned c : counts)
        chi += (c - expected) * (c - expected) / expected;
    const double freedom = static_cast<double>(counts.size()) - 1;
    return (chi - freedom) / std::sqrt(2 * freedom);
}

/// Seeds as the kernels make them, one a pixel.
uint pixelSeed(uint pixel) { return hashCombine(hashCombine(7u, 1u), pixel); }

struct Moments {
    double mean = 0, squares = 0;
    unsigned count = 0;
    void add(double x)
    {
        ++count;
        const double d = x - mean;
        mean += d / count;
        squares += d * (x - mean);
    }
    double standardError() const { return std::sqrt(squares / (count - 1.0) / count); }
};

} // namespace

TEST_CASE("bits are reversed, and unit floats stay below 1")
{
    CHECK(reverseBits(0u) == 0u);
    CHECK(reverseBits(1u) == 0x80000000u);
    CHECK(toUnitFloat(0u) == 0.0f);
    CHECK(toUnitFloat(0xffffffffu) < 1.0f);
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const uint x = static_cast<uint>(random());
        uint reversed = 0;
        for (int bit = 0; bit < 32; ++bit)
            reversed |= ((x >> bit) & 1u) << (31 - bit);
        REQUIRE(reverseBits(x) == reversed);
    }
}

TEST_CASE("the second Sobol dimension is that of its direction numbers")
{
    // Primitive polynomial x + 1: m_1 = 1, m_k = 2 m_(k-1) xor m_(k-1); direction number k is m_k / 2^k.
    uint directions[32];
    uint m = 1;
    for (int k = 0; k < 32; ++k) {
        directions[k] = m << (31 - k);
        m = (m << 1) ^ m;
    }
    std::mt19937 random(2);
    for (uint n = 0; n < 6000; ++n) {
        const uint i = n < 4096 ? n : static_cast<uint>(random());
        uint expected = 0;
        for (int k = 0; k < 32; ++k)
            expected ^= ((i >> k) & 1u) != 0u ? directions[k] : 0u;
        REQUIRE(sobolSecond(i) == expected);
    }
}

TEST_CASE("the first 2^k scrambled points are a (0, k, 2)-net")
{
    for (uint s = 0; s < 40; ++s) {
        const uint seed = s == 0 ? 0u : (s == 1 ? 0xffffffffu : pixelSeed(s));
        for (uint k = 0; k <= 9; ++k) {
            const uint count = 1u << k;
            for (uint columnsLog = 0; columnsLog <= k; ++columnsLog) {
                const uint columns = 1u << columnsLog;
                const uint rows = 1u << (k - columnsLog);
                std::vector<unsigned> cells(count, 0);
                for (uint i = 0; i < count; ++i) {
                    const Vec2 p = sobolOwen(i, seed);
                    REQUIRE(p.x >= 0.0f);
                    REQUIRE(p.x < 1.0f);
                    REQUIRE(p.y >= 0.0f);
                    REQUIRE(p.y < 1.0f);
                    const uint column = static_cast<uint>(p.x * static_cast<float>(columns));
                    const uint row = static_cast<uint>(p.y * static_cast<float>(rows));
                    ++cells[row * columns + column];
                }
                CAPTURE(seed);
                CAPTURE(k);
                CAPTURE(columns);
                for (const unsigned c : cells)
                    REQUIRE(c == 1);
            }
        }
    }
}

TEST_CASE("a point of the sequence is uniform over the seeds of pixels")
{
    for (const uint index : { 0u, 1u, 8u, 27u }) {
        std::vector<unsigned> cells(256, 0);
        for (uint pixel = 0; pixel < 40000; ++pixel) {
            const Vec2 p = sobolOwen(index, pixelSeed(pixel));
            ++cells[static_cast<uint>(p.y * 16.0f) * 16u + static_cast<uint>(p.x * 16.0f)];
        }
        CAPTURE(index);
        CHECK(std::fabs(chiSquareDeviation(cells)) < 5);
    }
}

TEST_CASE("neighbouring pixels, lights and frame seeds draw independent points")
{
    constexpr uint count = 20000;
    double pixels = 0, lights = 0, frames = 0, axes = 0;
    for (uint i = 0; i < count; ++i) {
        const auto at = [](uint frame, uint light, uint pixel) {
            const Vec2 p = sobolOwen(3u, hashCombine(hashCombine(frame, light), pixel));
            return vec2(p.x - 0.5f, p.y - 0.5f);
        };
        const Vec2 here = at(0, 0, i);
        pixels += here.x * at(0, 0, i + 1).x;
        lights += here.x * at(0, 1, i).x;
        frames += here.x * at(1, 0, i).x;
        axes += here.x * here.y;
    }
    // Products of two independent uniforms around 0 have the standard deviation 1/12.
    const double five = 5.0 / 12.0 * std::sqrt(static_cast<double>(count));
    CHECK(std::fabs(pixels) < five);
    CHECK(std::fabs(lights) < five);
    CHECK(std::fabs(frames) < five);
    CHECK(std::fabs(axes) < five);
}

TEST_CASE("permuteIndex is a permutation, and each place gets each element")
{
    for (uint length = 1; length <= 130; ++length) {
        for (const uint seed : { 0u, 1u, 0xffffffffu, pixelSeed(length) }) {
            std::vector<bool> seen(length, false);
            for (uint i = 0; i < length; ++i) {
                const uint to = permuteIndex(i, length, seed);
                REQUIRE(to < length);
                REQUIRE_FALSE(seen[to]);
                seen[to] = true;
            }
        }
    }
    std::vector<unsigned> first(19, 0);
    for (uint pixel = 0; pixel < 19000; ++pixel)
        ++first[permuteIndex(0u, 19u, pixelSeed(pixel))];
    CHECK(std::fabs(chiSquareDeviation(first)) < 5);
}

TEST_CASE("stratified samples take each stratum once, whatever their number")
{
    for (uint n = 1; n <= 70; ++n) {
        const uint columns = static_cast<uint>(std::lround(std::sqrt(static_cast<double>(n))));
        const uint rows = n / columns;
        for (const uint seed : { 0u, pixelSeed(n), 0xffffffffu }) {
            std::vector<unsigned> cells(columns * rows, 0);
            for (uint i = 0; i < n; ++i) {
                const Vec2 p = stratified(i, n, seed ^ 0x55u, seed);
                REQUIRE(p.x >= 0.0f);
                REQUIRE(p.x < 1.0f);
                REQUIRE(p.y >= 0.0f);
                REQUIRE(p.y < 1.0f);
                ++cells[static_cast<uint>(p.y * static_cast<float>(rows)) * columns
                    + static_cast<uint>(p.x * static_cast<float>(columns))];
            }
            unsigned empty = 0;
            for (const unsigned c : cells)
                empty += c == 0 ? 1 : 0;
            CAPTURE(n);
            REQUIRE(empty == 0);
        }
    }
}

TEST_CASE("both samplers integrate without bias")
{
    // f = x^2 e^y: (e - 1) / 3 over the unit square.
    const double expected = (std::numbers::e - 1) / 3;
    for (const uint n : { 1u, 2u, 3u, 7u, 9u, 16u, 28u, 100u }) {
        Moments jittered, sobol;
        for (uint pixel = 0; pixel < 3000; ++pixel) {
            double a = 0, b = 0;
            for (uint i = 0; i < n; ++i) {
                const Vec2 p = stratified(i, n, 7u, pixelSeed(pixel));
                const Vec2 q = sobolOwen(i, pixelSeed(pixel));
                a += p.x * p.x * std::exp(p.y);
                b += q.x * q.x * std::exp(q.y);
            }
            jittered.add(a / n);
            sobol.add(b / n);
        }
        CAPTURE(n);
        CHECK(std::fabs(jittered.mean - expected) < 5 * jittered.standardError());
        CHECK(std::fabs(sobol.mean - expected) < 5 * sobol.standardError());
    }
}
