// Directions drawn for the reflection of light, the shared maths as C++: frames, densities, weights. No device.
#include "kernels/shared/bsdf.h"
#include "tests/lobe_grid.h"
#include "tests/statistics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace wedge::shared;
using wedge::test::chiSquareP;
using wedge::test::LobeGrid;
using wedge::test::polar;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;
constexpr uint models[] = { WEDGE_PHONG, WEDGE_BLINN_PHONG };
const Vec3 up = vec3(0, 0, 1);

Vec3 mirrored(Vec3 n, Vec3 v) { return vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v)); }

float toUnit(std::mt19937& random) { return toUnitFloat(static_cast<uint>(random())); }

Vec2 point(std::mt19937& random)
{
    const float x = toUnit(random), y = toUnit(random);
    return vec2(x, y);
}

Vec3 anyDirection(std::mt19937& random)
{
    const Vec2 u = point(random);
    return polar(std::acos(2.0 * u.x - 1), 2 * pi * u.y);
}

/// Probability of a chi-square at least that large if `draw` is distributed as `density`. What the density lacks to 1
/// counts as a cell of its own, of the directions whose density is 0.
double agreement(
    Vec3 axis, const std::function<Vec3(Vec2)>& draw, const std::function<float(Vec3)>& density, unsigned seed)
{
    constexpr int samples = 60000;
    const LobeGrid grid(axis);
    std::vector<double> expected;
    double total = 0;
    for (int ring = 0; ring < LobeGrid::rings; ++ring)
        for (int sector = 0; sector < LobeGrid::sectors; ++sector) {
            expected.push_back(samples * grid.cell(ring, sector, density));
            total += expected.back();
        }
    std::vector<double> observed(expected.size() + 1);
    expected.push_back(std::max(0.0, samples - total));
    std::mt19937 random(seed);
    for (int i = 0; i < samples; ++i) {
        const Vec3 l = draw(point(random));
        observed[density(l) > 0 ? grid.cellOf(l) : observed.size() - 1] += 1;
    }
    return chiSquareP(observed, expected);
}

/// Mean of weight x cosine over a grid of the samples' unit square.
double sampledAlbedo(const Lobe& lobe, Vec3 v, int steps = 400)
{
    double sum = 0;
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
            const Vec3 l = sampleLobe(
                lobe, up, v, vec2(static_cast<float>((i + 0.5) / steps), static_cast<float>((k + 0.5) / steps)));
            sum += l.z > 0 ? lobeOverPdf(lobe, up, v, l) * l.z : 0;
        }
    return sum / (steps * steps);
}

double integratedAlbedo(const Lobe& lobe, Vec3 v)
{
    return LobeGrid(mirrored(up, v)).overSphere([&](Vec3 l) {
        return l.z > 0 ? lobeValue(lobe, up, v, l) * l.z : 0.0f;
    });
}

bool isDirection(Vec3 d) { return std::fabs(vecLength(d) - 1.0f) < 1e-5f; } // false for NaN

} // namespace

TEST_CASE("the probability of a chi-square is that of tables")
{
    const auto p = [](double value, std::size_t degrees) { // one cell is off by what gives that value
        std::vector<double> expected(degrees + 1, 100.0), observed = expected;
        observed[0] += std::sqrt(100 * value);
        return chiSquareP(observed, expected);
    };
    CHECK(p(3.841459, 1) == doctest::Approx(0.05).epsilon(1e-4));
    CHECK(p(18.307038, 10) == doctest::Approx(0.05).epsilon(1e-4));
    CHECK(p(149.449253, 100) == doctest::Approx(0.001).epsilon(1e-3));
    CHECK(p(77.929465, 100) == doctest::Approx(0.95).epsilon(1e-4));
}

TEST_CASE("tangent frames are orthonormal and right-handed, also about the lower pole")
{
    std::vector<Vec3> normals = { up, vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0), vec3(1, 0, -0.0f),
        vec3(0, 1, 1e-30f), vec3(0, 1, -1e-30f) };
    for (const float tilt : { 1e-7f, 1e-4f, 1e-2f })
        for (const float side : { -1.0f, 1.0f }) {
            normals.push_back(vecNormalize(vec3(tilt, -tilt, side)));
            normals.push_back(vecNormalize(vec3(-tilt, 0, side)));
        }
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i)
        normals.push_back(anyDirection(random));
    for (const Vec3 n : normals) {
        Vec3 s, t;
        tangentFrame(n, &s, &t);
        CAPTURE(n.x);
        CAPTURE(n.y);
        CAPTURE(n.z);
        REQUIRE(std::fabs(vecLength(s) - 1) < 1e-6f);
        REQUIRE(std::fabs(vecLength(t) - 1) < 1e-6f);
        REQUIRE(std::fabs(vecDot(s, t)) < 1e-6f);
        REQUIRE(std::fabs(vecDot(s, n)) < 1e-6f);
        REQUIRE(std::fabs(vecDot(t, n)) < 1e-6f);
        REQUIRE(vecDot(vecCross(s, t), n) > 0.99999f);
    }
}

TEST_CASE("directions follow their densities: Lambert")
{
    unsigned seed = 1;
    for (const Vec3 n : { up, vec3(0, 0, -1), polar(1, 2), polar(2.5, -1) }) {
        const double p = agreement(
            n, [&](Vec2 u) { return cosineDirection(n, u); },
            [&](Vec3 l) { return fmax(0.0f, vecDot(n, l)) * WEDGE_INV_PI; }, seed++);
        CHECK(p > 1e-4);
    }
}

TEST_CASE("directions follow their densities: Phong and Blinn-Phong")
{
    double least = 1;
    unsigned seed = 1;
    for (const uint model : models)
        for (const float exponent : { 0.0f, 1.0f, 4.0f, 12.0f, 64.0f, 1000.0f })
            for (const double angle : { 0.0, 45.0, 85.0 }) {
                CAPTURE(model);
                CAPTURE(exponent);
                CAPTURE(angle);
                const Lobe lobe = makeLobe(exponent, model);
                const Vec3 n = polar(2, 0.7), v = vecNormalize(LobeGrid(n).direction(angle * degree, 3));
                const double p = agreement(
                    mirrored(n, v), [&](Vec2 u) { return sampleLobe(lobe, n, v, u); },
                    [&](Vec3 l) { return lobePdf(lobe, n, v, l); }, seed++);
                least = std::min(least, p);
                CHECK(p > 1e-5); // of 36 tests
            }
    MESSAGE("least p-value of 36: " << least);
}

TEST_CASE("densities integrate to 1, less the half vectors that look away from the viewer")
{
    for (const double angle : { 0.0, 45.0, 85.0 }) {
        const Vec3 v = polar(angle * degree);
        const auto mass = [&](float exponent, uint model) {
            const Lobe lobe = makeLobe(exponent, model);
            return LobeGrid(mirrored(up, v)).overSphere([&](Vec3 l) { return lobePdf(lobe, up, v, l); });
        };
        CAPTURE(angle);
        for (const float exponent : { 0.0f, 1.0f, 4.0f, 12.0f, 64.0f, 1000.0f })
            CHECK(mass(exponent, WEDGE_PHONG) == doctest::Approx(1).epsilon(2e-3));
        // Of the half vectors about n, those on v's side: a lune of the hemisphere, and its projection.
        CHECK(mass(0, WEDGE_BLINN_PHONG) == doctest::Approx(1 - angle / 180).epsilon(3e-3));
        CHECK(mass(1, WEDGE_BLINN_PHONG) == doctest::Approx((1 + std::cos(angle * degree)) / 2).epsilon(3e-3));
        for (const float exponent : { 4.0f, 12.0f, 64.0f, 1000.0f }) {
            CAPTURE(exponent);
            const double kept = LobeGrid(up).overSphere([&](Vec3 h) {
                return h.z > 0 && vecDot(h, v) > 0 ? (exponent + 1) / (2 * pi) * std::pow(h.z, exponent) : 0.0;
            });
            CHECK(mass(exponent, WEDGE_BLINN_PHONG) == doctest::Approx(kept).epsilon(3e-3));
        }
    }
}

TEST_CASE("weight times density is the lobe, and only directions below the horizon are lost")
{
    std::mt19937 random(3);
    for (const uint model : models)
        for (const float exponent : { 0.0f, 1.0f, 4.0f, 12.0f, 64.0f, 1000.0f })
            for (int i = 0; i < 3000; ++i) {
                const Lobe lobe = makeLobe(exponent, model);
                const Vec3 n = anyDirection(random), v = cosineDirection(n, point(random));
                const Vec3 l = sampleLobe(lobe, n, v, point(random));
                const float pdf = lobePdf(lobe, n, v, l), weight = lobeOverPdf(lobe, n, v, l);
                CAPTURE(model);
                CAPTURE(exponent);
                REQUIRE(weight >= 0);
                REQUIRE(pdf >= 0);
                if (vecDot(n, l) > 1e-5f && vecDot(n, v) > 1e-5f) {
                    REQUIRE(pdf > 0);
                    REQUIRE(weight * pdf == doctest::Approx(lobeValue(lobe, n, v, l)).epsilon(1e-4));
                }
            }
}

TEST_CASE("sampling finds the albedo of quadrature")
{
    for (const uint model : models)
        for (const float exponent : { 0.0f, 1.0f, 4.0f, 12.0f, 64.0f, 1000.0f })
            for (const double angle : { 0.0, 45.0, 85.0 }) {
                CAPTURE(model);
                CAPTURE(exponent);
                CAPTURE(angle);
                const Lobe lobe = makeLobe(exponent, model);
                const Vec3 v = polar(angle * degree);
                CHECK(sampledAlbedo(lobe, v) == doctest::Approx(integratedAlbedo(lobe, v)).epsilon(2e-3));
            }
}

TEST_CASE("no lobe reflects more than arrives")
{
    for (const uint model : models) {
        double most = 0, mostExponent = 0, mostAngle = 0;
        for (const float exponent :
            { 0.0f, 0.1f, 0.5f, 1.0f, 2.0f, 4.0f, 8.0f, 16.0f, 50.0f, 64.0f, 256.0f, 1000.0f, 1e4f })
            for (const double angle : { 0.0, 5.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9 }) {
                const double albedo = sampledAlbedo(makeLobe(exponent, model), polar(angle * degree), 150);
                CHECK(albedo <= 1 + 1e-3);
                if (albedo > most) {
                    most = albedo;
                    mostExponent = exponent;
                    mostAngle = angle;
                }
            }
        MESSAGE(std::string(model == WEDGE_PHONG ? "Phong" : "Blinn-Phong")
            << ": largest albedo " << most << " at exponent " << mostExponent << ", " << mostAngle << " degrees");
    }
}

TEST_CASE("lobes are reciprocal")
{
    std::mt19937 random(5);
    for (const uint model : models)
        for (const float exponent : { 0.0f, 1.0f, 4.0f, 64.0f, 1000.0f, 1e4f })
            for (int i = 0; i < 2000; ++i) {
                const Lobe lobe = makeLobe(exponent, model);
                const Vec3 n = anyDirection(random), v = cosineDirection(n, point(random));
                const Vec3 l = i % 2 == 0 ? cosineDirection(n, point(random)) : sampleLobe(lobe, n, v, point(random));
                CAPTURE(exponent);
                // A cosine is known to 2e-7; at the cut, 1e-7 of the peak, one of the two may be 0.
                const float there = lobeValue(lobe, n, v, l), back = lobeValue(lobe, n, l, v);
                REQUIRE(std::fabs(there - back) <= (1e-5f + 1e-6f * exponent) * there + 2e-7f * lobe.normalization);
            }
}

TEST_CASE("degenerate input gives finite directions of length 1")
{
    const float almostOne = 0.99999994f;
    const std::vector<float> ends = { 0.0f, 1e-30f, 0.5f, almostOne };
    const std::vector<Vec3> normals = { up, vec3(0, 0, -1), polar(1, 2), vecNormalize(vec3(1e-4f, 0, -1)) };
    for (const Vec3 n : normals)
        for (const float x : ends)
            for (const float y : ends) {
                const Vec2 u = vec2(x, y);
                REQUIRE(isDirection(cosineDirection(n, u)));
                REQUIRE(vecDot(n, cosineDirection(n, u)) >= -1e-6f);
                for (const uint model : models)
                    for (const float exponent : { 0.0f, 1e-6f, 0.3f, 1.0f, 1000.0f, 1e6f })
                        for (const double angle : { 0.0, 1e-4, 80.0, 89.9, 89.9999, 90.0 }) {
                            const Vec3 v = vecNormalize(LobeGrid(n).direction(angle * degree, 5));
                            const Lobe lobe = makeLobe(exponent, model);
                            const Vec3 l = sampleLobe(lobe, n, v, u);
                            CAPTURE(model);
                            CAPTURE(exponent);
                            CAPTURE(angle);
                            REQUIRE(isDirection(l));
                            REQUIRE(isDirection(powerCosineDirection(n, exponent, u)));
                            for (const float value : { lobePdf(lobe, n, v, l), lobeOverPdf(lobe, n, v, l),
                                     lobePdf(lobe, n, v, vecScale(v, -1.0f)), lobePdf(lobe, n, v, vecScale(n, -1.0f)),
                                     lobeValue(lobe, n, v, l) }) {
                                REQUIRE(std::isfinite(value));
                                REQUIRE(value >= 0);
                            }
                        }
            }
}
