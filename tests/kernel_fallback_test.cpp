// fallback.cl alone: against the same in double.
#include "kernels/shared/filter_params.h"
#include "tests/render_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

struct Images {
    Planes<float> filtered, noisy, deviation, variance; ///< no variance: none was gathered
    Planes<std::uint32_t> objectId;

    /// Pixels of two objects and none; filters are off by `bias`, samples by noise of deviation `noise`.
    Images(const render::PlaneLayout& layout, std::mt19937& random, double bias, double noise)
        : filtered(layout, 3, 0.0f)
        , noisy(layout, 3, 0.0f)
        , deviation(layout, 1, 0.0f)
        , variance(layout, 1, 0.0f)
        , objectId(layout, 1, 0u)
    {
        std::normal_distribution<double> gauss;
        for (int y = 0; y < static_cast<int>(layout.height); ++y)
            for (int x = 0; x < static_cast<int>(layout.width); ++x) {
                objectId.at(x, y) = random() % 7 == 0 ? 0 : 1 + static_cast<std::uint32_t>(x / 9 + y / 5) % 2;
                const double off = noise * gauss(random);
                filtered.setVector(x, y, glm::dvec3(1 + bias));
                noisy.setVector(x, y, glm::dvec3(1 + off));
                deviation.at(x, y) = static_cast<float>(noise * gauss(random));
                variance.at(x, y) = static_cast<float>(noise * noise * uniform(random, 0, 3));
                if (objectId.at(x, y) == 0)
                    filtered.setVector(x, y, glm::dvec3(std::nan("")));
            }
    }
};

shared::AnalysisParams paramsOf(const render::PlaneLayout& layout)
{
    shared::AnalysisParams p {};
    p.x1 = p.width = layout.width;
    p.y1 = p.height = layout.height;
    p.stride = layout.stride;
    p.planeSize = static_cast<std::uint32_t>(layout.size);
    return p;
}

/// Squares of the whole image, and what is shown of the rectangle; gathered: whether variances are, too; others: pixels
/// do not count for themselves.
Planes<float> fallBack(
    KernelBench& bench, const shared::AnalysisParams& rectangle, const Images& in, bool gathered, bool others = false)
{
    const auto filtered = bench.buffer(in.filtered.values), noisy = bench.buffer(in.noisy.values);
    const auto squares = bench.filled((gathered ? 3 : 2) * in.filtered.layout.size, 0.0f);
    const std::uint32_t flag = gathered ? 1 : 0;
    bench.passes.rows("fallback", device::PassKind::Filter, "analysis/fallback.cl", "fallbackSquares",
        paramsOf(in.filtered.layout), WEDGE_BLOCK_PIXELS, flag, filtered, noisy, bench.buffer(in.deviation.values),
        bench.buffer(in.variance.values), squares);
    if (others) {
        const auto shares = bench.filled(in.filtered.layout.size, 0.0f);
        bench.passes.rows("fallback", device::PassKind::Filter, "analysis/fallback.cl", "ownShares", rectangle,
            WEDGE_BLOCK_PIXELS, flag, squares, bench.buffer(in.objectId.values), shares);
        Planes<float> out = in.filtered;
        const auto share = planesOf(in.filtered.layout, bench.read(shares));
        for (std::size_t c = 0; c < 3; ++c)
            for (int y = 0; y < static_cast<int>(in.filtered.layout.height); ++y)
                for (int x = 0; x < static_cast<int>(in.filtered.layout.width); ++x)
                    out.at(x, y, c) += share.at(x, y) * (in.noisy.at(x, y, c) - in.filtered.at(x, y, c));
        return out;
    }
    bench.passes.rows("fallback", device::PassKind::Filter, "analysis/fallback.cl", "fallBack", rectangle,
        WEDGE_BLOCK_PIXELS, flag, squares, bench.buffer(in.objectId.values), noisy, filtered);
    return planesOf(in.filtered.layout, bench.read(filtered));
}

double squared(double x) { return x * x; }

} // namespace

TEST_CASE("fallback: shrinks samples towards what is filtered by the noise and difference of the object around")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        for (const auto& [width, height, gathered, others] :
            { std::tuple(1, 1, false, false), { 1, 9, false, false }, { 41, 23, false, false }, { 41, 23, true, false },
                { 1, 1, false, true }, { 41, 23, false, true }, { 41, 23, true, true } })
            for (const auto& [bias, noise] :
                { std::pair(0.0, 0.1), { 0.1, 0.1 }, { 0.3, 0.1 }, { 0.2, 0.0 }, { 0.0, 0.0 } }) {
                const render::PlaneLayout layout(width, height);
                std::mt19937 random(7);
                const Images in(layout, random, bias, noise);
                const Planes<float> found = fallBack(bench, paramsOf(layout), in, gathered, others);
                int kept = 0, replaced = 0, between = 0;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        if (in.objectId.at(x, y) == 0)
                            continue;
                        double variance = 0, difference = 0, around = 0;
                        const auto add = [&](int px, int py) {
                            variance += squared(in.deviation.at(px, py));
                            around += in.variance.at(px, py);
                            difference += squared(in.noisy.at(px, py) - in.filtered.at(px, py));
                        };
                        for (int py = std::max(0, y - 3); py <= std::min(height - 1, y + 3); ++py)
                            for (int px = std::max(0, x - 3); px <= std::min(width - 1, x + 3); ++px)
                                if (in.objectId.at(px, py) == in.objectId.at(x, y) && !(others && px == x && py == y))
                                    add(px, py);
                        if (difference == 0) {
                            variance = around = 0;
                            add(x, y);
                        }
                        if (gathered)
                            variance = std::max(variance, around);
                        const double share = difference > 0 ? std::max(0.0, 1 - 2 * variance / difference) : 0;
                        const double f = in.filtered.at(x, y), u = in.noisy.at(x, y);
                        for (std::size_t c = 0; c < 3; ++c)
                            REQUIRE(std::fabs(found.at(x, y, c) - (f + share * (u - f))) < 1e-5);
                        (share == 0 ? kept : share == 1 ? replaced : between) += 1;
                    }
                if (width > 1) {
                    // Copies: a binding cannot be captured.
                    const double off = bias, spread = noise;
                    CAPTURE(off);
                    CAPTURE(spread);
                    // Noise alone is hardly ever taken for bias, bias without noise always for what it is.
                    if (bias == 0)
                        CHECK(kept > 10 * (between + replaced));
                    if (noise == 0 && bias > 0)
                        CHECK(replaced > 400);
                    if (bias == 0.3)
                        CHECK(between > 400);
                }
            }
    });
}

TEST_CASE("fallback: pixels of a rectangle are those of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const render::PlaneLayout layout(53, 31);
        std::mt19937 random(9);
        const Images in(layout, random, 0.2, 0.1);
        const Planes<float> whole = fallBack(bench, paramsOf(layout), in, true);
        shared::AnalysisParams p = paramsOf(layout);
        p.x0 = 16;
        p.x1 = 32;
        p.y0 = 7;
        p.y1 = 19;
        const Planes<float> found = fallBack(bench, p, in, true);
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 53; ++x) {
                const bool inside = x >= 16 && x < 32 && y >= 7 && y < 19;
                if (in.objectId.at(x, y) != 0)
                    REQUIRE(found.at(x, y) == (inside ? whole : in.filtered).at(x, y));
            }
    });
}
