// How far filtered pixels fall back, and what is shown of them then: against the same in double.
#include "kernels/shared/packed.h"
#include "tests/pass_bench.h"

#include <limits>
#include <optional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// To what 16 bits hold, as kernels have it.
float rounded(double x) { return shared::unpackShort(shared::packShort(static_cast<float>(x))); }

struct Images {
    Planes<float> filtered, noisy, deviation, variance; ///< no variance: none was gathered
    Planes<std::uint32_t> objectId;

    /// Pixels of two objects and none; filters are off by `bias`, in turns up and down where it is `uneven`, samples by
    /// noise of deviation `noise`.
    Images(const render::PlaneLayout& layout, std::mt19937& random, double bias, double noise, bool uneven = false)
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
                filtered.setVector(x, y, glm::dvec3(1 + (uneven && (x + y) % 2 == 0 ? -bias : bias)));
                noisy.setVector(x, y, glm::dvec3(1 + off));
                deviation.at(x, y) = rounded(noise * gauss(random));
                variance.at(x, y) = rounded(noise * noise * uniform(random, 0, 3));
                if (objectId.at(x, y) == 0)
                    filtered.setVector(x, y, glm::dvec3(std::nan("")));
            }
    }
};

/// A frame that filters light and paths, of one receiver a pixel, or, where pixels do not count for themselves
/// (`others`), of several.
class FallbackFrame : public DeclaredFrame {
public:
    FallbackFrame(const device::Device& device, const render::PlaneLayout& size, bool ofOthers)
        : DeclaredFrame(device, smallScene(), settings(size, ofOthers), true)
        , others(ofOthers)
    {
    }

    const bool others;

private:
    static render::Settings settings(const render::PlaneLayout& size, bool ofOthers)
    {
        render::Settings out =
            sized(render::axisAligned(16), static_cast<int>(size.width), static_cast<int>(size.height));
        out.bounces = 1;
        out.antialias = ofOthers;
        return out;
    }
};

/// Differences of the whole image, and what is shown of a window of it; gathered: whether variances are, too.
Planes<float> fallBack(FallbackFrame& frame, const Images& in, bool gathered, Planes<float>* found = nullptr,
    const std::optional<Window>& window = {})
{
    // One light of two, or paths; pixels of one receiver have one sum of lights.
    const std::size_t nth = !gathered ? 0 : frame.others ? 2 : 1;
    PassBench differences(frame, "fallbackDifferences", "fallback", nth);
    REQUIRE(differences.has("variance") == gathered);
    REQUIRE(differences.has("texture") == frame.others);
    const std::size_t size = frame.layout.size;
    std::vector<float> filtered = in.filtered.values; // of one number they are grey
    filtered.resize(differences.own<std::uint32_t>("values") * size);
    differences.plane("filtered", filtered);
    differences.plane("noisy", in.noisy);
    differences.plane("deviation", in.deviation);
    if (gathered)
        differences.plane("variance", in.variance);
    if (frame.others)
        differences.plane("texture", std::vector<float>(3 * size, 1.0f));
    differences.run();
    if (found != nullptr)
        *found = differences.pixels<float>("differences");
    PassBench ownShares(frame, "ownShares", "fallback", nth);
    ownShares.plane("differences", differences.read<float>("differences"));
    ownShares.plane("objectId", in.objectId);
    if (window)
        ownShares.window(*window);
    ownShares.run();
    if (frame.others) {
        const Planes<float> share = ownShares.pixels<float>("shares");
        Planes<float> out = in.filtered;
        everyPixel(frame.layout, [&](int x, int y) {
            for (std::size_t c = 0; c < 3; ++c) {
                const float f = in.filtered.at(x, y, c) * (1 + share.at(x, y, 1));
                out.at(x, y, c) = f + share.at(x, y, 0) * (in.noisy.at(x, y, c) - f);
            }
        });
        return out;
    }
    PassBench reflected(frame, "addReflected", "composite", nth);
    reflected.plane("light", in.filtered);
    reflected.plane("noisy", in.noisy);
    reflected.plane("objectId", in.objectId);
    reflected.plane("shares", ownShares.read<float>("shares"));
    if (window)
        reflected.window(*window);
    reflected.run();
    auto out = reflected.pixels<float>("reflected");
    const auto sum = reflected.pixels<float>("sum");
    everyPixel(frame.layout, [&](int x, int y) {
        if (in.objectId.at(x, y) == 0 || std::isfinite(out.at(x, y)))
            REQUIRE(sum.at(x, y) == (in.objectId.at(x, y) != 0 ? out.at(x, y) : 0.0f));
    });
    return out;
}

double squared(double x) { return x * x; }

/// What is summed of a pixel: as it is in double, and as kernels have it in 16 bits.
struct Summed {
    double d, variance, level, gathered;
};
Summed summed(const Images& in, int x, int y)
{
    return { in.noisy.at(x, y) - in.filtered.at(x, y), squared(in.deviation.at(x, y)), in.filtered.at(x, y),
        in.variance.at(x, y) };
}
Summed summed(const Planes<float>& found, int x, int y, bool gathered)
{
    return { found.at(x, y, 0), found.at(x, y, 1), found.at(x, y, 2), gathered ? found.at(x, y, 3) : 0.0 };
}

} // namespace

TEST_CASE("fallback: shrinks samples towards what is filtered by the noise and difference of the object around")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto& [width, height, gathered, others] :
            { std::tuple(1, 1, false, false), { 1, 9, false, false }, { 41, 23, false, false }, { 41, 23, true, false },
                { 1, 1, false, true }, { 41, 23, false, true }, { 41, 23, true, true } })
            for (const auto& [bias, noise, uneven] :
                { std::tuple(0.0, 0.1, false), { 0.1, 0.1, false }, { 0.3, 0.1, false }, { 0.2, 0.0, false },
                    { 0.0, 0.0, false }, { 0.1, 0.1, true }, { 0.3, 0.1, true }, { 0.2, 0.0, true } }) {
                const render::PlaneLayout layout(width, height);
                std::mt19937 random(7);
                const Images in(layout, random, bias, noise, uneven);
                FallbackFrame frame(device, layout, others);
                Planes<float> differences(layout, 1, 0.0f);
                const Planes<float> found = fallBack(frame, in, gathered, &differences);
                int kept = 0, scaled = 0, replaced = 0, between = 0;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        if (in.objectId.at(x, y) == 0)
                            continue;
                        const Summed exact = summed(in, x, y), kept16 = summed(differences, x, y, gathered);
                        REQUIRE(std::fabs(kept16.d - exact.d) <= 0.004 * std::fabs(exact.d) + 1e-6);
                        REQUIRE(std::fabs(kept16.variance - exact.variance) <= 0.004 * exact.variance);
                        REQUIRE(std::fabs(kept16.level - exact.level) <= 0.004 * std::fabs(exact.level));
                        if (gathered)
                            REQUIRE(std::fabs(kept16.gathered - exact.gathered) <= 0.004 * exact.gathered);
                        double variance = 0, around = 0, d = 0, f1 = 0, dd = 0, df = 0, ff = 0;
                        const auto add = [&, withGathered = gathered](int px, int py) {
                            const Summed there = summed(differences, px, py, withGathered);
                            const double level = there.level, off = there.d;
                            variance += there.variance;
                            around += there.gathered;
                            d += off;
                            f1 += level;
                            dd += off * off;
                            df += off * level;
                            ff += level * level;
                        };
                        for (int py = std::max(0, y - 3); py <= std::min(height - 1, y + 3); ++py)
                            for (int px = std::max(0, x - 3); px <= std::min(width - 1, x + 3); ++px)
                                if (in.objectId.at(px, py) == in.objectId.at(x, y) && !(others && px == x && py == y))
                                    add(px, py);
                        if (others && dd == 0)
                            add(x, y);
                        if (gathered)
                            variance = std::max(variance, around);
                        const double ratio = d != 0 ? std::max(0.0, 1 - 6 * variance / (d * d)) * d / f1 : 0;
                        const double left = dd - 2 * ratio * df + ratio * ratio * ff;
                        // Where the ratio explains all of it the rest is rounding, and the share anything.
                        const bool explained = left <= 1e-5 * dd;
                        const double share = !explained ? std::max(0.0, 1 - 2 * variance / left) : 0;
                        scaled += ratio != 0 ? 1 : 0;
                        const double f = in.filtered.at(x, y), u = in.noisy.at(x, y);
                        const double scaledUp = f + ratio * f, more = share * (u - scaledUp);
                        // Shares of terms have 16 bits.
                        const double rounding = others ? 0.004 * (std::fabs(ratio * f) + std::fabs(more)) : 0.0;
                        const double rest = explained ? std::fabs(u - scaledUp) : 0.0;
                        for (std::size_t c = 0; c < 3; ++c)
                            REQUIRE(std::fabs(found.at(x, y, c) - (scaledUp + more)) < 1e-5 + rounding + rest);
                        (share == 0 ? kept : share == 1 ? replaced : between) += 1;
                    }
                if (width > 1) {
                    // Copies: a binding cannot be captured.
                    const double off = bias, spread = noise;
                    CAPTURE(off);
                    CAPTURE(spread);
                    // Noise alone is seldom taken for bias, bias of all pixels always for what it is.
                    if (bias == 0)
                        CHECK(kept > 10 * (between + replaced));
                    if (bias == 0 && noise > 0)
                        CHECK(scaled < 250);
                    if (bias > 0 && !uneven)
                        CHECK(scaled > 700);
                    if (uneven && noise == 0)
                        CHECK(replaced > 400);
                    if (uneven && bias == 0.3)
                        CHECK(between > 400);
                }
            }
    });
}

TEST_CASE("fallback: pixels of a rectangle are those of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        const render::PlaneLayout layout(53, 31);
        std::mt19937 random(9);
        const Images in(layout, random, 0.2, 0.1);
        FallbackFrame frame(device, layout, false);
        const Window window { 16, 7, 32, 19 };
        const Planes<float> whole = fallBack(frame, in, true), found = fallBack(frame, in, true, nullptr, window);
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                if (in.objectId.at(x, y) != 0)
                    REQUIRE(found.at(x, y) == whole.at(x, y));
    });
}

TEST_CASE("fallback: numbers that are none stay where they are")
{
    onEveryDevice([](const device::Device& device) {
        const render::PlaneLayout layout(41, 23);
        for (const bool others : { false, true }) {
            FallbackFrame frame(device, layout, others);
            for (const bool gathered : { false, true })
                for (const int where : { 0, 1, 2 })
                    for (const float wrong : { std::numeric_limits<float>::infinity(), std::nanf("") }) {
                        CAPTURE(others);
                        CAPTURE(gathered);
                        CAPTURE(where);
                        CAPTURE(wrong);
                        std::mt19937 random(7);
                        Images in(layout, random, 0.3, 0.1);
                        everyPixel(layout, [&](int x, int y) { in.objectId.at(x, y) = 1; });
                        everyPixel(layout, [&](int x, int y) { in.filtered.setVector(x, y, glm::dvec3(1.3)); });
                        const int badX = 20, badY = 11;
                        if (where == 2)
                            in.deviation.at(badX, badY) = wrong;
                        else
                            (where == 0 ? in.filtered : in.noisy).setVector(badX, badY, glm::dvec3(wrong));
                        const Planes<float> found = fallBack(frame, in, gathered);
                        everyPixel(layout, [&](int x, int y) {
                            if (x != badX || y != badY)
                                REQUIRE(std::isfinite(found.at(x, y)));
                        });
                    }
        }
    });
}
