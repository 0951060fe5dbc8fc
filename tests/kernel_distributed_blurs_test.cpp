// distributed.cl alone: deviations and directions of the filters of what lens and shutter blur.
#include "tests/distributed_support.h"
#include "tests/packed_support.h"

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

/// The default exponents, and those of the setting as published; each plain and packed.
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
    for (std::size_t k = 0; k < 2; ++k) {
        out.push_back(out[k]);
        out.back().packed = 1;
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

void requireAlong(
    const shared::DistributedParams& p, const Motion& m, bool apart, double n, float along, float dx, float dy)
{
    if (p.packed != 0) {
        // Direction times deviation, of 8 bits.
        const double expected =
            apart && m.one(p) ? bestWidth(p.shutterWidth, p.shutterExponent, m.speed() / 2, n, 1) : 0;
        const double scale = expected > 0 ? expected / m.speed() : 0;
        REQUIRE(agree(along, expected));
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
    return { rounded(m.x), rounded(m.y), 0 };
}

/// The directions that a kernel has stored in a plane that was `before`; fails if it has changed others than the
/// window's.
Planes<float> directionsOf(
    KernelBench& bench, const Region& region, const device::Buffer<float>& buffer, const Planes<float>& before)
{
    const Planes<float> after = planesOf(region.layout, bench.read(buffer));
    Planes<float> out(region.layout, 2, 0.0f);
    for (std::size_t k = 0; k < 2; ++k) {
        const Planes<float> numbers = numbersOf(after, k), old = numbersOf(before, k);
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            const image::Window& w = region.window;
            const bool inside = x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
            REQUIRE((inside || numbers.at(x, y) == old.at(x, y)));
            out.at(x, y, k) = numbers.at(x, y);
        });
    }
    return out;
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

struct BlursFound {
    Planes<float> lens, along, directions;
};
BlursFound blurs(KernelBench& bench, const Region& region, const shared::DistributedParams& p,
    const Planes<float>& confusion, const Planes<float>& motion, const Planes<std::uint32_t>& taken)
{
    Output<float> lens(bench, region, 1), along(bench, region, 1), directions(bench, region, 2);
    const auto takens = bench.buffer(taken.values);
    if (p.packed == 0) {
        const auto confusions = bench.buffer(confusion.values), motions = bench.buffer(motion.values);
        launchPixels(bench, "waves/distributed.cl", "blurs", p, confusions, motions, takens, lens.buffer(),
            along.buffer(), directions.buffer());
        return { lens.read(), along.read(), directions.read() };
    }
    Planes<float> ofY = motion;
    std::copy_n(motion.values.begin() + static_cast<std::ptrdiff_t>(region.layout.size), region.layout.size,
        ofY.values.begin());
    const Planes<float> both = packedNumbers(motion, ofY);
    const auto confusions = bench.buffer(packedNumbers(confusion, confusion).values),
               motions = bench.buffer(both.values), packedDirections = bench.buffer(both.values);
    launchPixels(bench, "waves/distributed.cl", "blurs", p, confusions, motions, takens, lens.buffer(), along.buffer(),
        packedDirections);
    return { lens.read(), along.read(), directionsOf(bench, region, packedDirections, both) };
}

/// shadows: six planes, or packed the first two in one.
BlursFound shadowBlurs(KernelBench& bench, const Region& region, const shared::DistributedParams& p,
    const Planes<float>& shadows, const Planes<float>& beta, const Planes<std::uint32_t>& taken)
{
    Planes<float> ofY = shadows;
    std::copy_n(shadows.values.begin() + static_cast<std::ptrdiff_t>(region.layout.size), region.layout.size,
        ofY.values.begin());
    const auto shadowed = bench.buffer((p.packed != 0 ? packedNumbers(shadows, ofY) : shadows).values);
    const auto betas = bench.buffer(beta.values);
    const auto takens = bench.buffer(taken.values);
    Output<float> along(bench, region, 1), directions(bench, region, 2);
    const Planes<float> before(region.layout, 1, 0.0f);
    const auto packed = bench.buffer(before.values);
    launchPixels(bench, "waves/distributed.cl", "shadowBlurs", p, shadowed, takens, betas, along.buffer(),
        p.packed != 0 ? packed : directions.buffer());
    const Planes<float> width = along.read();
    return { width, width, p.packed != 0 ? directionsOf(bench, region, packed, before) : directions.read() };
}

} // namespace

TEST_CASE("blurs: of the lens where all of the pixel is blurred, of the shutter where it has one motion")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        unsigned seed = 0;
        for (const Region& region : regions())
            for (const Samples& samples : sampleKinds)
                for (const shared::DistributedParams& p : settingsOf(region, samples)) {
                    std::mt19937 random(++seed);
                    auto confusion = filledPlanes(region, 2, 1e30f, [&](int x, int y, std::size_t plane) {
                        const double middle = ((x + y) % 3 - 1) * 12,
                                     half = random() % 4 == 0 ? 20 : uniform(random, 0, 12);
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
                        if (p.packed == 0)
                            return;
                        const Motion m = packedMotion(p, { motion.at(x, y), motion.at(x, y, 1), motion.at(x, y, 2) });
                        motion.setVector(x, y, { m.x, m.y, 0 });
                        const float low = confusion.at(x, y), high = confusion.at(x, y, 1);
                        confusion.at(x, y) = confusion.at(x, y, 1) = rounded(low > 0 ? low : high < 0 ? high : 0.0);
                    });
                    const auto taken = randomTaken(region, random);
                    const BlursFound found = blurs(bench, region, p, confusion, motion, taken);
                    everyPixel(region.window, [&](int x, int y) {
                        CAPTURE(x);
                        CAPTURE(y);
                        const double low = confusion.at(x, y), high = confusion.at(x, y, 1),
                                     n = samples.of(taken.at(x, y));
                        const double r = low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
                        if (std::fabs(r - p.leastRadius) > 1e-5)
                            REQUIRE(agree(found.lens.at(x, y),
                                r > p.leastRadius ? bestWidth(p.blurWidth, p.blurExponent, r, n, 2) : 0));
                        const Motion m { motion.at(x, y), motion.at(x, y, 1), motion.at(x, y, 2) };
                        if (!m.uncertain(p))
                            requireAlong(p, m, true, n, found.along.at(x, y), found.directions.at(x, y),
                                found.directions.at(x, y, 1));
                    });
                }
    });
}

TEST_CASE("shadows' blurs: of the mean motion of those that move, where they move alike and the light is taken apart")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        unsigned seed = 500;
        int uncertain = 0, pixels = 0;
        std::array<int, 2> found {};
        for (const Region& region : regions())
            for (const Samples& samples : sampleKinds)
                for (const shared::DistributedParams& p : settingsOf(region, samples)) {
                    std::mt19937 random(++seed);
                    auto shadows =
                        filledPlanes(region, 6, 1e30f, [&](int, int, std::size_t) { return uniform(random, 1, 9); });
                    std::vector<std::vector<glm::dvec2>> motions(region.layout.size);
                    everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                        const std::vector<glm::dvec2> all = motions[shadows.index(x, y)] = randomMotions(random);
                        const ShadowSums sums = sumsOf(all);
                        const double values[] = { sums.x, sums.y, sums.squared, sums.count };
                        for (std::size_t k = 0; k < 4; ++k)
                            shadows.at(x, y, 2 + k) = static_cast<float>(values[k]);
                        if (p.packed != 0) {
                            const Motion m = packedMotion(p, all.empty() ? Motion {} : motionOf(all));
                            shadows.at(x, y) = static_cast<float>(m.x);
                            shadows.at(x, y, 1) = static_cast<float>(m.y);
                        }
                    });
                    const auto beta = filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) {
                        return random() % 4 == 0 ? -1 : random() % 4 == 0 ? 0 : 0.1;
                    });
                    const auto taken = randomTaken(region, random);
                    const BlursFound is = shadowBlurs(bench, region, p, shadows, beta, taken);
                    everyPixel(region.window, [&](int x, int y) {
                        CAPTURE(x);
                        CAPTURE(y);
                        const auto& all = motions[shadows.index(x, y)];
                        const Motion mean = all.empty() ? Motion {} : motionOf(all);
                        const Motion m = p.packed != 0 ? packedMotion(p, mean) : mean;
                        ++pixels;
                        if (m.uncertain(p)) {
                            ++uncertain;
                            return;
                        }
                        ++found[m.one(p) ? 1 : 0];
                        requireAlong(p, m, beta.at(x, y) >= 0, samples.of(taken.at(x, y)), is.along.at(x, y),
                            is.directions.at(x, y), is.directions.at(x, y, 1));
                    });
                }
        CHECK(uncertain < 0.01 * pixels);
        CHECK(found[0] > 1000);
        CHECK(found[1] > 1000);
    });
}
