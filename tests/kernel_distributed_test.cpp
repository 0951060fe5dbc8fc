// distributed.cl alone: where texture and irradiance may be taken apart, how wide filters are, and counts of demands.
#include "tests/distributed_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

/// Least radius of circles of confusion.
double leastRadius(double low, double high)
{
    return low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
}

/// Least and largest circle of confusion: of either sign, of both, or of none at all.
Planes<float> randomConfusion(const Region& region, std::mt19937& random)
{
    auto out = filledPlanes(region, 2, 1e30f, [](int, int, std::size_t) { return 0; });
    everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
        const double low = uniform(random) * uniform(random, 0, 40), high = low + uniform(random, 0, 10);
        const auto kind = random() % 8;
        out.at(x, y) = static_cast<float>(kind == 0 ? 0 : kind < 3 ? -high : kind < 4 ? -low : low);
        out.at(x, y, 1) = static_cast<float>(kind == 0 ? 0 : kind < 3 ? -low : high);
    });
    return out;
}

/// What factoredWidths is to make of a pixel, or that a rounding decides.
struct ExpectedWidth {
    double beta;
    bool uncertain;
};

struct Widths {
    Planes<float> error, confusion, pixelSize, beta;
    Planes<std::uint32_t> objectId;

    Widths(const Region& region, std::mt19937& random)
        : error(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, -0.05, 0.07); }))
        , confusion(randomConfusion(region, random))
        , pixelSize(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 1e-3, 0.1); }))
        , beta(filledPlanes(region, 1, 1e30f,
              [&](int, int, std::size_t) {
                  return random() % 5 == 0 ? -1.0 : random() % 5 == 0 ? 0.0 : uniform(random, 0, 0.3);
              }))
        , objectId(filledPlanes(region, 1, 1u, [&](int x, int y, std::size_t) {
            return random() % 9 == 0 ? random() % 3 : 1u + static_cast<unsigned>(x / 9 + y / 7) % 2;
        }))
    {
    }
    ExpectedWidth expected(const Region& region, const shared::DistributedParams& p, int x, int y) const
    {
        const int r = static_cast<int>(p.factoringRadius);
        double sum = 0, count = 0;
        for (int py = y - r; py <= y + r; ++py)
            for (int px = x - r; px <= x + r; ++px)
                if (region.contains(px, py) && objectId.at(px, py) == objectId.at(x, y)) {
                    sum += error.at(px, py);
                    ++count;
                }
        const double mean = std::fabs(sum / count), radius = leastRadius(confusion.at(x, y), confusion.at(x, y, 1));
        const bool uncertain = std::fabs(mean - p.factoringError) < 1e-6 || std::fabs(radius - p.leastRadius) < 1e-4;
        if (p.never != 0 || mean > p.factoringError || beta.at(x, y) < 0)
            return { -1, uncertain };
        const double blurred = radius >= p.leastRadius ? p.irradianceWidth * radius * pixelSize.at(x, y) : 0;
        return { std::max<double>(beta.at(x, y), blurred), uncertain };
    }
};

/// in: becomes what the pass has of it.
Planes<float> factoredWidths(DeclaredFrame& frame, const Region& region, const shared::DistributedParams& p, Widths& in)
{
    RegionPass pass(frame, "factoredWidths", { "beta" });
    pass.plane("objectId", in.objectId);
    for (const auto& [name, plane] : { std::pair("error", &in.error), { "confusion", &in.confusion },
             { "pixelSize", &in.pixelSize }, { "beta", &in.beta } }) {
        pass.plane(name, *plane);
        *plane = pass.floats(name);
    }
    pass.runIn(region, p);
    return pass.floats("beta");
}

} // namespace

TEST_CASE("the factoring error is the signed luminance of k E - k mean(e)")
{
    const auto test = [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const auto any = [&](int, int, std::size_t) { return random() % 6 == 0 ? 0 : uniform(random); };
        auto texture = filledPlanes(region, 3, 1e30f, any), value = filledPlanes(region, 3, 1e30f, any);
        const auto plain = filledPlanes(region, 1, 1e30f, any);
        RegionPass pass(frame, "factoringError", { "error" });
        pass.plane("texture", texture);
        pass.plane("value", value);
        pass.plane("plain", plain);
        pass.runIn(region, paramsOf(region));
        texture = pass.floats("texture"); // as the formats have them
        value = pass.floats("value");
        const auto found = pass.floats("error");
        int negative = 0;
        everyPixel(region.window, [&](int x, int y) {
            const glm::dvec3 t = texture.vector(x, y);
            const double expected = luminanceOf(t * value.vector(x, y)) - luminanceOf(t) * plain.at(x, y);
            REQUIRE(agree(found.at(x, y), expected, 1e-5, 3e-7));
            negative += expected < -0.1 ? 1 : 0;
        });
        CHECK((negative > 0 || region.width * region.height < 100));
    };
    onEveryRegion(0, Kept::Full, test);
    render::Settings steps = render::axisAligned(16);
    steps.progressive = true;
    onEveryRegion(0, Kept::Lean, test, steps);
}

TEST_CASE(
    "widths: apart where the mean error around of the same object is small, and as wide as the lens blurs at least")
{
    onEveryRegion(50, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        for (const std::uint32_t radius : { 0u, 1u, 2u, 5u })
            for (const std::uint32_t never : { 0u, 1u }) {
                Widths in(region, random);
                shared::DistributedParams p = paramsOf(region);
                p.factoringRadius = radius;
                p.never = never;
                const Planes<float> found = factoredWidths(frame, region, p, in);
                everyPixel(region.window, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    const ExpectedWidth expected = in.expected(region, p, x, y);
                    if (!expected.uncertain)
                        REQUIRE(agree(found.at(x, y), expected.beta));
                });
            }
    });
}

TEST_CASE("widths: errors without a sign cancel, those of one sign do not, and other objects have no say")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        const Region region(30, 20);
        std::mt19937 random(3);
        Widths in(region, random);
        everyPixel(region.window, [&](int x, int y) {
            in.beta.at(x, y) = 0.25f;
            in.confusion.at(x, y) = in.confusion.at(x, y, 1) = 0;
            in.objectId.at(x, y) = x < 15 ? 1 : 2;
            // Of 5x5 pixels 13 and 12: 0.2 / 25 are left. On the right of the middle always the same.
            in.error.at(x, y) = x < 15 ? ((x + y) % 2 == 0 ? 0.2f : -0.2f) : (y < 10 ? 0.0101f : -0.0101f);
        });
        const Planes<float> found = factoredWidths(frame, region, paramsOf(region), in);
        everyPixel({ 2, 2, 28, 18 }, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            if (x < 13)
                REQUIRE(found.at(x, y) == 0.25f);
            if (x >= 15 && std::abs(y - 9.5) > 2)
                REQUIRE(found.at(x, y) == -1);
            if (x >= 15 && std::abs(y - 9.5) < 2)
                REQUIRE(found.at(x, y) == 0.25f);
        });
    });
}
