// curvature.cl alone: screen-space curvatures of spheres, cylinders and planes in closed form, and widths along both
// axes against the same in double.
#include "kernels/shared/curvature.h"
#include "kernels/shared/path.h"
#include "tests/environment_support.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// What the kernel reads.
struct CurvedImage {
    shared::CurvatureParams params {};
    Planes<float> position, normal, occluders, pixelSize;
    Planes<std::uint32_t> objectId, gloss, taken;

    CurvedImage(int width, int height)
        : CurvedImage(render::PlaneLayout(width, height))
    {
        params.x1 = layout().width;
        params.y1 = params.height = layout().height;
        params.stride = layout().stride;
        params.planeSize = static_cast<std::uint32_t>(layout().size);
        params.component = WEDGE_COMPONENT_ENVIRONMENT;
        params.curvedBand = params.cosineBand = 1;
        params.hiddenLobes = 2;
        params.lightBand = 3;
        params.isSigned = 1;
        params.leastPixels = 1e-3f;
        params.mostPixels = 1e3f;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                objectId.at(x, y) = 1;
                taken.at(x, y) = 16;
                normal.setVector(x, y, { 0, 0, 1 });
            }
    }
    const render::PlaneLayout& layout() const { return position.layout; }
    int width() const { return static_cast<int>(layout().width); }
    int height() const { return static_cast<int>(layout().height); }

    /// Each pixel's position and normal.
    void setSurface(const std::function<std::pair<glm::dvec3, glm::dvec3>(int, int)>& at)
    {
        for (int y = 0; y < height(); ++y)
            for (int x = 0; x < width(); ++x) {
                position.setVector(x, y, at(x, y).first);
                normal.setVector(x, y, at(x, y).second);
            }
    }

private:
    explicit CurvedImage(const render::PlaneLayout& layout)
        : position(layout, 3, 0.0f)
        , normal(layout, 3, 0.0f)
        , occluders(layout, 1, 0.0f)
        , pixelSize(layout, 1, 1.0f)
        , objectId(layout, 1, 0u)
        , gloss(layout, 1, 0u)
        , taken(layout, 1, 0u)
    {
    }
};

struct Widths {
    Planes<float> x, y, mean;
};

/// A frame that filters an environment's light by curvature, with occluders smoothed.
DeclaredFrame frameOf(const device::Device& device, const render::PlaneLayout& layout)
{
    render::Settings settings =
        sized(render::axisAligned(16), static_cast<int>(layout.width), static_cast<int>(layout.height));
    settings.environment.widths = render::EnvironmentWidths::Corrected;
    return { device, openFloor().scene, settings };
}

Widths widthsOf(DeclaredFrame& frame, const CurvedImage& image)
{
    PassBench pass(frame, "curvatureWidths");
    pass.value("p", image.params);
    pass.plane("occluders", image.occluders);
    pass.plane("position", image.position);
    pass.plane("normal", image.normal);
    pass.plane("objectId", image.objectId);
    pass.plane("pixelSize", image.pixelSize);
    pass.plane("gloss", image.gloss);
    pass.plane("taken", image.taken);
    pass.run();
    return { pass.pixels<float>("widthX"), pass.pixels<float>("widthY"), pass.pixels<float>("beta") };
}

/// (6.20) of pixel (x, y) along (dx, dy), as its definition has it, in double.
double curvatureOf(const CurvedImage& image, int x, int y, int dx, int dy)
{
    for (const int step : { 1, -1 }) {
        const int qx = x + step * dx, qy = y + step * dy;
        if (qx < 0 || qy < 0 || qx >= image.width() || qy >= image.height()
            || image.objectId.at(qx, qy) != image.objectId.at(x, y))
            continue;
        const glm::dvec3 n = image.normal.vector(x, y), m = image.normal.vector(qx, qy),
                         d = image.position.vector(qx, qy) - image.position.vector(x, y);
        if (glm::length(d) == 0)
            continue;
        const double angle = std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m)) / glm::length(d);
        return glm::dot(d, m - n) < 0 ? -angle : angle;
    }
    return 0;
}

/// (6.17) and exp(-2 B^2 r^2).
double expectedWidth(const CurvedImage& image, int x, int y, double curvature)
{
    const shared::CurvatureParams& p = image.params;
    const bool glossy = p.component == WEDGE_COMPONENT_ENVIRONMENT_GLOSSY;
    const shared::Gloss g = shared::unpackGloss(image.gloss.at(x, y));
    // Blinn-Phong's exponent is four times that of a Phong lobe as wide.
    const double phong = g.kind == WEDGE_PHONG || g.kind == WEDGE_LAMBERT ? g.exponent : g.exponent / 4;
    const double lobe = glossy ? 1.8213863677 * std::sqrt(phong) : 0.0;
    const double nearest = image.occluders.at(x, y), occluded = nearest > 0 ? 1 / nearest : 0.0;
    const double bent = p.isSigned != 0 ? curvature : std::fabs(curvature);
    const double hidden = p.cosineBand + static_cast<double>(p.hiddenLobes) * lobe + p.lightBand;
    const double bandwidth = std::fabs(bent * (p.curvedBand + 2 * lobe) + occluded * hidden);
    const double size = image.pixelSize.at(x, y);
    return std::clamp(0.5 / std::max(bandwidth, 1e-30), p.leastPixels * size, p.mostPixels * size);
}

/// A sphere's part around +z, whose neighbours are `step` radians apart.
std::pair<glm::dvec3, glm::dvec3> onSphere(int x, int y, double radius, double step, bool inside)
{
    const double along = step * (x - 8), across = step * (y - 6);
    const glm::dvec3 n(std::sin(along) * std::cos(across), std::sin(across), std::cos(along) * std::cos(across));
    return { radius * n, inside ? -n : n };
}

} // namespace

TEST_CASE("curvatures of spheres, cylinders and planes, from outside and from inside")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame = frameOf(device, render::PlaneLayout(17, 13));
        const double radius = 0.4, step = 0.03;
        for (const bool inside : { false, true }) {
            CAPTURE(inside);
            CurvedImage sphere(17, 13), cylinder(17, 13), plane(17, 13);
            sphere.setSurface([&](int x, int y) { return onSphere(x, y, radius, step, inside); });
            cylinder.setSurface([&](int x, int y) { // its axis along y
                auto [at, n] = onSphere(x, 6, radius, step, inside);
                at.y = 0.01 * y;
                return std::pair(at, n);
            });
            plane.setSurface([](int x, int y) { return std::pair(glm::dvec3(x, y, 0.3 * x), glm::dvec3(0, 0, 1)); });
            // What hides directions tells the sign: 8 over 4 m, and 2.5 1/m of curvature.
            for (CurvedImage* image : { &sphere, &cylinder, &plane }) {
                image->params.lightBand = 7;
                std::fill(image->occluders.values.begin(), image->occluders.values.end(), 4.0f);
            }
            const Widths ofSphere = widthsOf(frame, sphere), ofCylinder = widthsOf(frame, cylinder),
                         ofPlane = widthsOf(frame, plane);
            const double curved = 0.5 / std::fabs(2 + (inside ? -2.5 : 2.5)), flat = 0.5 / 2;
            for (int y = 0; y < 13; ++y)
                for (int x = 0; x < 17; ++x) {
                    CAPTURE(x);
                    CAPTURE(y);
                    REQUIRE(ofSphere.y.at(x, y) == doctest::Approx(curved).epsilon(2e-3));
                    // Farther from the middle steps along x are on smaller circles, and as long as they turn.
                    REQUIRE(ofSphere.x.at(x, y) == doctest::Approx(curved).epsilon(2e-3));
                    REQUIRE(ofCylinder.x.at(x, y) == doctest::Approx(curved).epsilon(2e-3));
                    REQUIRE(ofCylinder.y.at(x, y) == doctest::Approx(flat).epsilon(1e-5));
                    REQUIRE(ofCylinder.mean.at(x, y) == doctest::Approx(0.5 * (curved + flat)).epsilon(2e-3));
                    REQUIRE(ofPlane.x.at(x, y) == doctest::Approx(flat).epsilon(1e-6)); // cos^2/z (B_f + B_e)
                    REQUIRE(ofPlane.y.at(x, y) == doctest::Approx(flat).epsilon(1e-6));
                }
        }
    });
}

TEST_CASE("widths of pixels of any kind are those of the definition")
{
    onEveryDevice([](const device::Device& device) {
        std::mt19937 random(7);
        for (const std::uint32_t component : { WEDGE_COMPONENT_ENVIRONMENT, WEDGE_COMPONENT_ENVIRONMENT_GLOSSY })
            for (const std::uint32_t isSigned : { 0u, 1u })
                for (const std::pair<int, int>& extent : { std::pair(53, 21), { 1, 1 }, { 1, 9 }, { 16, 2 } }) {
                    const int width = extent.first, height = extent.second;
                    CAPTURE(component);
                    CAPTURE(isSigned);
                    CAPTURE(width);
                    CurvedImage image(width, height);
                    image.params.component = component;
                    image.params.isSigned = isSigned;
                    image.params.curvedBand = isSigned != 0 ? 1.0f : 6.0f;
                    image.params.hiddenLobes = isSigned != 0 ? 1.0f : 2.0f;
                    image.params.leastPixels = isSigned != 0 ? 1e-3f : 1.0f;
                    image.params.mostPixels = isSigned != 0 ? 1e3f : 5.0f;
                    for (int y = 0; y < height; ++y)
                        for (int x = 0; x < width; ++x) {
                            const bool flat = random() % 8 == 0; // as the pixel to the left
                            image.position.setVector(
                                x, y, glm::dvec3(0.01 * x, 0.01 * y, 0) + 0.004 * unitVector(random));
                            const glm::dvec3 n = flat && x > 0
                                ? image.normal.vector(x - 1, y)
                                : glm::normalize(glm::dvec3(0, 0, 1) + uniform(random, 0, 0.5) * unitVector(random));
                            image.normal.setVector(x, y, n);
                            image.objectId.at(x, y) = 1 + static_cast<std::uint32_t>(random() % 5 == 0);
                            image.taken.at(x, y) = random() % 7 == 0 ? 0 : 16;
                            image.occluders.at(x, y) =
                                random() % 3 == 0 ? 0.0f : static_cast<float>(std::exp(uniform(random, -6, 3)));
                            image.pixelSize.at(x, y) = static_cast<float>(uniform(random, 0.005, 0.02));
                            image.gloss.at(x, y) =
                                shared::packGloss(shared::makeGloss(static_cast<float>(uniform(random, 0, 100)),
                                    random() % 2 == 0 ? WEDGE_PHONG : WEDGE_BLINN_PHONG));
                        }
                    DeclaredFrame frame = frameOf(device, image.layout());
                    const Widths found = widthsOf(frame, image);
                    for (int y = 0; y < height; ++y)
                        for (int x = 0; x < width; ++x) {
                            CAPTURE(x);
                            CAPTURE(y);
                            const bool has = image.taken.at(x, y) > 0;
                            const double ofX = expectedWidth(image, x, y, curvatureOf(image, x, y, 1, 0)),
                                         ofY = expectedWidth(image, x, y, curvatureOf(image, x, y, 0, 1));
                            // Where both parts cancel each other roundings are left.
                            const double exact = isSigned != 0 ? 1e-2 : 1e-4;
                            REQUIRE(found.x.at(x, y) == doctest::Approx(has ? ofX : -1).epsilon(exact));
                            REQUIRE(found.y.at(x, y) == doctest::Approx(has ? ofY : -1).epsilon(exact));
                            REQUIRE(found.mean.at(x, y)
                                == doctest::Approx(has ? 0.5 * (found.x.at(x, y) + found.y.at(x, y)) : -1));
                        }
                }
    });
}

TEST_CASE("smoothed, occluders are the nearest of the pixels around, in the geometric mean over those around")
{
    onEveryDevice([](const device::Device& device) {
        std::mt19937 random(11);
        for (const std::pair<int, int>& extent : { std::pair(41, 19), { 1, 1 }, { 3, 9 } }) {
            const int width = extent.first, height = extent.second;
            CAPTURE(width);
            CurvedImage image(width, height);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    image.objectId.at(x, y) = static_cast<std::uint32_t>(x / 9 + 2 * (y / 11)); // of which one is none
                    image.occluders.at(x, y) =
                        random() % 12 != 0 ? 0.0f : static_cast<float>(std::exp(uniform(random, -8, 4)));
                }
            DeclaredFrame frame = frameOf(device, image.layout());
            PassBench nearest(frame, "nearestOccluders"), mean(frame, "meanOccluders");
            std::vector<float> occluders = image.occluders.values; // the first of three numbers of each pixel
            occluders.resize(nearest.read<float>("occluders").size());
            nearest.plane("occluders", occluders);
            nearest.plane("objectId", image.objectId);
            nearest.run();
            const auto least = nearest.pixels<float>("nearest");
            mean.plane("nearest", least);
            mean.plane("objectId", image.objectId);
            mean.run();
            const auto found = mean.pixels<float>("mean");
            const auto around = [&](int x, int y, int reach, const Planes<float>& from) {
                std::vector<double> out;
                for (int qy = std::max(0, y - reach); qy <= std::min(height - 1, y + reach); ++qy)
                    for (int qx = std::max(0, x - reach); qx <= std::min(width - 1, x + reach); ++qx)
                        if (image.objectId.at(qx, qy) == image.objectId.at(x, y) && from.at(qx, qy) > 0)
                            out.push_back(from.at(qx, qy));
                return out;
            };
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    if (image.objectId.at(x, y) == 0)
                        continue;
                    CAPTURE(x);
                    CAPTURE(y);
                    const std::vector<double> near = around(x, y, 1, image.occluders), far = around(x, y, 3, least);
                    REQUIRE(least.at(x, y) == (near.empty() ? 0.0 : *std::ranges::min_element(near)));
                    double logarithms = 0;
                    for (const double distance : far)
                        logarithms += std::log(distance) / static_cast<double>(far.size());
                    REQUIRE(found.at(x, y) == doctest::Approx(far.empty() ? 0.0 : std::exp(logarithms)).epsilon(2e-4));
                }
        }
    });
}

TEST_CASE("bandwidths are those of the thesis' flatland")
{
    shared::CurvatureParams p {};
    p.curvedBand = p.cosineBand = 1;
    p.hiddenLobes = 2;
    p.lightBand = 3;
    p.isSigned = 1;
    CHECK(shared::curvatureBandwidth(p, 0.5f, 0.5f, 0) == doctest::Approx(2.5)); // Fig. 6.5
    CHECK(shared::curvatureBandwidth(p, 0.5f, 0.5f, 3.5f) == doctest::Approx(9.5)); // (6.17) adds 2 B_rho (kappa + ...)
    CHECK(shared::curvatureBandwidth(p, -0.5f, 0.5f, 0) == doctest::Approx(1.5));
    p.isSigned = 0;
    CHECK(shared::curvatureBandwidth(p, -0.5f, 0.5f, 0) == doctest::Approx(2.5));
    // docs/environment.md, and a lobe of four times the exponent that is as wide.
    CHECK(shared::lobeBandwidth(shared::makeGloss(32, WEDGE_PHONG)) == doctest::Approx(10.3).epsilon(0.005));
    CHECK(shared::lobeBandwidth(shared::makeGloss(3.4f, WEDGE_PHONG)) == doctest::Approx(3.5).epsilon(0.05));
    CHECK(shared::lobeBandwidth(shared::makeGloss(128, WEDGE_BLINN_PHONG)) == doctest::Approx(10.3).epsilon(0.005));
    CHECK(shared::lobeBandwidth(shared::makeGloss(0, WEDGE_PHONG)) == 0);
}
