// The shared maths as C++: lights, the frequency analysis, reflection. No device.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/light.h"
#include "kernels/shared/wedge.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace wedge::shared;

namespace {

constexpr double pi = std::numbers::pi;
const float notANumber = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

/// The x with erf(x) = y, by Newton's method.
double exactErfInverse(double y)
{
    double x = 0;
    for (int step = 0; step < 100; ++step)
        x -= (std::erf(x) - y) * std::sqrt(pi) / 2 * std::exp(std::min(x * x, 40.0));
    return x;
}

/// Integral of lobe times cosine over the hemisphere of light directions, for a viewer at that angle.
double albedo(float exponent, uint model, double viewAngle)
{
    const Vec3 n = vec3(0, 0, 1);
    const Vec3 v = vec3(static_cast<float>(std::sin(viewAngle)), 0, static_cast<float>(std::cos(viewAngle)));
    // In cos^2, so that the cosine goes into the measure.
    constexpr int rings = 1500, sectors = 360;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double z = std::sqrt((i + 0.5) / rings), r = std::sqrt(1 - z * z);
        for (int k = 0; k < sectors; ++k) {
            const double phi = 2 * pi * (k + 0.5) / sectors;
            const Vec3 l = vec3(
                static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z));
            sum += specularLobe(n, v, l, exponent, model);
        }
    }
    return sum * pi / (static_cast<double>(rings) * sectors);
}

} // namespace

TEST_CASE("the zero vector normalises to itself")
{
    const Vec3 zero = vecNormalize(vec3(0, 0, 0));
    CHECK(zero.x == 0);
    CHECK(zero.y == 0);
    CHECK(zero.z == 0);
    CHECK(vecLength(vecNormalize(vec3(3, -4, 12))) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("erfInverse undoes the error function")
{
    CHECK(erfInverse(0.0f) == 0.0f);
    double worst = 0;
    for (int i = -4000; i <= 4000; ++i) {
        const float y = static_cast<float>(i) / 4000.5f;
        if (i == 0)
            continue;
        const double exact = exactErfInverse(y);
        worst = std::max(worst, std::fabs(erfInverse(y) - exact) / std::fabs(exact));
    }
    CHECK(worst < 2e-6);
    for (const float y : { 1e-30f, 1e-6f, 0.9999f, 0.99999994f })
        CHECK(std::isfinite(erfInverse(y)));
}

TEST_CASE("light coordinates follow the light's profile, cut and all")
{
    constexpr int count = 200000;
    for (const float cut : { 0.5f, 1.0f, 2.0f, 3.0f, 5.0f }) {
        CAPTURE(cut);
        const double mass = std::erf(cut / std::sqrt(2.0));
        double mean = 0, square = 0, below = 0;
        for (int i = 0; i < count; ++i) {
            const float a = lightCoordinate(
                static_cast<float>((i + 0.5) / count), WEDGE_PROFILE_GAUSSIAN, cut, static_cast<float>(mass));
            mean += a / count;
            square += static_cast<double>(a) * a / count;
            below += a < 0.25f ? 1.0 / count : 0.0;
        }
        const double density = std::exp(-0.5 * cut * cut) / std::sqrt(2 * pi);
        const double variance = 1 - 2 * cut * density / mass;
        CHECK(std::fabs(mean) < 1e-5);
        CHECK(square * cut * cut == doctest::Approx(variance).epsilon(1e-3));
        CHECK(below == doctest::Approx(0.5 + 0.5 * std::erf(0.25 * cut / std::sqrt(2.0)) / mass).epsilon(1e-4));
        for (const float u : { 0.0f, 0.5f, 0.99999994f })
            CHECK(std::fabs(lightCoordinate(u, WEDGE_PROFILE_GAUSSIAN, cut, static_cast<float>(mass))) <= 1.0001f);
        CHECK(lightCoordinate(0.5f, WEDGE_PROFILE_GAUSSIAN, cut, static_cast<float>(mass)) == 0.0f);
        CHECK(lightProfile(0, 0, WEDGE_PROFILE_GAUSSIAN, cut) == 1.0f);
        CHECK(lightProfile(1, 0, WEDGE_PROFILE_GAUSSIAN, cut) == doctest::Approx(std::exp(-0.5 * cut * cut)));
        CHECK(lightProfile(0.6f, -0.8f, WEDGE_PROFILE_GAUSSIAN, cut) == doctest::Approx(std::exp(-0.5 * cut * cut)));
    }
    CHECK(lightCoordinate(0.0f, WEDGE_PROFILE_UNIFORM, 1, 1) == -1.0f);
    CHECK(lightCoordinate(0.75f, WEDGE_PROFILE_UNIFORM, 1, 1) == 0.5f);
    CHECK(lightProfile(0.9f, -0.9f, WEDGE_PROFILE_UNIFORM, 2) == 1.0f);
}

TEST_CASE("light coordinates stay on the light at every cut, and lightFraction undoes them")
{
    for (const float cut : { 0.5f, 2.0f, 4.0f, 6.0f, 8.0f }) {
        CAPTURE(cut);
        const auto mass = static_cast<float>(std::erf(cut / std::sqrt(2.0)));
        for (const uint profile : { WEDGE_PROFILE_GAUSSIAN, WEDGE_PROFILE_UNIFORM }) {
            for (const float u : { 0.0f, 1e-7f, 0.25f, 0.5f, 0.999f, 0.99999994f }) {
                const float a = lightCoordinate(u, profile, cut, mass);
                CHECK(std::fabs(a) <= 1.0f);
                CHECK(std::fabs(lightFraction(a, profile, cut, mass) - u) < 2e-6f);
            }
        }
    }
}

TEST_CASE("elementary functions are those of the library")
{
    double power = 0, turn = 0, logarithm = 0, error = 0;
    for (int i = 0; i <= 4000; ++i) {
        const float x = static_cast<float>(std::exp(-80.0 + 0.04 * i)), u = static_cast<float>(i) / 4000.0f;
        logarithm = std::max(logarithm, std::fabs(logPositive(x) - std::log(static_cast<double>(x))) / 80);
        error = std::max(error, std::fabs(errorFunction(8 * u - 4) - std::erf(8.0 * u - 4.0)));
        for (const float exponent : { 0.0f, 0.3f, 1.0f, 12.0f, 2000.0f }) {
            const double exact = std::pow(static_cast<double>(u), static_cast<double>(exponent));
            if (u > 0 && exact > 1e-30)
                power =
                    std::max(power, std::fabs(powPositive(u, exponent) / exact - 1) / std::max(1.0, -std::log2(exact)));
        }
        float s, c;
        sinCosTurn(u, &s, &c);
        turn = std::max({ turn, std::fabs(s - std::sin(2 * pi * u)), std::fabs(c - std::cos(2 * pi * u)) });
    }
    double angle = 0;
    for (int i = 0; i < 4000; ++i) {
        const double a = 2 * pi * i / 4000.0, size = std::pow(10.0, i % 21 - 10);
        const float x = static_cast<float>(size * std::cos(a)), y = static_cast<float>(size * std::sin(a));
        angle = std::max(angle, std::fabs(turnOf(y, x) - std::atan2(double { y }, double { x }) / (2 * pi)));
    }
    CHECK(angle < 1.2e-7);
    CHECK(turnOf(0.0f, 0.0f) == 0.0f);
    CHECK(turnOf(1e-40f, 0.0f) == 0.25f); // what devices may take for 0, and divide by
    CHECK(turnOf(0.0f, -2.0f) == 0.5f);
    CHECK(turnOf(-3.0f, 0.0f) == -0.25f);
    CHECK(turnOf(1e-30f, 1e30f) == 0.0f);
    CHECK(logarithm < 1e-7);
    CHECK(error < 5e-7);
    CHECK(power < 1e-6);
    CHECK(turn < 5e-7);
    CHECK(powPositive(0.5f, 1e6f) < 1.2e-38f); // far below what a float holds
    CHECK(powPositive(1.0f, 1e6f) == 1.0f);
    CHECK(exp2Bounded(-1e30f) > 0.0f);
    CHECK(exp2Bounded(3.0f) == 8.0f);
}

TEST_CASE("samples of the part of a light above a horizon are above it, and their weights make up that part's power")
{
    std::mt19937 random(7);
    const auto number = [&](float lo, float hi) {
        return lo + (hi - lo) * static_cast<float>(random()) / 4294967296.0f;
    };
    int cut = 0, whole = 0;
    for (int run = 0; run < 600; ++run) {
        AreaLight light {};
        light.halfU = vec3(number(0.1f, 2), 0, 0);
        light.halfV = vec3(0, number(0.1f, 2), 0);
        light.profile = run % 2 == 0 ? WEDGE_PROFILE_GAUSSIAN : WEDGE_PROFILE_UNIFORM;
        light.cut = number(1, 4);
        light.erfCut = static_cast<float>(std::erf(light.cut / std::sqrt(2.0)));
        const Vec3 normal = vecNormalize(vec3(number(-1, 1), number(-1, 1), number(-1, 1)));
        const Vec3 position = vec3(number(-2, 2), number(-2, 2), number(0.1f, 2));
        const LightPart part = partAboveHorizon(light, position, normal);
        const auto height = [&](float a, float b) {
            return vecDot(normal, vecSub(lightPoint(light.centre, light.halfU, light.halfV, a, b), position));
        };
        constexpr int steps = 128;
        // Moments of the profile over what is above: by a grid of the whole light, and by the part's samples.
        double expected[2] = { 0, 0 }, found[2] = { 0, 0 };
        int below = 0;
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const Vec2 u = vec2((static_cast<float>(i) + 0.5f) / steps, (static_cast<float>(k) + 0.5f) / steps);
                const float a = lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
                const float b = lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
                if (height(a, b) > 0) {
                    expected[0] += 1.0 / (steps * steps);
                    expected[1] += (a + 2.0 * b) / (steps * steps);
                }
                const PartSample s = samplePart(light, part, u);
                REQUIRE(std::fabs(s.a) <= 1);
                REQUIRE(std::fabs(s.b) <= 1);
                REQUIRE(
                    s.mass == doctest::Approx(part.cut != 0 ? partMass(light, part, s.a, s.b) : 1.0f).epsilon(2e-3));
                below += part.cut != 0 && height(s.a, s.b) < -0.02f * (std::fabs(part.inner) + std::fabs(part.outer))
                    ? 1
                    : 0;
                if (height(s.a, s.b) > 0) {
                    found[0] += static_cast<double>(s.mass) / (steps * steps);
                    found[1] += s.mass * (s.a + 2.0 * s.b) / (steps * steps);
                }
            }
        REQUIRE(below <= steps); // the border's, by what rounding adds
        REQUIRE(std::fabs(found[0] - expected[0]) < 6e-3);
        REQUIRE(std::fabs(found[1] - expected[1]) < 2e-2);
        cut += part.cut != 0 && expected[0] > 0 && expected[0] < 0.5 ? 1 : 0;
        whole += part.cut == 0 ? 1 : 0;
    }
    CHECK(cut > 50);
    CHECK(whole > 100);
}

TEST_CASE("the geometry term is cos cos / d^2, and 0 wherever no light arrives")
{
    const Vec3 up = vec3(0, 1, 0), down = vec3(0, -1, 0);
    CHECK(geometryTerm(up, vec3(0, 0, 0), down, 0) == 0.0f);
    CHECK(geometryTerm(up, vec3(0, -2, 0), up, 0) == 0.0f); // below the horizon
    CHECK(geometryTerm(up, vec3(5, 0, 0), vec3(-1, 0, 0), 0) == 0.0f); // at the horizon
    CHECK(geometryTerm(up, vec3(0, 2, 0), up, 0) == 0.0f); // turned away
    CHECK(geometryTerm(up, vec3(0, 2, 0), up, 1) == doctest::Approx(0.25)); // of two sides
    CHECK(geometryTerm(up, vec3(0, 2, 0), down, 0) == doctest::Approx(0.25));
    CHECK(geometryTerm(up, vec3(2, 2, 0), down, 0) == doctest::Approx(0.5 / 8));
    CHECK(geometryTerm(up, vec3(notANumber, 1, 0), down, 0) == 0.0f);
    CHECK(geometryTerm(up, vec3(0, 1e18f, 0), down, 0) == 0.0f);
    CHECK(std::isfinite(geometryTerm(up, vec3(0, 1e-9f, 0), down, 0)));
    CHECK(lightPoint(vec3(1, 2, 3), vec3(2, 0, 0), vec3(0, 0, 4), -0.5f, 1).x == 0.0f);
    CHECK(lightPoint(vec3(1, 2, 3), vec3(2, 0, 0), vec3(0, 0, 4), -0.5f, 1).z == 7.0f);
}

TEST_CASE("slopes come from the occluder's place on the ray, and s_min is never 0")
{
    CHECK(slopeOfHit(0.5f) == doctest::Approx(1));
    CHECK(slopeOfHit(0.75f) == doctest::Approx(3));
    CHECK(slopeOfHit(0.2f) == doctest::Approx(0.25));
    CHECK(slopeOfHit(0.0f) == WEDGE_SLOPE_MIN);
    CHECK(slopeOfHit(1.0f) == WEDGE_SLOPE_MAX);
    for (const float t :
        { 0.0f, 1e-38f, 1e-7f, 0.3f, 0.99999f, 0.99999994f, 1.0f, 1.5f, -1.0f, infinity, notANumber }) {
        CAPTURE(t);
        CHECK(slopeOfHit(t) >= WEDGE_SLOPE_MIN);
        CHECK(slopeOfHit(t) <= WEDGE_SLOPE_MAX);
    }
}

TEST_CASE("width (3.13) and count (3.21) at values worked out by hand")
{
    // max(0.25 * 1, (1 + 1) * 0.01) / (3 * 2)
    CHECK(filterWidth(1, 0.25f, 0.01f, 3, 2, 1) == doctest::Approx(0.25 / 6));
    // The pixel's own bandlimit wins at contacts: (1 + 0.001) * 0.01 / (3 * 2)
    CHECK(filterWidth(0.001f, 0.25f, 0.01f, 3, 2, 1) == doctest::Approx(0.01001 / 6));
    CHECK(filterWidth(0.001f, 0.25f, 0.01f, 3, 2, 0.5f) == doctest::Approx(0.02002 / 6));
    // 4 (1 + 2)^2 (2 * 2 * 0.01 / 0.5 + 1 / 2)^2 = 36 * 0.58^2
    CHECK(sampleCount(1, 1, 0.01f, 0.5f, 2, 1) == doctest::Approx(36 * 0.58 * 0.58));
    // 4 (1 + 2 * 4)^2 (2 * 4 * 0.02 + 1 / 1.5)^2
    CHECK(sampleCount(0.5f, 2, 0.01f, 0.5f, 2, 1) == doctest::Approx(4 * 81 * std::pow(0.16 + 2.0 / 3, 2)));
}

TEST_CASE("widths and counts are numbers over all slopes, sizes and mu, and converge with mu")
{
    for (const float tNear : { 0.0f, 1e-7f, 0.01f, 0.5f, 0.999f, 1.0f })
        for (const float tFar : { 0.0f, 0.3f, 0.9f, 1.0f })
            for (const float pixel : { 0.0f, 1e-8f, 1e-3f, 1.0f, 1e3f })
                for (const float sigma : { 1e-6f, 0.1f, 1e3f }) {
                    const float sMin = slopeOfHit(tNear), sMax = std::max(sMin, slopeOfHit(tFar));
                    float widthBefore = infinity, countBefore = 0;
                    for (const float mu : { 0.01f, 1.0f, 2.0f, 8.0f, 1000.0f }) {
                        const float width = filterWidth(sMin, sigma, pixel, 3, mu, 1);
                        const float count = sampleCount(sMin, sMax, pixel, 2 * sigma, mu, 1);
                        REQUIRE(std::isfinite(width));
                        REQUIRE(width >= 0);
                        REQUIRE(width < widthBefore);
                        REQUIRE_FALSE(std::isnan(count));
                        REQUIRE(count >= countBefore);
                        REQUIRE(fmin(fmax(count, 9.0f), 100.0f) >= 9.0f);
                        REQUIRE(fmin(fmax(count, 9.0f), 100.0f) <= 100.0f);
                        widthBefore = width;
                        countBefore = count;
                    }
                }
}

TEST_CASE("specular lobes reflect all light at normal incidence, and never more than arrives")
{
    for (const uint model : { WEDGE_PHONG, WEDGE_BLINN_PHONG })
        for (const float exponent : { 0.0f, 1.0f, 10.0f, 80.0f }) {
            CAPTURE(model);
            CAPTURE(exponent);
            CHECK(albedo(exponent, model, 0.0) == doctest::Approx(1).epsilon(0.003));
            for (const double degrees : { 30.0, 60.0, 85.0 })
                CHECK(albedo(exponent, model, degrees * pi / 180) <= 1.003);
        }
}

TEST_CASE("specular lobes are reciprocal, never negative, and finite at their ends")
{
    const std::vector<Vec3> directions = { vec3(0, 0, 1), vecNormalize(vec3(1, 0, 0.5f)),
        vecNormalize(vec3(-1, 0, 0.5f)), vecNormalize(vec3(0.3f, -0.9f, 0.01f)), vec3(1, 0, 0), vec3(-1, 0, 0) };
    const Vec3 n = vec3(0, 0, 1);
    for (const uint model : { WEDGE_PHONG, WEDGE_BLINN_PHONG })
        for (const float exponent : { 0.0f, 1.0f, 30.0f, 1e6f })
            for (const Vec3 v : directions)
                for (const Vec3 l : directions) {
                    const float there = specularLobe(n, v, l, exponent, model);
                    REQUIRE(std::isfinite(there));
                    REQUIRE(there >= 0);
                    REQUIRE(there == doctest::Approx(specularLobe(n, l, v, exponent, model)).epsilon(1e-4));
                }
    // In the mirror direction the lobe is at its largest: the normalisation itself.
    const Vec3 v = vecNormalize(vec3(1, 0, 1)), mirrored = vecNormalize(vec3(-1, 0, 1));
    CHECK(specularLobe(n, v, mirrored, 20, WEDGE_PHONG) == doctest::Approx(22 / (2 * pi)).epsilon(1e-4));
}

TEST_CASE("directions in 32 bits come back as unit vectors within 1e-4 radians")
{
    std::vector<Vec3> directions;
    for (const float x : { -1.0f, -0.0f, 0.0f, 1e-20f, 1.0f })
        for (const float y : { -1.0f, -0.0f, 0.0f, -1e-6f, 1.0f })
            for (const float z : { -1.0f, -0.0f, 0.0f, 1e-6f, 1.0f })
                if (vecLength(vec3(x, y, z)) > 0.5f)
                    directions.push_back(vecNormalize(vec3(x, y, z)));
    std::mt19937 random(6);
    std::uniform_real_distribution<double> z(-1, 1), angle(-pi, pi);
    for (int i = 0; i < 20000; ++i) {
        // Every other one near the fold of the map.
        const double h = i % 2 == 0 ? z(random) : 1e-4 * z(random), r = std::sqrt(1 - h * h), a = angle(random);
        directions.push_back(
            vec3(static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), static_cast<float>(h)));
    }
    double worst = 0;
    for (const Vec3 d : directions) {
        const Vec3 back = unpackDirection(packDirection(d));
        REQUIRE(std::fabs(vecLength(back) - 1) < 1e-6f);
        // The chord, which unlike the cosine is exact for small angles.
        worst = std::max<double>(worst, vecLength(vecSub(back, d)));
    }
    CAPTURE(worst);
    CHECK(worst < 1e-4);
    CHECK(worst > 1e-6);
    for (const Vec3 axis : { vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0) })
        CHECK(vecDot(unpackDirection(packDirection(axis)), axis) > 1 - 1e-7f);
}
