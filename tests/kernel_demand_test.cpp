// distributed.cl alone: variances of pixels, how uncertain they leave an image, and bounds of counts.
#include "tests/distributed_support.h"

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
    Planes<std::uint32_t> taken;

    Moments(const Region& region, std::mt19937& random)
        : texture(filledPlanes(
            region, 3, 1e30f, [&](int, int, std::size_t) { return random() % 6 == 0 ? 0 : uniform(random); }))
        , textureSquares(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random); }))
        , value(filledPlanes(
              region, 3, 1e30f, [&](int, int, std::size_t) { return random() % 6 == 0 ? 0 : uniform(random, 0, 2); }))
        , squares(filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 2); }))
        , taken(filledPlanes(region, 1, 1000u, [&](int, int, std::size_t) { return random() % 12; }))
    {
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            if (random() % 9 == 0)
                texture.setVector(x, y, { 0, 0, 0 });
        });
    }
    /// Fills a pass, and is then what the pass has of it: of lean frames squares become those of deviations.
    void fill(PassBench& pass, const Region& region)
    {
        pass.plane("texture", texture);
        pass.plane("value", value);
        pass.plane("taken", taken);
        texture = pass.pixels<float>("texture");
        value = pass.pixels<float>("value");
        if (!pass.has("spreads")) {
            pass.plane("squares", squares);
            pass.plane("textureSquares", textureSquares);
            return;
        }
        pass.plane("spreads", filledPlanes(region, 2, 1e30f, [&](int x, int y, std::size_t which) {
            return (which == 0 ? squares : textureSquares).at(x, y);
        }));
        const auto spreads = pass.pixels<float>("spreads");
        everyPixel({ 0, 0, region.width, region.height }, [&](int x, int y) {
            const glm::dvec3 k = texture.vector(x, y);
            const double l = luminanceOf(k * value.vector(x, y)), t = luminanceOf(k);
            squares.at(x, y) = static_cast<float>(l * l + std::pow(spreads.at(x, y), 2));
            textureSquares.at(x, y) = static_cast<float>(t * t + std::pow(spreads.at(x, y, 1), 2));
        });
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

/// Of the texture, and of the irradiance.
std::array<Planes<float>, 2> splitVariance(
    DeclaredFrame& frame, const Region& region, Moments& in, std::uint32_t values = 1)
{
    RegionPass pass(frame, "splitVariance", { "ofTexture", "ofIrradiance" }, termOf(values));
    in.fill(pass, region);
    shared::DistributedParams p = paramsOf(region);
    p.values = values;
    pass.runIn(region, p);
    return { pass.floats("ofTexture"), pass.floats("ofIrradiance") };
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
    DeclaredFrame& frame, const Region& region, const shared::DistributedParams& p, const Filters& in)
{
    RegionPass pass(frame, "uncertaintyOfRays", { "uncertainty" });
    pass.plane("variance", in.variance);
    pass.plane("effective", in.effective);
    pass.plane("beta", in.beta);
    pass.plane("lens", in.lens);
    pass.plane("along", in.along);
    pass.runIn(region, p);
    return pass.floats("uncertainty");
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

TEST_CASE("variances: of the texture at most all of it, of the irradiance the rest; none of a sample or less")
{
    onEveryRegion(0, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        for (const std::uint32_t values : { 1u, 3u }) {
            CAPTURE(values);
            Moments in(region, random);
            const auto found = splitVariance(frame, region, in, values);
            int all = 0, some = 0;
            everyPixel(region.window, [&](int x, int y) {
                const std::array<double, 2> expected = in.expected(x, y);
                for (std::size_t k = 0; k < 2; ++k)
                    REQUIRE(agree(found[k].at(x, y), expected[k], 1e-4, 4e-6));
                all += expected[0] > 0 && expected[1] < 1e-6 ? 1 : 0;
                some += expected[0] > 0 && expected[1] > 1e-6 ? 1 : 0;
            });
            CHECK((all > 3 || region.width * region.height < 100));
            CHECK((some > 3 || region.width * region.height < 100));
        }
    });
}

TEST_CASE("variances: in the mean over pixels of few samples they are those of a sample")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
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
            const auto found = splitVariance(frame, region, in);
            double texture = 0, irradiance = 0;
            everyPixel(region.window, [&](int x, int y) {
                texture += found[0].at(x, y) / (120.0 * 90.0);
                irradiance += found[1].at(x, y) / (120.0 * 90.0);
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
    onEveryRegion(20, Kept::Full, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const auto emission =
            filledPlanes(region, 3, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 5); });
        const auto squares =
            filledPlanes(region, 1, 1e30f, [&](int, int, std::size_t) { return uniform(random, 0, 30); });
        const auto taken = someCounts(region, random, 6);
        RegionPass pass(frame, "emissionVariance", { "variance" });
        pass.plane("emission", emission);
        pass.plane("squares", squares);
        pass.plane("taken", taken);
        pass.runIn(region, paramsOf(region));
        const auto found = pass.floats("variance");
        everyPixel(region.window, [&](int x, int y) {
            const double rest = squares.at(x, y) - std::pow(luminanceOf(emission.vector(x, y)), 2);
            REQUIRE(agree(found.at(x, y), std::max(0.0, rest) * unbiased(taken.at(x, y)), 1e-4, 2e-5));
        });
    });
}

TEST_CASE("uncertainty: variance over what filters gather and rays cost")
{
    onEveryRegion(40, Kept::Full, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        for (const std::uint32_t alongMotion : { 0u, 1u })
            for (const float rays : { 1.0f, 4.0f }) {
                const Filters in(region, random);
                shared::DistributedParams p = paramsOf(region);
                p.alongMotion = alongMotion;
                p.rays = rays;
                const Planes<float> found = uncertaintyOfRays(frame, region, p, in);
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
        MovingFrame frame(device, Kept::Full);
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
                    REQUIRE(agree(uncertaintyOfRays(frame, region, p, in).at(0, 0), 1 / gathered, 1e-3));
                }
    });
}

TEST_CASE("at least so many samples of one kind as of another, where taken apart and where not")
{
    onEveryRegion(90, Kept::Full, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const Filters in(region, random);
        const Planes<float> before = in.effective;
        RegionPass pass(frame, "atLeast", { "demand" });
        pass.plane("demand", before);
        pass.plane("beta", in.beta);
        pass.plane("least", in.along);
        pass.value("apart", 0.5f);
        pass.value("together", 8.0f);
        pass.runIn(region, paramsOf(region));
        const auto found = pass.floats("demand");
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
    const auto test = [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const auto taken = someCounts(region, random, 900), wanted = someCounts(region, random, 4000);
        // Never fewer than there are.
        Planes<std::uint32_t> atLeastTaken = wanted;
        everyPixel({ 0, 0, region.width, region.height },
            [&](int x, int y) { atLeastTaken.at(x, y) = std::max(wanted.at(x, y), taken.at(x, y)); });
        RegionPass<std::uint32_t> pass(frame, "limitStep", { "wanted" });
        pass.plane("wanted", atLeastTaken);
        pass.plane("taken", taken);
        pass.runIn(region, paramsOf(region));
        const auto found = pass.pixels<std::uint32_t>("wanted");
        everyPixel(region.window, [&](int x, int y) {
            const std::uint32_t steps = std::min(atLeastTaken.at(x, y) - taken.at(x, y), 1024u);
            REQUIRE(found.at(x, y) == taken.at(x, y) + steps);
        });
    };
    render::Settings progressive = render::axisAligned(16);
    progressive.progressive = true;
    onEveryRegion(110, Kept::Full, test, progressive);
}
