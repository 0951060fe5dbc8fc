// filter.cl alone, against the same gather in double.
#include "tests/filter_run.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

const float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Calls test(filter, make, planes) for filters of a light's planes, and of others over plain distances. make(width,
/// height, shape, seed): such an image.
template <class Test>
void ofEachKind(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        FilterRun filter(device);
        for (const std::pair<int, bool>& kind : { std::pair(1, true), { 1, false }, { 3, false }, { 4, false } }) {
            const int planes = kind.first;
            const bool light = kind.second;
            CAPTURE(planes);
            CAPTURE(light);
            const auto make = [&](int width, int height, Shape shape, unsigned seed) {
                const FilterImage image = randomImage(width, height, shape, seed, static_cast<std::size_t>(planes));
                return light ? image : withoutLight(image);
            };
            test(filter, make, planes);
        }
    });
}

} // namespace

TEST_CASE("degenerate sizes: one pixel, one row, one column")
{
    ofEachKind([](FilterRun& filter, const auto& make, int planes) {
        for (const std::pair<int, int>& size : { std::pair(1, 1), { 1, 23 }, { 23, 1 }, { 17, 2 } }) {
            const int width = size.first, height = size.second;
            CAPTURE(width);
            CAPTURE(height);
            const FilterImage image = make(width, height, Shape::Tilted, 3);
            const OracleResult rows = oracleRows(image);
            compare(image, filter(image, true), rows, planes);
            compare(image, filter(image), oracleColumns(image, rows), planes);
        }
        // A single pixel has itself alone to gather.
        FilterImage one = make(1, 1, Shape::Flat, 1);
        one.beta.at(0, 0) = 1.0f;
        const FilterResult result = filter(one);
        CHECK(result.value.at(0, 0) == one.value.at(0, 0));
        CHECK(result.effective.at(0, 0) == 1.0f);
    });
}

TEST_CASE("weights sum to 1: a constant field comes out unchanged to rounding")
{
    ofEachKind([](FilterRun& filter, const auto& make, int planes) {
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough }) {
            FilterImage image = make(50, 33, shape, 77);
            everyPixel(image.value.layout, [&](int x, int y) {
                for (int c = 0; c < planes; ++c)
                    image.value.at(x, y, static_cast<std::size_t>(c)) = 0.7f + static_cast<float>(c);
            });
            const FilterResult result = filter(image);
            double worst = 0;
            everyPixel(image.value.layout, [&](int x, int y) {
                for (int c = 0; c < planes; ++c)
                    worst =
                        std::max(worst, std::fabs(result.value.at(x, y, static_cast<std::size_t>(c)) / (0.7 + c) - 1));
            });
            CHECK(worst < 2.8e-6);
        }
    });
}

TEST_CASE("what is not gathered does not leak: NaN of another object, of another normal, of a pixel without light")
{
    ofEachKind([](FilterRun& filter, const auto& make, int planes) {
        FilterImage image = make(40, 24, Shape::Flat, 19);
        std::vector<std::pair<int, int>> bad;
        std::mt19937 random(2);
        for (int i = 0; i < 40; ++i) {
            const int x = static_cast<int>(random() % 40), y = static_cast<int>(random() % 24);
            bad.emplace_back(x, y);
            if (i % 3 == 0)
                image.objectId.at(x, y) = 99;
            else if (i % 3 == 1)
                image.beta.at(x, y) = -1.0f;
            else
                image.normal.setVector(x, y, { 0, -1, 0 });
        }
        FilterImage poisoned = image;
        for (const auto& [x, y] : bad)
            for (int c = 0; c < planes; ++c)
                poisoned.value.at(x, y, static_cast<std::size_t>(c)) = notANumber;
        const FilterResult expected = filter(image), found = filter(poisoned);
        unsigned leaks = 0;
        everyPixel(image.value.layout, [&](int x, int y) {
            if (std::ranges::find(bad, std::pair(x, y)) != bad.end())
                return;
            for (int c = 0; c < planes; ++c) {
                const std::size_t plane = static_cast<std::size_t>(c);
                leaks += found.value.at(x, y, plane) == expected.value.at(x, y, plane) ? 0 : 1;
            }
        });
        CHECK(leaks == 0);
    });
}

TEST_CASE("both passes gather what their definition in double gathers")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        double uncertain = 0;
        unsigned runs = 0, seed = 10;
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps, Shape::Rough })
            for (const auto& [oblique, narrower, fitted] : { std::tuple(false, false, 0u), { false, true, 1u },
                     { true, false, 1u }, { true, true, 0u }, { true, true, 1u } }) {
                FilterImage image = randomImage(53, 31, shape, seed++);
                image.params.fitted = fitted;
                CAPTURE(image.params.fitted);
                image.params.oblique = oblique ? 1 : 0;
                image.params.narrower = narrower ? 1 : 0;
                CAPTURE(static_cast<int>(shape));
                CAPTURE(image.params.oblique);
                CAPTURE(image.params.narrower);
                const OracleResult rows = oracleRows(image);
                uncertain += compare(image, filter(image, true), rows);
                uncertain += compare(image, filter(image), oracleColumns(image, rows));
                runs += 2;
            }
        // The comparison must not have been left out to death.
        CHECK(uncertain / runs < 0.1);
    });
}

TEST_CASE("with a specular term both channels are gathered with the same weights")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        const FilterImage image = randomImage(35, 20, Shape::Tilted, 5, 2);
        const OracleResult rows = oracleRows(image);
        compare(image, filter(image), oracleColumns(image, rows), 2);
    });
}

namespace {

/// A plane with a straight gradient, seen straight from above, whose kernels narrow towards one side; the left part is
/// of another object.
FilterImage gradient(std::uint32_t fitted)
{
    FilterImage image = randomImage(48, 36, Shape::Flat, 31);
    image.params.fitted = fitted;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            image.position.setVector(x, y, { 0.05 * x, 0, 0.05 * y });
            image.normal.setVector(x, y, { 0, 1, 0 });
            image.objectId.at(x, y) = x < 9 ? 2 : 1;
            image.pixelSize.at(x, y) = 0.05f;
            image.beta.at(x, y) = 0.05f + 0.004f * static_cast<float>(x);
            image.value.at(x, y) = static_cast<float>(0.1 + 0.01 * x + 0.006 * y);
        }
    return image;
}

} // namespace

TEST_CASE("fitted, a straight gradient comes out as it is, at edges too, and means are off there")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        const auto worstOf = [&](std::uint32_t fitted) {
            const FilterImage image = gradient(fitted);
            const FilterResult result = filter(image);
            double worst = 0;
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x)
                    worst = std::max<double>(worst, std::fabs(result.value.at(x, y) - image.value.at(x, y)));
            return worst;
        };
        const double mean = worstOf(0), line = worstOf(1);
        MESSAGE("off by up to " << line << ", means by " << mean);
        // What is left is the ridge's, one part in ten where a kernel is two pixels wide.
        CHECK(mean > 0.02);
        CHECK(line < 0.25 * mean);
    });
}

TEST_CASE("fitted, nothing is farther from the mean than lines are believed, nor negative, nor beyond all of the light")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = randomImage(40, 21, Shape::Steps, 8);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
                image.value.at(x, y) = std::min(1.0f, static_cast<float>(std::max(0, 3 * (x - 12) - y)) / 30.0f);
        image.value.at(30, 10) = 400.0f; // far brighter than all around: no line
        const FilterResult means = filter(image, true);
        image.params.fitted = 1;
        const FilterResult lines = filter(image, true);
        image.params.most = 1.0f;
        const FilterResult shares = filter(image, true);
        int beyond = 0, differ = 0;
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                const float mean = means.value.at(x, y), line = lines.value.at(x, y), share = shares.value.at(x, y);
                REQUIRE(std::isfinite(mean));
                // off (2 - 5 off / mean) is at most a fifth of the mean where off is.
                REQUIRE(line >= 0.799f * mean - 1e-30f); // less is flushed to 0
                REQUIRE(line <= 1.201f * mean);
                REQUIRE(lines.effective.at(x, y) >= 0.999f);
                REQUIRE(share <= std::max(1.0f, mean));
                beyond += line > 1.0f && mean < 1.0f ? 1 : 0;
                differ += line != mean ? 1 : 0;
            }
        CHECK(beyond > 3);
        CHECK(differ > 100);
    });
}

TEST_CASE("fitted, what is not finite stays so: nothing turns black")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = randomImage(40, 21, Shape::Flat, 8);
        image.params.fitted = 1;
        for (const float bad : { notANumber, std::numeric_limits<float>::infinity() }) {
            image.value.at(20, 10) = bad;
            image.beta.at(20, 10) = 0.1f;
            CHECK_FALSE(std::isfinite(filter(image).value.at(20, 10)));
        }
    });
}

TEST_CASE("no weight is negative, whatever the normals: results stay within the values gathered")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const float cosine : { -1.0f, 0.0f, 0.985f }) {
            FilterImage image = randomImage(40, 21, Shape::Flat, 8);
            std::mt19937 random(4);
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x)
                    image.normal.setVector(x, y, unitVector(random));
            image.params.normalCosine = cosine;
            const FilterResult result = filter(image);
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) {
                    REQUIRE(result.value.at(x, y) >= 0.0f);
                    REQUIRE(result.value.at(x, y) <= 1.0f);
                    REQUIRE(result.effective.at(x, y) >= 0.999f);
                }
        }
    });
}

TEST_CASE("a pixel with nothing to gather keeps its value, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        FilterImage image = randomImage(37, 18, Shape::Flat, 9);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                image.beta.at(x, y) = std::vector { 0.0f, -1.0f, 0.5f, 1e-30f }[static_cast<std::size_t>(x) % 4];
                image.objectId.at(x, y) =
                    static_cast<std::uint32_t>(1 + y * image.width() + x); // all of different objects
            }
        const FilterResult result = filter(image);
        for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x) {
                REQUIRE(result.value.at(x, y) == image.value.at(x, y));
                REQUIRE(result.effective.at(x, y) == 1.0f);
            }
    });
}

TEST_CASE("the padding beyond the right border is not read")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const int width : { 16, 17, 31 }) {
            const FilterImage image = randomImage(width, 9, Shape::Flat, 12);
            FilterImage baited = image;
            // Everything there looks like the pixels inside, but for the object and a value that would show.
            const auto bait = [&](auto& planes, std::size_t count) {
                for (std::size_t plane = 0; plane < count; ++plane)
                    for (int y = 0; y < 9; ++y)
                        for (int x = width; x < static_cast<int>(planes.layout.stride); ++x)
                            planes.at(x, y, plane) = planes.at(width - 1, y, plane);
            };
            bait(baited.position, 3);
            bait(baited.normal, 3);
            bait(baited.beta, 1);
            for (int y = 0; y < 9; ++y)
                for (int x = width; x < static_cast<int>(image.value.layout.stride); ++x)
                    baited.value.at(x, y) = 1e6f;
            const FilterResult expected = filter(image), found = filter(baited);
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < width; ++x)
                    REQUIRE(found.value.at(x, y) == expected.value.at(x, y));
        }
    });
}

TEST_CASE("rows below the image are not read")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        // The last rows of a larger image lie below; then the same rows hold nothing.
        FilterImage image = randomImage(21, 30, Shape::Flat, 13), cut = image;
        for (int y = 22; y < 30; ++y)
            for (int x = 0; x < 21; ++x)
                cut.objectId.at(x, y) = 0;
        image.params.height = image.params.y1 = 22;
        cut.params = image.params;
        const FilterResult found = filter(image), expected = filter(cut);
        for (int y = 0; y < 22; ++y)
            for (int x = 0; x < 21; ++x)
                REQUIRE(found.value.at(x, y) == expected.value.at(x, y));
    });
}

TEST_CASE("windows are symmetric: a mirrored image gives the mirrored result")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        const FilterImage image = randomImage(45, 26, Shape::Steps, 15);
        const FilterResult straight = filter(image);
        for (const bool vertical : { false, true }) {
            const FilterImage turned = mirrored(image, vertical);
            const FilterResult result = filter(turned);
            double worst = 0;
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x) {
                    const int mx = vertical ? x : image.width() - 1 - x, my = vertical ? image.height() - 1 - y : y;
                    worst = std::max<double>(worst, std::fabs(result.value.at(mx, my) - straight.value.at(x, y)));
                }
            CAPTURE(vertical);
            CHECK(worst < 1e-5);
        }
    });
}

TEST_CASE("widths are metres, not pixels: a scene in other units gives the same picture")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        const FilterImage image = randomImage(45, 26, Shape::Tilted, 16);
        const FilterResult expected = filter(image);
        // The smallest has areas whose products hardly fit a float.
        for (const float factor : { 1.0f / 1024, 4096.0f, 0x1p-27f }) {
            const FilterResult result = filter(scaled(image, factor));
            for (int y = 0; y < image.height(); ++y)
                for (int x = 0; x < image.width(); ++x)
                    REQUIRE(result.value.at(x, y) == doctest::Approx(expected.value.at(x, y)).epsilon(1e-5));
        }
    });
}

TEST_CASE("a window of the image has the pixels of the whole, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        const FilterImage image = randomImage(70, 40, Shape::Rough, 17);
        const FilterResult whole = filter(image);
        const FilterResult part = filter(image, false, { 32, 7, 64, 25 });
        for (int y = 7; y < 25; ++y)
            for (int x = 32; x < 64; ++x)
                REQUIRE(part.value.at(x, y) == whole.value.at(x, y));
        CHECK(part.value.at(31, 7) == -7.0f);
        CHECK(part.value.at(64, 7) == -7.0f);
    });
}

TEST_CASE("two passes are close to the gather over squares of pixels, which they stand for")
{
    onEveryDevice([](const device::Device& device) {
        FilterRun filter(device);
        for (const Shape shape : { Shape::Flat, Shape::Tilted, Shape::Steps }) {
            FilterImage image = randomImage(64, 48, shape, 21);
            for (int y = 0; y < 48; ++y)
                for (int x = 0; x < 64; ++x) {
                    image.beta.at(x, y) = 0.09f;
                    image.value.at(x, y) = static_cast<float>(0.5 + 0.4 * std::sin(0.21 * x + 0.13 * y));
                }
            const FilterResult separable = filter(image);
            const std::vector<double> square = oracleSquare(image);
            double difference = 0, effect = 0;
            for (int y = 0; y < 48; ++y)
                for (int x = 0; x < 64; ++x) {
                    const double reference = square[static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)];
                    difference += std::pow(separable.value.at(x, y) - reference, 2) / (64 * 48);
                    effect += std::pow(image.value.at(x, y) - reference, 2) / (64 * 48);
                }
            MESSAGE("shape " << static_cast<int>(shape) << ": two passes differ from the square by RMS "
                             << std::sqrt(difference) << ", the filter's own effect is " << std::sqrt(effect));
            // A square is cut where a circle is not, and around the corners of objects the two orders of going differ.
            CHECK(std::sqrt(difference) < (shape == Shape::Steps ? 0.5 : 0.15) * std::sqrt(effect));
        }
    });
}
