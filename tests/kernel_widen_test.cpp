// widening.cl alone: against the same in double.
#include "kernels/shared/path.h"
#include "tests/pass_bench.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr float wideInPixels = 2;

/// A frame that widens its filters. layers: with planes of floats; else in fewer bits.
DeclaredFrame widening(const device::Device& device, int width, int height, bool layers = true)
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.antialias = true;
    return DeclaredFrame(device, smallScene(), settings, layers);
}

/// A camera that looks down -z from 5 m, at a pixel of 1 cm there.
shared::FrameParams cameraOf(const render::PlaneLayout& layout)
{
    shared::FrameParams f {};
    f.width = layout.width;
    f.height = layout.height;
    f.stride = layout.stride;
    f.planeSize = static_cast<std::uint32_t>(layout.size);
    f.eye = shared::vec3(0, 0, 5);
    f.forward = shared::vec3(0, 0, -1);
    f.right = shared::vec3(0.002f, 0, 0);
    f.down = shared::vec3(0, -0.002f, 0);
    return f;
}

/// Pixels of two objects and none on the plane z = 0, and what their filters are made of.
struct Pixels {
    Planes<float> position, normal, beta, deviation, weights, narrow, wide, counts, countsWide;
    Planes<std::uint32_t> objectId;

    /// quiet: pixels from this column on have no noise
    Pixels(const render::PlaneLayout& layout, std::mt19937& random, double bias, double noise, int quiet = 1 << 20)
        : position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , beta(layout, 1, -1.0f)
        , deviation(layout, 1, 0.0f)
        , weights(layout, 1, 0.0f)
        , narrow(layout, 1, 0.0f)
        , wide(layout, 1, 0.0f)
        , counts(layout, 1, 1.0f)
        , countsWide(layout, 1, 1.0f)
        , objectId(layout, 1, 0u)
    {
        std::normal_distribution<double> gauss;
        everyPixel(layout, [&](int x, int y) {
            objectId.at(x, y) = random() % 7 == 0 ? 0 : 1 + static_cast<std::uint32_t>(x / 9 + y / 5) % 2;
            position.setVector(x, y, { 0.01 * (x - 20), 0.01 * (10 - y), 0 });
            normal.setVector(x, y, { 0, 0, 1 });
            // Of the pixels a third is wider than what it is compared with, and some have no filter.
            const double own = random() % 9 == 0 ? -1 : 0.01 * uniform(random, 0, 3);
            beta.at(x, y) = static_cast<float>(own);
            counts.at(x, y) = static_cast<float>(uniform(random, 1, 8));
            countsWide.at(x, y) = own >= 0 && own < 0.02 ? 20.0f : 1.0f;
            const double v = x < quiet ? noise : 0, k = counts.at(x, y), apart = 1 / k - 2 / (k + 20);
            deviation.at(x, y) = static_cast<float>(v * gauss(random));
            weights.at(x, y) = static_cast<float>(uniform(random, 0.5, 2));
            wide.at(x, y) = 1;
            narrow.at(x, y) = static_cast<float>(1 + bias + v * std::sqrt(apart) * gauss(random));
        });
    }
};

double squared(double x) { return x * x; }

/// One of the passes that ask where pixels are, filled with that.
template <class Where>
PassBench passOf(DeclaredFrame& frame, const std::string& kernel, const shared::FrameParams& camera, const Where& in)
{
    PassBench pass(frame, kernel);
    pass.value("frame", camera);
    pass.value("pixels", wideInPixels);
    pass.plane("position", in.position);
    pass.plane("normal", in.normal);
    pass.plane("objectId", in.objectId);
    pass.plane("beta", in.beta);
    return pass;
}

} // namespace

TEST_CASE("widen: narrow pixels are compared with a width of that many pixels, where there is noise around")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = widening(device, 83, 31);
        std::mt19937 random(3);
        const Pixels in(frame.layout, random, 0, 0.1, 20);
        PassBench pass = passOf(frame, "comparedWidths", cameraOf(frame.layout), in);
        pass.plane("deviation", in.deviation);
        pass.run();
        const auto w = pass.pixels<float>("compared");
        int compared = 0, left = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            const double own = in.beta.at(x, y);
            if (in.objectId.at(x, y) == 0 || own < 0) {
                REQUIRE(w.at(x, y) == -1);
                return;
            }
            // A pixel's edge on the plane: its solid angle and distance off the axis cancel but for the cosines.
            const double size = 0.02;
            const bool narrower = own < size;
            // Noise ends at column 20, and squares count to twice the reach.
            if (x < 20 + 2 * WEDGE_SHRINK_REACH)
                REQUIRE(std::fabs(w.at(x, y) - (narrower ? size : 0)) < 2e-4);
            if (x >= 48)
                REQUIRE(w.at(x, y) == 0);
            compared += w.at(x, y) > 0 ? 1 : 0;
            left += narrower && w.at(x, y) == 0 ? 1 : 0;
        });
        CHECK(compared > 100);
        CHECK(left > 100);
    });
}

namespace {

/// Seen at all angles, from nearby and far off, off the view's axis: positions, normals and widths.
struct Surfaces {
    shared::FrameParams camera;
    Planes<float> position, normal, beta;
    Planes<std::uint32_t> objectId;

    Surfaces(const render::PlaneLayout& layout, std::mt19937& random)
        : camera(cameraOf(layout))
        , position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , beta(layout, 1, 0.0f)
        , objectId(layout, 1, 3u)
    {
        const glm::dvec3 forward = glm::normalize(glm::dvec3(0.3, -0.7, 0.4)),
                         right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
        const auto narrowed = [](glm::dvec3 v) {
            return shared::vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
        };
        camera.forward = narrowed(forward);
        camera.right = narrowed(0.02 * right);
        camera.down = narrowed(-0.02 * glm::cross(right, forward));
        everyPixel(layout, [&](int x, int y) {
            position.setVector(x, y, eye() + uniform(random, 1, 9) * ray(x, y));
            normal.setVector(x, y, unitVector(random));
        });
    }

    static glm::dvec3 wide(shared::Vec3 v) { return { v.x, v.y, v.z }; }
    glm::dvec3 eye() const { return wide(camera.eye); }
    /// Through (x, y) of the pixels' middles.
    glm::dvec3 ray(double x, double y) const
    {
        return wide(camera.forward) + (x - 0.5 * (camera.width - 1)) * wide(camera.right)
            + (y - 0.5 * (camera.height - 1)) * wide(camera.down);
    }
    /// Side of a square as large as what pixel (x, y) sees of the tangent plane; 0 where it is seen too flat to say.
    double side(int x, int y) const
    {
        const glm::dvec3 n = normal.vector(x, y), at = position.vector(x, y);
        if (std::fabs(glm::dot(n, glm::normalize(at - eye()))) < 0.15)
            return 0;
        const auto corner = [&](double dx, double dy) {
            const glm::dvec3 d = ray(x + dx, y + dy);
            return d * glm::dot(n, at - eye()) / glm::dot(n, d);
        };
        const glm::dvec3 diagonal = corner(0.5, 0.5) - corner(-0.5, -0.5),
                         other = corner(0.5, -0.5) - corner(-0.5, 0.5);
        return std::sqrt(0.5 * glm::length(glm::cross(diagonal, other)));
    }
};

} // namespace

TEST_CASE("widen: widths in pixels are those of the tangent planes that pixels see, in all frames")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool layers : { true, false }) {
            CAPTURE(layers);
            DeclaredFrame frame = widening(device, 53, 37, layers);
            std::mt19937 random(11);
            Surfaces in(frame.layout, random);
            PassBench pass = passOf(frame, "comparedWidths", in.camera, in);
            in.normal = pass.pixels<float>("normal");
            // Noise in the left half alone: read wrong, widths would be missed there or made on the right.
            Planes<float> deviation(frame.layout, 1, 0.0f);
            everyPixel(frame.layout, [&](int x, int y) { deviation.at(x, y) = x < 10 ? 0.25f : 0.0f; });
            pass.plane("deviation", deviation);
            pass.run();
            const auto w = pass.pixels<float>("compared");
            int seen = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                const double side = in.side(x, y);
                REQUIRE(w.at(x, y) >= 0);
                if (x >= 32)
                    REQUIRE(w.at(x, y) == 0);
                if (x >= 10 || side == 0)
                    return;
                // Packed normals are of unit length to a thousandth; a pixel's square is not small at a slant.
                REQUIRE(w.at(x, y) == doctest::Approx(static_cast<double>(wideInPixels) * side).epsilon(0.02));
                ++seen;
            });
            CHECK(seen > 200);
        }
    });
}

namespace {

/// t of pixel (x, y), or -1 where there is no wider filter to compare with.
double shareOf(const Pixels& in, int x, int y, double c)
{
    const auto compared = [&](int px, int py) {
        return in.objectId.at(px, py) != 0 && in.countsWide.at(px, py) > in.counts.at(px, py);
    };
    double v = 0, d = 0;
    for (int py = std::max(0, y - 3); py <= std::min(22, y + 3); ++py)
        for (int px = std::max(0, x - 3); px <= std::min(40, x + 3); ++px) {
            const double k = in.counts.at(px, py), kWide = in.countsWide.at(px, py), t = in.weights.at(px, py);
            if (in.objectId.at(px, py) != in.objectId.at(x, y) || !compared(px, py))
                continue;
            v += c * squared(t * in.deviation.at(px, py)) * (1 / k - 2 / (k + kWide));
            d += squared(t * (in.narrow.at(px, py) - in.wide.at(px, py)));
        }
    if (!compared(x, y) || d == 0 || in.narrow.at(x, y) == in.wide.at(x, y))
        return -1;
    const double ratio = squared(in.beta.at(x, y) / 0.02), rest = std::max(1 - ratio, 1e-3);
    return std::clamp((v - ratio / rest * std::max(d - rest * v, 0.0)) / d, 0.0, 1.0);
}

} // namespace

TEST_CASE("widen: the width is as far between both as noise and difference of the object around say")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = widening(device, 41, 23);
        const render::PlaneLayout& layout = frame.layout;
        for (const float c : { 0.5f, 1.0f })
            for (const auto& errors : { std::pair(0.0, 0.1), { 0.1, 0.1 }, { 0.3, 0.1 }, { 0.2, 0.0 }, { 0.0, 0.0 } }) {
                const double bias = errors.first, noise = errors.second;
                CAPTURE(bias);
                CAPTURE(noise);
                std::mt19937 random(7);
                const Pixels in(layout, random, bias, noise);
                Planes<float> difference(layout, 1, 0.0f), apart(layout, 1, 0.0f);
                everyPixel(layout, [&](int x, int y) {
                    const float k = in.counts.at(x, y), kWide = in.countsWide.at(x, y);
                    difference.at(x, y) = in.narrow.at(x, y) - in.wide.at(x, y);
                    apart.at(x, y) = kWide > k ? 1 / k - 2 / (k + kWide) : 0.0f;
                });
                PassBench first(frame, "widenSquares");
                first.plane("difference", difference);
                first.plane("apart", apart);
                first.plane("deviation", in.deviation);
                first.plane("weights", in.weights);
                first.run();
                PassBench second = passOf(frame, "wideShares", cameraOf(layout), in);
                second.value("noise", c);
                second.plane("difference", first.read<float>("squares"));
                second.plane("variance", first.read<float>("variance"));
                second.run();
                PassBench last = passOf(frame, "widen", cameraOf(layout), in);
                last.plane("shares", second.read<float>("shares"));
                last.run();
                const auto t = second.pixels<float>("shares"), found = last.pixels<float>("beta");
                int kept = 0, widened = 0, between = 0;
                everyPixel(layout, [&](int x, int y) {
                    const double share = shareOf(in, x, y, static_cast<double>(c));
                    REQUIRE(std::fabs(t.at(x, y) - share) < 1e-3);
                    if (share < 0) {
                        REQUIRE(found.at(x, y) == in.beta.at(x, y));
                        return;
                    }
                    double sum = 0, count = 0;
                    for (int py = std::max(0, y - 3); py <= std::min(22, y + 3); ++py)
                        for (int px = std::max(0, x - 3); px <= std::min(40, x + 3); ++px)
                            if (in.objectId.at(px, py) == in.objectId.at(x, y) && t.at(px, py) >= 0) {
                                sum += t.at(px, py);
                                ++count;
                            }
                    const double own = in.beta.at(x, y);
                    REQUIRE(std::fabs(found.at(x, y) - (own + sum / count * (0.02 - own))) < 1e-5);
                    (share == 1 ? widened : share == 0 ? kept : between) += 1;
                });
                if (noise == 0)
                    CHECK(widened + between == 0);
                if (noise > 0 && bias == 0 && c == 1)
                    CHECK(widened > 20);
                if (bias == 0.3)
                    CHECK(kept > widened);
            }
    });
}

TEST_CASE("widen: squares that are no number widen nothing around them, and nothing else changes")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = widening(device, 41, 23);
        const render::PlaneLayout& layout = frame.layout;
        std::mt19937 random(8);
        const Pixels in(layout, random, 0, 0.1);
        Planes<float> squares(layout, 1, 0.0f), variance(layout, 1, 0.0f);
        everyPixel(layout, [&](int x, int y) {
            squares.at(x, y) = static_cast<float>(uniform(random, 0.1, 1));
            variance.at(x, y) = static_cast<float>(uniform(random, 0.1, 1));
        });
        PassBench pass = passOf(frame, "wideShares", cameraOf(layout), in);
        pass.value("noise", 1.0f);
        pass.plane("variance", variance);
        const auto sharesOf = [&] {
            pass.plane("difference", squares);
            pass.run();
            return pass.pixels<float>("shares");
        };
        const Planes<float> sound = sharesOf();
        constexpr int brokenX = 22, brokenY = 8;
        squares.at(brokenX, brokenY) = std::nanf("");
        const Planes<float> found = sharesOf();
        int lost = 0, kept = 0;
        everyPixel(layout, [&](int x, int y) {
            const bool near = std::abs(x - brokenX) <= WEDGE_SHRINK_REACH && std::abs(y - brokenY) <= WEDGE_SHRINK_REACH
                && in.objectId.at(x, y) == in.objectId.at(brokenX, brokenY);
            REQUIRE(found.at(x, y) == (near ? -1 : sound.at(x, y)));
            lost += near && sound.at(x, y) >= 0 ? 1 : 0;
            kept += sound.at(x, y) >= 0 ? 1 : 0;
        });
        CHECK(lost > 4);
        CHECK(kept > 300);
    });
}
