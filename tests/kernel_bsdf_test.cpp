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

constexpr float roughnesses[] = { 0.0f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f };

/// Of microfacets whose specular colour is f0 beside a diffuse one.
Lobe microfacets(float roughness, float f0 = 0.04f, float diffuse = 0.5f)
{
    return lobeOf(microfacetGloss(roughness, vec3(diffuse, 0.1f, 0), vec3(f0, f0, 0)));
}

/// D G2 F / (4 nv nl) in double as the papers have it: Trowbridge and Reitz's distribution by the tangent, Smith's
/// Lambda (Heitz 2014), Schlick's Fresnel. Without F0. v and l above the horizon.
double published(double roughness, double f0, double diffuse, Vec3 v, Vec3 l)
{
    const double alpha = std::max(roughness * roughness, 1e-3), squared = alpha * alpha;
    const double hx = v.x + l.x, hy = v.y + l.y, hz = v.z + l.z, length = std::sqrt(hx * hx + hy * hy + hz * hz);
    const double nh = hz / length, tangent = (hx * hx + hy * hy) / (hz * hz),
                 vh = (v.x * hx + v.y * hy + v.z * hz) / length;
    const double d = std::exp(-std::log(pi * squared * std::pow(nh, 4)) - 2 * std::log1p(tangent / squared));
    const auto lambda = [&](double c) { return (std::sqrt(1 + squared * (1 - c * c) / (c * c)) - 1) / 2; };
    const double g = 1 / (1 + lambda(v.z) + lambda(l.z));
    const double f = f0 + (std::max(f0, 1 - diffuse) - f0) * std::pow(1 - vh, 5);
    return d * g * f / (4 * v.z * l.z) / f0;
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

TEST_CASE("microfacets: as published, and reciprocal")
{
    std::mt19937 random(6);
    for (const float roughness : roughnesses)
        for (int i = 0; i < 3000; ++i) {
            const Lobe lobe = microfacets(roughness);
            const Vec3 v = cosineDirection(up, point(random));
            const Vec3 l = i % 2 == 0 ? cosineDirection(up, point(random)) : sampleLobe(lobe, up, v, point(random));
            if (v.z < 0.01f || l.z < 0.01f)
                continue;
            CAPTURE(roughness);
            // The angle of a half vector of floats is known to 1e-7 and the sharpest lobe 1e-3 wide.
            const double tolerance = roughness < 0.1f ? 2e-3 : 1e-4;
            const double expected = published(roughness, 0.04f, 0.5f, v, l);
            REQUIRE(lobeValue(lobe, up, v, l) == doctest::Approx(expected).epsilon(tolerance));
            REQUIRE(lobeValue(lobe, up, l, v) == doctest::Approx(expected).epsilon(tolerance));
        }
}

TEST_CASE("microfacets: directions follow their density, which integrates to 1, also from below the horizon")
{
    unsigned seed = 1;
    double least = 1;
    for (const float roughness : roughnesses)
        for (const double angle : { 0.0, 45.0, 85.0, 95.0 }) {
            CAPTURE(roughness);
            CAPTURE(angle);
            if (roughness < 0.1f && angle > 90)
                continue; // sharper than half vectors of floats are there
            const Lobe lobe = microfacets(roughness);
            const Vec3 n = polar(2, 0.7), v = vecNormalize(LobeGrid(n).direction(angle * degree, 3));
            const Vec3 about = mirrored(n, facingView(n, v));
            const auto density = [&](Vec3 l) { return lobePdf(lobe, n, v, l); };
            CHECK(LobeGrid(about).overSphere(density) == doctest::Approx(1).epsilon(4e-3));
            const double p = agreement(
                about, [&](Vec2 u) { return sampleLobe(lobe, n, v, u); }, density, seed++);
            least = std::min(least, p);
            CHECK(p > 1e-5); // of 23 tests
        }
    MESSAGE("least p-value of 23: " << least);
}

TEST_CASE("microfacets: weight times density is the lobe, and sampling finds the albedo of quadrature")
{
    std::mt19937 random(3);
    for (const float roughness : roughnesses) {
        CAPTURE(roughness);
        const Lobe lobe = microfacets(roughness);
        for (int i = 0; i < 3000; ++i) {
            const Vec3 n = anyDirection(random), v = cosineDirection(n, point(random));
            const Vec3 l = sampleLobe(lobe, n, v, point(random));
            const float pdf = lobePdf(lobe, n, v, l), weight = lobeOverPdf(lobe, n, v, l);
            REQUIRE(pdf > 0);
            REQUIRE(weight * pdf == doctest::Approx(lobeValue(lobe, n, v, l)).epsilon(1e-4));
        }
        for (const double angle : { 0.0, 45.0, 85.0 }) {
            const Vec3 v = polar(angle * degree);
            CHECK(sampledAlbedo(lobe, v) == doctest::Approx(integratedAlbedo(lobe, v)).epsilon(3e-3));
        }
    }
}

TEST_CASE("microfacets: a smooth one reflects Fresnel's part, and none more than arrives beside what is diffuse")
{
    for (const double angle : { 0.0, 30.0, 60.0, 80.0 }) {
        const double expected = 0.04 + 0.46 * std::pow(1 - std::cos(angle * degree), 5);
        CHECK(0.04 * sampledAlbedo(microfacets(0), polar(angle * degree)) == doctest::Approx(expected).epsilon(0.01));
    }
    for (const double diffuse : { 0.0, 0.3, 0.96 })
        for (const double f0 : { 0.001, 0.04, 0.5, 1.0 })
            for (const float roughness : roughnesses)
                for (const double angle : { 0.0, 30.0, 60.0, 75.0, 85.0, 89.0, 89.9 }) {
                    if (diffuse + f0 > 1.0)
                        continue;
                    const Lobe lobe = microfacets(roughness, static_cast<float>(f0), static_cast<float>(diffuse));
                    CHECK(diffuse + f0 * sampledAlbedo(lobe, polar(angle * degree), 100) <= 1 + 1e-5);
                }
    // At alpha 1 the distribution is even and s = 1: seen from above, the integral of 2 - 1 / u over u in [1/2, 1].
    CHECK(sampledAlbedo(microfacets(1, 1, 0), polar(0)) == doctest::Approx(1 - std::log(2)).epsilon(1e-4));
    for (const float roughness : roughnesses)
        MESSAGE("albedo of a white metal of roughness "
            << roughness << " at 0, 60, 80 degrees: " << sampledAlbedo(microfacets(roughness, 1, 0), polar(0)) << ", "
            << sampledAlbedo(microfacets(roughness, 1, 0), polar(60 * degree)) << ", "
            << sampledAlbedo(microfacets(roughness, 1, 0), polar(80 * degree)));
}

TEST_CASE("microfacets: degenerate input gives finite directions of length 1")
{
    for (const Vec3 n : { up, vec3(0, 0, -1), polar(1, 2), vecNormalize(vec3(1e-4f, 0, -1)) })
        for (const float x : { 0.0f, 1e-30f, 0.5f, 0.99999994f })
            for (const float y : { 0.0f, 1e-30f, 0.5f, 0.99999994f })
                for (const float roughness : roughnesses)
                    for (const double angle : { 0.0, 1e-4, 80.0, 89.9999, 90.0, 90.1, 135.0, 179.9, 180.0 }) {
                        const Vec3 v = vecNormalize(LobeGrid(n).direction(angle * degree, 5));
                        const Lobe lobe = microfacets(roughness);
                        const Vec3 l = sampleLobe(lobe, n, v, vec2(x, y));
                        CAPTURE(roughness);
                        CAPTURE(angle);
                        REQUIRE(isDirection(l));
                        for (const float value : { lobePdf(lobe, n, v, l), lobeOverPdf(lobe, n, v, l),
                                 lobePdf(lobe, n, v, vecScale(v, -1.0f)), lobePdf(lobe, n, v, vecScale(n, -1.0f)),
                                 lobeValue(lobe, n, v, l), lobeValue(lobe, n, v, vecScale(v, -1.0f)) }) {
                            REQUIRE(std::isfinite(value));
                            REQUIRE(value >= 0);
                        }
                    }
}
