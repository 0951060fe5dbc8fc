// filter.cl alone: the gather over plain distances, of one plane, three and four.
#include "tests/filter_run.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Calls test(filter, planes) for each number of planes on every device.
template <class Test>
void withEach(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        FilterRun filter(device);
        for (const int planes : { 3, 4, 1 }) {
            CAPTURE(planes);
            test(filter, planes);
        }
    });
}

FilterImage unlit(int width, int height, Shape shape, unsigned seed, int planes)
{
    return withoutLight(randomImage(width, height, shape, seed, static_cast<std::size_t>(planes)));
}

template <class Visit>
void everyPixel(const FilterImage& image, const Visit& visit)
{
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            visit(x, y);
}

/// A few waves of random direction, length (pixels) and phase, between -1 and 1.
class Waves {
public:
    Waves(std::mt19937& random, double shortest)
    {
        for (auto& wave : waves_) {
            const double angle = uniform(random, 0, 6.283), number = 6.283 / (shortest * uniform(random, 1, 3));
            wave = { number * std::cos(angle), number * std::sin(angle), uniform(random, 0, 6.283) };
        }
    }
    double operator()(int x, int y) const
    {
        double sum = 0;
        for (const glm::dvec3& wave : waves_)
            sum += std::sin(wave.x * x + wave.y * y + wave.z) / 4;
        return sum;
    }

private:
    glm::dvec3 waves_[4];
};

/// A rolling surface with values and widths that vary gently across it.
FilterImage smoothImage(int width, int height, unsigned seed)
{
    FilterImage image = unlit(width, height, Shape::Flat, seed, 3);
    std::mt19937 random(seed);
    const Waves relief(random, 40), widths(random, 25), values[3] = { { random, 14 }, { random, 20 }, { random, 30 } };
    const glm::dvec3 eye = toGlm(image.params.eye);
    const auto at = [&](int x, int y) {
        const glm::dvec3 ray = rayOf(image.params, x, y);
        return eye + ray * ((0.15 * relief(x, y) - eye.y) / ray.y);
    };
    everyPixel(image, [&](int x, int y) {
        const glm::dvec3 n = glm::normalize(glm::cross(at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)));
        image.position.setVector(x, y, at(x, y));
        image.normal.setVector(x, y, n.y > 0 ? n : -n);
        image.beta.at(x, y) = static_cast<float>(0.11 + 0.05 * widths(x, y));
        for (std::size_t c = 0; c < 3; ++c)
            image.value.at(x, y, c) = static_cast<float>(0.5 + 0.4 * values[c](x, y));
    });
    return image;
}

} // namespace

TEST_CASE("without a light: both passes gather over plain distances, all planes with the same weights")
{
    withEach([](FilterRun& filter, int planes) {
        double uncertain = 0;
        unsigned runs = 0, seed = 30;
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough })
            for (const bool narrower : { false, true }) {
                FilterImage image = unlit(53, 31, shape, seed++, planes);
                image.params.narrower = narrower ? 1 : 0;
                image.params.fitted = static_cast<std::uint32_t>(narrower ? std::min(planes, 3) : 0);
                CAPTURE(static_cast<int>(shape));
                CAPTURE(narrower);
                const OracleResult rows = oracleRows(image);
                uncertain += compare(image, filter(image, true), rows, planes);
                uncertain += compare(image, filter(image), oracleColumns(image, rows), planes);
                runs += 2;
            }
        CHECK(uncertain / runs < 0.1);
    });
}

TEST_CASE("along the axes: pairs have the mean of both squared bandwidths, and rows and columns widths of their own")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const int planes : { 3, 4 }) {
            CAPTURE(planes);
            double uncertain = 0;
            unsigned runs = 0, seed = 60;
            for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough })
                for (const bool fitted : { false, true }) {
                    FilterImage image = unlit(53, 31, shape, seed, planes);
                    image.betaOfColumns = unlit(53, 31, shape, seed + 100, planes).beta;
                    image.meanSquare = true;
                    image.params.maxRadius = 15;
                    image.params.fitted = fitted ? 3 : 0;
                    ++seed;
                    CAPTURE(static_cast<int>(shape));
                    CAPTURE(fitted);
                    const OracleResult rows = oracleRows(image);
                    uncertain += compare(image, filter(image, true), rows, planes);
                    uncertain += compare(image, filter(image), oracleColumns(image, rows), planes);
                    runs += 2;
                }
            CHECK(uncertain / runs < 0.1);
        }
    });
}

TEST_CASE("on a smooth scene two passes over plain distances are close to the gather over squares of pixels")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const bool narrower : { false, true })
            for (const unsigned seed : { 41u, 42u, 43u }) {
                FilterImage image = smoothImage(64, 48, seed);
                image.params.narrower = narrower ? 1 : 0;
                const FilterResult separable = filter(image);
                const std::vector<double> square = oracleSquare(image);
                double difference = 0, effect = 0, worst = 0;
                everyPixel(image, [&](int x, int y) {
                    const double reference = square[static_cast<std::size_t>(y) * 64 + x];
                    const double apart = separable.value.at(x, y) - reference;
                    worst = std::max(worst, std::fabs(apart));
                    difference += apart * apart / (64 * 48);
                    effect += std::pow(image.value.at(x, y) - reference, 2) / (64 * 48);
                });
                const double ratio = std::sqrt(difference / effect);
                MESSAGE("scene " << seed << (narrower ? std::string(", narrower of both") : std::string(", own width"))
                                 << ": RMS difference " << std::sqrt(difference) << ", worst " << worst
                                 << ", of the filter's effect " << ratio);
                CHECK(ratio < 0.1);
                CHECK(worst < 0.015);
                CHECK(std::sqrt(effect) > 0.01);
            }
    });
}

TEST_CASE("programs of lean frames: what the others make of the same normals, without counts of three planes")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device), lean(device, true);
        for (const int planes : { 3, 1 }) {
            CAPTURE(planes);
            const bool counts = planes == 1;
            for (const Shape shape : { Shape::Tilted, Shape::Steps, Shape::Rough }) {
                const FilterImage image = keptLean(unlit(61, 29, shape, 50, planes));
                const FilterResult expected = filter(image), found = lean(image);
                int filtered = 0;
                everyPixel(image, [&](int x, int y) {
                    CAPTURE(x);
                    CAPTURE(y);
                    for (std::size_t c = 0; c < static_cast<std::size_t>(planes); ++c) {
                        REQUIRE(found.value.at(x, y, c) == doctest::Approx(expected.value.at(x, y, c)).epsilon(1e-5));
                        filtered += found.value.at(x, y, c) != image.value.at(x, y, c) ? 1 : 0;
                    }
                    REQUIRE(found.effective.at(x, y) == doctest::Approx(counts ? expected.effective.at(x, y) : -7.0f));
                });
                CHECK(filtered > 100);
            }
        }
    });
}

TEST_CASE("the counts alone are those of the filter")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const auto& [width, height] : { std::pair(1, 1), { 1, 40 }, { 67, 33 } })
            for (const Shape shape : { Shape::Flat, Shape::Rough }) {
                const FilterImage image = unlit(width, height, shape, 4, 1);
                const Planes<float> expected = filter(image).effective, found = filter.counts(image);
                int gathered = 0;
                everyPixel(image, [&](int x, int y) {
                    REQUIRE(found.at(x, y) == doctest::Approx(expected.at(x, y)).epsilon(1e-5));
                    gathered += found.at(x, y) > 1.5f ? 1 : 0;
                });
                CHECK((width == 1 || gathered > width * height / 15));
            }
    });
}
