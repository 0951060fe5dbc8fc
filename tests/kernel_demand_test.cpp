// distributed.cl alone: variances of pixels, how uncertain they leave an image, and bounds of counts.
#include "tests/distributed_support.h"
#include "tests/pass_bench.h"

#include <array>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double pi = 3.14159265358979;

/// n / (n - 1), which makes the variance of n samples about their own mean unbiased; 0 where there is none to speak of.
double unbiased(double n) { return n > 1 ? n / (n - 1) : 0; }

/// Frames of so many pixels. Of one image their planes are packed, with layers they are not.
enum class Frames { OneImage, Layers, Progressive };
DeclaredFrame frameOf(const device::Device& device, Frames frames, int width, int height)
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.antialias = true;
    settings.bounces = 1;
    settings.progressive = frames == Frames::Progressive;
    return DeclaredFrame(device, smallScene(), settings, frames == Frames::Layers);
}

/// Calls test(frame, region, random) for every device and each of regions(), with random numbers that go on.
template <class Test>
void inRegions(Frames frames, unsigned seed, const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        std::mt19937 random(seed);
        for (const Region& region : regions()) {
            DeclaredFrame frame = frameOf(device, frames, region.width, region.height);
            test(frame, region, random);
        }
    });
}

/// A pass of the frame, over the region's window.
PassBench benchOf(DeclaredFrame& frame, const Region& region, const std::string& kernel, std::size_t nth = 0)
{
    PassBench bench(frame, kernel, "", nth);
    bench.window(region.window);
    return bench;
}

/// A value in each pixel, and beside the image what is to come from nowhere.
template <class Value>
Planes<float> numbersIn(const Region& region, std::size_t planes, const Value& value)
{
    return filledPlanes(region, planes, 1e30f, [&](int, int, std::size_t) { return value(); });
}

/// Fills what splitVariance takes. Squares of frames of one image are kept as two deviations.
PassBench splitVariance(DeclaredFrame& frame, const Region& region, std::mt19937& random, std::size_t nth)
{
    PassBench bench = benchOf(frame, region, "splitVariance", nth);
    const auto black = [&](double most) { return random() % 6 == 0 ? 0 : uniform(random, 0, most); };
    Planes<float> texture = numbersIn(region, 3, [&] { return black(1); });
    everyPixel(region.window, [&](int x, int y) {
        if (random() % 9 == 0)
            texture.setVector(x, y, { 0, 0, 0 });
    });
    bench.plane("texture", texture);
    bench.plane("value", numbersIn(region, 3, [&] { return black(2); }));
    if (bench.has("spreads")) {
        bench.plane("spreads", numbersIn(region, 2, [&] { return uniform(random, 0, 2); }));
    } else {
        bench.plane("squares", numbersIn(region, 1, [&] { return uniform(random, 0, 2); }));
        bench.plane("textureSquares", numbersIn(region, 1, [&] { return uniform(random); }));
    }
    bench.plane("taken", someCounts(random, region.layout.size, 12));
    return bench;
}

/// What uncertaintyOfRays takes.
struct Filters {
    Planes<float> variance, effective, beta, lens, along;

    Filters(const Region& region, std::mt19937& random)
        : variance(numbersIn(region, 1,
            [&] { return random() % 3 != 0 ? 0
                      : random() % 9 == 0  ? 1e-35
                                           : std::exp(uniform(random, -9, 3)); }))
        , effective(numbersIn(region, 1, [&] { return uniform(random, 0.2, 40); }))
        , beta(numbersIn(
              region, 1, [&] { return random() % 3 == 0 ? -1.0
                                   : random() % 4 == 0  ? 0.0
                                                        : uniform(random); }))
        , lens(numbersIn(region, 1, [&] { return random() % 3 == 0 ? 0 : uniform(random, 0, 6); }))
        , along(numbersIn(region, 1, [&] { return random() % 3 == 0 ? 0 : uniform(random, 0, 6); }))
    {
    }
    /// Equal samples: of a Gaussian of deviations a and b pixels 4 pi a b; covariances of one after the other add up.
    double gathered(bool alongMotion, int x, int y) const
    {
        const double own = beta.at(x, y) > 0 ? std::max(1.0, double { effective.at(x, y) }) : 1;
        const double across = own / (4 * pi) + std::pow(lens.at(x, y), 2);
        const double lengthwise = across + (alongMotion ? std::pow(along.at(x, y), 2) : 0);
        return std::max(1.0, 4 * pi * std::sqrt(across) * std::sqrt(lengthwise));
    }
};
Planes<float> uncertaintyOfRays(
    DeclaredFrame& frame, const Region& region, bool alongMotion, float rays, const Filters& in)
{
    PassBench bench = benchOf(frame, region, "uncertaintyOfRays");
    auto p = bench.own<shared::DistributedParams>("p");
    p.alongMotion = alongMotion ? 1 : 0;
    p.rays = rays;
    bench.value("p", p);
    bench.plane("variance", in.variance);
    bench.plane("effective", in.effective);
    bench.plane("beta", in.beta);
    bench.plane("lens", in.lens);
    bench.plane("along", in.along);
    bench.run();
    return bench.pixels<float>("uncertainty");
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

} // namespace

TEST_CASE("variances: of the texture at most all of it, of the irradiance the rest; none of a sample or less")
{
    for (const Frames frames : { Frames::OneImage, Frames::Layers })
        inRegions(frames, 0, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
            for (const std::size_t nth : { std::size_t { 0 }, std::size_t { 2 } }) { // of a light, and indirect light
                PassBench bench = splitVariance(frame, region, random, nth);
                bench.run();
                const auto ofTexture = bench.pixels<float>("ofTexture");
                const auto ofIrradiance = bench.pixels<float>("ofIrradiance");
                const auto texture = bench.pixels<float>("texture"), value = bench.pixels<float>("value");
                const bool plain = bench.has("squares");
                const auto squares = bench.pixels<float>(plain ? "squares" : "spreads");
                const auto textureSquares = plain ? bench.pixels<float>("textureSquares") : squares;
                const auto taken = bench.pixels<std::uint32_t>("taken");
                int all = 0, some = 0;
                everyPixel(region.window, [&](int x, int y) {
                    const double k = luminanceOf(texture.vector(x, y));
                    const double l = luminanceOf(texture.vector(x, y) * value.vector(x, y));
                    // In squares, or in deviations, the luminance's and the texture's.
                    const double whole =
                        plain ? std::max(0.0, squares.at(x, y) - l * l) : std::pow(squares.at(x, y), 2);
                    const double spread =
                        plain ? std::max(0.0, textureSquares.at(x, y) - k * k) : std::pow(squares.at(x, y, 1), 2);
                    const double n = unbiased(taken.at(x, y));
                    const double part = std::min(n * whole, k > 0 ? n * spread * std::pow(l / k, 2) : 0.0);
                    REQUIRE(agree(ofTexture.at(x, y), part, 1e-4, 4e-6));
                    REQUIRE(agree(ofIrradiance.at(x, y), n * whole - part, 1e-4, 4e-6));
                    all += part > 0 && n * whole - part < 1e-6 ? 1 : 0;
                    some += part > 0 && n * whole - part > 1e-6 ? 1 : 0;
                });
                CHECK((all > 3 || region.width * region.height < 100));
                CHECK((some > 3 || region.width * region.height < 100));
            }
        });
}

TEST_CASE("variances: in the mean over pixels of few samples they are those of a sample")
{
    onEveryDevice([](const device::Device& device) {
        const Region region(120, 90);
        DeclaredFrame frame = frameOf(device, Frames::Layers, region.width, region.height);
        PassBench bench(frame, "splitVariance");
        std::mt19937 random(70);
        constexpr unsigned n = 5;
        bench.plane("taken", Planes<std::uint32_t>(region.layout, 1, n));
        Planes<float> texture(region.layout, 3, 0.0f), value = texture, textureSquares(region.layout, 1, 0.0f),
                                                       squares = textureSquares;
        // Grey textures of 0 to 1 under light that is the same, or of 0 to 2: var(t) is 1/12, of t e it is 4/9 - 1/4.
        for (const bool noisy : { false, true }) {
            everyPixel(region.window, [&](int x, int y) {
                double t[2] = {}, l[2] = {};
                for (unsigned k = 0; k < n; ++k) {
                    const double ti = uniform(random), li = ti * (noisy ? uniform(random, 0, 2) : 1);
                    t[0] += ti / n;
                    t[1] += ti * ti / n;
                    l[0] += li / n;
                    l[1] += li * li / n;
                }
                texture.setVector(x, y, glm::dvec3(t[0]));
                value.setVector(x, y, glm::dvec3(l[0] / t[0]));
                textureSquares.at(x, y) = static_cast<float>(t[1]);
                squares.at(x, y) = static_cast<float>(l[1]);
            });
            bench.plane("texture", texture);
            bench.plane("value", value);
            bench.plane("textureSquares", textureSquares);
            bench.plane("squares", squares);
            bench.run();
            const auto found = bench.pixels<float>("ofTexture"), rest = bench.pixels<float>("ofIrradiance");
            double ofTexture = 0, ofIrradiance = 0;
            everyPixel(region.window, [&](int x, int y) {
                ofTexture += found.at(x, y) / (120.0 * 90.0);
                ofIrradiance += rest.at(x, y) / (120.0 * 90.0);
            });
            CAPTURE(noisy);
            CHECK(ofTexture + ofIrradiance == doctest::Approx(noisy ? 4.0 / 9 - 0.25 : 1.0 / 12).epsilon(0.02));
            if (!noisy)
                CHECK(ofIrradiance < 1e-5);
        }
    });
}

TEST_CASE("emission: the variance of its luminance, none of a sample or less")
{
    inRegions(Frames::Layers, 20, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        PassBench bench = benchOf(frame, region, "emissionVariance");
        bench.plane("emission", numbersIn(region, 3, [&] { return uniform(random, 0, 5); }));
        bench.plane("squares", numbersIn(region, 1, [&] { return uniform(random, 0, 30); }));
        bench.plane("taken", someCounts(random, region.layout.size, 6));
        bench.run();
        const auto found = bench.pixels<float>("variance");
        const auto emission = bench.pixels<float>("emission"), squares = bench.pixels<float>("squares");
        const auto taken = bench.pixels<std::uint32_t>("taken");
        everyPixel(region.window, [&](int x, int y) {
            const double rest = squares.at(x, y) - std::pow(luminanceOf(emission.vector(x, y)), 2);
            REQUIRE(agree(found.at(x, y), std::max(0.0, rest) * unbiased(taken.at(x, y)), 1e-4, 2e-5));
        });
    });
}

TEST_CASE("uncertainty: variance over what filters gather and rays cost")
{
    inRegions(Frames::Layers, 40, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        for (const bool alongMotion : { false, true })
            for (const float rays : { 1.0f, 4.0f }) {
                const Filters in(region, random);
                const Planes<float> found = uncertaintyOfRays(frame, region, alongMotion, rays, in);
                everyPixel(region.window, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    REQUIRE(agree(found.at(x, y), in.variance.at(x, y) / in.gathered(alongMotion, x, y) / rays, 1e-4));
                });
            }
    });
}

TEST_CASE("uncertainty: filters one after the other gather what their kernels, convolved, do")
{
    onEveryDevice([](const device::Device& device) {
        const Region region(1, 1);
        DeclaredFrame frame = frameOf(device, Frames::Layers, 1, 1);
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
                    const double gathered = 1 / (squaredWeights({ own, lens }) * squaredWeights({ own, lens, along }));
                    REQUIRE(agree(uncertaintyOfRays(frame, region, true, 1, in).at(0, 0), 1 / gathered, 1e-3));
                }
    });
}

TEST_CASE("at least so many samples of one kind as of another, where taken apart and where not")
{
    inRegions(Frames::OneImage, 90, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        const Filters in(region, random);
        PassBench bench = benchOf(frame, region, "atLeast");
        bench.value("apart", 0.5f);
        bench.value("together", 8.0f);
        bench.plane("beta", in.beta);
        bench.plane("least", in.along);
        bench.plane("demand", in.effective);
        bench.run();
        const auto found = bench.pixels<float>("demand");
        int raised[2] = {};
        everyPixel(region.window, [&](int x, int y) {
            const bool apart = in.beta.at(x, y) >= 0;
            const double bound = (apart ? 0.5 : 8.0) * in.along.at(x, y), before = in.effective.at(x, y);
            REQUIRE(agree(found.at(x, y), std::max(before, bound)));
            raised[apart ? 1 : 0] += bound > before ? 1 : 0;
        });
        CHECK((region.width * region.height < 100 || (raised[0] > 0 && raised[1] > 0)));
    });
}

TEST_CASE("counts: no more new primary samples than a wave has room for")
{
    inRegions(Frames::Progressive, 110, [](DeclaredFrame& frame, const Region& region, std::mt19937& random) {
        PassBench bench = benchOf(frame, region, "limitStep");
        const std::vector<std::uint32_t> taken = someCounts(random, region.layout.size, 900);
        std::vector<std::uint32_t> wanted = someCounts(random, region.layout.size, 4000);
        // Never fewer than there are.
        std::ranges::transform(wanted, taken, wanted.begin(), [](auto a, auto b) { return std::max(a, b); });
        bench.plane("taken", taken);
        bench.plane("wanted", wanted);
        const auto has = bench.pixels<std::uint32_t>("taken"), wants = bench.pixels<std::uint32_t>("wanted");
        bench.run();
        const auto found = bench.pixels<std::uint32_t>("wanted");
        everyPixel(region.window, [&](int x, int y) {
            const std::uint32_t steps = std::min(wants.at(x, y) - has.at(x, y), 1024u);
            REQUIRE(found.at(x, y) == has.at(x, y) + steps);
        });
    });
}
