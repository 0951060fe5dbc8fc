// The thin-lens camera with a shutter: rays, their distributions, and where points appear. The shared maths as C++, no
// device.
#include "kernels/shared/camera.h"
#include "kernels/shared/defocus.h"
#include "kernels/shared/frame.h"
#include "tests/statistics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <glm/glm.hpp>

using namespace wedge::shared;
using wedge::test::chiSquareP;

namespace {

constexpr float width = 320, height = 200;
constexpr int samples = 200000;

double uniform(std::mt19937& random, double lo = 0, double hi = 1)
{
    return lo + (hi - lo) * (static_cast<double>(random()) + 0.5) / 4294967296.0;
}

/// As the sampler's numbers: below 1.
float unitFloat(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }

Vec3 narrowed(glm::dvec3 v) { return vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)); }
glm::dvec3 wide(Vec3 v) { return { v.x, v.y, v.z }; }

/// A camera at rest, its axes those of a turned frame, a pixel's step 0.004.
CameraParams cameraAt(glm::dvec3 eye, glm::dvec3 lookAt, float apertureRadius = 0, float focusDistance = 2.5f)
{
    const glm::dvec3 forward = glm::normalize(lookAt - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    CameraParams c {};
    c.pixelStep = 0.004f;
    c.eye = narrowed(eye);
    c.forward = narrowed(forward);
    c.right = narrowed(0.004 * right);
    c.down = narrowed(-0.004 * glm::cross(right, forward));
    c.apertureRadius = apertureRadius;
    c.focusDistance = focusDistance;
    c.erfCut = std::erf(WEDGE_APERTURE_CUT / std::sqrt(2.0f));
    return c;
}

/// The first that becomes the second while the shutter is open.
CameraParams moving(CameraParams open, const CameraParams& close)
{
    open.eyeMotion = vecSub(close.eye, open.eye);
    open.forwardMotion = vecSub(close.forward, open.forward);
    open.rightMotion = vecSub(close.right, open.right);
    open.downMotion = vecSub(close.down, open.down);
    open.shutter = 1;
    return open;
}

CameraParams stillCamera(float apertureRadius = 0) { return cameraAt({ 1, 2, 3 }, { 0.3, 1.4, -0.2 }, apertureRadius); }
CameraParams movingCamera(float apertureRadius = 0)
{
    return moving(stillCamera(apertureRadius), cameraAt({ 1.2, 1.9, 2.7 }, { 0.4, 1.1, -0.3 }, apertureRadius));
}

glm::dvec3 pointAt(const CameraRay& ray, double depth) { return wide(ray.origin) + depth * wide(ray.direction); }

Vec2 lensPoint(std::mt19937& random) { return aperturePoint(0, vec2(unitFloat(random), unitFloat(random))); }

/// Probability of counts of `values` in cells of equal share of the distribution whose cumulative function is given.
double equalCellsP(const std::vector<double>& values, const std::function<double(double)>& cumulative)
{
    constexpr int cells = 64;
    std::vector<double> seen(cells), expected(cells, static_cast<double>(values.size()) / cells);
    for (const double v : values) {
        const double share = cumulative(v);
        REQUIRE(share >= 0);
        REQUIRE(share <= 1);
        seen[static_cast<std::size_t>(std::min(cells - 1.0, cells * share))] += 1;
    }
    return chiSquareP(seen, expected);
}

} // namespace

TEST_CASE("a pinhole at rest looks along cameraDirection() from the eye, whatever the numbers for lens and time")
{
    std::mt19937 random(1);
    const CameraParams c = stillCamera();
    for (int k = 0; k < 1000; ++k) {
        const auto x = static_cast<float>(uniform(random, 0, width)),
                   y = static_cast<float>(uniform(random, 0, height));
        const float time = unitFloat(random);
        const CameraRay ray = cameraRay(c, width, height, x, y, lensPoint(random), time);
        const Vec3 d = cameraDirection(c.forward, c.right, c.down, width, height, x, y);
        REQUIRE(wide(ray.origin) == wide(c.eye));
        REQUIRE(wide(ray.direction) == wide(d));
        REQUIRE(ray.time == time);
    }
}

TEST_CASE("all rays of an image point, over the lens, meet in one point of the plane in focus")
{
    std::mt19937 random(2);
    for (const CameraParams& c : { stillCamera(0.05f), movingCamera(0.2f) })
        for (int k = 0; k < 300; ++k) {
            const auto x = static_cast<float>(uniform(random, 0, width)),
                       y = static_cast<float>(uniform(random, 0, height));
            const float time = unitFloat(random);
            const CameraRay central = cameraRay(c, width, height, x, y, vec2(0, 0), time);
            const glm::dvec3 met = pointAt(central, c.focusDistance);
            const glm::dvec3 forward = wide(c.forward) + static_cast<double>(time) * wide(c.forwardMotion);
            // The pinhole's ray is the lens' central one.
            const Vec3 eye = vecMad(c.eye, c.eyeMotion, time);
            REQUIRE(glm::distance(wide(central.origin), wide(eye)) < 1e-6);
            for (int lens = 0; lens < 8; ++lens) {
                const Vec2 u = lensPoint(random);
                const CameraRay ray = cameraRay(c, width, height, x, y, u, time);
                REQUIRE(glm::distance(pointAt(ray, c.focusDistance), met) < 3e-6);
                // From the lens, which lies across the view; a turning camera's axes are shorter by a hair halfway.
                const glm::dvec3 offset = wide(ray.origin) - wide(eye);
                const double radius = c.apertureRadius * std::sqrt(u.x * u.x + u.y * u.y);
                REQUIRE(std::fabs(glm::length(offset) - radius) < 0.01 * c.apertureRadius);
                REQUIRE(std::fabs(glm::dot(offset, forward)) < 0.01 * c.apertureRadius);
                REQUIRE(ray.time == time);
            }
        }
}

TEST_CASE("aperturePoint is in the unit disc, of even angles, and of the radii that a uniform or a Gaussian lens has")
{
    for (const std::uint32_t gaussian : { 0u, 1u }) {
        CAPTURE(gaussian);
        std::mt19937 random(3);
        std::vector<double> radii, angles;
        double sumX = 0, sumY = 0, squares = 0, product = 0;
        for (int k = 0; k < samples; ++k) {
            const Vec2 p = aperturePoint(gaussian, vec2(unitFloat(random), unitFloat(random)));
            const double r = std::hypot(p.x, p.y);
            REQUIRE(r <= 1 + 1e-6);
            radii.push_back(std::min(r, 1.0));
            angles.push_back(std::atan2(p.y, p.x));
            sumX += p.x;
            sumY += p.y;
            squares += r * r;
            product += static_cast<double>(p.x) * p.y;
        }
        // Within r of the centre: its share of the disc's area, or of a Gaussian's mass within two deviations.
        const auto inside = [&](double r) {
            return gaussian != 0 ? (1 - std::exp(-2 * r * r)) / (1 - std::exp(-2.0)) : r * r;
        };
        CHECK(equalCellsP(radii, inside) > 1e-4);
        CHECK(equalCellsP(angles, [](double a) { return 0.5 + 0.5 * a / std::numbers::pi; }) > 1e-4);
        // Mean of r^2: 1/2; and of the Gaussian with sigma = 1/2: 2 sigma^2 (1 - 2 e^-2 / (1 - e^-2)).
        const double e = std::exp(-2.0), meanSquare = gaussian != 0 ? 0.5 * (1 - 2 * e / (1 - e)) : 0.5;
        CHECK(squares / samples == doctest::Approx(meanSquare).epsilon(0.005));
        CHECK(std::fabs(sumX / samples) < 0.006);
        CHECK(std::fabs(sumY / samples) < 0.006);
        CHECK(std::fabs(product / samples) < 0.003);
        // The ends of the random numbers' range.
        const Vec2 centre = aperturePoint(gaussian, vec2(0, 0.3f));
        const Vec2 edge = aperturePoint(gaussian, vec2(0.99999994f, 0));
        CHECK(std::hypot(centre.x, centre.y) == 0);
        CHECK(edge.x == doctest::Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("shutterTime is in [0, 1] and as the shutter transmits")
{
    CameraParams c = stillCamera();
    for (const std::uint32_t gaussian : { 0u, 1u }) {
        CAPTURE(gaussian);
        c.gaussianShutter = gaussian;
        std::mt19937 random(4);
        std::vector<double> times;
        double sum = 0, squares = 0, before = -1;
        for (int k = 0; k < samples; ++k) {
            const float time = shutterTime(c, unitFloat(random));
            REQUIRE(time >= 0);
            REQUIRE(time <= 1);
            times.push_back(time);
            sum += time;
            squares += (time - 0.5) * (time - 0.5);
        }
        // Half of the time is two standard deviations.
        const double root2 = std::numbers::sqrt2;
        const auto passed = [&](double t) {
            return gaussian != 0
                ? std::clamp(0.5 + 0.5 * std::erf((t - 0.5) * 4 / root2) / std::erf(2 / root2), 0.0, 1.0)
                : t;
        };
        CHECK(equalCellsP(times, passed) > 1e-4);
        const double cutDensity = 2 * std::exp(-2.0) / std::sqrt(2 * std::numbers::pi);
        const double variance = gaussian != 0 ? (1 - 2 * cutDensity / std::erf(2 / root2)) / 16 : 1.0 / 12;
        CHECK(sum / samples == doctest::Approx(0.5).epsilon(0.005));
        CHECK(squares / samples == doctest::Approx(variance).epsilon(0.01));
        for (int k = 0; k <= 1000; ++k) {
            const double time = shutterTime(c, std::min(static_cast<float>(k) / 1000, 0.99999994f));
            REQUIRE(time > before);
            before = time;
        }
    }
}

TEST_CASE("circleOfConfusion() is how far a point's image moves with the lens position")
{
    std::mt19937 random(5);
    const CameraParams c = stillCamera(0.06f);
    const auto radiusAt = [](const CameraParams& camera, float depth) {
        return circleOfConfusion(camera.apertureRadius, camera.focusDistance, depth, camera.pixelStep);
    };
    CHECK(radiusAt(c, c.focusDistance) == 0);
    CHECK(radiusAt(stillCamera(), 0.7f) == 0);
    CHECK(radiusAt(c, std::numeric_limits<float>::infinity()) == doctest::Approx(-0.06 / 0.004 / 2.5));
    CHECK(radiusAt(c, 0) == WEDGE_BLUR_MAX);
    CHECK(radiusAt(c, -1) == WEDGE_BLUR_MAX);
    for (int k = 0; k < 2000; ++k) {
        const auto depth = static_cast<float>(std::exp(uniform(random, -2, 4)));
        const double r = radiusAt(c, depth);
        REQUIRE((r > 0) == (depth < c.focusDistance));
        // The lens' ray through pixel x meets that depth where the central ray of pixel x + r u does.
        const auto x = static_cast<float>(uniform(random, 0, width)),
                   y = static_cast<float>(uniform(random, 0, height));
        const Vec2 u = lensPoint(random);
        const CameraRay ray = cameraRay(c, width, height, x, y, u, 0);
        const glm::dvec3 met = pointAt(ray, depth);
        const Vec2 image = projectPoint(c, narrowed(met), 0);
        const double tolerance = 1e-3 + 1e-4 * std::fabs(r);
        REQUIRE(std::fabs(image.x - (x - 0.5 * width + r * u.x)) < tolerance);
        REQUIRE(std::fabs(image.y - (y - 0.5 * height + r * u.y)) < tolerance);
        REQUIRE(glm::dot(met - wide(c.eye), wide(c.forward)) == doctest::Approx(depth).epsilon(1e-4));
    }
}

TEST_CASE("projectPoint finds the image point of a pinhole's ray, also when the camera moves")
{
    std::mt19937 random(6);
    const CameraParams slid = moving(stillCamera(), cameraAt({ 1.4, 1.5, 2.6 }, { 0.7, 0.9, -0.6 }));
    const auto farthest = [&](const CameraParams& c, float time) {
        double worst = 0;
        for (int k = 0; k < 500; ++k) {
            const auto x = static_cast<float>(uniform(random, 0, width)),
                       y = static_cast<float>(uniform(random, 0, height));
            const CameraRay ray = cameraRay(c, width, height, x, y, vec2(0, 0), time);
            const Vec2 image = projectPoint(c, narrowed(pointAt(ray, uniform(random, 0.3, 30))), time);
            worst = std::max<double>(worst, std::hypot(image.x - (x - 0.5f * width), image.y - (y - 0.5f * height)));
        }
        return worst;
    };
    CHECK(farthest(stillCamera(), 0) < 0.003);
    CHECK(farthest(stillCamera(), 0.7f) < 0.003);
    for (const float time : { 0.0f, 0.3f, 0.5f, 1.0f })
        CHECK(farthest(slid, time) < 0.003);
    // Of a camera that turns, exactly when the shutter opens and closes; between, its straight axes are shorter by a
    // part (angle / 2)^2 at most, and so are positions.
    const CameraParams turned = movingCamera();
    CHECK(farthest(turned, 0) < 0.003);
    CHECK(farthest(turned, 1) < 0.003);
    const double cosine =
        glm::dot(wide(turned.forward), glm::normalize(wide(vecAdd(turned.forward, turned.forwardMotion))));
    const double angle = std::acos(cosine);
    CHECK(angle > 0.03);
    CHECK(farthest(turned, 0.5f) < 0.003 + 2 * std::hypot(width, height) / 2 * angle * angle / 4);
    // Behind the eye, or in it, is no division by zero.
    const Vec2 none = projectPoint(turned, turned.eye, 0);
    CHECK(std::isfinite(none.x));
    CHECK(std::isfinite(none.y));
}

TEST_CASE("rays of a pixel lie around its centre as its filter weighs")
{
    constexpr double pi = 3.14159265358979;
    const auto box = [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); };
    const auto gaussian = [](double x) {
        const double whole = std::erf(3 / std::sqrt(2.0));
        return std::clamp(0.5 + 0.5 * std::erf(x / 0.5 / std::sqrt(2.0)) / whole, 0.0, 1.0);
    };
    const auto blackmanHarris = [](double x) {
        const double t = x / 3 + 0.5;
        const double sum = 0.35875 * t - 0.48829 * std::sin(2 * pi * t) / (2 * pi)
            + 0.14128 * std::sin(4 * pi * t) / (4 * pi) - 0.01168 * std::sin(6 * pi * t) / (6 * pi);
        return std::clamp(sum / 0.35875, 0.0, 1.0);
    };
    std::mt19937 random(11);
    for (const auto& [filter, cumulative] :
        std::vector<std::pair<std::uint32_t, std::function<double(double)>>> { { WEDGE_PIXEL_BOX, box },
            { WEDGE_PIXEL_GAUSSIAN, gaussian }, { WEDGE_PIXEL_BLACKMAN_HARRIS, blackmanHarris } }) {
        CAPTURE(filter);
        std::vector<double> offsets;
        float before = -2;
        for (int k = 0; k <= 4096; ++k) {
            const float u = std::min(static_cast<float>(k) / 4096.0f, 0.99999994f), offset = pixelOffset(filter, u);
            REQUIRE(offset >= before);
            REQUIRE(std::fabs(offset) <= (filter == WEDGE_PIXEL_BOX ? 0.5f : 1.5f));
            REQUIRE(std::fabs(cumulative(offset) - u) < 1.5e-4);
            before = offset;
        }
        for (int k = 0; k < 200000; ++k)
            offsets.push_back(pixelOffset(filter, unitFloat(random)));
        CHECK(equalCellsP(offsets, cumulative) > 1e-4);
    }
}
