// The lights that stand for a map: energy, cells, shares, by brute force and in closed form.
#include "effects/shadow_lights/map_lights.h"
#include "host/error.h"
#include "tests/environment_support.h"

#include <doctest/doctest.h>

#include <numbers>
#include <set>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double pi = std::numbers::pi;

/// Texels of all kinds of brightness, turned.
std::shared_ptr<render::EnvironmentPicture> varied(int width, int height, std::uint32_t seed = 1)
{
    auto p = even(glm::vec3(0), width, height);
    std::mt19937 random(seed);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double bright = std::pow(10.0, uniform(random, -2, 2));
            set(*p, x, y, bright * glm::dvec3(uniform(random), uniform(random), uniform(random)));
        }
    p->right = { 0.8f, 0, -0.6f };
    p->back = { 0.6f, 0, 0.8f };
    return p;
}

std::size_t indexOf(const render::EnvironmentPicture& p, int x, int y)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) + static_cast<std::size_t>(x);
}

glm::dvec3 energyOf(const render::EnvironmentPicture& p)
{
    glm::dvec3 sum(0);
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
            const double solidAngle =
                2 * pi / p.width * (std::cos(pi * y / p.height) - std::cos(pi * (y + 1) / p.height));
            const std::size_t at = 3 * indexOf(p, x, y);
            sum += solidAngle * glm::dvec3(p.radiance[at], p.radiance[at + 1], p.radiance[at + 2]);
        }
    return sum;
}

glm::dvec3 energyOf(const std::vector<render::MapLight>& lights)
{
    glm::dvec3 sum(0);
    for (const render::MapLight& light : lights)
        sum += glm::dvec3(light.irradiance);
    return sum;
}

/// The direction of a texel's middle.
glm::dvec3 directionOf(const render::EnvironmentPicture& p, int x, int y)
{
    const double angle = 2 * pi * ((x + 0.5) / p.width - 0.5), down = pi * (y + 0.5) / p.height;
    return std::cos(down) * glm::dvec3(p.up)
        + std::sin(down) * (std::sin(angle) * glm::dvec3(p.right) - std::cos(angle) * glm::dvec3(p.back));
}

void checkClose(const glm::dvec3& a, const glm::dvec3& b, double error)
{
    for (int channel = 0; channel < 3; ++channel)
        CHECK(a[channel] == doctest::Approx(b[channel]).epsilon(error));
}

} // namespace

TEST_CASE("lights have all of a map's energy, however many and however large the map")
{
    const glm::ivec2 sizes[] = { { 1, 1 }, { 2, 1 }, { 7, 5 }, { 128, 64 }, { 700, 300 }, { 1100, 3 } };
    for (const glm::ivec2& size : sizes) {
        CAPTURE(size.x);
        const auto p = varied(size.x, size.y);
        const render::MapPlaces places = render::mapPlaces(*p);
        CHECK(places.columns <= 512);
        CHECK(places.rows <= 256);
        CHECK(places.all.size() >= 64u * 32u);
        double solidAngle = 0;
        glm::dvec3 energy(0);
        for (const render::MapPlace& place : places.all) {
            solidAngle += place.solidAngle;
            energy += place.irradiance;
        }
        CHECK(solidAngle == doctest::Approx(4 * pi).epsilon(1e-12));
        checkClose(energy, energyOf(*p), 1e-12);
        for (const std::size_t lights : { 1u, 2u, 40u, 333u }) {
            CAPTURE(lights);
            const std::vector<render::MapLight> all = render::mapLights(*p, lights);
            REQUIRE(all.size() == lights);
            checkClose(energyOf(all), energyOf(*p), 1e-6);
            for (const render::MapLight& light : all)
                REQUIRE(glm::length(light.towards) == doctest::Approx(1).epsilon(1e-6));
        }
    }
}

TEST_CASE("each place is in the cell of the nearest point, and lights are within their cells")
{
    for (const std::uint32_t seed : { 1u, 2u }) {
        const auto p = varied(96, 48, seed);
        const render::MapPlaces places = render::mapPlaces(*p);
        const render::MapCells cells = render::mapCells(places, 60);
        REQUIRE(cells.points.size() == 60);
        REQUIRE(cells.cellOf.size() == places.all.size());
        CHECK(std::set<std::uint32_t>(cells.points.begin(), cells.points.end()).size() == 60);
        const auto nearestTo = [&](const glm::dvec3& direction) {
            std::size_t nearest = 0;
            for (std::size_t k = 1; k < cells.points.size(); ++k) {
                const auto cosine = [&](std::size_t i) {
                    return glm::dot(direction, places.all[cells.points[i]].direction);
                };
                nearest = cosine(k) > cosine(nearest) ? k : nearest;
            }
            return nearest;
        };
        std::vector<glm::dvec3> energies(60, glm::dvec3(0));
        for (std::size_t i = 0; i < places.all.size(); ++i) {
            const std::size_t nearest = nearestTo(places.all[i].direction);
            // Of two as near rounding may choose.
            const double best = glm::dot(places.all[i].direction, places.all[cells.points[nearest]].direction);
            const double own = glm::dot(places.all[i].direction, places.all[cells.points[cells.cellOf[i]]].direction);
            REQUIRE(own >= best - 1e-14);
            energies[cells.cellOf[i]] += places.all[i].irradiance;
        }
        const std::vector<render::MapLight> lights = render::mapLights(places, cells);
        for (std::size_t k = 0; k < lights.size(); ++k) {
            checkClose(lights[k].irradiance, energies[k], 1e-6);
            // Cells are convex: what is a mean of their directions is in them.
            const glm::dvec3 towards = glm::transpose(places.axes) * glm::dvec3(lights[k].towards);
            REQUIRE(nearestTo(towards) == k);
            glm::dvec3 moment(0);
            double least = 1;
            for (std::size_t i = 0; i < places.all.size(); ++i)
                if (cells.cellOf[i] == k) {
                    moment += luminanceOf(places.all[i].irradiance) * places.all[i].direction;
                    least = std::min(least, glm::dot(places.all[i].direction, places.all[cells.points[k]].direction));
                }
            CHECK(glm::length(glm::normalize(moment) - towards) < 1e-6);
            CHECK(glm::dot(towards, places.all[cells.points[k]].direction) >= least - 1e-6);
        }
    }
}

TEST_CASE("of several points as near the first has a place")
{
    render::MapPlaces places { 4, 1, {} };
    for (const glm::dvec3& d : { glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1) })
        places.all.push_back({ d, pi, glm::dvec3(1), d });
    const render::MapCells cells = render::mapCells(places, 2);
    CHECK(cells.points == std::vector<std::uint32_t> { 0, 2 });
    CHECK(cells.cellOf == std::vector<std::uint32_t> { 0, 0, 1, 0 });
}

TEST_CASE("texels of light on black are lights of their own")
{
    auto p = even(glm::vec3(0), 128, 64);
    const glm::ivec2 bright[] = { { 3, 10 }, { 4, 30 }, { 50, 8 }, { 51, 40 }, { 90, 33 }, { 127, 20 } };
    for (const glm::ivec2& at : bright)
        set(*p, at.x, at.y, { 30, 20, 10 });
    const std::vector<render::MapLight> lights = render::mapLights(*p, std::size(bright));
    for (const glm::ivec2& at : bright) {
        const glm::dvec3 towards = directionOf(*p, at.x, at.y);
        const auto found = std::ranges::max_element(
            lights, {}, [&](const render::MapLight& light) { return glm::dot(glm::dvec3(light.towards), towards); });
        CHECK(glm::length(glm::dvec3(found->towards) - towards) < 1e-6);
        const double solidAngle = 2 * pi / 128 * (std::cos(pi * at.y / 64) - std::cos(pi * (at.y + 1) / 64));
        checkClose(found->irradiance, solidAngle * glm::dvec3(30, 20, 10), 1e-6);
    }
}

TEST_CASE("parts of the sky have lights by their energy and a root of their size")
{
    // Two squares on black, as far from the equator, of as many texels: three quarters of the light in one.
    auto p = even(glm::vec3(0), 128, 64);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            set(*p, 20 + x, 10 + y, glm::vec3(3));
            set(*p, 90 + x, 46 + y, glm::vec3(1));
        }
    const auto within = [&](int left, std::size_t lights) {
        const render::MapPlaces places = render::mapPlaces(*p);
        const render::MapCells cells = render::mapCells(places, lights);
        return std::ranges::count_if(cells.points, [&](std::uint32_t place) {
            const int x = static_cast<int>(place) % 128;
            return x >= left && x < left + 8 && luminanceOf(places.all[place].irradiance) > 0;
        });
    };
    CHECK(within(20, 40) == 30);
    CHECK(within(90, 40) == 10);
    // As much light in a sixteenth of the solid angle, all below 0.01 sr: half the weight.
    auto sharp = even(glm::vec3(0), 512, 256);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            set(*sharp, 300 + x, 124 + y, glm::vec3(1));
    for (const int x : { 0, 1 })
        for (const int y : { 0, 1 })
            set(*sharp, 100 + x, 127 + y, glm::vec3(16));
    const render::MapPlaces fine = render::mapPlaces(*sharp);
    const auto inSmall = [&](std::uint32_t place) { return place % 512 < 200; };
    CHECK(std::ranges::count_if(render::mapCells(fine, 6).points, inSmall) == 2);
    CHECK(std::ranges::count_if(render::mapCells(fine, 30).points, inSmall) == 4); // it has no room for more
    // The first column is beside the last one: one part, not two smaller ones.
    auto seam = even(glm::vec3(0), 512, 256);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            set(*seam, (508 + x) % 512, 124 + y, glm::vec3(1));
            set(*seam, 200 + x, 124 + y, glm::vec3(1));
        }
    const auto atSeam = [](std::uint32_t place) { return place % 512 < 100 || place % 512 > 400; };
    CHECK(std::ranges::count_if(render::mapCells(render::mapPlaces(*seam), 20).points, atSeam) == 10);
    // A texel that has nearly all light takes one light all the same.
    auto spike = even(glm::vec3(1), 64, 32);
    set(*spike, 30, 10, glm::vec3(1e6f));
    const render::MapCells spiked = render::mapCells(render::mapPlaces(*spike), 10);
    CHECK(std::set<std::uint32_t>(spiked.points.begin(), spiked.points.end()).size() == 10);
    CHECK(std::ranges::count(spiked.points, 10u * 64u + 30u) == 1);
    // A gradient: brighter parts have more lights for their area than darker ones.
    auto slope = even(glm::vec3(0), 64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            set(*slope, x, y, glm::vec3(y < 4 ? 20.0f : 1.0f));
    std::size_t above = 0;
    for (const render::MapLight& light : render::mapLights(*slope, 40))
        above += light.towards.y > 0.9f ? 1 : 0;
    const double area = 1 - std::cos(pi / 8), share = 20 * area / (20 * area + 2 - area);
    CHECK(static_cast<double>(above) == doctest::Approx(40 * share).epsilon(0.15));
}

TEST_CASE("even maps, maps of one texel, and black ones have lights all around, the same each time")
{
    for (const auto& p :
        { even(glm::vec3(2, 1, 0.5f)), even(glm::vec3(2, 1, 0.5f), 64, 32), even(glm::vec3(0), 64, 32) }) {
        for (const std::size_t count : { 1u, 12u, 100u }) {
            CAPTURE(count);
            const std::vector<render::MapLight> lights = render::mapLights(*p, count),
                                                again = render::mapLights(*p, count);
            REQUIRE(lights.size() == count);
            glm::dvec3 middle(0);
            for (std::size_t i = 0; i < count; ++i) {
                CHECK(lights[i].towards == again[i].towards);
                CHECK(lights[i].irradiance == again[i].irradiance);
                CHECK(glm::length(lights[i].towards) == doctest::Approx(1).epsilon(1e-6));
                middle += glm::dvec3(lights[i].towards) / static_cast<double>(count);
            }
            CHECK((count == 1 || glm::length(middle) < 0.2));
            checkClose(energyOf(lights), 4 * pi * glm::dvec3(p->radiance[0], p->radiance[1], p->radiance[2]), 1e-5);
        }
        // As many as there are places: each is one.
        const render::MapPlaces places = render::mapPlaces(*p);
        const render::MapCells cells = render::mapCells(places, places.all.size());
        for (std::size_t i = 0; i < places.all.size(); ++i)
            REQUIRE(cells.points[cells.cellOf[i]] == i);
    }
}

TEST_CASE("lights turn with the map")
{
    const auto p = varied(64, 32);
    auto turned = std::make_shared<render::EnvironmentPicture>(*p);
    turned->right = p->up;
    turned->up = p->back;
    turned->back = p->right;
    const std::vector<render::MapLight> before = render::mapLights(*p, 30), after = render::mapLights(*turned, 30);
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK(
            glm::dot(before[i].towards, p->right) == doctest::Approx(glm::dot(after[i].towards, p->up)).epsilon(1e-5));
        CHECK(glm::dot(before[i].towards, p->up) == doctest::Approx(glm::dot(after[i].towards, p->back)).epsilon(1e-5));
        CHECK(before[i].irradiance == after[i].irradiance);
    }
}

TEST_CASE("more lights than places are refused, with both numbers and the way out")
{
    const auto p = even(glm::vec3(1), 64, 32);
    CHECK_THROWS_WITH_AS(render::mapLights(*p, 2049),
        "the environment's map has fewer places for lights: 2049 lights, 2048 places: give --shadow-lights 2048 or "
        "less",
        UsageError);
    CHECK_THROWS_AS(render::requirePlaces(*p, 2049), UsageError);
    CHECK_NOTHROW(render::requirePlaces(*p, 2048));
}

TEST_CASE("the largest irradiance by harmonics has its unit")
{
    // An even map: pi L. L = 1 + 0.5 d.up: pi + 0.5 2 pi / 3 of what faces up.
    const auto one = even(glm::vec3(2, 1, 0.5f));
    checkClose(render::environmentTable(one.get()).mostIrradiance, pi * glm::dvec3(2, 1, 0.5), 1e-3);
    auto slope = even(glm::vec3(0), 256, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x)
            set(*slope, x, y, glm::dvec3(1 + 0.5 * std::cos(pi * (y + 0.5) / 128)));
    checkClose(render::environmentTable(slope.get()).mostIrradiance, glm::dvec3(pi + pi / 3), 1e-3);
    CHECK(render::environmentTable(nullptr).mostIrradiance == glm::dvec3(0));
    const auto black = even(glm::vec3(0));
    CHECK(render::environmentTable(black.get()).mostIrradiance == glm::dvec3(0));
}
