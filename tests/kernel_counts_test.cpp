// demand.cl and counts.cl alone: from variances to demands, and from those to counts.
#include "kernels/shared/filter_params.h"
#include "tests/distributed_support.h"

#include <algorithm>
#include <functional>
#include <optional>

using namespace wedge;
using namespace wedge::test;

namespace {

shared::AnalysisParams paramsFor(const render::PlaneLayout& layout)
{
    shared::AnalysisParams p = paramsOf(layout);
    p.countCap = 256;
    p.leastCount = 9;
    p.countExponent = 0.4f;
    p.varianceFloor = 0.004f;
    p.varianceSpread = 0.25f;
    return p;
}

/// One kind of samples, of pixels.
struct Asked {
    Planes<float> demand;
    float rays = 1, least = 9;
    std::optional<Planes<std::uint32_t>> taken = {};
    std::optional<Planes<float>> uncertainty = {};
};

/// What comes of it.
struct Scaled {
    std::vector<Planes<std::uint32_t>> counts; ///< of each kind
    std::vector<float> numbers; ///< WEDGE_SCALE_NUMBERS
};

/// The passes that make counts of demands, of a frame of one kind of samples with a mask, or of several kinds without.
class CountPasses {
public:
    CountPasses(DeclaredFrame& frame, std::size_t kinds)
        : frame_(frame)
        , kinds_(kinds)
    {
    }

    /// rays: a pixel in the mean; mask: where it is 0 there are no samples.
    Scaled run(const std::vector<Asked>& kinds, float rays, float most, const Planes<std::uint32_t>* mask = nullptr)
    {
        REQUIRE(kinds.size() == kinds_);
        Scaled out;
        PassBench first(frame_, "firstScales");
        first.run();
        out.numbers = first.read<float>("scale");
        for (int round = 0; round < WEDGE_SCALE_ROUNDS; ++round) {
            const auto [own, others] = sums("samplesAtScales", kinds, most, out.numbers, mask);
            PassBench refine(frame_, "refineScales");
            refine.value("rays", rays);
            refine.plane("sums", own);
            if (kinds_ > 1)
                refine.plane("sumsOfOthers", others);
            refine.plane("scale", out.numbers);
            refine.run();
            out.numbers = refine.read<float>("scale");
        }
        if (kinds[0].uncertainty) {
            const auto [own, others] = sums("noiseOfCounts", kinds, most, out.numbers, nullptr);
            PassBench share(frame_, "shareOfEven");
            share.plane("noise", own);
            share.plane("noiseOfOthers", others);
            share.plane("scale", out.numbers);
            share.run();
            out.numbers = share.read<float>("scale");
        }
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            PassBench pass = filled("countsFromDemand", kinds[k], k, most, out.numbers, mask);
            pass.plane("wanted", std::vector<std::uint32_t>(frame_.layout.size, 777));
            pass.run();
            out.counts.push_back(pass.pixels<std::uint32_t>("wanted"));
        }
        return out;
    }

private:
    PassBench filled(const std::string& kernel, const Asked& kind, std::size_t number, float most,
        const std::vector<float>& scale, const Planes<std::uint32_t>* mask)
    {
        PassBench pass(frame_, kernel, "", number);
        pass.value("least", kind.least);
        pass.value("most", most);
        pass.plane("scale", scale);
        pass.plane("demand", kind.demand);
        REQUIRE(pass.has("taken") == kind.taken.has_value());
        if (kind.taken)
            pass.plane("taken", *kind.taken);
        if (mask != nullptr)
            pass.plane("mask", *mask);
        return pass;
    }

    /// What a pass adds up of the first kind, and of all others.
    std::pair<std::vector<float>, std::vector<float>> sums(const std::string& kernel, const std::vector<Asked>& kinds,
        float most, const std::vector<float>& scale, const Planes<std::uint32_t>* mask)
    {
        std::vector<float> own, others;
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            PassBench pass = filled(kernel, kinds[k], k, most, scale, mask);
            pass.value("rays", kinds[k].rays);
            if (pass.has("uncertainty"))
                pass.plane("uncertainty", kinds[k].uncertainty.value());
            // Garbage of an earlier frame in what is written anew.
            pass.plane("sums", k > 1 ? others : std::vector<float>(pass.elements("sums"), 1e9f));
            pass.run();
            (k == 0 ? own : others) = pass.read<float>("sums");
        }
        return { own, others };
    }

    DeclaredFrame& frame_;
    std::size_t kinds_;
};

/// A frame of one light, one receiver a pixel.
render::Settings oneKind(int width, int height) { return sized(render::axisAligned(28), width, height); }

/// One of lights and paths.
DeclaredFrame pathsFrame(const device::Device& device, int width, int height)
{
    render::Settings settings = oneKind(width, height);
    settings.bounces = 1;
    return { device, smallScene(), settings };
}

Planes<std::uint32_t> countsOf(DeclaredFrame& frame, const Planes<float>& demand, const Planes<std::uint32_t>& objectId,
    float mean, std::uint32_t cap)
{
    return CountPasses(frame, 1).run({ { demand } }, mean, static_cast<float>(cap), &objectId).counts[0];
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
        DeclaredFrame bench(device, smallScene(), oneKind(37, 21));
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
        DeclaredFrame bench(device, smallScene(), oneKind(1, 1));
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
        DeclaredFrame bench(device, smallScene(), oneKind(93, 61));
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
        DeclaredFrame bench(device, smallScene(), oneKind(64, 40));
        const Demands in(64, 40, 0, 1, 1);
        const Planes<std::uint32_t> counts = countsOf(bench, in.demand, in.objectId, 40, 256);
        for (int y = 0; y < 40; ++y)
            for (int x = 1; x < 64; ++x)
                if (in.objectId.at(x, y) != 0 && in.objectId.at(x - 1, y) != 0
                    && in.demand.at(x, y) > in.demand.at(x - 1, y))
                    REQUIRE(counts.at(x, y) >= counts.at(x - 1, y));
    });
}

TEST_CASE("kinds of samples share one scale: their rays are what was asked for, and no count goes below what there is")
{
    onEveryDevice([](const device::Device& device) {
        const render::PlaneLayout layout(61, 47);
        MovingFrame frame(device, Kept::Full, layout);
        std::mt19937 random(11);
        CountPasses passes(frame, 4); // primary samples, those of two lights, and paths
        for (const std::uint32_t most : { 60u, 5000u })
            for (const double spread : { 0.01, 3.0, 12.0 }) {
                std::vector<Asked> kinds;
                for (std::size_t k = 0; k < 4; ++k) {
                    Asked kind { Planes<float>(layout, 1, 1e30f), k == 3 ? 2.0f : 1.0f, static_cast<float>(4 + k) };
                    kind.taken.emplace(layout, 1, 1u << 20);
                    kind.uncertainty.emplace(layout, 1, 0.0f);
                    everyPixel(layout, [&](int x, int y) {
                        const double d = std::exp2(uniform(random, -spread, spread));
                        kind.demand.at(x, y) = random() % 9 == 0 ? 0.0f : static_cast<float>(d);
                        kind.taken->at(x, y) = random() % 11 == 0 ? 90 : 8;
                    });
                    kinds.push_back(std::move(kind));
                }
                const float asked = 150;
                const Scaled found = passes.run(kinds, asked, static_cast<float>(most));
                CAPTURE(most);
                CAPTURE(spread);
                const float scale = found.numbers[WEDGE_SCALE_FOUND];
                double rays = 0, primary = 0, pixels = 0;
                for (std::size_t k = 0; k < 4; ++k)
                    everyPixel(layout, [&](int x, int y) {
                        const double n = std::max(std::clamp(static_cast<double>(scale) * kinds[k].demand.at(x, y),
                                                      double { kinds[k].least }, double { static_cast<float>(most) }),
                            static_cast<double>(kinds[k].taken->at(x, y)));
                        rays += kinds[k].rays * n;
                        primary += k == 0 ? n : 0;
                        pixels += k == 0 ? 1 : 0;
                        const std::uint32_t count = found.counts[k].at(x, y);
                        if (std::fabs(n - std::floor(n) - 0.5) > 1e-3)
                            REQUIRE(count == static_cast<std::uint32_t>(std::floor(n + 0.5)));
                    });
                CHECK(rays / pixels == doctest::Approx(asked).epsilon(0.005));
                CHECK(found.numbers[WEDGE_SCALE_MEAN] == doctest::Approx(primary / pixels).epsilon(0.005));
                CHECK(found.numbers[WEDGE_SCALE_EVEN] == 0); // nothing is uncertain
            }
    });
}

TEST_CASE("counts are even where demands say nothing of the pixels that have them")
{
    onEveryDevice([](const device::Device& device) {
        const int width = 40, height = 30;
        const render::PlaneLayout layout(width, height);
        MovingFrame frame(device, Kept::Full, layout);
        std::mt19937 random(3);
        Planes<float> found(layout, 1, 0.0f); // one of eight samples found something
        everyPixel(layout, [&](int x, int y) { found.at(x, y) = random() % 25 == 0 ? 1.0f : 0.0f; });
        const auto around = [&](int x, int y) {
            float sum = 0;
            for (int qy = std::max(0, y - 1); qy <= std::min(height - 1, y + 1); ++qy)
                for (int qx = std::max(0, x - 1); qx <= std::min(width - 1, x + 1); ++qx)
                    sum += qx == x && qy == y ? 0.0f : found.at(qx, qy);
            return sum;
        };
        const auto numbers = [&](const auto& demand, const auto& uncertainty, float ofOthers) {
            std::vector<Asked> kinds;
            for (std::size_t k = 0; k < 4; ++k) {
                Asked kind { Planes<float>(layout, 1, 0.0f) };
                kind.taken.emplace(layout, 1, 8u);
                if (k == 0)
                    kind.taken->at(5, 7) = kind.taken->at(30, 2) = 300; // more than any pixel is to have
                kind.uncertainty.emplace(layout, 1, k == 0 ? 0.0f : ofOthers);
                if (k == 0)
                    everyPixel(layout, [&](int x, int y) {
                        kind.demand.at(x, y) = demand(x, y);
                        kind.uncertainty->at(x, y) = uncertainty(x, y);
                    });
                kinds.push_back(std::move(kind));
            }
            const Scaled scaled = CountPasses(frame, 4).run(kinds, 28 + 3 * 9, 256);
            const float even = scaled.numbers[WEDGE_SCALE_EVEN], mean = scaled.numbers[WEDGE_SCALE_MEAN];
            everyPixel(layout, [&](int x, int y) {
                const double asked = std::clamp(scaled.numbers[WEDGE_SCALE_FOUND] * demand(x, y), 9.0f, 256.0f);
                const double n = asked + double { even } * (mean - asked);
                const std::uint32_t there = kinds[0].taken->at(x, y);
                if (std::fabs(n - std::floor(n) - 0.5) > 1e-3)
                    REQUIRE(
                        scaled.counts[0].at(x, y) == std::max(static_cast<std::uint32_t>(std::floor(n + 0.5)), there));
                REQUIRE(scaled.counts[1].at(x, y) == 9); // of primary samples alone
            });
            return std::pair(even, mean);
        };
        const auto own = [&](int x, int y) { return found.at(x, y); };
        const auto [share, mean] = numbers(around, own, 0.0f);
        CHECK(share >= 0.75f);
        CHECK(mean == doctest::Approx(28).epsilon(0.02)); // of which two pixels have 300
        // Where all else has far more noise there is nothing to gain.
        CHECK(numbers(around, own, 10.0f).first == 0);
        // A quarter that is uncertain, and knows it of its neighbours.
        const auto uncertain = [](int x, int) { return x < width / 4 ? 1.0f : 0.01f; };
        CHECK(numbers([&](int x, int y) { return std::sqrt(uncertain(x, y)); }, uncertain, 0.0f).first == 0);
    });
}

TEST_CASE("counts are those of a window's pixels, and nothing changes beside it")
{
    onEveryRegion(150, Kept::Full, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        PassBench pass(frame, "countsFromDemand");
        pass.value("least", 8.0f);
        pass.value("most", 100.0f);
        pass.value("evens", 1u);
        std::vector<float> scale(WEDGE_SCALE_NUMBERS, 1e30f);
        scale[WEDGE_SCALE_FOUND] = 37.5f;
        scale[WEDGE_SCALE_MEAN] = 26;
        scale[WEDGE_SCALE_EVEN] = 0.75f;
        pass.plane("scale", scale);
        const auto demand = filledPlanes(region, 1, 1e30f,
            [&](int, int, std::size_t) { return random() % 5 == 0 ? 0.0 : std::exp(uniform(random, -6, 6)); });
        const auto taken = filledPlanes(region, 1, 1u << 20, [&](int, int, std::size_t) { return random() % 80; });
        pass.plane("demand", demand);
        pass.plane("taken", taken);
        pass.plane("wanted", std::vector<std::uint32_t>(region.layout.size, 777));
        pass.window(region.window);
        pass.run();
        const auto found = pass.pixels<std::uint32_t>("wanted");
        everyPixel(region.layout, [&](int x, int y) {
            const image::Window& w = region.window;
            if (x < w.x0 || x >= w.x1 || y < w.y0 || y >= w.y1) {
                REQUIRE(found.at(x, y) == 777);
                return;
            }
            const double asked = std::clamp(37.5 * demand.at(x, y), 8.0, 100.0), n = asked + 0.75 * (26 - asked);
            if (std::fabs(n - std::floor(n) - 0.5) > 1e-4)
                REQUIRE(found.at(x, y) == std::max(static_cast<std::uint32_t>(std::floor(n + 0.5)), taken.at(x, y)));
        });
    });
}

TEST_CASE(
    "uncertainty: variance over equal pixels, of visibilities p (1 - p) and no less than the floor; -1 where there "
    "are no samples, or no slopes")
{
    onEveryDevice([](const device::Device& device) {
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
            DeclaredFrame frame = pathsFrame(device, width, height);
            const auto run = [&](const char* kernel, const char* counted) {
                PassBench pass(frame, kernel);
                pass.value("p", p);
                pass.plane(counted, filtered);
                pass.plane("effective", effective);
                pass.plane("beta", beta);
                pass.run();
                return pass.pixels<float>("uncertainty");
            };
            const Planes<float> ofLight = run("visibilityUncertainty", "filtered"),
                                ofPaths = run("uncertaintyOf", "variance");
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
        for (const std::pair<int, int>& extent : { std::pair(1, 1), { 1, 9 }, { 40, 21 }, { 48, 3 } })
            for (const double dark : { 0.2, 1.0 }) {
                const int width = extent.first, height = extent.second;
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
                DeclaredFrame frame = pathsFrame(device, width, height + 2);
                for (const std::uint32_t which : { 0u, 1u, 2u, 3u }) {
                    const std::uint32_t oneObject = which & 1u, ownToo = which >> 1;
                    PassBench pass(frame, "demandOf");
                    pass.value("p", p);
                    pass.value("oneObject", oneObject);
                    pass.value("ownToo", ownToo);
                    pass.plane("uncertainty", uncertainty);
                    pass.plane("objectId", objectId);
                    pass.run();
                    const auto found = pass.pixels<float>("demand");
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
        const Demands in(40, 12, 0, 1, 1);
        DeclaredFrame frame = pathsFrame(device, 40, 12);
        PassBench pass(frame, "uniformCounts");
        pass.value("count", 13u);
        pass.plane("mask", in.objectId);
        pass.plane("wanted", std::vector<std::uint32_t>(in.demand.layout.size, 777));
        pass.window({ 16, 3, 40, 9 });
        pass.run();
        const auto found = pass.pixels<std::uint32_t>("wanted");
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 40; ++x) {
                const bool inside = x >= 16 && y >= 3 && y < 9;
                REQUIRE(found.at(x, y) == (inside ? (in.objectId.at(x, y) != 0 ? 13u : 0u) : 777u));
            }
    });
}
