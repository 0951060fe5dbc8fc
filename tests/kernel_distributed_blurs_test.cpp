// distributed.cl alone: deviations and directions of the filters of what lens and shutter blur.
#include "tests/distributed_support.h"

#include <array>
#include <limits>

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

/// The default exponents, and those of the setting as published.
std::vector<shared::DistributedParams> settingsOf(const Region& region, const Samples& samples)
{
    std::vector<shared::DistributedParams> out(2, paramsOf(region));
    out[1].blurWidth = 0.177f;
    out[1].blurExponent = 0;
    out[1].shutterWidth = 0.177f;
    out[1].shutterExponent = 0;
    out[1].leastRadius = 0.5f;
    for (shared::DistributedParams& p : out) {
        p.frames = samples.frames;
        p.samples = samples.expected;
    }
    return out;
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

/// What a pass says of blurs along motions: in two planes, or in one the direction times the deviation, of 8 bits.
struct Along {
    explicit Along(const PassBench& pass)
        : inOne(pass.has("vectors"))
        , apart(pass.has("along"))
        , directions(pass.pixels<float>(inOne ? "vectors" : "directions"))
        , widths(apart ? pass.pixels<float>("along") : directions)
    {
        if (!apart)
            everyPixel(directions.layout,
                [&](int x, int y) { widths.at(x, y) = std::hypot(directions.at(x, y), directions.at(x, y, 1)); });
    }
    void require(const shared::DistributedParams& p, const Motion& m, bool filtered, double n, int x, int y) const
    {
        const bool one = filtered && m.one(p);
        const double width = one ? bestWidth(p.shutterWidth, p.shutterExponent, m.speed() / 2, n, 1) : 0;
        const double scale = inOne ? width : 1, tolerance = inOne ? 1.0 / 256 : 1e-4;
        REQUIRE(agree(widths.at(x, y), width, apart ? 1e-5 : tolerance));
        REQUIRE(agree(directions.at(x, y), scale * (one ? m.x / m.speed() : 1), tolerance));
        REQUIRE(agree(directions.at(x, y, 1), scale * (one ? m.y / m.speed() : 0), tolerance));
    }

    bool inOne, apart;
    Planes<float> directions, widths;
};

/// What lean frames have of a motion: infinity where there are several.
Motion inLeanFrames(const shared::DistributedParams& p, const Motion& m)
{
    return m.spread > p.oneVelocity * m.speed() ? Motion { std::numeric_limits<double>::infinity(), 0, 0 }
                                                : Motion { m.x, m.y, 0 };
}

Planes<std::uint32_t> randomTaken(const Region& region, std::mt19937& random)
{
    return filledPlanes(
        region, 1, 1u << 20, [&](int, int, std::size_t) { return random() % 4 == 0 ? 0 : random() % 100; });
}

/// What a light's first pass keeps of the motions of one pixel's shadows.
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
    onEveryRegion(1, [](MovingFrame& frame, const Region& region, std::mt19937& random) {
        RegionPass pass(frame, "blurs", { "lens", "along", frame.lean ? "vectors" : "directions" });
        for (const Samples& samples : sampleKinds)
            for (const shared::DistributedParams& p : settingsOf(region, samples)) {
                auto confusion = filledPlanes(region, 2, 1e30f, [](int, int, std::size_t) { return 0; });
                auto motion = confusion;
                auto spread = filledPlanes(region, 1, 1e30f, [](int, int, std::size_t) { return 0; });
                everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                    const double middle = ((x + y) % 3 - 1) * 12,
                                 half = random() % 4 == 0 ? 20 : uniform(random, 0, 12);
                    confusion.at(x, y) = static_cast<float>(middle - half);
                    confusion.at(x, y, 1) = static_cast<float>(middle + half);
                    const double speed = uniform(random) * uniform(random, 0, 40), angle = uniform(random, 0, 7);
                    Motion m { speed * std::cos(angle), speed * std::sin(angle),
                        random() % 3 == 0 ? 0 : speed * uniform(random, 0, 0.2) };
                    if (random() % 5 == 0)
                        m = { 0, 0, uniform(random, 0, 9) };
                    if (frame.lean)
                        m = inLeanFrames(p, m);
                    motion.at(x, y) = static_cast<float>(m.x);
                    motion.at(x, y, 1) = static_cast<float>(m.y);
                    spread.at(x, y) = static_cast<float>(m.spread);
                });
                const auto taken = randomTaken(region, random);
                pass.plane("taken", taken);
                pass.plane("confusion", confusion);
                pass.plane("motion", motion);
                if (!frame.lean)
                    pass.plane("motionSpread", spread);
                confusion = pass.floats("confusion");
                motion = pass.floats("motion");
                pass.runIn(region, p);
                const auto lens = pass.floats("lens");
                const Along along(pass);
                everyPixel(region.window, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    const double low = confusion.at(x, y), high = confusion.at(x, y, 1), n = samples.of(taken.at(x, y));
                    const double r = low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
                    if (std::fabs(r - p.leastRadius) > 1e-5)
                        REQUIRE(agree(
                            lens.at(x, y), r > p.leastRadius ? bestWidth(p.blurWidth, p.blurExponent, r, n, 2) : 0));
                    const Motion m { motion.at(x, y), motion.at(x, y, 1), spread.at(x, y) };
                    if (!m.uncertain(p))
                        along.require(p, m, true, n, x, y);
                });
            }
    });
}

TEST_CASE("shadows' blurs: of the mean motion of those that move, where they move alike and the light is taken apart")
{
    int uncertain = 0, pixels = 0;
    std::array<int, 2> found {};
    onEveryRegion(500, [&](MovingFrame& frame, const Region& region, std::mt19937& random) {
        RegionPass pass(frame, "shadowBlurs",
            frame.lean ? std::vector<std::string> { "vectors" } : std::vector<std::string> { "along", "directions" });
        const std::string name = frame.lean ? "shadowMotion" : "shadowSums";
        for (const Samples& samples : sampleKinds)
            for (const shared::DistributedParams& p : settingsOf(region, samples)) {
                auto shadows = filledPlanes(region, frame.lean ? 2 : 4, 1e30f, [](int, int, std::size_t) { return 0; });
                std::vector<Motion> motions(region.layout.size);
                everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                    const std::vector<glm::dvec2> all = randomMotions(random);
                    Motion& m = motions[shadows.index(x, y)] = all.empty() ? Motion {} : motionOf(all);
                    if (frame.lean)
                        m = inLeanFrames(p, m);
                    const ShadowSums sums = sumsOf(all);
                    const double values[] = { frame.lean ? m.x : sums.x, frame.lean ? m.y : sums.y, sums.squared,
                        sums.count };
                    for (std::size_t k = 0; k < (frame.lean ? 2 : 4); ++k)
                        shadows.at(x, y, k) = static_cast<float>(values[k]);
                });
                const auto beta = filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) {
                    return random() % 4 == 0 ? -1 : random() % 4 == 0 ? 0 : 0.1;
                });
                const auto taken = randomTaken(region, random);
                pass.plane(name, shadows);
                pass.plane("beta", beta);
                pass.plane("taken", taken);
                shadows = pass.floats(name);
                pass.runIn(region, p);
                const Along along(pass);
                everyPixel(region.window, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    const Motion m =
                        frame.lean ? Motion { shadows.at(x, y), shadows.at(x, y, 1), 0 } : motions[shadows.index(x, y)];
                    ++pixels;
                    if (m.uncertain(p)) {
                        ++uncertain;
                        return;
                    }
                    ++found[m.one(p) ? 1 : 0];
                    along.require(p, m, beta.at(x, y) >= 0, samples.of(taken.at(x, y)), x, y);
                });
            }
    });
    CHECK(uncertain < 0.01 * pixels);
    CHECK(found[0] > 1000);
    CHECK(found[1] > 1000);
}
