// Mirrors and glass against the laws of reflection and refraction in double.
#include "kernels/shared/mirror.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include <glm/glm.hpp>

using namespace wedge;

namespace {

double uniform(std::mt19937& random, double lo = 0, double hi = 1)
{
    return lo + (hi - lo) * (static_cast<double>(random()) + 0.5) / 4294967296.0;
}

glm::dvec3 unitVector(std::mt19937& random)
{
    const double z = uniform(random, -1, 1), angle = uniform(random, 0, 6.28318530717959);
    const double r = std::sqrt(1 - z * z);
    return { r * std::cos(angle), r * std::sin(angle), z };
}

/// Fresnel's equations by the angles themselves.
double fresnel(double c, double index)
{
    const double i = std::acos(c), sine = std::sin(i) / index;
    if (sine >= 1)
        return 1;
    const double t = std::asin(sine);
    if (i < 1e-9)
        return std::pow((1 - index) / (1 + index), 2);
    const double across = std::sin(i - t) / std::sin(i + t), along = std::tan(i - t) / std::tan(i + t);
    return 0.5 * (across * across + along * along);
}

shared::Vec3 toVec3(glm::dvec3 v)
{
    return shared::vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}
glm::dvec3 toDouble(shared::Vec3 v) { return { v.x, v.y, v.z }; }

const shared::Vec3 one = shared::vec3(1, 1, 1), tint = shared::vec3(0.5f, 0.25f, 1);

} // namespace

TEST_CASE("what a dielectric reflects is Fresnel's, the same from both sides")
{
    for (const double index : { 1.0, 1.33, 1.5, 2.4, 1 / 1.5, 1 / 2.4 })
        for (int k = 1; k <= 400; ++k) {
            const double c = k / 400.0;
            float behind = -1;
            const float share = shared::dielectricFresnel(static_cast<float>(c), static_cast<float>(index), &behind);
            CAPTURE(index);
            CAPTURE(c);
            CHECK(share == doctest::Approx(fresnel(c, index)).epsilon(1e-3));
            if (share < 1 && behind > 0.05f) {
                float back = -1;
                const float other = shared::dielectricFresnel(behind, static_cast<float>(1 / index), &back);
                CHECK(other == doctest::Approx(share).epsilon(2e-3));
                CHECK(back == doctest::Approx(c).epsilon(1e-3));
            }
        }
    // Brewster's angle: what vibrates in the plane of incidence is not reflected.
    float behind = 0;
    const double brewster = std::cos(std::atan(1.5));
    CHECK(shared::dielectricFresnel(static_cast<float>(brewster), 1.5f, &behind)
        == doctest::Approx(0.5 * std::pow((1.5 * 1.5 - 1) / (1.5 * 1.5 + 1), 2)).epsilon(1e-4));
}

TEST_CASE("directions obey the laws of reflection and refraction, and rays may go back")
{
    std::mt19937 random(7);
    int through = 0, reflected = 0, total = 0;
    for (int k = 0; k < 4000; ++k) {
        const glm::dvec3 n = unitVector(random);
        glm::dvec3 v = unitVector(random);
        v = glm::dot(v, n) < 0 ? -v : v;
        if (glm::dot(v, n) < 0.02)
            continue;
        const double index = k % 2 == 0 ? uniform(random, 1.05, 2.5) : 1 / uniform(random, 1.05, 2.5);
        const shared::Deflection d = shared::deflect(
            toVec3(n), toVec3(n), toVec3(v), static_cast<float>(index), one, tint, static_cast<float>(uniform(random)));
        const glm::dvec3 l = toDouble(d.direction);
        CHECK(glm::length(l) == doctest::Approx(1).epsilon(1e-5));
        const double share = fresnel(glm::dot(n, v), index);
        if (d.through == 0) {
            CHECK(glm::length(l - (2 * glm::dot(n, v) * n - v)) < 1e-5);
            CHECK(d.weight.x == 1);
            ++reflected;
            total += share == 1.0 ? 1 : 0;
            continue;
        }
        ++through;
        REQUIRE(share < 1);
        // Snell: sines, in one plane.
        CHECK(glm::dot(l, n) < 0);
        CHECK(glm::length(glm::cross(n, l) * index + glm::cross(n, v)) < 2e-5);
        CHECK(d.weight.x == doctest::Approx(0.5 / (index * index)).epsilon(1e-5));
        CHECK(d.weight.y == doctest::Approx(0.25 / (index * index)).epsilon(1e-5));
        if (std::abs(glm::dot(l, n)) > 0.05) {
            const shared::Deflection back =
                shared::deflect(toVec3(-n), toVec3(-n), d.direction, static_cast<float>(1 / index), one, one, 0.99999f);
            CHECK(back.through == 1);
            CHECK(glm::length(toDouble(back.direction) - v) < 1e-3);
            // There and back, radiance is what it was.
            CHECK(back.weight.x * d.weight.z == doctest::Approx(1).epsilon(1e-5));
        }
    }
    CHECK(through > 1000);
    CHECK(reflected > total);
    CHECK(total > 100);
}

TEST_CASE("the shares of both directions are Fresnel's")
{
    const glm::dvec3 n(0, 0, 1), v(std::sin(1.2), 0, std::cos(1.2));
    int through = 0;
    for (int k = 0; k < 10000; ++k)
        through += static_cast<int>(
            shared::deflect(toVec3(n), toVec3(n), toVec3(v), 1.5f, one, one, (static_cast<float>(k) + 0.5f) / 10000)
                .through);
    CHECK(through / 10000.0 == doctest::Approx(1 - fresnel(std::cos(1.2), 1.5)).epsilon(1e-3));
}

TEST_CASE("no direction is on the wrong side of the surface, whatever its shading normal, and none is lost")
{
    std::mt19937 random(11);
    for (int k = 0; k < 20000; ++k) {
        const glm::dvec3 g = unitVector(random);
        glm::dvec3 v = unitVector(random), n = glm::normalize(g + 1.5 * unitVector(random));
        v = glm::dot(v, g) < 0 ? -v : v;
        const float index = k % 3 == 0 ? 0.0f : static_cast<float>(k % 3 == 1 ? 1.5 : 1 / 1.5);
        const shared::Deflection d =
            shared::deflect(toVec3(n), toVec3(g), toVec3(v), index, one, one, static_cast<float>(uniform(random)));
        const double side = glm::dot(toDouble(d.direction), g);
        CAPTURE(index);
        CHECK((d.through != 0 ? -side : side) >= -1e-6);
        CHECK(glm::length(toDouble(d.direction)) == doctest::Approx(1).epsilon(1e-5));
        CHECK(d.weight.x > 0);
    }
}
