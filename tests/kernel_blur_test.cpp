// blur.cl alone: rows, columns and lines along motions against gathers over the whole image in double.
#include "kernels/shared/frame.h"
#include "tests/distributed_support.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr double cut = 2.5; ///< standard deviations at which kernels end
constexpr int lensReach = WEDGE_MAX_RADIUS, motionReach = 160; ///< pixels
constexpr float beside = 1e30f; ///< in the padding

/// Weight of two pixels that are d apart: the narrower kernel of both.
double pairWeight(double a, double b, double d)
{
    const double s = std::min(a, b);
    return s > 0 && d <= cut * s ? std::exp(-d * d / (2 * s * s)) : 0;
}

/// What is blurred.
struct Blurred {
    explicit Blurred(const Region& of)
        : region(of)
        , sigma(filledPlanes(of, 1, beside, [](int, int, std::size_t) { return 0; }))
        , direction(filledPlanes(of, 2, beside, [](int, int, std::size_t plane) { return plane == 0 ? 1 : 0; }))
        , value(filledPlanes(of, 3, beside, [](int, int, std::size_t) { return 0; }))
    {
    }
    void setDirection(int x, int y, double angle)
    {
        direction.at(x, y, 0) = static_cast<float>(std::cos(angle));
        direction.at(x, y, 1) = static_cast<float>(std::sin(angle));
    }
    template <class Visit>
    void everywhere(const Visit& visit)
    {
        everyPixel({ 0, 0, region.width, region.height }, visit);
    }

    /// Directions times widths, as lean frames have them, and back.
    Planes<float> vectors() const
    {
        Planes<float> out = direction;
        for (std::size_t i = 0; i < out.values.size(); ++i)
            out.values[i] *= sigma.values[i % sigma.values.size()];
        return out;
    }
    void setVectors(const Planes<float>& vectors)
    {
        everywhere([&](int x, int y) {
            const glm::dvec2 along(vectors.at(x, y), vectors.at(x, y, 1));
            const double width = glm::length(along);
            sigma.at(x, y) = static_cast<float>(width);
            direction.at(x, y) = static_cast<float>(width > 0 ? along.x / width : 1);
            direction.at(x, y, 1) = static_cast<float>(width > 0 ? along.y / width : 0);
        });
    }

    Region region;
    Planes<float> sigma, direction, value;
};

/// Widths of no, few and many pixels in turn, in any order; colours in [0, 1].
Blurred randomImage(const Region& region, unsigned seed)
{
    Blurred out(region);
    std::mt19937 random(seed);
    const double widths[] = { 0, 0.3, 0.45, 1, 2.3, 4.1, 9, 30, 1e4 };
    out.everywhere([&](int x, int y) {
        out.sigma.at(x, y) = static_cast<float>(widths[random() % 9] * uniform(random, 0.9, 1.1));
        out.setDirection(x, y, uniform(random, -0.25, 0.25));
        out.value.setVector(x, y, { uniform(random), uniform(random), uniform(random) });
    });
    return out;
}

Planes<float> lensFiltered(DeclaredFrame& frame, const Blurred& image, const std::string& kernel)
{
    RegionPass pass(frame, kernel, { "out" });
    pass.plane("lens", image.sigma);
    pass.plane("in", image.value);
    pass.runIn(image.region, paramsOf(image.region));
    return pass.floats("out");
}

/// A texture, or, of one channel, the first of its numbers as a light's value. image: becomes what the pass has of it.
Planes<float> motionFiltered(MovingFrame& frame, Blurred& image, std::uint32_t channels = 3)
{
    RegionPass pass(frame, "blurMotion", { "out" }, channels == 3 ? 1 : 0);
    if (frame.lean) {
        pass.plane("vectors", image.vectors());
        image.setVectors(pass.floats("vectors"));
    } else {
        pass.plane("along", image.sigma);
        pass.plane("directions", image.direction);
    }
    if (channels == 3) {
        pass.plane("texture", image.value);
        image.value = pass.floats("texture");
    } else {
        pass.plane("value",
            std::vector(image.value.values.begin(),
                image.value.values.begin() + static_cast<std::ptrdiff_t>(image.region.layout.size)));
    }
    pass.runIn(image.region, paramsOf(image.region));
    return pass.floats("out");
}

/// blurRows (step 1, 0) or blurColumns (0, 1) of one pixel.
glm::dvec3 lensOracle(const Blurred& image, int x, int y, int stepX, int stepY)
{
    glm::dvec3 sum = image.value.vector(x, y);
    double weights = 1;
    for (int k = -lensReach; k <= lensReach; ++k) {
        const int px = x + k * stepX, py = y + k * stepY;
        if (k == 0 || !image.region.contains(px, py))
            continue;
        const double w = pairWeight(image.sigma.at(x, y), image.sigma.at(px, py), std::abs(k));
        sum += w * image.value.vector(px, py);
        weights += w;
    }
    return sum / weights;
}

struct MotionOracle {
    glm::dvec3 value;
    bool uncertain; ///< a step ends on a pixel's edge, or a direction is at the limit
};

MotionOracle motionOracle(const Blurred& image, int x, int y)
{
    const glm::dvec2 along(image.direction.at(x, y), image.direction.at(x, y, 1));
    MotionOracle out { image.value.vector(x, y), false };
    double weights = 1;
    for (int k = -motionReach; k <= motionReach; ++k) {
        const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) + static_cast<double>(k) * along;
        const int px = static_cast<int>(std::floor(at.x)), py = static_cast<int>(std::floor(at.y));
        if (k == 0 || std::abs(k) > cut * image.sigma.at(x, y))
            continue;
        for (int axis = 0; axis < 2; ++axis)
            out.uncertain |= std::fabs(at[axis] - std::round(at[axis])) < 1e-4 && at[axis] > -1 && at[axis] < 1000;
        if (!image.region.contains(px, py))
            continue;
        const double turn = glm::dot(along, glm::dvec2(image.direction.at(px, py), image.direction.at(px, py, 1)));
        out.uncertain |= std::fabs(turn - 0.9) < 1e-6;
        const double w = turn > 0.9 ? pairWeight(image.sigma.at(x, y), image.sigma.at(px, py), std::abs(k)) : 0;
        out.value += w * image.value.vector(px, py);
        weights += w;
    }
    out.value /= weights;
    return out;
}

void requireColour(const Planes<float>& found, int x, int y, glm::dvec3 expected, double tolerance = 1e-5)
{
    CAPTURE(x);
    CAPTURE(y);
    REQUIRE(glm::length(found.vector(x, y) - expected) <= tolerance);
}

/// Rows, then columns.
Planes<float> bothFiltered(DeclaredFrame& frame, Blurred image)
{
    image.value = lensFiltered(frame, image, "blurRows");
    return lensFiltered(frame, image, "blurColumns");
}

} // namespace

TEST_CASE("rows and columns are the gather over all pixels, the narrower kernel of each pair")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        unsigned seed = 0;
        for (const Region& region : regions()) {
            const Blurred image = randomImage(region, ++seed);
            const auto rows = lensFiltered(frame, image, "blurRows"),
                       columns = lensFiltered(frame, image, "blurColumns");
            everyPixel(region.window, [&](int x, int y) {
                requireColour(rows, x, y, lensOracle(image, x, y, 1, 0));
                requireColour(columns, x, y, lensOracle(image, x, y, 0, 1));
            });
        }
    });
}

TEST_CASE("lines along motions are the gather over all steps, in every direction")
{
    int uncertain = 0, pixels = 0;
    unsigned seed = 10;
    onEveryRegion(10, [&](MovingFrame& frame, const Region& region, std::mt19937& random) {
        for (const double angle : { 0.0, 0.7, 1.7, 2.9, -0.5, -1.3, -2.6 }) {
            CAPTURE(angle);
            const double middle = angle;
            Blurred image = randomImage(region, ++seed);
            image.everywhere([&](int x, int y) { image.setDirection(x, y, middle + uniform(random, -0.25, 0.25)); });
            const auto found = motionFiltered(frame, image);
            everyPixel(region.window, [&](int x, int y) {
                const MotionOracle expected = motionOracle(image, x, y);
                ++pixels;
                uncertain += expected.uncertain ? 1 : 0;
                if (!expected.uncertain)
                    requireColour(found, x, y, expected.value);
            });
        }
    });
    CHECK(uncertain < 0.05 * pixels);
}

TEST_CASE("a light's value becomes what the first channel of a texture does")
{
    onEveryRegion(3, [](MovingFrame& frame, const Region& region, std::mt19937& random) {
        Blurred image = randomImage(region, static_cast<unsigned>(random()));
        const auto three = motionFiltered(frame, image), one = motionFiltered(frame, image, 1);
        everyPixel(region.window, [&](int x, int y) { REQUIRE(one.at(x, y) == three.at(x, y)); });
    });
}

TEST_CASE("of width 0 each pixel is as it was, to the bit; a constant image stays what it is at any widths")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        for (const Region& region : regions()) {
            Blurred still = randomImage(region, 4), constant = randomImage(region, 5);
            still.everywhere([&](int x, int y) {
                still.sigma.at(x, y) = 0;
                constant.value.setVector(x, y, { 0.3, 5, 1e-3 });
            });
            const Planes<float> stills[] = { lensFiltered(frame, still, "blurRows"),
                lensFiltered(frame, still, "blurColumns"), motionFiltered(frame, still) };
            const Planes<float> constants[] = { lensFiltered(frame, constant, "blurRows"),
                lensFiltered(frame, constant, "blurColumns"), motionFiltered(frame, constant) };
            everyPixel(region.window, [&](int x, int y) {
                for (const Planes<float>& found : stills)
                    REQUIRE(found.vector(x, y) == still.value.vector(x, y));
                for (const Planes<float>& found : constants)
                    requireColour(found, x, y, { 0.3, 5, 1e-3 }, 1e-5);
            });
        }
    });
}

TEST_CASE("what is sharp neither gets anything from what is blurred nor gives it anything")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        const Region region(45, 29);
        Blurred image(region);
        std::mt19937 random(6);
        const auto sharp = [](int x, int y) { return (x * 7 + y * 3) % 5 < 2; };
        // Widths below 0.4 pixels reach no neighbour and are sharp, too.
        image.everywhere([&](int x, int y) {
            image.sigma.at(x, y) = sharp(x, y) ? (x % 2 == 0 ? 0 : 0.39f) : static_cast<float>(uniform(random, 1, 12));
            const double value = sharp(x, y) ? 1e6 * uniform(random) : 2;
            image.value.setVector(x, y, glm::dvec3(value));
        });
        const Planes<float> all[] = { bothFiltered(frame, image), motionFiltered(frame, image) };
        for (const Planes<float>& found : all)
            everyPixel(region.window, [&](int x, int y) {
                if (sharp(x, y))
                    REQUIRE(found.vector(x, y) == image.value.vector(x, y));
                else
                    requireColour(found, x, y, glm::dvec3(2), 1e-5);
            });
    });
}

TEST_CASE("motions in other directions do not mix, whichever way they turn")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        const Region region(45, 29);
        const double degree = std::acos(-1.0) / 180;
        for (const double own : { 0.0, 37.0, 90.0, -120.0 })
            for (const double turn : { 20.0, -20.0, 30.0, -30.0, 90.0, 180.0 }) {
                CAPTURE(own);
                CAPTURE(turn);
                Blurred image(region);
                image.everywhere([&](int x, int y) {
                    const bool other = (x + 2 * y) % 3 == 0;
                    image.sigma.at(x, y) = 4;
                    image.setDirection(x, y, (own + (other ? turn : 0)) * degree);
                    image.value.setVector(x, y, glm::dvec3(other ? 1e6 : 2));
                });
                const auto found = motionFiltered(frame, image);
                const glm::dvec3 middle = found.vector(22, 15); // 22 + 30 = 52: not one of the others
                if (std::fabs(turn) < 25) {
                    REQUIRE(middle.x > 1e4);
                    continue;
                }
                everyPixel(region.window, [&](int x, int y) {
                    const bool other = (x + 2 * y) % 3 == 0;
                    REQUIRE(agree(found.at(x, y), other ? 1e6 : 2, 1e-6));
                });
            }
    });
}

TEST_CASE("a point becomes a Gaussian of that deviation: along axes, and of the lens in both")
{
    onEveryDevice([](const device::Device& device) {
        MovingFrame frame(device, Kept::Full);
        const Region region(73, 71); // no kernel of a pixel that the point reaches ends at a border
        const int cx = 36, cy = 35;
        for (const float sigma : { 0.8f, 1.0f, 2.5f, 7.0f }) {
            CAPTURE(sigma);
            const auto gaussian = [&](int d) {
                return std::abs(d) <= cut * sigma ? std::exp(-0.5 * d * d / (sigma * sigma)) : 0;
            };
            double sum = 0;
            for (int d = -lensReach; d <= lensReach; ++d)
                sum += gaussian(d);
            Blurred image(region);
            image.everywhere([&](int x, int y) { image.sigma.at(x, y) = sigma; });
            image.value.setVector(cx, cy, { 1, 10, 0 });
            const auto lens = bothFiltered(frame, image);
            const auto right = motionFiltered(frame, image);
            image.everywhere([&](int x, int y) {
                image.direction.at(x, y, 0) = 0;
                image.direction.at(x, y, 1) = -1;
            });
            const auto up = motionFiltered(frame, image);
            everyPixel(region.window, [&](int x, int y) {
                const double gx = gaussian(x - cx) / sum, gy = gaussian(y - cy) / sum;
                requireColour(right, x, y, (y == cy ? gx : 0) * glm::dvec3(1, 10, 0));
                requireColour(up, x, y, (x == cx ? gy : 0) * glm::dvec3(1, 10, 0));
                requireColour(lens, x, y, gx * gy * glm::dvec3(1, 10, 0));
            });
        }
    });
}

TEST_CASE("kernels reach as far as their limits and no farther")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool upright : { false, true }) {
            const int width = upright ? 3 : 401, height = upright ? 401 : 3;
            const render::PlaneLayout layout(width, height);
            MovingFrame frame(device, Kept::Full, layout);
            const Region region(width, height, { 0, 0, width, height }, layout);
            Blurred image(region);
            image.everywhere([&](int x, int y) {
                image.sigma.at(x, y) = 1e4f;
                image.direction.at(x, y, 0) = upright ? 0 : 1;
                image.direction.at(x, y, 1) = upright ? 1 : 0;
            });
            image.value.setVector(upright ? 1 : 200, upright ? 200 : 1, glm::dvec3(1));
            const auto lens = lensFiltered(frame, image, upright ? "blurColumns" : "blurRows");
            const auto motion = motionFiltered(frame, image);
            const auto across = lensFiltered(frame, image, upright ? "blurRows" : "blurColumns");
            for (int k = 0; k < 401; ++k) {
                CAPTURE(k);
                const int x = upright ? 1 : k, y = upright ? k : 1;
                REQUIRE((lens.at(x, y) > 0) == (std::abs(k - 200) <= lensReach));
                REQUIRE((motion.at(x, y) > 0) == (std::abs(k - 200) <= motionReach));
                REQUIRE((across.at(x, y) > 0) == (k == 200));
            }
        }
    });
}
