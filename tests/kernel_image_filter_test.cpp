// filter/image.cl alone, kernel by kernel, against their definitions in double.
#include "tests/pass_bench.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr float beside = 1e30f; ///< beyond images

using Images = std::vector<std::pair<const char*, Planes<float>>>; ///< by the names that kernels have them by

/// An image, no larger than the frame, and the pixels of it that are made.
struct Area {
    int width, height;
    image::Window window;

    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// The whole image, parts of it, and images that are smaller than windows.
const std::vector<Area>& areas()
{
    static const std::vector<Area> all { { 45, 31, { 0, 0, 45, 31 } }, { 45, 31, { 9, 4, 40, 23 } },
        { 45, 31, { 30, 29, 45, 31 } }, { 1, 1, { 0, 0, 1, 1 } }, { 2, 3, { 0, 0, 2, 3 } }, { 45, 1, { 0, 0, 45, 1 } },
        { 1, 31, { 0, 0, 1, 31 } } };
    return all;
}

/// A frame that has every filter.
render::Settings everyFilter()
{
    render::Settings s = sized(render::monteCarlo(4), 45, 31);
    s.filters = { { "gaussian", { 2.0f } }, { "bilateral", { 2.0f, 1.0f } }, { "median", { 1.0f } },
        { "mad-median", { 1.0f, 4.45f } }, { "sharpen", { 1.5f, 0.5f } }, { "bloom", { 1.0f, 0.1f, 3.0f } },
        { "colour", { 1.0f, 0.5f, 0.25f, 0.6f } }, { "box", { 1.0f } } };
    return s;
}

template <class Visit>
void everyPixelOf(const image::Window& window, const Visit& visit)
{
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            visit(x, y);
}

/// Calls test(bench, area, random) for the kernel's first pass on every device.
template <class Test>
void inEveryArea(const std::string& kernel, const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        CAPTURE(kernel);
        DeclaredFrame frame(device, smallScene(), everyFilter());
        std::mt19937 random(1);
        for (const Area& area : areas()) {
            CAPTURE(&area - areas().data());
            PassBench bench(frame, kernel);
            test(bench, area, random);
        }
    });
}

/// What the kernel makes of these images; fails if it writes anything beside the window.
Planes<float> made(PassBench& bench, const Area& area, const Images& images)
{
    auto p = bench.own<shared::AnalysisParams>("p");
    p.width = static_cast<std::uint32_t>(area.width);
    p.height = static_cast<std::uint32_t>(area.height);
    render::setRectangle(p, area.window);
    bench.value("p", p);
    bench.window(area.window);
    for (const auto& [name, planes] : images)
        bench.plane(name, planes);
    bench.plane("out", Planes<float>(bench.layout, 3, 7.0f));
    bench.run();
    return bench.pixels<float>("out");
}

/// Colours over so many powers of ten, some black, and some of no light in some channels; with `broken` some, the
/// first among them, with a channel that is not finite.
Planes<float> someImage(const PassBench& bench, const Area& area, std::mt19937& random, double decades, bool broken)
{
    Planes<float> out(bench.layout, 3, beside);
    const float bad[] = { std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity() };
    everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
        const double scale = random() % 8 == 0 ? 0 : std::pow(10, uniform(random, -decades / 2, decades / 2));
        for (std::size_t k = 0; k < 3; ++k)
            out.at(x, y, k) = static_cast<float>(random() % 12 == 0 ? 0 : scale * uniform(random, 0.2, 1));
        if (broken && (x + y == 0 || random() % 6 == 0))
            out.at(x, y, random() % 3) = bad[random() % 3];
    });
    return out;
}

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
glm::dvec3 finiteOf(const Planes<float>& image, int x, int y)
{
    return isFinite(image.vector(x, y)) ? image.vector(x, y) : glm::dvec3(0);
}

void requireNear(const Planes<float>& found, int x, int y, const glm::dvec3& expected, const glm::dvec3& tolerance)
{
    CAPTURE(x);
    CAPTURE(y);
    for (int k = 0; k < 3; ++k) {
        CAPTURE(k);
        CAPTURE(expected[k]);
        CAPTURE(found.vector(x, y)[k]);
        // No weight is less than 2^-126, maths.h.
        const double least = tolerance[k] > 0 ? 1e-30 : 0;
        REQUIRE(std::fabs(found.vector(x, y)[k] - expected[k]) <= std::max(tolerance[k], least));
    }
}

/// The mean of the finite pixels within (reachX, reachY) of a pixel, each of weight(dx, dy, own, value); 0 if there is
/// none.
template <class Weight>
glm::dvec3 weightedMean(
    const Planes<float>& image, const Area& area, int x, int y, int reachX, int reachY, const Weight& weight)
{
    glm::dvec3 sum(0);
    double weights = 0;
    for (int dy = -reachY; dy <= reachY; ++dy)
        for (int dx = -reachX; dx <= reachX; ++dx) {
            if (!area.contains(x + dx, y + dy) || !isFinite(image.vector(x + dx, y + dy)))
                continue;
            const double w = weight(dx, dy, image.vector(x, y), image.vector(x + dx, y + dy));
            sum += w * image.vector(x + dx, y + dy);
            weights += w;
        }
    return weights > 0 ? sum / weights : sum;
}

/// Of a mean; as it is summed in differences from the pixel's own value, it has that value's, too.
glm::dvec3 roundingOf(const glm::dvec3& mean, const Planes<float>& image, int x, int y)
{
    return 3e-5 * mean + 1e-6 * finiteOf(image, x, y);
}

int reachOf(float sigma) { return static_cast<int>(std::ceil(3.0 * sigma)); }

double gaussian(double sigma, double squared) { return std::exp(-squared / (2 * sigma * sigma)); }

/// Weight of a neighbour by its brightness.
double stopsWeight(double tolerance, double own, double there)
{
    if (own == 0 || there == 0)
        return own == there ? 1 : 0;
    return gaussian(tolerance, std::pow(std::log2(there / own), 2));
}

double medianOf(std::vector<double> values)
{
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return n == 0 ? 0 : (values[(n - 1) / 2] + values[n / 2]) / 2;
}

/// What a channel becomes, and where the deviation is at the limit what else it may become.
struct MedianOracle {
    double value, other;
    bool replaced;
};

MedianOracle medianOracle(const Planes<float>& image, const Area& area, int x, int y, int k, int radius, double factor)
{
    std::vector<double> values, off;
    for (int py = y - radius; py <= y + radius; ++py)
        for (int px = x - radius; px <= x + radius; ++px)
            if (area.contains(px, py) && isFinite(image.vector(px, py)))
                values.push_back(image.vector(px, py)[k]);
    const double median = medianOf(values);
    if (factor < 0 || !isFinite(image.vector(x, y)))
        return { median, median, true };
    for (const double v : values)
        off.push_back(std::fabs(v - median));
    const double own = image.vector(x, y)[k], limit = factor * medianOf(off), distance = std::fabs(own - median);
    const bool uncertain = std::fabs(distance - limit) <= 1e-6 * (own + median + limit), replaced = distance > limit;
    return { replaced ? median : own, replaced != uncertain ? median : own, replaced };
}

/// Some values other than the frame's.
void setValues(PassBench& bench, const std::string& kernel, float factor)
{
    if (kernel == "imageRows" || kernel == "imageColumns" || kernel == "imageBilateral")
        bench.value("sigma", 1.7f);
    if (kernel == "imageMedian") {
        bench.value("radius", 2u);
        bench.value("factor", factor);
    }
}

} // namespace

TEST_CASE("imageBox: the mean of the finite pixels in the square")
{
    inEveryArea("imageBox", [&](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const std::uint32_t radius : { 1u, 2u, 8u })
            for (const bool broken : { false, true }) {
                CAPTURE(radius);
                const auto image = someImage(bench, area, random, 6, broken);
                bench.value("radius", radius);
                const auto found = made(bench, area, { { "image", image } });
                const int reach = static_cast<int>(radius);
                everyPixelOf(area.window, [&](int x, int y) {
                    const glm::dvec3 expected =
                        weightedMean(image, area, x, y, reach, reach, [](auto&&...) { return 1.0; });
                    requireNear(found, x, y, expected, roundingOf(expected, image, x, y));
                });
            }
    });
}

TEST_CASE("imageRows, imageColumns: the Gaussian over the finite pixels of the row, and of the column")
{
    for (const char* kernel : { "imageRows", "imageColumns" })
        inEveryArea(kernel, [&](PassBench& bench, const Area& area, std::mt19937& random) {
            const bool rows = std::string(kernel) == "imageRows";
            for (const float sigma : { 0.4f, 1.3f, 2.0f, 9.0f })
                for (const bool broken : { false, true }) {
                    CAPTURE(sigma);
                    const auto image = someImage(bench, area, random, 6, broken);
                    bench.value("sigma", sigma);
                    const auto found = made(bench, area, { { "image", image } });
                    const int reachX = rows ? reachOf(sigma) : 0, reachY = rows ? 0 : reachOf(sigma);
                    const auto weight = [&](int dx, int dy, auto&&...) { return gaussian(sigma, dx * dx + dy * dy); };
                    everyPixelOf(area.window, [&](int x, int y) {
                        const glm::dvec3 expected = weightedMean(image, area, x, y, reachX, reachY, weight);
                        bool any = false;
                        for (int dx = -reachX; dx <= reachX; ++dx)
                            any = any || (area.contains(x + dx, y) && isFinite(image.vector(x + dx, y)));
                        if (rows && !any) // the columns leave it out
                            REQUIRE_FALSE(isFinite(found.vector(x, y)));
                        else
                            requireNear(found, x, y, expected, roundingOf(expected, image, x, y));
                    });
                }
        });
}

TEST_CASE("imageRows, imageColumns: a hole wider than the Gaussian darkens nothing around it")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, smallScene(), everyFilter());
        PassBench rows(frame, "imageRows"), columns(frame, "imageColumns");
        const Area area { 40, 30, { 0, 0, 40, 30 } };
        Planes<float> image(rows.layout, 3, 0.75f);
        for (int y = 10; y < 20; ++y)
            for (int x = 5; x < 35; ++x)
                image.at(x, y, 1) = std::numeric_limits<float>::quiet_NaN();
        for (PassBench* bench : { &rows, &columns })
            bench->value("sigma", 1.0f);
        const auto found = made(columns, area, { { "image", made(rows, area, { { "image", image } }) } });
        everyPixelOf(area.window, [&](int x, int y) {
            CAPTURE(x);
            CAPTURE(y);
            const float expected = x >= 8 && x < 32 && y >= 13 && y < 17 ? 0.0f : 0.75f;
            for (std::size_t c = 0; c < 3; ++c)
                REQUIRE(found.at(x, y, c) == doctest::Approx(expected).epsilon(1e-6));
        });
    });
}

TEST_CASE("imageBilateral: Gaussians of distance and of stops, black with black alone")
{
    inEveryArea("imageBilateral", [](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const glm::vec2 widths :
            { glm::vec2(0.4f, 1.0f), glm::vec2(1.3f, 0.4f), glm::vec2(2, 1.5f), glm::vec2(2, 20) })
            for (const double decades : { 0.5, 6.0 })
                for (const bool broken : { false, true }) {
                    const float sigma = widths.x, tolerance = widths.y;
                    CAPTURE(sigma);
                    CAPTURE(tolerance);
                    CAPTURE(decades);
                    const auto image = someImage(bench, area, random, decades, broken);
                    bench.value("sigma", sigma);
                    bench.value("tolerance", tolerance);
                    const auto found = made(bench, area, { { "image", image } });
                    const int reach = reachOf(sigma);
                    const auto weight = [&](int dx, int dy, const glm::dvec3& own, const glm::dvec3& there) {
                        const double stops =
                            isFinite(own) ? stopsWeight(tolerance, luminanceOf(own), luminanceOf(there)) : 1;
                        return gaussian(sigma, dx * dx + dy * dy) * stops;
                    };
                    everyPixelOf(area.window, [&](int x, int y) {
                        const glm::dvec3 expected = weightedMean(image, area, x, y, reach, reach, weight);
                        requireNear(found, x, y, expected, roundingOf(expected, image, x, y));
                    });
                }
    });
}

TEST_CASE("imageMedian: medians of channels, of outliers alone if a factor says what is one")
{
    unsigned replaced = 0, kept = 0;
    const auto near = [](double a, double b) { return std::fabs(a - b) <= 1e-6 * b; };
    inEveryArea("imageMedian", [&](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const std::uint32_t radius : { 1u, 2u, 3u })
            for (const float factor : { -1.0f, 1.0f, 4.45f })
                for (const bool broken : { false, true }) {
                    CAPTURE(radius);
                    CAPTURE(factor);
                    const auto image = someImage(bench, area, random, 3, broken);
                    bench.value("radius", radius);
                    bench.value("factor", factor);
                    const auto found = made(bench, area, { { "image", image } });
                    everyPixelOf(area.window, [&](int x, int y) {
                        for (int k = 0; k < 3; ++k) {
                            const MedianOracle expected =
                                medianOracle(image, area, x, y, k, static_cast<int>(radius), factor);
                            const double is = found.vector(x, y)[k];
                            CAPTURE(is);
                            CAPTURE(expected.value);
                            REQUIRE((near(is, expected.value) || near(is, expected.other)));
                            if (factor > 0)
                                ++(expected.replaced ? replaced : kept);
                        }
                    });
                }
    });
    CHECK(std::min(replaced, kept) > 2000);
}

TEST_CASE("sharpenImage: what a blur takes away is added, and nothing falls below 0")
{
    unsigned black = 0;
    inEveryArea("sharpenImage", [&](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const float amount : { 0.0f, 0.7f, 3.0f }) {
            const auto image = someImage(bench, area, random, 3, true), soft = someImage(bench, area, random, 3, true);
            bench.value("amount", amount);
            const auto found = made(bench, area, { { "image", image }, { "blurred", soft } });
            everyPixelOf(area.window, [&](int x, int y) {
                const double a = amount;
                const glm::dvec3 v = finiteOf(image, x, y), b = finiteOf(soft, x, y);
                const glm::dvec3 sum = v + a * (v - b);
                requireNear(found, x, y, glm::max(sum, glm::dvec3(0)), 1e-6 * a * (v + b));
                black += sum.x < 0 && found.at(x, y) == 0 ? 1 : 0;
            });
        }
    });
    CHECK(black > 200);
}

TEST_CASE("brightParts: light above the threshold in the pixel's colour, with no threshold all of it to the bit")
{
    unsigned bright = 0, dark = 0;
    inEveryArea("brightParts", [&](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const float threshold : { 0.0f, 0.02f, 1.0f }) {
            const auto image = someImage(bench, area, random, 4, true);
            bench.value("threshold", threshold);
            const auto found = made(bench, area, { { "image", image } });
            everyPixelOf(area.window, [&](int x, int y) {
                const glm::dvec3 v = finiteOf(image, x, y);
                const double l = luminanceOf(v), rest = std::max(l - threshold, 0.0);
                requireNear(found, x, y, l > threshold ? v * (rest / l) : glm::dvec3(0),
                    (threshold > 0 ? 1e-6 : 0.0) * (l > 0.999 * threshold ? v : glm::dvec3(0)));
                if (threshold > 0)
                    ++(l > threshold ? bright : dark);
            });
        }
    });
    CHECK(std::min(bright, dark) > 200);
}

TEST_CASE("addBloom: a half, a third and a sixth of what is blurred, at no strength nothing to the bit")
{
    inEveryArea("addBloom", [](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const float strength : { 0.0f, 0.1f, 2.5f }) {
            Images images;
            for (const char* name : { "image", "near", "middle", "far" })
                images.emplace_back(name, someImage(bench, area, random, 3, true));
            bench.value("strength", strength);
            const auto found = made(bench, area, images);
            everyPixelOf(area.window, [&](int x, int y) {
                const auto of = [&](std::size_t k) { return finiteOf(images[k].second, x, y); };
                const double s = strength;
                const glm::dvec3 expected = of(0) + s * (of(1) / 2.0 + of(2) / 3.0 + of(3) / 6.0);
                requireNear(found, x, y, expected, (s > 0 ? 1e-6 : 0) * expected);
            });
        }
    });
}

TEST_CASE("colourImage: the colour as far as its density says, at none nothing to the bit")
{
    inEveryArea("colourImage", [](PassBench& bench, const Area& area, std::mt19937& random) {
        for (const float density : { 0.0f, 0.6f, 1.0f }) {
            const auto image = someImage(bench, area, random, 6, true);
            bench.value("red", 3.0f);
            bench.value("green", 0.25f);
            bench.value("blue", 0.0f);
            bench.value("density", density);
            const auto found = made(bench, area, { { "image", image } });
            everyPixelOf(area.window, [&](int x, int y) {
                const double d = density;
                const glm::dvec3 v = finiteOf(image, x, y), gains(1 + 2 * d, 1 - 0.75 * d, 1 - d);
                requireNear(found, x, y, v * gains, (d > 0 ? 1e-6 : 0) * v);
            });
        }
    });
}

TEST_CASE("a constant image stays what it is to the bit: imageRows, imageColumns, imageBilateral, imageMedian, sharpen")
{
    for (const char* kernel : { "imageRows", "imageColumns", "imageBilateral", "imageMedian", "sharpenImage" })
        inEveryArea(kernel, [&](PassBench& bench, const Area& area, std::mt19937&) {
            Planes<float> image(bench.layout, 3, beside);
            everyPixelOf({ 0, 0, area.width, area.height }, [&](int x, int y) {
                image.setVector(x, y, { 0.3, 5.1, 1.7e-3 });
            });
            setValues(bench, kernel, -1);
            Images images { { "image", image } };
            if (bench.has("blurred"))
                images.emplace_back("blurred", image);
            const auto found = made(bench, area, images);
            everyPixelOf(area.window, [&](int x, int y) { REQUIRE(found.vector(x, y) == image.vector(x, y)); });
        });
}

TEST_CASE("a power of two times the image is made that times the result, to the bit")
{
    for (const char* kernel : { "imageRows", "imageColumns", "imageMedian", "sharpenImage", "colourImage" })
        inEveryArea(kernel, [&](PassBench& bench, const Area& area, std::mt19937& random) {
            setValues(bench, kernel, 1.5f);
            Images images { { "image", someImage(bench, area, random, 4, false) } };
            if (bench.has("blurred"))
                images.emplace_back("blurred", someImage(bench, area, random, 4, false));
            const auto plain = made(bench, area, images);
            for (const float times : { 1024.0f, 1.0f / 4096.0f }) {
                Images scaled = images;
                for (auto& [name, planes] : scaled)
                    std::ranges::transform(planes.values, planes.values.begin(), [&](float v) { return v * times; });
                const auto found = made(bench, area, scaled);
                everyPixelOf(area.window, [&](int x, int y) {
                    REQUIRE(found.vector(x, y) == static_cast<double>(times) * plain.vector(x, y));
                });
            }
        });
}
