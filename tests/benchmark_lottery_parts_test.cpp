// What the lottery computes with: its scenes, which are frozen, errors without the reference's noise, and verdicts. No
// device.
#include "benchmarks/common/squared_error.h"
#include "benchmarks/lottery/verdict.h"
#include "data/generator/lottery/lottery.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <sstream>

using namespace wedge;
using namespace wedge::benchmark;

namespace {

double gaussian(std::mt19937& random)
{
    double sum = -6;
    for (int i = 0; i < 12; ++i)
        sum += static_cast<double>(random()) / 4294967296.0;
    return sum;
}

image::RgbImage plainImage(float value)
{
    image::RgbImage image { 64, 48, {} };
    image.rgb.assign(64 * 48 * 3, value);
    return image;
}

void addNoise(image::RgbImage& image, double deviation, std::mt19937& random)
{
    for (float& v : image.rgb)
        v += static_cast<float>(deviation * gaussian(random));
}

/// Errors that fall with samples as `rate` says, from `first` at one sample on; milliseconds: fixed + each * spp.
std::vector<LotteryPoint> pointsOf(double first, double rate, double fixed, double each)
{
    std::vector<LotteryPoint> out;
    for (const int spp : LotteryPlan {}.budgets) {
        LotteryPoint p;
        p.spp = spp;
        p.error.mean = std::pow(first * std::pow(spp, rate), 2);
        p.error.trimmed = 0.25 * p.error.mean;
        p.error.deviation = spp <= 64 ? 0.02 : 0.0;
        p.deviceMilliseconds = fixed + each * spp;
        p.wallMilliseconds = p.deviceMilliseconds + 5;
        out.push_back(p);
    }
    return out;
}

LotteryResult resultOf(double error, double rate, double fixed, double each)
{
    LotteryResult r;
    r.plain = pointsOf(1.0, -0.5, 0.0, 1.0);
    r.filtered = pointsOf(error, rate, fixed, each);
    r.fixedBlur.mean = 1.0;
    return r;
}

} // namespace

TEST_CASE("scenes of the lottery are frozen")
{
    struct Known {
        std::uint32_t seed;
        std::size_t triangles, materials, lights;
        double vertices, eye;
    };
    // Sums of coordinates, x + 2 y + 3 z. Another scene is another lottery: what was measured would mean nothing any
    // more.
    for (const Known& known : { Known { 1, 23076, 5, 1, 26838.3140, 3.08269 },
             Known { 2, 25164, 6, 4, 16092.3577, 19.12597 }, Known { 17, 7978, 7, 4, 28997.9931, 19.23482 },
             Known { 1001, 15305, 8, 7, 23575.2924, 17.90744 }, Known { 1200, 7298, 4, 1, 15915.7283, 15.61741 } }) {
        CAPTURE(known.seed);
        const generator::GeneratedScene scene = generator::makeLottery(known.seed);
        CHECK(triangles(scene) == known.triangles);
        CHECK(scene.materials.size() == known.materials);
        CHECK(scene.furtherLights.size() + 1 == known.lights);
        const glm::vec3 eye = scene.camera.eye;
        CHECK(eye.x + 2 * eye.y + 3 * eye.z == doctest::Approx(known.eye).epsilon(1e-5));
        std::istringstream text(scene.mesh.text());
        double sum = 0, x, y, z;
        for (std::string line; std::getline(text, line);)
            if (line.starts_with("v ") && std::istringstream(line.substr(2)) >> x >> y >> z)
                sum += x + 2 * y + 3 * z;
        CHECK(sum == doctest::Approx(known.vertices).epsilon(1e-5));
    }
}

TEST_CASE("version 2 is version 1 but for lamps, in a quarter of the scenes or more, of three kinds")
{
    for (const std::uint32_t first : { 1u, 2001u }) {
        std::map<generator::Lamps, int> kinds;
        int alone = 0;
        for (std::uint32_t seed = first; seed < first + 100; ++seed) {
            const generator::LotteryTraits before = generator::lotteryTraits(seed),
                                           t = generator::lotteryTraits(seed, 2);
            CHECK(before.lamps == generator::Lamps::None);
            CHECK(t.things == before.things);
            CHECK(t.lights == before.lights);
            CHECK(hardCases(t).size() == hardCases(before).size() + (t.lamps != generator::Lamps::None ? 1 : 0));
            ++kinds[t.lamps];
            alone += t.quads ? 0 : 1;
        }
        CHECK(kinds[generator::Lamps::None] <= 75);
        for (const auto kind : { generator::Lamps::Large, generator::Lamps::Small, generator::Lamps::Textured })
            CHECK(kinds[kind] >= 5);
        CHECK(alone >= 10);
    }
}

TEST_CASE("lamps of version 2 emit, and are frozen")
{
    struct Known {
        std::uint32_t seed;
        generator::Lamps lamps;
        bool quads;
        std::size_t emitting;
        double emission;
    };
    for (const Known& known : { Known { 2001, generator::Lamps::Large, false, 1, 3053.92 },
             { 2003, generator::Lamps::Small, true, 1, 4667.74 },
             { 2018, generator::Lamps::Textured, false, 2, 1893.92 }, { 2002, generator::Lamps::None, true, 0, 0 } }) {
        CAPTURE(known.seed);
        const generator::GeneratedScene scene = generator::makeLottery(known.seed, 2);
        const generator::LotteryTraits t = generator::lotteryTraits(known.seed, 2);
        CHECK(t.lamps == known.lamps);
        CHECK(scene.hasLight == known.quads);
        std::size_t emitting = 0;
        double emission = 0;
        for (const scene::Material& m : scene.materials) {
            emitting += m.emission != glm::vec3(0) ? 1 : 0;
            emission += m.emission.x + 2 * m.emission.y + 3 * m.emission.z;
        }
        CHECK(emitting == known.emitting);
        CHECK(emission == doctest::Approx(known.emission).epsilon(1e-5));
        CHECK(scene.name == "lottery2_" + std::to_string(known.seed));
    }
}

TEST_CASE("version 3 is version 1 on open ground, under skies of five kinds")
{
    for (const std::uint32_t first : { 1u, 3001u }) {
        std::map<generator::Sky, int> kinds;
        int alone = 0;
        for (std::uint32_t seed = first; seed < first + 100; ++seed) {
            const generator::LotteryTraits before = generator::lotteryTraits(seed),
                                           t = generator::lotteryTraits(seed, 3);
            CHECK(before.sky == generator::Sky::None);
            CHECK(t.open);
            CHECK(t.lamps == generator::Lamps::None);
            CHECK(t.things == before.things);
            CHECK(hardCases(t).size() == hardCases(before).size() + (before.open ? 1 : 2));
            ++kinds[t.sky];
            alone += t.quads ? 0 : 1;
        }
        CHECK(kinds.size() == 5);
        for (const auto& kind : kinds)
            CHECK(kind.second >= 5);
        CHECK(alone >= 60);
        CHECK(alone <= 90);
    }
}

TEST_CASE("skies of version 3 have the light that was drawn, and are frozen")
{
    struct Known {
        std::uint32_t seed;
        generator::Sky sky;
        double mean, sum; ///< luminance over the sphere; x + 2 y + 3 z of texels
    };
    for (const Known& known : { Known { 2, generator::Sky::Even, 0.506141, 2.74523 },
             { 3, generator::Sky::Clear, 0.635797, 118500 }, { 5, generator::Sky::Clouds, 0.465555, 106468 },
             { 4, generator::Sky::Sun, 0.763147, 131567 }, { 3010, generator::Sky::Lamps, 0.723191, 160695 } }) {
        CAPTURE(known.seed);
        const generator::GeneratedScene scene = generator::makeLottery(known.seed, 3);
        CHECK(generator::lotteryTraits(known.seed, 3).sky == known.sky);
        CHECK(scene.name == "lottery3_" + std::to_string(known.seed));
        const image::RgbImage& map = scene.sky;
        REQUIRE(map.rgb.size() == 3u * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
        double sum = 0, light = 0, weights = 0;
        for (std::size_t i = 0; i < map.rgb.size(); i += 3) {
            const double r = map.rgb[i], g = map.rgb[i + 1], b = map.rgb[i + 2];
            const std::size_t row = i / 3 / static_cast<std::size_t>(map.width);
            const double weight = std::sin(std::numbers::pi * (static_cast<double>(row) + 0.5) / map.height);
            REQUIRE(std::min({ r, g, b }) >= 0);
            sum += r + 2 * g + 3 * b;
            light += weight * (0.2126 * r + 0.7152 * g + 0.0722 * b);
            weights += weight;
        }
        CHECK(light / weights == doctest::Approx(known.mean).epsilon(1e-4));
        CHECK(sum == doctest::Approx(known.sum).epsilon(1e-5));
    }
}

TEST_CASE("of the seeds to tune on and of those to report on, a quarter or more are of each hard case")
{
    for (const std::uint32_t first : { 1u, 1001u }) {
        std::map<std::string, int> cases;
        int bounces = 0, antialiased = 0, lenses = 0, motions = 0;
        for (std::uint32_t seed = first; seed < first + 200; ++seed) {
            const generator::LotteryTraits t = generator::lotteryTraits(seed);
            for (const std::string& name : generator::hardCases(t))
                ++cases[name];
            bounces += t.bounces;
            antialiased += t.antialias;
            lenses += t.lens;
            motions += t.motion;
            REQUIRE(t.lights >= 1);
            REQUIRE(t.lights <= 16);
        }
        CHECK(cases.size() == 5);
        for (const auto& found : cases) {
            CAPTURE(found.first);
            CHECK(found.second >= 50);
        }
        CHECK(bounces > 70);
        CHECK(antialiased > 50);
        CHECK(lenses > 25);
        CHECK(motions > 20);
    }
}

TEST_CASE("squared errors have the reference's noise taken out, and the worst pixels apart")
{
    std::mt19937 random(3);
    const image::RgbImage truth = plainImage(0.5f);
    image::RgbImage a = truth, b = truth;
    addNoise(a, 0.02, random);
    addNoise(b, 0.02, random);
    Reference reference;
    reference.image = reference.deviation = truth;
    for (std::size_t i = 0; i < truth.rgb.size(); ++i) {
        reference.image.rgb[i] = 0.5f * (a.rgb[i] + b.rgb[i]);
        reference.deviation.rgb[i] = 0.5f * (a.rgb[i] - b.rgb[i]);
    }
    std::vector<image::RgbImage> images(4, plainImage(0.51f));
    for (image::RgbImage& image : images)
        addNoise(image, 0.01, random);
    const SquaredError found = squaredError(images, reference);
    CHECK(found.mean
        == doctest::Approx(0.01 * 0.01 + 0.01 * 0.01).epsilon(0.1)); // bias and noise; the reference's was as large
    CHECK(found.bias == doctest::Approx(0.02).epsilon(0.05));
    CHECK(found.deviation < 0.1);
    CHECK(found.deviation > 0);
    for (std::size_t i = 0; i < 30; ++i)
        images[0].rgb[i] += 5.0f; // 10 pixels of 3072: fewer than the worst 0.5 %
    const SquaredError spiked = squaredError({ images[0] }, reference);
    CHECK(spiked.mean > 0.05);
    CHECK(spiked.trimmed < 2.5e-4);
    CHECK(spiked.deviation == 0);
}

TEST_CASE("a black image of a scene without light is neither biased nor wrong")
{
    Reference reference;
    reference.image = reference.deviation = { 2, 1, std::vector<float>(6, 0.0f) };
    const SquaredError found = squaredError({ reference.image, reference.image }, reference);
    CHECK(found.mean == 0);
    CHECK(found.bias == 0);
    CHECK(found.biasDeviation == 0);
}

TEST_CASE("how well the reference's noise is known enters errors and slopes")
{
    // Most of the noise in a few grey pixels, as at the edges of lights, where the image is good.
    std::mt19937 random(5);
    const image::RgbImage truth = plainImage(0.5f);
    image::RgbImage image = truth;
    addNoise(image, 0.002, random);
    std::vector<double> means, predicted;
    for (unsigned trial = 0; trial < 200; ++trial) {
        Reference reference;
        reference.image = reference.deviation = truth;
        for (std::size_t i = 0; i < truth.rgb.size() / 3; ++i) {
            const double size = i % 150 == 0 ? 0.05 : 0.001;
            const auto noise = static_cast<float>(size * gaussian(random));
            const auto known = static_cast<float>(size * gaussian(random));
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
                reference.image.rgb[c] = truth.rgb[c] + noise;
                reference.deviation.rgb[c] = known;
            }
        }
        const SquaredError found = squaredError({ image }, reference);
        means.push_back(found.mean);
        predicted.push_back(found.referenceDeviation * found.mean);
    }
    double mean = 0, scatter = 0, expected = 0;
    for (const double m : means)
        mean += m / 200;
    for (std::size_t i = 0; i < 200; ++i) {
        scatter += (means[i] - mean) * (means[i] - mean) / 199;
        expected += predicted[i] * predicted[i] / 200;
    }
    CHECK(std::sqrt(scatter) > 0.3 * mean);
    CHECK(std::sqrt(expected / scatter) == doctest::Approx(1).epsilon(0.25));

    LotteryResult known = resultOf(0.2, -0.3, 0, 1), unknown = known;
    unknown.filtered.back().error.referenceDeviation = 2;
    CHECK(verdictOf(known, 28).slopeDeviation < 0.02);
    CHECK(verdictOf(unknown, 28).slopeDeviation == doctest::Approx(1 / std::log(512 / 28.0)).epsilon(0.01));
    for (const auto& [result, broken] : { std::pair(known, 1.0), { unknown, 0.0 } })
        for (const Claim& claim : lotteryClaims({ result }, 28))
            if (claim.id == "lottery.all.slope_broken")
                CHECK(claim.value == broken);
}

TEST_CASE("verdicts: savings, slopes and bounds")
{
    // Half the error of plain sampling at every count, at twice the time of a sample.
    const Verdict half = verdictOf(resultOf(0.5, -0.5, 0, 2), 28);
    CHECK(half.againstPlain.value == doctest::Approx(0.5));
    CHECK(half.savedSamples == doctest::Approx(4));
    CHECK(half.savedTrimmed == doctest::Approx(4));
    CHECK(half.savedTime == doctest::Approx(2));
    CHECK(half.againstEqualTime.value == doctest::Approx(0.5 * std::sqrt(2.0)).epsilon(1e-3));
    CHECK(half.slope == doctest::Approx(-0.5));
    CHECK(half.plainSlope == doctest::Approx(-0.5));
    CHECK_FALSE(half.againstPlain.exceeds(mostAgainstPlain));
    // Beyond the curve's end it goes on as a mean of independent samples does.
    CHECK(verdictOf(resultOf(0.1, -0.5, 0, 1), 28).savedSamples == doctest::Approx(100).epsilon(1e-3));

    const std::vector<LotteryResult> results { resultOf(0.5, -0.5, 0, 2), resultOf(1.5, -0.5, 0, 2),
        resultOf(0.2, -0.1, 0, 1) };
    std::map<std::string, double> claims;
    for (const Claim& claim : lotteryClaims(results, 28))
        claims[claim.id] = claim.value;
    CHECK(claims.at("lottery.direct.scenes") == 3);
    CHECK(claims.at("lottery.all.worse_than_mc") == 1);
    CHECK(claims.at("lottery.all.slower_than_mc") == 1);
    CHECK(claims.at("lottery.all.behind_fixed_blur") == 0);
    CHECK(claims.at("lottery.all.slope_worst") == doctest::Approx(-0.1));
    CHECK(claims.at("lottery.all.slope_broken") == 1);
    // Within two standard errors nothing is broken.
    CHECK_FALSE(Ratio { 1.06, 0.01 }.exceeds(1.05));
    CHECK(Ratio { 1.08, 0.01 }.exceeds(1.05));
}
