// published.cl alone: which pixels are taken apart, and how demands become counts.
#include "tests/distributed_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

Planes<std::uint32_t> counts(DeclaredFrame& frame, const Region& region, std::uint32_t most,
    const Planes<float>& demand, const Planes<std::uint32_t>& least, const Planes<std::uint32_t>& taken)
{
    RegionPass<std::uint32_t> pass(frame, "publishedCounts", { "wanted" });
    pass.value("most", most);
    pass.plane("demand", demand);
    pass.plane("least", least);
    pass.plane("taken", taken);
    pass.runIn(region, paramsOf(region));
    return pass.pixels<std::uint32_t>("wanted");
}

Planes<std::uint32_t> constant(const Region& region, std::uint32_t value)
{
    return filledPlanes(region, 1, 1u << 20, [&](int, int, std::size_t) { return value; });
}

} // namespace

TEST_CASE("flags (5.30): |L - k E| below the threshold, of one value and of three, never where never")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full, render::asPublished());
        for (const Region& region : regions())
            for (const std::uint32_t values : { 1u, 3u })
                for (const std::uint32_t never : { 0u, 1u }) {
                    std::mt19937 random(values + never);
                    const auto any = [&](int, int, std::size_t) { return uniform(random); };
                    const auto texture = filledPlanes(region, 3, 1e30f, any),
                               value = filledPlanes(region, 3, 1e30f, any);
                    // Off by up to 0.01 in each channel, to either side, and now and then by much.
                    const auto radiance = filledPlanes(region, 3, 1e30f, [&](int x, int y, std::size_t c) {
                        const double own = texture.at(x, y, c) * value.at(x, y, values == 3 ? c : 0);
                        return own + uniform(random, -0.01, 0.01) * (random() % 8 == 0 ? 30 : 1);
                    });
                    shared::DistributedParams p = paramsOf(region);
                    p.values = values;
                    p.never = never;
                    RegionPass pass(frame, "publishedFlags", { "flags" });
                    pass.plane("texture", texture);
                    pass.plane("value", value);
                    pass.plane("termRadiance", radiance);
                    pass.runIn(region, p);
                    const auto found = pass.floats("flags");
                    everyPixel(region.window, [&](int x, int y) {
                        const glm::dvec3 arrives = values == 3 ? value.vector(x, y) : glm::dvec3(value.at(x, y));
                        const double error = glm::length(radiance.vector(x, y) - texture.vector(x, y) * arrives);
                        if (std::fabs(error - 0.01) > 1e-6)
                            REQUIRE(found.at(x, y) == (never == 0 && error < 0.01 ? 1 : 0));
                    });
                }
    });
}

TEST_CASE("counts are the largest demand of 3x3 pixels rounded up, within bounds")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full, render::asPublished());
        unsigned seed = 0;
        for (const Region& region : regions())
            for (const std::uint32_t most : { 1u, 40u, 512u }) {
                std::mt19937 random(++seed);
                const auto demand = filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) {
                    return random() % 4 == 0 ? std::floor(uniform(random, 0, 90)) : uniform(random, 0, 30);
                });
                const auto few = [&](int, int, std::size_t) { return random() % 70; };
                const auto least = filledPlanes(region, 1, 1u << 20, few),
                           taken = filledPlanes(region, 1, 1u << 20, few);
                const Planes<std::uint32_t> found = counts(frame, region, most, demand, least, taken);
                everyPixel(region.window, [&](int x, int y) {
                    double largest = 0;
                    for (int py = y - 1; py <= y + 1; ++py)
                        for (int px = x - 1; px <= x + 1; ++px)
                            largest = region.contains(px, py) ? std::max<double>(largest, demand.at(px, py)) : largest;
                    const auto rounded = static_cast<std::uint32_t>(std::min<double>(std::ceil(largest), most));
                    REQUIRE(found.at(x, y) == std::max({ rounded, least.at(x, y), taken.at(x, y) }));
                });
            }
    });
}

TEST_CASE("counts: in focus one, next to a demand as many as it, of endless and undefined ones no more than the most")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full, render::asPublished());
        const Region region(9, 9);
        auto demand = filledPlanes(region, 1, 1e30f, [](int, int, std::size_t) { return 1; });
        demand.at(4, 4) = 7.01f;
        const auto peak = counts(frame, region, 512, demand, constant(region, 0), constant(region, 0));
        everyPixel(region.window,
            [&](int x, int y) { REQUIRE(peak.at(x, y) == (std::abs(x - 4) <= 1 && std::abs(y - 4) <= 1 ? 8 : 1)); });
        for (const float endless : { 1e30f, std::numeric_limits<float>::infinity() }) {
            demand.at(4, 4) = endless;
            CHECK(counts(frame, region, 512, demand, constant(region, 2), constant(region, 0)).at(5, 5) == 512);
        }
        demand.at(4, 4) = std::numeric_limits<float>::quiet_NaN();
        CHECK(counts(frame, region, 512, demand, constant(region, 2), constant(region, 0)).at(5, 5) == 2);
    });
}
