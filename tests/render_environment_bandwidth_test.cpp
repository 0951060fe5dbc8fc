// B_e of pictures whose spectrum is known.
#include "host/render/environment_bandwidth.h"
#include "tests/environment_support.h"

#include <doctest/doctest.h>

#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Luminances, by column and row.
float bandwidthOf(int width, int height, const std::function<double(int, int)>& luminance)
{
    auto p = even(glm::vec3(0), width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            set(*p, x, y, glm::vec3(static_cast<float>(luminance(x, y))));
    return render::environmentBandwidth(*p);
}

const double turn = 2 * std::acos(-1.0);

} // namespace

TEST_CASE("waves have their frequencies, even pictures none")
{
    const std::pair<int, int> sizes[] = { { 64, 32 }, { 60, 45 }, { 1, 1 }, { 27, 1 }, { 1, 8 }, { 512, 256 } };
    for (const std::pair<int, int>& size : sizes) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        CHECK(bandwidthOf(width, height, [](int, int) { return 0.7; }) == 0);
        CHECK(bandwidthOf(width, height, [](int, int) { return 0.0; }) == 0);
        CHECK(bandwidthOf(width, height, [](int, int) { return 1e30; }) == 0);
    }
    for (const std::pair<int, int>& size : { std::pair(64, 32), { 60, 45 }, { 512, 256 } })
        for (const std::pair<int, int>& wave : { std::pair(1, 0), { 7, 0 }, { 0, 3 }, { 3, 2 }, { 12, 10 } }) {
            const int width = size.first, height = size.second, across = wave.first, down = wave.second;
            CAPTURE(width);
            CAPTURE(across);
            CAPTURE(down);
            const float found = bandwidthOf(width, height, [&](int x, int y) {
                return 1 + 0.9 * std::cos(turn * (across * (x + 0.5) / width + down * (y + 0.5) / height));
            });
            // Rows are half a turn in all: a wave of theirs is two to a turn.
            CHECK(found == std::ceil(std::hypot(across, 2.0 * down)));
        }
    // A hundredth of the energy is left out, and not more: amplitudes a beside the mean 1 have a^2 / 2.
    const auto beside = [](double amplitude) {
        return bandwidthOf(64, 32, [&](int x, int) { return 1 + amplitude * std::cos(turn * 9 * x / 64); });
    };
    CHECK(beside(0.13) == 0);
    CHECK(beside(0.15) == 9);
}

TEST_CASE("noise has all the frequencies that texels can have")
{
    std::mt19937 random(3);
    std::vector<double> noise(64 * 32);
    for (double& v : noise)
        v = uniform(random) < 0.02 ? 1 : 0;
    const float found = bandwidthOf(64, 32, [&](int x, int y) { return noise[static_cast<std::size_t>(y) * 64 + x]; });
    // The largest are hypot(32, 32); within how much 99 % of them are.
    std::vector<double> radii;
    for (int y = -16; y < 16; ++y)
        for (int x = -32; x < 32; ++x)
            radii.push_back(std::hypot(x, 2.0 * y));
    std::ranges::sort(radii);
    CHECK(found == doctest::Approx(radii[radii.size() * 99 / 100]).epsilon(0.04));
}

TEST_CASE("pictures of awkward or large sizes are averaged")
{
    // 1021 and 509 are primes, which a transform would take minutes for; of 1000 and 500 texels waves are the same.
    for (const std::pair<int, int>& size : { std::pair(1021, 509), { 4099, 33 }, { 5, 3001 } }) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        CHECK(bandwidthOf(width, height, [&](int x, int) { return 1 + 0.9 * std::cos(turn * 2 * (x + 0.5) / width); })
            == 2);
    }
    const float found =
        bandwidthOf(4096, 8, [](int x, int) { return 1 + 0.9 * std::cos(turn * 900 * (x + 0.5) / 4096); });
    CHECK(found == 900); // half of 2048 is 1024
}

TEST_CASE("it is worked out once, and without a picture 0")
{
    CHECK(render::EnvironmentBandwidth(nullptr).value() == 0);
    const render::EnvironmentBandwidth b(spotted());
    CHECK(b.value() == render::environmentBandwidth(*spotted()));
    CHECK(b.value() > 10);
    CHECK(b.value() == b.value());
}
