// How much of a pixel, or of the lens, a quad covers: closed forms against grids. The shared maths as C++, no device.
#include "kernels/shared/coverage.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

using namespace wedge::shared;

namespace {

double uniform(std::mt19937& random, double lo, double hi)
{
    return lo + (hi - lo) * (static_cast<double>(random()) + 0.5) / 4294967296.0;
}

/// A parallelogram somewhere around the origin.
ImageQuad randomQuad(std::mt19937& random, double away, double size)
{
    const auto number = [&](double most) { return static_cast<float>(uniform(random, -most, most)); };
    const Vec2 centre = vec2(number(away), number(away)), u = vec2(number(size), number(size));
    const Vec2 v = vec2(number(size), number(size));
    const auto corner = [&](float a, float b) {
        return vec2(centre.x + a * u.x + b * v.x, centre.y + a * u.y + b * v.y);
    };
    return { { corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1) } };
}

bool inQuad(const ImageQuad& quad, double x, double y)
{
    int sides = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec2 a = quad.corners[k], b = quad.corners[(k + 1) % 4];
        const double side = (static_cast<double>(b.x) - a.x) * (y - a.y) - (static_cast<double>(b.y) - a.y) * (x - a.x);
        sides += side > 0 ? 1 : -1;
    }
    return sides == 4 || sides == -4;
}

/// The share of points, of a grid of numbers in the unit square, that are in the quad.
double shareOfGrid(const ImageQuad& quad, const std::function<Vec2(double, double)>& point)
{
    constexpr int steps = 400;
    int inside = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const Vec2 p = point((i + 0.5) / steps, (k + 0.5) / steps);
            inside += inQuad(quad, p.x, p.y) ? 1 : 0;
        }
    return static_cast<double>(inside) / (steps * steps);
}

} // namespace

TEST_CASE("coverage of a pixel is that of a fine grid")
{
    std::mt19937 random(1);
    for (int k = 0; k < 150; ++k) {
        CAPTURE(k);
        const ImageQuad quad = randomQuad(random, 1, k % 3 == 0 ? 0.3 : 3);
        const double expected = shareOfGrid(
            quad, [](double u, double v) { return vec2(static_cast<float>(u - 0.5), static_cast<float>(v - 0.5)); });
        CHECK(std::fabs(pixelCoverage(quad) - expected) < 2e-3); // of the grid
    }
}

TEST_CASE("coverage in closed form: halves, all, nothing, corners, edges along the pixel's")
{
    const auto of = [](float x0, float y0, float x1, float y1) {
        return pixelCoverage({ { vec2(x0, y0), vec2(x1, y0), vec2(x1, y1), vec2(x0, y1) } });
    };
    CHECK(of(-5, -5, 5, 5) == doctest::Approx(1));
    CHECK(of(-5, -5, 0, 5) == doctest::Approx(0.5));
    CHECK(of(-5, 0.25f, 5, 7) == doctest::Approx(0.25));
    CHECK(of(0.5f, -1, 3, 1) == doctest::Approx(0));
    CHECK(of(-0.5f, -0.5f, 0.5f, 0.5f) == doctest::Approx(1));
    CHECK(of(-0.1f, -0.1f, 0.1f, 0.1f) == doctest::Approx(0.04));
    CHECK(of(1000, 1000, 1001, 1001) == doctest::Approx(0));
    // A diagonal through the centre, of a quad that is large.
    CHECK(pixelCoverage({ { vec2(-1000, -1000), vec2(1000, 1000), vec2(0, 2000), vec2(-2000, 0) } })
        == doctest::Approx(0.5).epsilon(1e-3));
    // Nothing has no area.
    CHECK(pixelCoverage({ { vec2(0, 0), vec2(0, 0), vec2(0, 0), vec2(0, 0) } }) == 0);
}

TEST_CASE("coverage of the lens is that of a fine grid")
{
    std::mt19937 random(2);
    for (int k = 0; k < 100; ++k) {
        CAPTURE(k);
        const ImageQuad quad = randomQuad(random, 1.2, k % 3 == 0 ? 0.4 : 4);
        const double expected = shareOfGrid(quad, [](double u, double v) {
            const double r = std::sqrt(u), angle = 2 * std::numbers::pi * v;
            return vec2(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)));
        });
        CHECK(std::fabs(discCoverage(quad) - expected) < 4e-3);
    }
    // Edges of quads that are thousands of radii long.
    for (const float far : { 300.0f, 1000.0f, 10000.0f }) {
        CAPTURE(far);
        for (int k = 0; k < 100; ++k) {
            const double angle = uniform(random, 0, 2 * std::numbers::pi), from = uniform(random, -1, 1);
            const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
            const auto at = [&](float along, float across) {
                return vec2(across * x - along * y, across * y + along * x);
            };
            const auto first = static_cast<float>(from);
            const ImageQuad quad { { at(-0.7f * far, first), at(far, first), at(far, far), at(-0.7f * far, far) } };
            const double beyond = (std::acos(from) - from * std::sqrt(1 - from * from)) / std::numbers::pi;
            CHECK(std::fabs(discCoverage(quad) - beyond) < 3e-7 * far + 1e-5);
        }
    }
    const auto half = [](float from) {
        return discCoverage({ { vec2(from, -9), vec2(9, -9), vec2(9, 9), vec2(from, 9) } });
    };
    CHECK(half(0) == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(half(-2) == doctest::Approx(1).epsilon(1e-6));
    CHECK(half(2) == doctest::Approx(0));
    // A segment of half the radius' height.
    CHECK(half(0.5f) == doctest::Approx((std::acos(0.5) - 0.5 * std::sqrt(0.75)) / std::numbers::pi).epsilon(1e-5));
}

TEST_CASE("a square is in a quad, beyond it, or neither")
{
    std::mt19937 random(3);
    int found[3] = { 0, 0, 0 };
    for (int k = 0; k < 300; ++k) {
        CAPTURE(k);
        const ImageQuad quad = randomQuad(random, 3, 3);
        const int where = squareInQuad(quad, 0.5f);
        const double share = shareOfGrid(
            quad, [](double u, double v) { return vec2(static_cast<float>(u - 0.5), static_cast<float>(v - 0.5)); });
        ++found[where + 1];
        CHECK((where < 0 ? share == 0 : where == 0 || share == 1));
    }
    for (const int n : found)
        CHECK(n > 10);
}
