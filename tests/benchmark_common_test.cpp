// What the benchmarks compute with: order statistics, error curves, fingerprints, biases, savings.
#include "benchmarks/common/claims.h"
#include "benchmarks/common/equal_time.h"
#include "benchmarks/common/error_curve.h"
#include "benchmarks/common/fingerprint.h"
#include "benchmarks/common/image_bias.h"
#include "benchmarks/common/savings.h"
#include "benchmarks/common/smooth_region.h"
#include "benchmarks/common/statistics.h"
#include "effects/environment/environment.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
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

TEST_CASE("the count of a time is on the line through the two nearest, and in proportion where none rises")
{
    const std::vector<CountTime> line = { { 10, 25 }, { 40, 85 }, { 100, 205 } }; // 5 + 2 count
    CHECK(countOfTime(line, 45) == doctest::Approx(20));
    CHECK(countOfTime(line, 1005) == doctest::Approx(500));
    CHECK(countOfTime(line, 85) == doctest::Approx(40));
    CHECK(countOfTime({ { 10, 20 }, { 20, 40 }, { 100, 1000 } }, 30) == doctest::Approx(15)); // the third is far
    CHECK(countOfTime({ { 16, 40 } }, 80) == doctest::Approx(32));
    CHECK(countOfTime({ { 16, 40 }, { 16, 44 } }, 80) == doctest::Approx(16 * 80.0 / 44)); // no line through one count
    CHECK(countOfTime({ { 10, 40 }, { 20, 30 } }, 60) == doctest::Approx(15)); // noise: more in less time
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
    scene::Scene defocused = scene;
    defocused.camera.apertureRadius = 0.01f;
    CHECK(of(defocused) != original);
    scene::Scene moving = scene;
    moving.geometry.positionsAtClose = moving.geometry.positions;
    CHECK(of(moving) != original);
    scene::Scene panned = scene;
    panned.cameraAtClose = scene.camera;
    CHECK(of(panned) != original);
}

TEST_CASE("a fingerprint tells environments apart by their radiance and how they lie")
{
    const auto of = [](const std::shared_ptr<render::EnvironmentPicture>& picture) {
        scene::Scene scene;
        render::setEnvironment(scene, picture);
        Fingerprint f;
        add(f, scene);
        return f.text();
    };
    const auto sky = [] {
        auto out = std::make_shared<render::EnvironmentPicture>();
        out->width = 2;
        out->height = 1;
        out->radiance = { 1, 2, 3, 4, 5, 6 };
        return out;
    };
    const std::string original = of(sky());
    CHECK(of(sky()) == original);
    CHECK(of(nullptr) != original);
    const auto brighter = sky(), turned = sky(), hidden = sky(), upright = sky();
    brighter->radiance[5] = 6.000001f;
    std::swap(turned->right, turned->back);
    hidden->seen = false;
    std::swap(upright->width, upright->height);
    for (const auto& other : { brighter, turned, hidden, upright }) {
        CHECK(of(other) != original);
    }
}

/// A grey reference of that luminance and noise a pixel.
Reference greyReference(int side, const std::function<float(int x, int y)>& grey, float noise)
{
    Reference out;
    out.image = { side, side, {} };
    out.deviation = out.image;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const float off = (x + y) % 2 == 0 ? noise : -noise;
            for (int c = 0; c < 3; ++c) {
                out.image.rgb.push_back(grey(x, y) + off);
                out.deviation.rgb.push_back(off);
            }
        }
    }
    return out;
}

TEST_CASE("smooth regions end before edges, what is seen without noise, and the image's border")
{
    constexpr int side = 24;
    const auto at = [](int x, int y) { return static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x); };
    const Reference edge = greyReference(
        side, [](int x, int) { return x < 12 ? 1.0f : 1.5f; }, 0.01f);
    const std::vector<bool> beside = smoothRegion(edge);
    REQUIRE(beside.size() == side * side);
    for (int x = 0; x < side; ++x) {
        CHECK(beside[at(x, 12)] == ((x >= 3 && x + 3 < 12) || (x - 3 >= 12 && x + 3 < side)));
    }
    CHECK_FALSE(beside[at(6, 2)]);
    CHECK(beside[at(6, 3)]);

    // A ramp across 7 pixels deviates by twice what it grows by a pixel.
    const auto ramp = [](float slope) {
        return [slope](int x, int) { return 10.0f + slope * static_cast<float>(x - 12); };
    };
    CHECK(smoothRegion(greyReference(side, ramp(0.24f), 0.01f))[at(12, 12)]);
    CHECK_FALSE(smoothRegion(greyReference(side, ramp(0.26f), 0.01f))[at(12, 12)]);

    // The reference's own noise is no edge, what has none is not sampled, and nowhere is nowhere.
    const auto even = [](int, int) { return 1.0f; };
    CHECK(smoothRegion(greyReference(side, even, 0.2f))[at(12, 12)]);
    CHECK(smoothRegion(greyReference(side, even, 0.0f)).empty());
    Reference seen = greyReference(side, even, 0.01f);
    for (std::size_t c = 0; c < 3; ++c) {
        seen.deviation.rgb[3 * at(12, 12) + c] = 0;
    }
    CHECK_FALSE(smoothRegion(seen)[at(15, 12)]);
    CHECK(smoothRegion(seen)[at(16, 12)]);
}

TEST_CASE("an error over a part of an image counts nothing beside it")
{
    const Reference reference = greyReference(
        8, [](int, int) { return 1.0f; }, 0.5f);
    image::RgbImage image = reference.image;
    std::vector<bool> part(64, false);
    part[9] = part[10] = true;
    image.rgb[27] += 3.0f; // of pixel 9
    image.rgb[33] += 100.0f; // of pixel 11
    const RegionError error = regionError(image, reference, part);
    CHECK(error.rmse == doctest::Approx(std::sqrt(9.0 / 6)));
    CHECK(error.noise == doctest::Approx(0.5));
}

TEST_CASE("claims without a goal or a finite value have nulls")
{
    const Json claim = json(Claim { "a.b.c", std::numeric_limits<double>::infinity(), "1", {}, {}, {} });
    CHECK(claim.dump() == R"({"id":"a.b.c","value":null,"unit":"1","spread":null,"paper":null,"goal":null})");
    CHECK(json(Claim { "a.b.c", 0.5, "ms", 0.25, 1.0, 2.0 }).dump()
        == R"({"id":"a.b.c","value":0.5,"unit":"ms","spread":0.25,"paper":1.0,"goal":2.0})");
}

/// Values around 1 + offset with normal noise of that deviation.
image::RgbImage noisyImage(std::uint32_t seed, float offset, float deviation)
{
    std::mt19937 engine(seed);
    std::normal_distribution<float> noise(1.0f + offset, deviation);
    image::RgbImage out { 64, 64, std::vector<float>(3 * 64 * 64) };
    for (float& value : out.rgb) {
        value = noise(engine);
    }
    return out;
}

TEST_CASE("the bias of images is found beneath their noise and the reference's")
{
    constexpr float noise = 0.1f, referenceNoise = 0.02f;
    const image::RgbImage reference = noisyImage(1, 0.0f, referenceNoise);
    for (const float bias : { 0.0f, 0.05f, -0.2f }) {
        std::vector<image::RgbImage> images;
        for (std::uint32_t seed = 2; seed < 10; ++seed) {
            images.push_back(noisyImage(seed, bias, noise));
        }
        // The noise of the mean is 0.035; what its subtraction leaves is of the order of 0.035 (2 / 12288)^(1/4) =
        // 0.004.
        CHECK(biasOf(images, reference, referenceNoise) == doctest::Approx(std::abs(bias)).epsilon(0.01).scale(1.0));
        CHECK(meanOf(images.front()) == doctest::Approx(1.0 + bias).epsilon(0.005));
    }
    CHECK(biasOf({ reference, reference }, reference, 0.0) == 0.0);
    CHECK(withoutNoise(5, 3) == doctest::Approx(4));
    CHECK(withoutNoise(3, 5) == 0.0);
}

TEST_CASE("savings are the baseline's samples and rays at the method's error, over the method's")
{
    Baseline baseline { "plain", "error = 1 / sqrt samples, two rays a sample", {}, {}, {}, {} };
    for (const double spp : { 16.0, 64.0, 256.0 }) {
        baseline.samples.push_back({ spp, 1 / std::sqrt(spp) });
        baseline.rays.push_back({ 2 * spp, 1 / std::sqrt(spp) });
    }
    Method method { "default", { { 20, 10, 0.2, 0.1, 1, 1 }, { 25, 50, 0.2, 0.1, 1, 2 } } };
    const Savings inside = savings(method, baseline);
    CHECK(inside.samples[0] == doctest::Approx(100.0 / 20));
    CHECK(inside.samples[1] == doctest::Approx(100.0 / 25));
    CHECK(inside.rays[0] == doctest::Approx(200.0 / 10));
    CHECK(inside.rays[1] == doctest::Approx(200.0 / 50));
    CHECK_FALSE(inside.extrapolated);
    CHECK(method.leastError() == 0.1);
    method.runs.push_back({ 25, 50, 0.2, 0.05, 1, 3 });
    CHECK(savings(method, baseline).extrapolated);
    CHECK(savings(method, baseline).samples[2] == doctest::Approx(400.0 / 25));
    CHECK(method.leastError() == 0.05);
}

} // namespace
} // namespace wedge::benchmark
