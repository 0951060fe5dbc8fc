// distributed.cl alone: deviations and directions of the filters of what lens and shutter blur.
#include "tests/distributed_support.h"
#include "tests/lens_support.h"
#include "tests/pass_bench.h"

#include <array>
#include <limits>
#include <optional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// c h (n h)^-e, or c r (n r^2)^-e if `axes` is 2: best against noise of n samples (docs/multiple-effects.md).
double bestWidth(double c, double e, double extent, double n, int axes)
{
    return c * extent * std::pow(n * std::pow(extent, axes), -e);
}

/// How many samples widths are for: those of a frame of so many, expected ones, or those that there are.
struct Samples {
    float frames, expected;
    double of(std::uint32_t taken) const { return frames * (expected > 0 ? expected : std::max(1.0, 1.0 * taken)); }
};
constexpr std::array<Samples, 3> sampleKinds = { { { 1, 0 }, { 1, 16 }, { 2, 0 } } };

/// The frame's own, the setting as published, and what of it a kernel is run with.
struct Kind {
    bool packed, published;
    Samples samples;

    shared::DistributedParams params(const PassBench& bench) const
    {
        auto p = bench.own<shared::DistributedParams>("p");
        p.blurWidth = published ? 0.177f : 0.65f;
        p.blurExponent = published ? 0 : 0.176f;
        p.shutterWidth = published ? 0.177f : 0.86f;
        p.shutterExponent = published ? 0 : 0.25f;
        p.leastRadius = published ? 0.5f : 2;
        p.oneVelocity = 0.1f;
        p.frames = samples.frames;
        p.samples = samples.expected;
        return p;
    }
};

/// Calls test(bench, region, kind, random) with the pass of that kernel over every region's window, in frames of one
/// image, whose planes are packed, and in those with layers.
template <class Test>
void inEveryKind(const std::string& kernel, unsigned seed, const Test& test)
{
    scene::Scene scene = smallScene();
    displace(scene, { 0.3f, 0, 0 });
    scene.shutterClose = 1;
    onEveryDevice([&](const device::Device& device) {
        unsigned of = seed;
        for (const Region& region : regions())
            for (const bool packed : { false, true }) {
                DeclaredFrame frame(
                    device, scene, sized(render::axisAligned(16), region.width, region.height), !packed);
                for (const Samples& samples : sampleKinds)
                    for (const bool published : { false, true }) {
                        CAPTURE(packed);
                        CAPTURE(published);
                        PassBench bench(frame, kernel);
                        bench.window(region.window);
                        std::mt19937 random(++of);
                        test(bench, region, Kind { packed, published, samples }, random);
                    }
            }
    });
}

struct Motion {
    double x, y, spread;
    double speed() const { return std::hypot(x, y); }
    /// One motion, and long enough.
    bool one(const shared::DistributedParams& p) const
    {
        return speed() < std::numeric_limits<double>::infinity() && speed() >= p.leastRadius
            && spread <= p.oneVelocity * speed();
    }
    /// Whether a rounding decides.
    bool uncertain(const shared::DistributedParams& p) const
    {
        const double margin = 1e-4 * (1 + speed()), beyond = speed() - p.leastRadius;
        return std::fabs(beyond) < margin || (beyond > 0 && std::fabs(spread - p.oneVelocity * speed()) < margin);
    }
};

/// Filters along motions.
struct Along {
    explicit Along(const PassBench& bench)
        : directions(bench.pixels<float>(bench.has("vectors") ? "vectors" : "directions"))
    {
        if (bench.has("along"))
            widths = bench.pixels<float>("along");
    }

    Planes<float> directions;
    std::optional<Planes<float>> widths;
};

/// What a pass has made of pixel (x, y): deviations, if it keeps them, and directions, or both in one.
void requireAlong(const PassBench& bench, const shared::DistributedParams& p, const Motion& m, bool apart, double n,
    const Along& found, int x, int y)
{
    const float dx = found.directions.at(x, y), dy = found.directions.at(x, y, 1);
    const float along = found.widths ? found.widths->at(x, y) : std::hypot(dx, dy);
    if (bench.has("vectors")) {
        // Direction times deviation, of 8 bits.
        const double expected =
            apart && m.one(p) ? bestWidth(p.shutterWidth, p.shutterExponent, m.speed() / 2, n, 1) : 0;
        const double scale = expected > 0 ? expected / m.speed() : 0;
        REQUIRE(agree(along, expected, found.widths ? 1e-5 : 1.0 / 256));
        REQUIRE(agree(dx, scale > 0 ? scale * m.x : 0, 1.0 / 256));
        REQUIRE(agree(dy, scale > 0 ? scale * m.y : 0, 1.0 / 256));
        return;
    }
    if (!apart || !m.one(p)) {
        REQUIRE(along == 0);
        REQUIRE(dx == 1);
        REQUIRE(dy == 0);
        return;
    }
    REQUIRE(agree(along, bestWidth(p.shutterWidth, p.shutterExponent, m.speed() / 2, n, 1)));
    REQUIRE(agree(dx, m.x / m.speed(), 1e-4));
    REQUIRE(agree(dy, m.y / m.speed(), 1e-4));
}

/// A packed motion, or infinity where there are several.
Motion packedMotion(const shared::DistributedParams& p, const Motion& m)
{
    if (m.spread > p.oneVelocity * m.speed())
        return { std::numeric_limits<double>::infinity(), 0, 0 };
    const auto rounded = [](double v) { return shared::unpackShort(shared::packShort(static_cast<float>(v))); };
    return { rounded(m.x), rounded(m.y), 0 };
}

Planes<std::uint32_t> randomTaken(const Region& region, std::mt19937& random)
{
    return filledPlanes(
        region, 1, 1u << 20, [&](int, int, std::size_t) { return random() % 4 == 0 ? 0 : random() % 100; });
}

/// What a light's first pass keeps of the motions of one pixel's shadows, of which that is the mean and the deviation.
struct ShadowSums {
    double x, y, squared, count;
};

ShadowSums sumsOf(const std::vector<glm::dvec2>& motions)
{
    ShadowSums out {};
    for (const glm::dvec2& m : motions) {
        out.x += m.x;
        out.y += m.y;
        out.squared += glm::dot(m, m);
        out.count += 1;
    }
    return out;
}

/// Mean, and root of the mean squared distance from it.
Motion motionOf(const std::vector<glm::dvec2>& motions)
{
    glm::dvec2 mean(0);
    for (const glm::dvec2& m : motions)
        mean += m / static_cast<double>(motions.size());
    double squared = 0;
    for (const glm::dvec2& m : motions)
        squared += glm::dot(m - mean, m - mean) / static_cast<double>(motions.size());
    return { mean.x, mean.y, std::sqrt(squared) };
}

std::vector<glm::dvec2> randomMotions(std::mt19937& random)
{
    std::vector<glm::dvec2> out;
    const auto count = random() % 6;
    const double angle = uniform(random, 0, 7), speed = uniform(random) * uniform(random, 0, 30),
                 differs = uniform(random, 0, 0.3);
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(speed
            * (glm::dvec2(std::cos(angle), std::sin(angle))
                + differs * glm::dvec2(uniform(random, -1, 1), uniform(random, -1, 1))));
    if (random() % 8 == 0)
        out = { { speed, 0.5 }, { -speed, -0.5 } }; // opposite ones
    return out;
}

} // namespace

TEST_CASE("blurs: of the lens where all of the pixel is blurred, of the shutter where it has one motion")
{
    inEveryKind("blurs", 0, [](PassBench& bench, const Region& region, const Kind& kind, std::mt19937& random) {
        const shared::DistributedParams p = kind.params(bench);
        auto confusion = filledPlanes(region, 2, 1e30f, [&](int x, int y, std::size_t plane) {
            const double middle = ((x + y) % 3 - 1) * 12, half = random() % 4 == 0 ? 20 : uniform(random, 0, 12);
            return plane == 0 ? middle - half : middle + half;
        });
        auto motion = filledPlanes(region, 3, 1e30f, [](int, int, std::size_t) { return 0; });
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            const double speed = uniform(random) * uniform(random, 0, 40), angle = uniform(random, 0, 7);
            motion.setVector(x, y,
                { speed * std::cos(angle), speed * std::sin(angle),
                    random() % 3 == 0 ? 0 : speed * uniform(random, 0, 0.2) });
            if (random() % 5 == 0)
                motion.setVector(x, y, { 0, 0, uniform(random, 0, 9) });
            if (!kind.packed)
                return;
            const Motion m = packedMotion(p, { motion.at(x, y), motion.at(x, y, 1), motion.at(x, y, 2) });
            motion.setVector(x, y, { m.x, m.y, 0 });
        });
        const auto taken = randomTaken(region, random);
        bench.value("p", p);
        bench.plane("taken", taken);
        bench.plane("confusion", confusion);
        confusion = bench.pixels<float>("confusion"); // as its format holds it
        const auto third = motion.values.begin() + static_cast<std::ptrdiff_t>(2 * region.layout.size);
        bench.plane("motion", std::vector<float>(motion.values.begin(), third));
        if (!kind.packed)
            bench.plane("motionSpread", std::vector<float>(third, motion.values.end()));
        bench.run();
        const auto lens = bench.pixels<float>("lens");
        const Along along(bench);
        everyPixel(region.window, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const double low = confusion.at(x, y), high = confusion.at(x, y, 1), n = kind.samples.of(taken.at(x, y));
            const double r = low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
            if (std::fabs(r - p.leastRadius) > 1e-5)
                REQUIRE(agree(lens.at(x, y), r > p.leastRadius ? bestWidth(p.blurWidth, p.blurExponent, r, n, 2) : 0));
            const Motion m { motion.at(x, y), motion.at(x, y, 1), motion.at(x, y, 2) };
            if (!m.uncertain(p))
                requireAlong(bench, p, m, true, n, along, x, y);
        });
    });
}

TEST_CASE("shadows' blurs: of the mean motion of those that move, where they move alike and the light is taken apart")
{
    int uncertain = 0, pixels = 0;
    std::array<int, 2> found {};
    inEveryKind(
        "shadowBlurs", 500, [&](PassBench& bench, const Region& region, const Kind& kind, std::mt19937& random) {
            const shared::DistributedParams p = kind.params(bench);
            // Sums of four kinds, or the motion itself.
            auto shadows = filledPlanes(region, kind.packed ? 2 : 4, 1e30f, [](int, int, std::size_t) { return 0; });
            std::vector<Motion> motions(region.layout.size);
            everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                const std::vector<glm::dvec2> all = randomMotions(random);
                const Motion mean = all.empty() ? Motion {} : motionOf(all);
                const Motion m = motions[shadows.index(x, y)] = kind.packed ? packedMotion(p, mean) : mean;
                const ShadowSums sums = sumsOf(all);
                const std::vector<double> values =
                    kind.packed ? std::vector { m.x, m.y } : std::vector { sums.x, sums.y, sums.squared, sums.count };
                for (std::size_t k = 0; k < values.size(); ++k)
                    shadows.at(x, y, k) = static_cast<float>(values[k]);
            });
            const auto beta = filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) {
                return random() % 4 == 0 ? -1 : random() % 4 == 0 ? 0 : 0.1;
            });
            const auto taken = randomTaken(region, random);
            bench.value("p", p);
            bench.plane("taken", taken);
            bench.plane("beta", beta);
            bench.plane(kind.packed ? "shadowMotion" : "shadowSums", shadows);
            bench.run();
            const Along along(bench);
            everyPixel(region.window, [&](int x, int y) {
                CAPTURE(x);
                CAPTURE(y);
                const Motion& m = motions[shadows.index(x, y)];
                ++pixels;
                if (m.uncertain(p)) {
                    ++uncertain;
                    return;
                }
                ++found[m.one(p) ? 1 : 0];
                requireAlong(bench, p, m, beta.at(x, y) >= 0, kind.samples.of(taken.at(x, y)), along, x, y);
            });
        });
    CHECK(uncertain < 0.01 * pixels);
    CHECK(found[0] > 1000);
    CHECK(found[1] > 1000);
}
