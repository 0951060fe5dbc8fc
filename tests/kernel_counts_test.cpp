// demand.cl and counts.cl alone: from variances to demands, and from those to counts.
#include "kernels/shared/filter_params.h"
#include "tests/render_support.h"

#include <algorithm>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

shared::AnalysisParams paramsFor(const render::PlaneLayout& layout)
{
    shared::AnalysisParams p {};
    p.x1 = p.width = layout.width;
    p.y1 = p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    p.countCap = 256;
    p.leastCount = 9;
    p.countExponent = 0.4f;
    p.varianceFloor = 0.004f;
    p.varianceSpread = 0.25f;
    return p;
}

/// demandHistogram, solveCountScale and countsFromDemand one after the other.
Planes<std::uint32_t> countsOf(KernelBench& bench, const Planes<float>& demand, const Planes<std::uint32_t>& objectId,
    float mean, std::uint32_t cap)
{
    shared::AnalysisParams p = paramsFor(demand.layout);
    p.countCap = cap;
    constexpr std::size_t bins = WEDGE_DEMAND_BINS, stripes = WEDGE_DEMAND_STRIPES;
    // Garbage in what they work in, as after an earlier frame.
    const auto counts = bench.filled(bins * stripes, 12345u), shaded = bench.filled(stripes, 99u),
               binCounts = bench.filled(bins, 5u);
    const auto sums = bench.filled(bins * stripes, 1e9f), binSums = bench.filled(bins, 3.0f),
               scale = bench.filled(1, -1.0f);
    const auto demands = bench.buffer(demand.values);
    const auto objects = bench.buffer(objectId.values);
    device::Kernel& histogram = bench.passes.find("analysis/counts.cl", "demandHistogram");
    histogram.setArgs(p, demands, objects, counts, sums, shaded);
    bench.queue.launch("counts", device::PassKind::Analysis, histogram, stripes, 1);
    device::Kernel& solve = bench.passes.find("analysis/counts.cl", "solveCountScale");
    solve.setArgs(mean, 9.0f, static_cast<float>(cap), counts, sums, shaded, binCounts, binSums, scale);
    bench.queue.launch("counts", device::PassKind::Analysis, solve, 1, 1);
    const auto wanted = bench.filled(demand.layout.size, 777u);
    bench.passes.rows("counts", device::PassKind::Analysis, "analysis/counts.cl", "countsFromDemand", p, 1, demands,
        scale, objects, wanted);
    return planesOf(demand.layout, bench.read(wanted));
}

/// Demands 2^normal(centre, spread) at a fraction of the pixels, holes in the image.
struct Demands {
    Planes<float> demand;
    Planes<std::uint32_t> objectId;

    Demands(int width, int height, double centre, double spread, double fraction, unsigned seed = 3)
        : demand(render::PlaneLayout(width, height), 1, 0.0f)
        , objectId(demand.layout, 1, 0u)
    {
        std::mt19937 random(seed);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                objectId.at(x, y) = random() % 7 == 0 && width > 1 ? 0 : 1;
                const bool wants = uniform(random) < fraction && objectId.at(x, y) != 0;
                double normal = -6;
                for (int k = 0; k < 12; ++k)
                    normal += uniform(random);
                demand.at(x, y) = wants ? static_cast<float>(std::exp2(centre + spread * normal)) : 0.0f;
            }
    }
};

struct Summary {
    double mean = 0;
    std::uint32_t least = 1u << 30, most = 0;
    bool holesEmpty = true;
};

Summary summarise(const Planes<std::uint32_t>& counts, const Planes<std::uint32_t>& objectId)
{
    Summary s;
    double pixels = 0;
    for (int y = 0; y < static_cast<int>(counts.layout.height); ++y)
        for (int x = 0; x < static_cast<int>(counts.layout.width); ++x) {
            const std::uint32_t n = counts.at(x, y);
            if (objectId.at(x, y) == 0) {
                s.holesEmpty = s.holesEmpty && n == 0;
                continue;
            }
            s.mean += n;
            pixels += 1;
            s.least = std::min(s.least, n);
            s.most = std::max(s.most, n);
        }
    s.mean /= std::max(pixels, 1.0);
    return s;
}

} // namespace

TEST_CASE("no demand at all: nine samples each; nothing shaded: none")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        Demands in(37, 21, 0, 1, 0.0);
        const Summary s = summarise(countsOf(bench, in.demand, in.objectId, 28, 256), in.objectId);
        CHECK(s.least == 9);
        CHECK(s.most == 9);
        CHECK(s.holesEmpty);
        for (std::uint32_t& id : in.objectId.values)
            id = 0;
        const Planes<std::uint32_t> none = countsOf(bench, in.demand, in.objectId, 28, 256);
        for (int x = 0; x < 37; ++x)
            REQUIRE(none.at(x, 5) == 0);
    });
}

TEST_CASE("a single pixel gets the mean itself, up to the cap")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const double centre : { -20.0, -5.0, 0.0, 6.0 }) {
            const Demands one(1, 1, centre, 0, 1);
            CAPTURE(centre);
            CHECK(std::fabs(countsOf(bench, one.demand, one.objectId, 28, 256).at(0, 0) - 28.0) <= 1);
            CHECK(countsOf(bench, one.demand, one.objectId, 1000, 256).at(0, 0) == 256);
            CHECK(countsOf(bench, one.demand, one.objectId, 2, 256).at(0, 0) == 9);
        }
    });
}

TEST_CASE("the mean count is what was asked for, within 1 %, and counts stay within 9 and the cap")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const double centre : { -15.0, -6.0, -1.0 })
            for (const double spread : { 0.01, 0.5, 2.5 })
                for (const double fraction : { 0.4, 1.0 })
                    for (const float mean : { 12.0f, 28.0f, 64.0f }) {
                        const Demands in(93, 61, centre, spread, fraction);
                        const Summary s = summarise(countsOf(bench, in.demand, in.objectId, mean, 2560), in.objectId);
                        CAPTURE(centre);
                        CAPTURE(spread);
                        CAPTURE(fraction);
                        CHECK(s.mean == doctest::Approx(mean).epsilon(0.01));
                        CHECK(s.least >= 9);
                        CHECK(s.most <= 2560);
                        CHECK(s.holesEmpty);
                    }
        const Demands wild(93, 61, 0, 6, 1);
        const Summary s = summarise(countsOf(bench, wild.demand, wild.objectId, 64, 100), wild.objectId);
        CHECK(s.mean == doctest::Approx(64).epsilon(0.01));
        CHECK(s.most == 100);
        CHECK(s.least == 9);
    });
}

TEST_CASE("counts follow the demand")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const Demands in(64, 40, 0, 1, 1);
        const Planes<std::uint32_t> counts = countsOf(bench, in.demand, in.objectId, 40, 256);
        for (int y = 0; y < 40; ++y)
            for (int x = 1; x < 64; ++x)
                if (in.objectId.at(x, y) != 0 && in.objectId.at(x - 1, y) != 0
                    && in.demand.at(x, y) > in.demand.at(x - 1, y))
                    REQUIRE(counts.at(x, y) >= counts.at(x - 1, y));
    });
}

TEST_CASE(
    "uncertainty: variance over equal pixels, of visibilities p (1 - p) and no less than the floor; -1 where there "
    "are no samples, or no slopes")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const auto& [width, height] : { std::pair(1, 1), { 19, 1 }, { 1, 7 }, { 50, 27 } }) {
            const render::PlaneLayout layout(width, height);
            const shared::AnalysisParams p = paramsFor(layout);
            Planes<float> filtered(layout, 1, 0.5f), effective(layout, 1, 1.0f), beta(layout, 1, 1.0f);
            std::mt19937 random(8);
            everyPixel(layout, [&](int x, int y) {
                filtered.at(x, y) = static_cast<float>(
                    random() % 3 == 0 ? uniform(random, -0.001, 1.001) : std::round(uniform(random)));
                effective.at(x, y) = static_cast<float>(uniform(random, 0, 40));
                beta.at(x, y) = static_cast<float>(static_cast<int>(random() % 3) - 1) * 0.1f;
            });
            const auto seen = bench.buffer(filtered.values), gathered = bench.buffer(effective.values),
                       widths = bench.buffer(beta.values);
            const auto run = [&](const char* kernel) {
                const auto out = bench.filled(layout.size, -7.0f);
                bench.passes.rows("counts", device::PassKind::Analysis, "analysis/demand.cl", kernel, p,
                    WEDGE_BLOCK_PIXELS, seen, gathered, widths, out);
                return planesOf(layout, bench.read(out));
            };
            const Planes<float> ofLight = run("visibilityUncertainty"), ofPaths = run("uncertaintyOf");
            everyPixel(layout, [&](int x, int y) {
                const double k = std::max<double>(effective.at(x, y), 1);
                const double visible = std::clamp<double>(filtered.at(x, y), 0, 1);
                const double v = std::max(visible * (1 - visible), 0.004);
                REQUIRE(ofLight.at(x, y) == doctest::Approx(beta.at(x, y) > 0 ? v / k : -1.0).epsilon(1e-5));
                REQUIRE(ofPaths.at(x, y)
                    == doctest::Approx(beta.at(x, y) >= 0 ? filtered.at(x, y) / k : -1.0).epsilon(1e-5));
            });
        }
    });
}

TEST_CASE(
    "demand: a power of the neighbours' mean uncertainty, at least a fraction of the largest within 5x5; of its own "
    "where that is asked for, or there are no others; of one object, or of all pixels of the image")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const auto& [width, height] : { std::pair(1, 1), { 1, 9 }, { 40, 21 }, { 48, 3 } })
            for (const double dark : { 0.2, 1.0 }) {
                // What lies beside and below the image does not count.
                const render::PlaneLayout layout(width, height + 2);
                Planes<float> uncertainty(layout, 1, 1e30f);
                Planes<std::uint32_t> objectId(layout, 1, 1u);
                std::mt19937 random(8);
                everyPixel(layout, [&](int x, int y) {
                    objectId.at(x, y) = random() % 6 == 0 ? 0 : 1 + static_cast<std::uint32_t>(x / 9 + y / 7) % 2;
                    uncertainty.at(x, y) = random() % 8 == 0 ? -1.0f
                        : uniform(random) < dark             ? (random() % 2 == 0 ? 0.0f : 1e-31f)
                                                 : static_cast<float>(std::pow(10.0, uniform(random, -25, 3)));
                });
                shared::AnalysisParams p = paramsFor(layout);
                p.y1 = p.height = static_cast<std::uint32_t>(height);
                for (const std::uint32_t which : { 0u, 1u, 2u, 3u }) {
                    const std::uint32_t oneObject = which & 1u, ownToo = which >> 1;
                    const auto out = bench.filled(layout.size, -7.0f);
                    bench.passes.rows("counts", device::PassKind::Analysis, "analysis/demand.cl", "demandOf", p,
                        WEDGE_BLOCK_PIXELS, oneObject, ownToo, bench.buffer(uncertainty.values),
                        bench.buffer(objectId.values), out);
                    const Planes<float> found = planesOf(layout, bench.read(out));
                    everyPixel(layout, [&](int x, int y) {
                        if (y >= height)
                            return;
                        double largest = 0, sum = 0;
                        int nearest = 0, within = 0;
                        for (int qy = std::max(0, y - 2); qy <= std::min(height - 1, y + 2); ++qy)
                            for (int qx = std::max(0, x - 2); qx <= std::min(width - 1, x + 2); ++qx) {
                                const double u = uncertainty.at(qx, qy);
                                const bool other = objectId.at(qx, qy) != objectId.at(x, y);
                                if (u < 0 || (oneObject != 0 && other) || (qx == x && qy == y))
                                    continue;
                                largest = std::max(largest, u);
                                ++within;
                                if (std::abs(qx - x) <= 1 && std::abs(qy - y) <= 1) {
                                    sum += u;
                                    ++nearest;
                                }
                            }
                        const double own = uncertainty.at(x, y);
                        const double others = std::max(sum / std::max(nearest, 1), 0.25 * largest);
                        const double u = within == 0 ? own : ownToo != 0 ? std::max(others, own) : others;
                        const double expected = own >= 0 && u > 1e-30 ? std::pow(u, 0.4) : 0.0;
                        REQUIRE(found.at(x, y) == doctest::Approx(expected).epsilon(1e-3));
                    });
                }
            }
    });
}

TEST_CASE("uniformCounts gives each shaded pixel of its window the same count")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const Demands in(40, 12, 0, 1, 1);
        shared::AnalysisParams p = paramsFor(in.demand.layout);
        p.x0 = 16;
        p.y0 = 3;
        p.y1 = 9;
        const auto wanted = bench.filled(in.demand.layout.size, 777u);
        bench.passes.rows("counts", device::PassKind::Analysis, "analysis/counts.cl", "uniformCounts", p, 1,
            std::uint32_t { 13 }, bench.buffer(in.objectId.values), wanted);
        const Planes<std::uint32_t> found = planesOf(in.demand.layout, bench.read(wanted));
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 40; ++x) {
                const bool inside = x >= 16 && y >= 3 && y < 9;
                REQUIRE(found.at(x, y) == (inside ? (in.objectId.at(x, y) != 0 ? 13u : 0u) : 777u));
            }
    });
}
