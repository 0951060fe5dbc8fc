// published.cl alone: widths and counts of terms and of primary rays against the equations of thesis chapter 5 and
// appendix B as printed, in double, with the differences that docs/multiple-effects.md names.
#include "tests/distributed_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double diffuseBand = 2.8; ///< Omega_v of (4.18)

/// Circles of confusion in a pixel.
struct Circles {
    double least, largest;
    Circles(double low, double high)
        : least(low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high)))
        , largest(std::max(std::fabs(low), std::fabs(high)))
    {
    }
};

double inverse(double x) { return x > 0 ? 1 / x : infinity; }
/// (5.7) and (5.18), (5.22), `secondary` being l_I s / l_p or z / (Omega_v l_p); scaled by (5.29).
double band(double rMin, double secondary, double mu)
{
    return std::min(0.5, mu * std::min({ 0.5, inverse(secondary), inverse(rMin) }));
}
/// (5.24) to (5.28): without `secondary` the primary rays.
double count(double band, double rMax, double secondary = 0)
{
    return std::pow((0.5 + band) * (1 + rMax * band) * (1 + secondary * band), 2);
}
/// Width in metres of exp(-16 d^2 (band / l_p)^2), (5.31).
double width(double band, double pixelSize) { return pixelSize / (std::sqrt(32.0) * band); }
/// Bandlimits of lobes, (A.3) and (A.5).
double lobeBand(std::uint32_t gloss)
{
    const shared::Gloss lobe = shared::unpackGloss(gloss);
    return lobe.kind == WEDGE_PHONG ? 4.27 + 0.15 * lobe.exponent : 3.6 + 0.084 * lobe.exponent;
}
std::uint32_t lobe(double exponent, bool phong)
{
    return shared::packGloss(shared::makeGloss(static_cast<float>(exponent), phong ? WEDGE_PHONG : WEDGE_BLINN_PHONG));
}

/// What the kernels read of each pixel.
struct Pixels {
    Pixels(const Region& of, unsigned seed)
        : region(of)
        , random(seed)
        , flags(
              plane(1, [&](int x, int y, std::size_t) { return (x / 4 + y / 5) % 2 == 0 ? chance(0.8) : chance(0.2); }))
        , confusion(plane(2, [](int, int, std::size_t) { return 0; }))
        , slopes(plane(2, [](int, int, std::size_t) { return 0; }))
        , reflectors(plane(3, [](int, int, std::size_t) { return 0; }))
        , pixelSize(plane(1, [&](int, int, std::size_t) { return std::exp(uniform(random, -7, -3)); }))
        , motion(slopes)
        , motionSpread(plane(1, [](int, int, std::size_t) { return 0; }))
        , objectId(
              filledPlanes(of, 1, 3u, [&](int, int, std::size_t) { return random() % 7 == 0 ? 0 : 1 + random() % 3; }))
        , gloss(filledPlanes(
              of, 1, 0u, [&](int, int, std::size_t) { return lobe(uniform(random, 0, 50), random() % 2 == 0); }))
    {
        everyPixel({ 0, 0, of.width, of.height }, [&](int x, int y) {
            pair(confusion, x, y, -uniform(random) * uniform(random) * 60, uniform(random) * uniform(random) * 60);
            if (random() % 2 == 0) // of one sign
                pair(confusion, x, y, confusion.at(x, y, 1), confusion.at(x, y, 1) + uniform(random, 0, 20));
            if (random() % 4 == 0)
                pair(confusion, x, y, -confusion.at(x, y, 1), -confusion.at(x, y));
            const double s = chance(0.8) * uniform(random), z = chance(0.8) * uniform(random);
            pair(slopes, x, y, s * s * s, s > 0 ? s + 3 * uniform(random) : 0); // 0: nothing in the way
            pair(reflectors, x, y, z * z * z, z > 0 ? z + 2 * uniform(random) : 0);
        });
    }

    template <class Value>
    Planes<float> plane(std::size_t planes, const Value& value)
    {
        return filledPlanes(region, planes, 1e30f, value);
    }
    double chance(double of) { return uniform(random) < of ? 1 : 0; }
    static void pair(Planes<float>& of, int x, int y, double first, double second)
    {
        const double least = std::min(first, second), largest = std::max(first, second);
        of.at(x, y) = static_cast<float>(least);
        of.at(x, y, 1) = static_cast<float>(largest);
    }

    Circles circles(int x, int y) const { return { confusion.at(x, y), confusion.at(x, y, 1) }; }

    /// The lower median of the 5x5 flags that the image has.
    bool apart(int x, int y) const
    {
        std::vector<float> found;
        for (int py = y - 2; py <= y + 2; ++py)
            for (int px = x - 2; px <= x + 2; ++px)
                if (region.contains(px, py))
                    found.push_back(flags.at(px, py));
        std::ranges::sort(found);
        return found[(found.size() - 1) / 2] > 0.5f;
    }

    Region region;
    std::mt19937 random;
    Planes<float> flags, confusion, slopes, reflectors, pixelSize, motion, motionSpread;
    Planes<std::uint32_t> objectId, gloss;
};

struct Found {
    Planes<float> beta, demand;
};

MovingFrame published(const device::Device& device) { return MovingFrame(device, Kept::Full, render::asPublished()); }

/// own: of the two kinds of terms, planes and values that only they have.
template <class Own>
Found widthsOf(DeclaredFrame& frame, const Pixels& in, const std::string& kernel, float mu, const Own& own)
{
    RegionPass pass(frame, kernel, { "beta", "demand" });
    pass.value("mu", mu);
    pass.plane("flags", in.flags);
    pass.plane("confusion", in.confusion);
    pass.plane("pixelSize", in.pixelSize);
    pass.plane("objectId", in.objectId);
    own(pass);
    pass.runIn(in.region, paramsOf(in.region));
    return { pass.floats("beta"), pass.floats("demand") };
}

Found shadows(DeclaredFrame& frame, const Pixels& in, float mu, float extent)
{
    return widthsOf(frame, in, "publishedShadows", mu, [&](PassBench& pass) {
        pass.value("lightExtent", extent);
        pass.plane("slopes", in.slopes);
    });
}

Found reflectors(DeclaredFrame& frame, const Pixels& in, float mu, std::uint32_t component)
{
    return widthsOf(frame, in, "publishedReflectors", mu, [&](PassBench& pass) {
        pass.value("component", component);
        pass.plane("reflectors", in.reflectors);
        pass.plane("gloss", in.gloss);
    });
}

Planes<float> primaries(DeclaredFrame& frame, const Pixels& in, float mu, float mixed = 64)
{
    RegionPass pass(frame, "publishedPrimary", { "demand" });
    pass.value("mu", mu);
    pass.value("mixed", mixed);
    pass.plane("confusion", in.confusion);
    pass.plane("motion", in.motion);
    pass.plane("motionSpread", in.motionSpread);
    pass.runIn(in.region, paramsOf(in.region));
    return pass.floats("demand");
}

/// A term's width and count, of what `secondary` is at its least and largest.
void requireTerm(const Pixels& in, const Found& found, int x, int y, double least, double largest, double mu)
{
    CAPTURE(x);
    CAPTURE(y);
    CAPTURE(mu);
    const Circles r = in.circles(x, y);
    const bool apart = in.apart(x, y);
    if (in.objectId.at(x, y) == 0) {
        REQUIRE(found.beta.at(x, y) == -1);
        REQUIRE(found.demand.at(x, y) == 0);
        return;
    }
    const double factored = band(r.least, least, mu), combined = band(r.least, 0, mu);
    REQUIRE(agree(found.beta.at(x, y), apart ? width(factored, in.pixelSize.at(x, y)) : -1));
    REQUIRE(agree(found.demand.at(x, y), count(apart ? factored : combined, r.largest, largest), 1e-4));
}

} // namespace

TEST_CASE("shadows: widths (5.18), counts (5.25) where taken apart and (5.27) where not, scaled by (5.29)")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame = published(device);
        unsigned seed = 0;
        for (const Region& region : regions())
            for (const float mu : { 1.0f, 0.6f, 3.0f, 1e6f })
                for (const float extent : { 0.0f, 0.01f, 0.4f }) {
                    const Pixels in(region, ++seed);
                    const Found found = shadows(frame, in, mu, extent);
                    everyPixel(region.window, [&](int x, int y) {
                        const double perSlope = extent / static_cast<double>(in.pixelSize.at(x, y));
                        requireTerm(
                            in, found, x, y, perSlope * in.slopes.at(x, y), perSlope * in.slopes.at(x, y, 1), mu);
                    });
                }
    });
}

TEST_CASE("reflectors: widths (5.22), counts (5.26) and (5.28) over Omega_v^2, of diffuse surfaces and of lobes")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame = published(device);
        unsigned seed = 100;
        for (const Region& region : regions())
            for (const float mu : { 1.0f, 0.6f, 3.0f, 1e6f })
                for (const bool glossy : { false, true }) {
                    const Pixels in(region, ++seed);
                    const Found found =
                        reflectors(frame, in, mu, glossy ? WEDGE_COMPONENT_GLOSSY : WEDGE_COMPONENT_DIFFUSE);
                    everyPixel(region.window, [&](int x, int y) {
                        const double transfer = glossy ? lobeBand(in.gloss.at(x, y)) : diffuseBand;
                        const double perMetre = 1 / (transfer * in.pixelSize.at(x, y));
                        requireTerm(in, found, x, y, perMetre * in.reflectors.at(x, y),
                            perMetre * in.reflectors.at(x, y, 1), mu);
                    });
                }
    });
}

TEST_CASE("primary rays: (5.24); (B.3) along one motion, a fixed count where motions differ, the largest of them")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame = published(device);
        unsigned seed = 200;
        for (const Region& region : regions())
            for (const float mu : { 1.0f, 0.6f, 3.0f }) {
                Pixels in(region, ++seed);
                everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
                    const double speed = in.chance(0.8) * uniform(in.random, 0, 5) * uniform(in.random, 0, 9),
                                 angle = uniform(in.random, 0, 7);
                    const bool opposite = in.random() % 8 == 0; // no mean at all
                    in.motion.at(x, y) = opposite ? 0 : static_cast<float>(speed * std::cos(angle));
                    in.motion.at(x, y, 1) = opposite ? 0 : static_cast<float>(speed * std::sin(angle));
                    in.motionSpread.at(x, y) = static_cast<float>(
                        opposite ? uniform(in.random, 0, 5) : in.chance(0.5) * speed * uniform(in.random, 0, 0.3));
                });
                const Planes<float> found = primaries(frame, in, mu);
                everyPixel(region.window, [&](int x, int y) {
                    const Circles r = in.circles(x, y);
                    const double speed = std::hypot(in.motion.at(x, y), in.motion.at(x, y, 1)),
                                 spread = in.motionSpread.at(x, y), half = speed / 2; // Omega_t = 2
                    if (std::fabs(speed - 2) < 1e-5 || std::fabs(spread - 2) < 1e-5
                        || std::fabs(spread - 0.1 * speed) < 1e-5)
                        return;
                    const bool several = (speed > 2 || spread > 2) && spread > 0.1 * speed;
                    const double ofMotion = several ? 64 : speed > 2 ? count(band(half, 0, mu), half) : 1;
                    REQUIRE(agree(found.at(x, y), std::max(count(band(r.least, 0, mu), r.largest), ofMotion), 1e-4));
                });
            }
    });
}

TEST_CASE("in focus one primary ray; of a point light, and of reflectors at the surface, as many rays as primary ones")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame = published(device);
        const Region region(45, 29);
        for (const float mu : { 0.6f, 1.0f, 4.0f })
            for (const float apart : { 0.0f, 1.0f }) {
                Pixels in(region, 7);
                everyPixel(region.window, [&](int x, int y) {
                    in.objectId.at(x, y) = 1;
                    in.flags.at(x, y) = apart;
                    Pixels::pair(in.reflectors, x, y, 0, 0);
                });
                const Planes<float> primary = primaries(frame, in, mu);
                const Planes<float> point = shadows(frame, in, mu, 0).demand;
                const Planes<float> contact = reflectors(frame, in, mu, WEDGE_COMPONENT_DIFFUSE).demand;
                Pixels focused = in;
                everyPixel(region.window, [&](int x, int y) {
                    // Of primary rays there is one at least, whatever mu.
                    REQUIRE(std::max(point.at(x, y), 1.0f) == primary.at(x, y));
                    REQUIRE(std::max(contact.at(x, y), 1.0f) == primary.at(x, y));
                    Pixels::pair(focused.confusion, x, y, 0, 0);
                });
                const Planes<float> one = primaries(frame, focused, mu);
                everyPixel(region.window, [&](int x, int y) { REQUIRE(one.at(x, y) == 1); });
            }
    });
}

TEST_CASE("no input makes anything but a width and a count within bounds")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame = published(device);
        const Region region(36, 36);
        Pixels in(region, 8);
        const float values[] = { 0, 1e-30f, 1e-6f, 1, 1e6f, 1e30f };
        everyPixel(region.window, [&](int x, int y) {
            in.objectId.at(x, y) = 1;
            Pixels::pair(in.slopes, x, y, values[x % 6], values[y % 6]);
            Pixels::pair(in.reflectors, x, y, values[x % 6], values[y % 6]);
            in.pixelSize.at(x, y) = values[x / 6];
            in.gloss.at(x, y) = lobe(values[y / 6], y % 2 == 0);
            Pixels::pair(in.confusion, x, y, (x + y) % 3 == 0 ? -1e4f : 1e4f, y % 4 == 0 ? 0 : 1e4f);
        });
        for (const float mu : { 1e-3f, 1.0f, 1e30f }) {
            const Found all[] = { shadows(frame, in, mu, 0), shadows(frame, in, mu, 0.5f),
                shadows(frame, in, mu, 1e30f), reflectors(frame, in, mu, WEDGE_COMPONENT_DIFFUSE),
                reflectors(frame, in, mu, WEDGE_COMPONENT_GLOSSY) };
            for (const Found& found : all)
                everyPixel(region.window, [&](int x, int y) {
                    REQUIRE(std::isfinite(found.beta.at(x, y)));
                    REQUIRE((found.beta.at(x, y) == -1 || found.beta.at(x, y) >= 0));
                    REQUIRE(std::isfinite(found.demand.at(x, y)));
                    REQUIRE(found.demand.at(x, y) >= 0.25f);
                });
        }
    });
}
