// distributed.cl alone: variances of pixels, how uncertain they leave an image, and bounds of counts.
#include "tests/distributed_support.h"
#include "tests/packed_support.h"

#include <array>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double pi = 3.14159265358979;

/// n / (n - 1), which makes the variance of n samples about their own mean unbiased; 0 where there is none to speak of.
double unbiased(double n) { return n > 1 ? n / (n - 1) : 0; }

/// What splitVariance takes, and what it is to make of it.
struct Moments {
    Planes<float> texture, textureSquares, value, squares;
    Planes<float> deviation, textureDeviation; ///< packed
    Planes<std::uint32_t> taken;

    /// Packed with p.packed: what they are then.
    Moments(const Region& region, std::mt19937& random, const shared::DistributedParams& p = {})
        : texture(filledPlanes(
            region, 3, 1e30f, [&](int, int, std::size_t) { return random() % 6 == 0 ? 0 : uniform(random); }))
        , textureSquares(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random); }))
        , value(filledPlanes(
              region, 3, 1e30f, [&](int, int, std::size_t) { return random() % 6 == 0 ? 0 : uniform(random, 0, 2); }))
        , squares(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 2); }))
        , deviation(squares)
        , textureDeviation(squares)
        , taken(filledPlanes(region, 1, 1000u, [&](int, int, std::size_t) { return random() % 12; }))
    {
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            if (random() % 9 == 0)
                texture.setVector(x, y, { 0, 0, 0 });
            if (p.packed != 0)
                round(p, x, y);
        });
    }
    /// Packed, squares are those of deviations of so many bits.
    void round(const shared::DistributedParams& p, int x, int y)
    {
        const glm::dvec3 k = rounded(texture.vector(x, y), shared::textureBits(1, p.values == 1));
        const glm::dvec3 e = rounded(value.vector(x, y), shared::valueBits(1, p.values == 1));
        texture.setVector(x, y, k);
        value.setVector(x, y, e);
        const double l = luminanceOf(k * e), t = luminanceOf(k);
        deviation.at(x, y) = rounded(squares.at(x, y));
        textureDeviation.at(x, y) = rounded(textureSquares.at(x, y));
        squares.at(x, y) = static_cast<float>(l * l + std::pow(deviation.at(x, y), 2));
        textureSquares.at(x, y) = static_cast<float>(t * t + std::pow(textureDeviation.at(x, y), 2));
    }
    std::array<double, 2> expected(int x, int y) const
    {
        const double k = luminanceOf(texture.vector(x, y)), l = luminanceOf(texture.vector(x, y) * value.vector(x, y));
        const double all = std::max(0.0, squares.at(x, y) - l * l) * unbiased(taken.at(x, y));
        const double spread = std::max(0.0, textureSquares.at(x, y) - k * k) * unbiased(taken.at(x, y));
        const double ofTexture = std::min(all, k > 0 ? spread * std::pow(l / k, 2) : 0.0);
        return { ofTexture, all - ofTexture };
    }
};

struct SplitPlanes {
    Planes<float> ofTexture, ofIrradiance;
};
SplitPlanes splitVariance(
    KernelBench& bench, const Region& region, const Moments& in, const shared::DistributedParams& p)
{
    Output<float> first(bench, region, 1), second(bench, region, 1);
    const bool light = p.values == 1;
    const auto k = bench.buffer(packedColours(in.texture, shared::textureBits(p.packed, light)).values),
               e = bench.buffer(packedColours(in.value, shared::valueBits(p.packed, light)).values),
               k2 = bench.buffer(in.textureSquares.values),
               l2 =
                   bench.buffer((p.packed != 0 ? packedNumbers(in.deviation, in.textureDeviation) : in.squares).values);
    const auto taken = bench.buffer(in.taken.values);
    launchPixels(
        bench, "waves/distributed.cl", "splitVariance", p, k, k2, e, l2, taken, first.buffer(), second.buffer());
    return { first.read(), second.read() };
}

/// What uncertaintyOfRays takes.
struct Filters {
    Planes<float> variance, effective, beta, lens, along;

    Filters(const Region& region, std::mt19937& random)
        : variance(filledPlanes(region, 1, 1e30f,
            [&](int, int, std::size_t) {
                return random() % 3 != 0 ? 0 : random() % 9 == 0 ? 1e-35 : std::exp(uniform(random, -9, 3));
            }))
        , effective(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0.2, 40); }))
        , beta(filledPlanes(region, 1, 1e30f,
              [&](int, int, std::size_t) {
                  return random() % 3 == 0 ? -1.0 : random() % 4 == 0 ? 0.0 : uniform(random);
              }))
        , lens(filledPlanes(
              region, 1, 1e30f, [&](int, int, std::size_t) { return random() % 3 == 0 ? 0 : uniform(random, 0, 6); }))
        , along(filledPlanes(
              region, 1, 1e30f, [&](int, int, std::size_t) { return random() % 3 == 0 ? 0 : uniform(random, 0, 6); }))
    {
    }
    /// Equal samples: of a Gaussian of deviations a and b pixels 4 pi a b; covariances of one after the other add up.
    double gathered(const shared::DistributedParams& p, int x, int y) const
    {
        const double own = beta.at(x, y) > 0 ? std::max(1.0, double { effective.at(x, y) }) : 1;
        const double across = own / (4 * pi) + std::pow(lens.at(x, y), 2);
        const double lengthwise = across + (p.alongMotion != 0 ? std::pow(along.at(x, y), 2) : 0);
        return std::max(1.0, 4 * pi * std::sqrt(across) * std::sqrt(lengthwise));
    }
};
Planes<float> uncertaintyOfRays(
    KernelBench& bench, const Region& region, const shared::DistributedParams& p, const Filters& in)
{
    Output<float> uncertainty(bench, region, 1);
    const auto variance = bench.buffer(in.variance.values), effective = bench.buffer(in.effective.values),
               beta = bench.buffer(in.beta.values), lens = bench.buffer(in.lens.values),
               along = bench.buffer(in.along.values);
    launchPixels(bench, "waves/distributed.cl", "uncertaintyOfRays", p, variance, effective, beta, lens, along,
        uncertainty.buffer());
    return uncertainty.read();
}

/// Sum of the squares of Gaussians of those deviations, one convolved with the other, on whole numbers.
double squaredWeights(const std::vector<double>& deviations)
{
    constexpr int reach = 120;
    std::vector<double> sum(2 * reach + 1, 0.0);
    sum[reach] = 1;
    for (const double s : deviations) {
        std::vector<double> next(sum.size(), 0.0);
        for (int i = -reach; i <= reach; ++i)
            for (int k = std::max(-reach, i - 60); k <= std::min(reach, i + 60); ++k)
                next[reach + i] += sum[reach + k] * std::exp(-0.5 * std::pow((i - k) / s, 2)) / (s * std::sqrt(2 * pi));
        sum = next;
    }
    double out = 0;
    for (const double w : sum)
        out += w * w;
    return out;
}

/// Random numbers of samples, some of them 0.
Planes<std::uint32_t> someCounts(const Region& region, std::mt19937& random, std::uint32_t most)
{
    return filledPlanes(region, 1, 1u << 20,
        [&](int, int, std::size_t) { return random() % 4 == 0 ? 0u : static_cast<std::uint32_t>(random()) % most; });
}

} // namespace

TEST_CASE(
    "variances: of the texture at most all of it, of the irradiance the rest; none of a sample or less; packed, too")
{
    onEveryRegion(0, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        for (const auto& [packed, values] : { std::pair(0u, 1u), { 1u, 1u }, { 1u, 3u } }) {
            CAPTURE(packed);
            CAPTURE(values);
            shared::DistributedParams p = paramsOf(region);
            p.packed = packed;
            p.values = values;
            const Moments in(region, random, p);
            const SplitPlanes found = splitVariance(bench, region, in, p);
            int all = 0, some = 0;
            everyPixel(region.window, [&](int x, int y) {
                const auto [texture, irradiance] = in.expected(x, y);
                REQUIRE(agree(found.ofTexture.at(x, y), texture, 1e-4, 4e-6));
                REQUIRE(agree(found.ofIrradiance.at(x, y), irradiance, 1e-4, 4e-6));
                all += texture > 0 && irradiance < 1e-6 ? 1 : 0;
                some += texture > 0 && irradiance > 1e-6 ? 1 : 0;
            });
            CHECK((all > 3 || region.width * region.height < 100));
            CHECK((some > 3 || region.width * region.height < 100));
        }
    });
}

TEST_CASE("variances: in the mean over pixels of few samples they are those of a sample")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const Region region(120, 90);
        std::mt19937 random(70);
        Moments in(region, random);
        // Grey textures of 0 to 1 under light that is the same, or of 0 to 2: var(t) is 1/12, of t e it is 4/9 - 1/4.
        for (const bool noisy : { false, true }) {
            everyPixel(region.window, [&](int x, int y) {
                constexpr unsigned n = 5;
                double t[2] = {}, l[2] = {};
                for (unsigned k = 0; k < n; ++k) {
                    const double ti = uniform(random), li = ti * (noisy ? uniform(random, 0, 2) : 1);
                    t[0] += ti / n;
                    t[1] += ti * ti / n;
                    l[0] += li / n;
                    l[1] += li * li / n;
                }
                in.texture.setVector(x, y, glm::dvec3(t[0]));
                in.value.setVector(x, y, glm::dvec3(l[0] / t[0]));
                in.textureSquares.at(x, y) = static_cast<float>(t[1]);
                in.squares.at(x, y) = static_cast<float>(l[1]);
                in.taken.at(x, y) = n;
            });
            const SplitPlanes found = splitVariance(bench, region, in, paramsOf(region));
            double texture = 0, irradiance = 0;
            everyPixel(region.window, [&](int x, int y) {
                texture += found.ofTexture.at(x, y) / (120.0 * 90.0);
                irradiance += found.ofIrradiance.at(x, y) / (120.0 * 90.0);
            });
            CAPTURE(noisy);
            CHECK(texture + irradiance == doctest::Approx(noisy ? 4.0 / 9 - 0.25 : 1.0 / 12).epsilon(0.02));
            if (!noisy)
                CHECK(irradiance < 1e-5);
        }
    });
}

TEST_CASE("emission: the variance of its luminance, none of a sample or less")
{
    onEveryRegion(20, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        const auto emission =
            filledPlanes(region, 3, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 5); });
        const auto squares =
            filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 30); });
        const auto taken = someCounts(region, random, 6);
        Output<float> variance(bench, region, 1);
        const auto e = bench.buffer(emission.values), e2 = bench.buffer(squares.values);
        const auto n = bench.buffer(taken.values);
        launchPixels(bench, "waves/distributed.cl", "emissionVariance", paramsOf(region), e, e2, n, variance.buffer());
        const Planes<float> found = variance.read();
        everyPixel(region.window, [&](int x, int y) {
            const double rest = squares.at(x, y) - std::pow(luminanceOf(emission.vector(x, y)), 2);
            REQUIRE(agree(found.at(x, y), std::max(0.0, rest) * unbiased(taken.at(x, y)), 1e-4, 2e-5));
        });
    });
}

TEST_CASE("uncertainty: variance over what filters gather and rays cost")
{
    onEveryRegion(40, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        for (const std::uint32_t alongMotion : { 0u, 1u })
            for (const float rays : { 1.0f, 4.0f }) {
                const Filters in(region, random);
                shared::DistributedParams p = paramsOf(region);
                p.alongMotion = alongMotion;
                p.rays = rays;
                const Planes<float> found = uncertaintyOfRays(bench, region, p, in);
                everyPixel(region.window, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    REQUIRE(agree(found.at(x, y), in.variance.at(x, y) / in.gathered(p, x, y) / rays, 1e-4));
                });
            }
    });
}

TEST_CASE("uncertainty: filters one after the other gather what their kernels, convolved, do")
{
    onEveryDevice([](const device::Device& device) {
        KernelBench bench(device);
        const Region region(1, 1);
        std::mt19937 random(5);
        for (const double own : { 1.0, 2.5 })
            for (const double lens : { 1.5, 6.0 })
                for (const double along : { 1.2, 8.0 }) {
                    Filters in(region, random);
                    in.variance.at(0, 0) = 1;
                    in.beta.at(0, 0) = 1;
                    in.effective.at(0, 0) = static_cast<float>(1 / std::pow(squaredWeights({ own }), 2));
                    in.lens.at(0, 0) = static_cast<float>(lens);
                    in.along.at(0, 0) = static_cast<float>(along);
                    shared::DistributedParams p = paramsOf(region);
                    p.alongMotion = 1;
                    const double gathered = 1 / (squaredWeights({ own, lens }) * squaredWeights({ own, lens, along }));
                    REQUIRE(agree(uncertaintyOfRays(bench, region, p, in).at(0, 0), 1 / gathered, 1e-3));
                }
    });
}

TEST_CASE("at least so many samples of one kind as of another, where taken apart and where not")
{
    onEveryRegion(90, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        const Filters in(region, random);
        const Planes<float> before = in.effective;
        Output<float> demand(bench, region, before);
        const auto beta = bench.buffer(in.beta.values), least = bench.buffer(in.along.values);
        launchPixels(
            bench, "waves/distributed.cl", "atLeast", paramsOf(region), 0.5f, 8.0f, beta, least, demand.buffer());
        const Planes<float> found = demand.read();
        int raised[2] = {};
        everyPixel(region.window, [&](int x, int y) {
            const bool apart = in.beta.at(x, y) >= 0;
            const double bound = (apart ? 0.5 : 8.0) * in.along.at(x, y);
            REQUIRE(agree(found.at(x, y), std::max<double>(before.at(x, y), bound)));
            raised[apart ? 1 : 0] += bound > before.at(x, y) ? 1 : 0;
        });
        CHECK((region.width * region.height < 100 || (raised[0] > 0 && raised[1] > 0)));
    });
}

TEST_CASE("counts: no more new primary samples than a wave has room for")
{
    onEveryRegion(110, [](KernelBench& bench, const Region& region, std::mt19937& random) {
        const auto taken = someCounts(region, random, 900), wanted = someCounts(region, random, 4000);
        const auto takenBuffer = bench.buffer(taken.values);
        // Never fewer than there are.
        Planes<std::uint32_t> atLeastTaken = wanted;
        everyPixel({ 0, 0, region.width, region.height },
            [&](int x, int y) { atLeastTaken.at(x, y) = std::max(wanted.at(x, y), taken.at(x, y)); });
        Output<std::uint32_t> primary(bench, region, atLeastTaken);
        launchPixels(bench, "waves/distributed.cl", "limitStep", paramsOf(region), takenBuffer, primary.buffer());
        const Planes<std::uint32_t> found = primary.read();
        everyPixel(region.window, [&](int x, int y) {
            const std::uint32_t steps = std::min(atLeastTaken.at(x, y) - taken.at(x, y), 1024u);
            REQUIRE(found.at(x, y) == taken.at(x, y) + steps);
        });
    });
}
