// What the benchmarks compute with: order statistics, error curves, fingerprints.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/error_curve.h"
#include "benchmarks/common/fingerprint.h"
#include "benchmarks/common/statistics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace wedge::benchmark {
namespace {

/// A curve that falls as cost^-exponent.
Curve powerLaw(std::initializer_list<int> costs, double exponent)
{
    Curve curve;
    for (const int cost : costs) {
        curve.push_back({ static_cast<double>(cost), 2.0 * std::pow(cost, -exponent) });
    }
    return curve;
}

TEST_CASE("order statistics")
{
    const Summary none = summarize({});
    CHECK(none.median == 0);
    CHECK(none.spread() == 0);
    const Summary one = summarize({ 7 });
    CHECK(one.median == 7);
    CHECK(one.spread() == 0);
    const Summary five = summarize({ 50, 10, 30, 20, 40 });
    CHECK(five.median == 30);
    CHECK(five.q1 == 20);
    CHECK(five.q3 == 40);
    CHECK(five.spread() == 20);
    CHECK(five.min == 10);
    CHECK(five.max == 50);
    CHECK(summarize({ 1, 2, 4, 8 }).median == 3);
    CHECK(summarize({ 1, 2, 4, 8 }).q1 == doctest::Approx(1.75));
}

TEST_CASE("a power law is met exactly between its points and beyond both ends")
{
    for (const double exponent : { 0.5, 0.75, 1.5 }) {
        const Curve curve = powerLaw({ 9, 25, 144 }, exponent);
        for (const double cost : { 10.0, 24.0, 26.0, 100.0, 144.0 }) {
            const Crossing at = costAt(curve, 2.0 * std::pow(cost, -exponent) * (1 + 1e-12));
            CHECK(at.cost == doctest::Approx(cost));
            CHECK_FALSE(at.extrapolated);
        }
        for (const double cost : { 4.0, 400.0 }) {
            const Crossing at = costAt(curve, 2.0 * std::pow(cost, -exponent));
            CHECK(at.cost == doctest::Approx(cost));
            CHECK(at.extrapolated);
        }
    }
}

TEST_CASE("a curve that rises again answers with its first crossing")
{
    const Curve curve = { { 10, 1.0 }, { 20, 0.1 }, { 30, 0.5 }, { 40, 0.01 } };
    CHECK(costAt(curve, 0.1).cost == doctest::Approx(20));
    CHECK(costAt(curve, 0.2).cost < 20);
}

TEST_CASE("a curve that stops falling never reaches less")
{
    const Crossing never = costAt({ { 10, 1.0 }, { 20, 0.5 }, { 30, 0.5 } }, 0.4);
    CHECK(std::isinf(never.cost));
    CHECK(never.extrapolated);
}

TEST_CASE("curves that say nothing are refused")
{
    CHECK_THROWS_AS(costAt({}, 1), std::invalid_argument);
    CHECK_THROWS_AS(costAt({ { 9, 1 } }, 1), std::invalid_argument);
    CHECK_THROWS_AS(costAt({ { 9, 1 }, { 9, 0.5 } }, 0.7), std::invalid_argument);
    CHECK_THROWS_AS(costAt({ { 9, 1 }, { 16, 0 } }, 0.7), std::invalid_argument);
    CHECK_THROWS_AS(costAt(powerLaw({ 9, 16 }, 0.5), 0), std::invalid_argument);
    CHECK_THROWS_AS(costAt(powerLaw({ 9, 16 }, 0.5), std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST_CASE("a curve is lengthened to the error and no further, in whole squares")
{
    std::vector<int> measured;
    const auto measure = [&](int samples) {
        measured.push_back(samples);
        return CurvePoint { static_cast<double>(samples), 2.0 * std::pow(samples, -0.75) };
    };
    Curve curve = powerLaw({ 9, 25, 64 }, 0.75);
    const double wanted = 2.0 * std::pow(200.0, -0.75);
    extend(curve, wanted, 1600, measure);
    CHECK(measured == std::vector<int> { 256 }); // 1.15 * 200 = 230, and the next square
    CHECK(costAt(curve, wanted).cost == doctest::Approx(200));

    extend(curve, wanted, 1600, measure);
    CHECK(measured.size() == 1);

    Curve limited = powerLaw({ 9, 25, 64 }, 0.75);
    extend(limited, 1e-6, 400, measure);
    CHECK(limited.back().cost == 400);
    CHECK(costAt(limited, 1e-6).extrapolated);
}

TEST_CASE("a fingerprint tells scenes apart by their contents, not by their names")
{
    const auto of = [](const scene::Scene& scene) {
        Fingerprint f;
        add(f, scene);
        return f.text();
    };
    scene::Scene scene;
    scene.geometry.positions = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    scene.geometry.indices = { 0, 1, 2 };
    scene.areaLights.resize(1);
    const std::string original = of(scene);
    CHECK(original.size() == 16);

    scene.path = "elsewhere.toml";
    scene.areaLights[0].name = "lamp";
    CHECK(of(scene) == original);

    scene::Scene moved = scene;
    moved.geometry.positions[3] = 1.0000001f;
    CHECK(of(moved) != original);
    scene::Scene dimmed = scene;
    dimmed.areaLights[0].cut = 1;
    CHECK(of(dimmed) != original);
    scene::Scene turned = scene;
    turned.camera.verticalFov = 46;
    CHECK(of(turned) != original);
}

TEST_CASE("claims without a goal or a finite value have nulls")
{
    const Json claim = json(Claim { "a.b.c", std::numeric_limits<double>::infinity(), "1", {}, {}, {} });
    CHECK(claim.dump() == R"({"id":"a.b.c","value":null,"unit":"1","spread":null,"paper":null,"goal":null})");
    CHECK(json(Claim { "a.b.c", 0.5, "ms", 0.25, 1.0, 2.0 }).dump()
        == R"({"id":"a.b.c","value":0.5,"unit":"ms","spread":0.25,"paper":1.0,"goal":2.0})");
}

} // namespace
} // namespace wedge::benchmark
