// Quadrature over lights, and what the host makes of a light for the kernels.
#include "host/render/device_scene.h"
#include "host/render/quadrature.h"
#include "tests/render_oracles.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Mean over the light of the geometry term, by the tensor product of the rule of `count` nodes.
double meanGeometry(const scene::AreaLight& light, int count, glm::dvec3 position, glm::dvec3 normal)
{
    const std::vector<render::Node> rule = render::profileRule(light.profile, light.cut, count);
    double sum = 0;
    for (const render::Node& a : rule)
        for (const render::Node& b : rule) {
            const glm::dvec3 point =
                glm::dvec3(light.centre) + a.position * glm::dvec3(light.halfU) + b.position * glm::dvec3(light.halfV);
            sum += a.weight * b.weight * geometry(normal, point - position, lightNormal(light), light.twoSided);
        }
    return sum;
}

scene::AreaLight ceiling(scene::LightProfile profile)
{
    scene::AreaLight light;
    light.centre = { 0, 2, 0 };
    light.halfU = { 0.5f, 0, 0 };
    light.halfV = { 0, 0, 0.3f };
    light.profile = profile;
    light.radiance = { 3, 2, 1 };
    return light;
}

} // namespace

TEST_CASE("Gauss-Legendre rules integrate polynomials of degree 2n - 1 exactly")
{
    for (int count = 1; count <= 24; ++count) {
        const std::vector<render::Node> rule = render::gaussLegendre(count);
        CAPTURE(count);
        REQUIRE(rule.size() == static_cast<std::size_t>(count));
        for (const render::Node& node : rule) {
            REQUIRE(std::fabs(node.position) < 1);
            REQUIRE(node.weight > 0);
        }
        for (int degree = 0; degree <= 2 * count - 1; ++degree) {
            double sum = 0;
            for (const render::Node& node : rule)
                sum += node.weight * std::pow(node.position, degree);
            CAPTURE(degree);
            REQUIRE(std::fabs(sum - (degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0)) < 1e-12);
        }
    }
}

TEST_CASE("profile rules average over the light's profile")
{
    for (const double cut : { 0.5, 1.0, 2.0, 3.0 }) {
        double total = 0, square = 0;
        for (const render::Node& node : render::profileRule(scene::LightProfile::Gaussian, cut, 16)) {
            total += node.weight;
            square += node.weight * node.position * node.position;
        }
        const double density = std::exp(-0.5 * cut * cut) / std::sqrt(2 * std::numbers::pi);
        CAPTURE(cut);
        CHECK(total == doctest::Approx(1).epsilon(1e-12));
        CHECK(square * cut * cut
            == doctest::Approx(1 - 2 * cut * density / std::erf(cut / std::sqrt(2.0))).epsilon(1e-6));
    }
    double square = 0;
    for (const render::Node& node : render::profileRule(scene::LightProfile::Uniform, 7, 3))
        square += node.weight * node.position * node.position;
    CHECK(square == doctest::Approx(1.0 / 3).epsilon(1e-12));
}

TEST_CASE("the rule of n nodes averages polynomials of degree 2n - 1 over the profile")
{
    for (const scene::LightProfile profile : { scene::LightProfile::Uniform, scene::LightProfile::Gaussian })
        for (const double cut : { 0.01, 0.5, 2.0, 4.0, 8.0 })
            for (const std::uint32_t count :
                { 1u, WEDGE_FEW_NODES, WEDGE_COARSE_NODES, WEDGE_MEDIUM_NODES, WEDGE_FINE_NODES, 16u }) {
                CAPTURE(cut);
                CAPTURE(count);
                const std::vector<render::Node> rule = render::profileRule(profile, cut, static_cast<int>(count));
                REQUIRE(rule.size() == count);
                for (std::uint32_t degree = 0; degree < 2 * count; ++degree) {
                    double sum = 0, exact = 0, all = 0;
                    for (const render::Node& node : rule) {
                        CHECK(std::fabs(node.position) < 1);
                        CHECK(node.weight > 0);
                        sum += node.weight * std::pow(node.position, degree);
                    }
                    constexpr int steps = 20000;
                    for (int i = 0; i < steps; ++i) {
                        const double x = 2 * (i + 0.5) / steps - 1;
                        const double weight =
                            profile == scene::LightProfile::Gaussian ? std::exp(-0.5 * cut * cut * x * x) : 1;
                        all += weight;
                        exact += weight * std::pow(x, degree);
                    }
                    CAPTURE(degree);
                    CHECK(std::fabs(sum - exact / all) < 1e-6);
                }
            }
    const std::vector<render::Node> uniform = render::profileRule(scene::LightProfile::Uniform, 1, 3);
    CHECK(uniform.back().position == doctest::Approx(std::sqrt(0.6)));
}

TEST_CASE("the quadrature of an unshadowed uniform quad agrees with Lambert's formula")
{
    const scene::AreaLight light = ceiling(scene::LightProfile::Uniform);
    const double area = 4 * 0.5 * 0.3;
    for (const glm::dvec3 position : { glm::dvec3(0, 0, 0), glm::dvec3(0.7, 0, -0.4), glm::dvec3(-3, 0.2, 2) })
        for (const glm::dvec3 facing : { glm::dvec3(0, 1, 0), glm::dvec3(0.3, 1, 0.2) }) {
            const glm::dvec3 normal = glm::normalize(facing);
            const double exact = lambertIrradiance(light, position, normal);
            CAPTURE(position.x);
            CHECK(
                area * meanGeometry(light, WEDGE_FINE_NODES, position, normal) == doctest::Approx(exact).epsilon(1e-7));
            CHECK(area * meanGeometry(light, WEDGE_COARSE_NODES, position, normal)
                == doctest::Approx(exact).epsilon(1e-4));
        }
}

TEST_CASE("a light's power is its radiance integrated over the profile, its sigma that of the cut")
{
    for (const scene::LightProfile profile : { scene::LightProfile::Uniform, scene::LightProfile::Gaussian }) {
        scene::AreaLight light = ceiling(profile);
        light.cut = 1.5f;
        const shared::AreaLight made = render::deviceLight(light);
        double integral = 0;
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k)
                integral += profileAt(light, 2 * (i + 0.5) / steps - 1, 2 * (k + 0.5) / steps - 1);
        integral *= 4 * 0.5 * 0.3 / (static_cast<double>(steps) * steps);
        CHECK(made.power.x == doctest::Approx(3 * integral).epsilon(1e-4));
        CHECK(made.power.z == doctest::Approx(1 * integral).epsilon(1e-4));
        CHECK(made.radiance.y == 2.0f);
        CHECK(made.normal.y == doctest::Approx(-1));
        const double halfExtents = profile == scene::LightProfile::Gaussian ? 1.5 : 1.0;
        CHECK(made.sigma * halfExtents == doctest::Approx(std::sqrt(0.5 * 0.3)));
    }
}
