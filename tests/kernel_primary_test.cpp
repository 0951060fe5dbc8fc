// primary.cl and surface.h alone: what a camera ray finds, against the host's traversal and closed forms.
#include "tests/trace_support.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

double linear(std::uint32_t byte)
{
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double plain(std::uint32_t byte) { return byte / 255.0; }

/// Bilinear look-up with repetition, channel 0 to 2.
double texel(const scene::Texture& t, double u, double v, int channel, double (*decode)(std::uint32_t) = linear)
{
    const double x = (u - std::floor(u)) * t.width - 0.5, y = (v - std::floor(v)) * t.height - 0.5;
    const auto at = [&](double i, double k) {
        const auto px = static_cast<std::size_t>((static_cast<int>(i) + t.width) % t.width),
                   py = static_cast<std::size_t>((static_cast<int>(k) + t.height) % t.height);
        return decode((t.rgba[py * static_cast<std::size_t>(t.width) + px] >> (8 * channel)) & 255u);
    };
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const double low = at(std::floor(x), std::floor(y)) * (1 - fx) + at(std::floor(x) + 1, std::floor(y)) * fx;
    const double high = at(std::floor(x), std::floor(y) + 1) * (1 - fx) + at(std::floor(x) + 1, std::floor(y) + 1) * fx;
    return low * (1 - fy) + high * fy;
}

} // namespace

TEST_CASE("nothing there: no object, the background, infinitely far")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.background = { 0.25f, 0.5f, 1.0f };
        TracedScene traced(b.scene, device, 9, 5);
        const auto id = traced.counts("objectId");
        const auto depth = traced.floats("depth"), emission = traced.floats("emission");
        traced.everyPixel([&](int x, int y) {
            REQUIRE(id.at(x, y) == 0);
            REQUIRE(depth.at(x, y) == infinity);
            REQUIRE(emission.vector(x, y) == glm::dvec3(0.25, 0.5, 1.0));
        });
    });
}

TEST_CASE("the G-buffer holds what the host's traversal finds")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 61, 47);
        const auto id = traced.counts("objectId");
        const auto depth = traced.floats("depth"), position = traced.floats("position");
        const auto normal = traced.floats("normal"), diffuse = traced.floats("diffuse");
        const scene::Geometry& g = traced.scene().geometry;
        unsigned hits = 0, differ = 0;
        traced.everyPixel([&](int x, int y) {
            const bvh::Ray ray = traced.cameraRay(x, y);
            const shared::Hit hit = bvh::closestHit(traced.hierarchy(), ray);
            if (hit.triangle == WEDGE_NO_TRIANGLE || id.at(x, y) == 0 || g.objectIds[hit.triangle] != id.at(x, y)) {
                // Rays through an edge may go either way.
                differ += hit.triangle == WEDGE_NO_TRIANGLE && id.at(x, y) == 0 ? 0 : 1;
                return;
            }
            ++hits;
            const glm::dvec3 eye(ray.origin.x, ray.origin.y, ray.origin.z),
                d(ray.direction.x, ray.direction.y, ray.direction.z);
            const glm::dvec3 n = normal.vector(x, y), at = position.vector(x, y);
            REQUIRE(glm::length(at - (eye + static_cast<double>(hit.t) * d)) < 1e-5);
            REQUIRE(depth.at(x, y) == doctest::Approx(hit.t * glm::length(d)).epsilon(1e-5));
            REQUIRE(std::fabs(glm::length(n) - 1) < 1e-5);
            glm::dvec3 expected = faceNormal(g, hit.triangle);
            expected *= glm::dot(expected, d) > 0 ? -1.0 : 1.0;
            if (id.at(x, y) == 4) // the smooth sphere
                expected = glm::normalize(at - glm::dvec3(0, 0.35, 0.7));
            REQUIRE(glm::length(n - expected) < (id.at(x, y) == 4 ? 0.02 : 1e-5));
            REQUIRE(diffuse.at(x, y) == 0.8f);
        });
        CHECK(hits > 1500);
        CHECK(differ <= 3);
    });
}

TEST_CASE("the packed geometric normal is the triangle's on the viewer's side, also where the shading normal is smooth")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 61, 47);
        const auto id = traced.counts("objectId"), geometric = traced.counts("geometric");
        const auto normal = traced.floats("normal");
        const scene::Geometry& g = traced.scene().geometry;
        unsigned flat = 0, smooth = 0, turned = 0;
        double worst = 0;
        traced.everyPixel([&](int x, int y) {
            const bvh::Ray ray = traced.cameraRay(x, y);
            const shared::Hit hit = bvh::closestHit(traced.hierarchy(), ray);
            if (hit.triangle == WEDGE_NO_TRIANGLE || g.objectIds[hit.triangle] != id.at(x, y))
                return;
            const shared::Vec3 packed = shared::unpackDirection(geometric.at(x, y));
            const glm::dvec3 found(packed.x, packed.y, packed.z), face = faceNormal(g, hit.triangle);
            const bool behind = glm::dot(face, glm::dvec3(ray.direction.x, ray.direction.y, ray.direction.z)) > 0;
            const double apart = glm::length(found - (behind ? -face : face));
            // Between triangles of the sphere a ray may go either way.
            if (id.at(x, y) == 4 && apart > 1e-4 && (hit.u < 1e-3f || hit.v < 1e-3f || hit.u + hit.v > 0.999f))
                return;
            worst = std::max(worst, apart);
            (id.at(x, y) == 4 ? smooth : flat) += 1;
            turned += glm::length(found - normal.vector(x, y)) > 0.01 ? 1 : 0;
        });
        CHECK(worst < 1e-4);
        CHECK(flat > 1000);
        CHECK(smooth > 50);
        CHECK(turned > 20); // it is not the shading normal
    });
}

TEST_CASE("normals and origins are on the viewer's side, whichever way the triangle was wound")
{
    onEveryDevice([](const device::Device& device) {
        for (const float side : { 1.0f, -1.0f }) {
            SceneBuilder b;
            b.quad({ 0, 0, 0 }, { 2, 0, 0 }, { 0, side * 2, 0 });
            b.camera({ 0, 0, 3 }, { 0, 0, 0 });
            TracedScene traced(b.scene, device, 8, 8);
            const auto normal = traced.floats("normal"), origin = traced.floats("origin");
            CHECK(normal.at(4, 4, 2) == doctest::Approx(1));
            CHECK(origin.at(4, 4, 2) > 0.0f);
            CHECK(origin.at(4, 4, 2) < 1e-5f);
        }
    });
}

TEST_CASE("pixelSize: a plane across the view has distance times the pixel's step everywhere")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, -1 }, { 50, 0, 0 }, { 0, 50, 0 });
        b.camera({ 0, 0, 4 }, { 0, 0, 0 }, { 0, 1, 0 }, 80);
        TracedScene traced(b.scene, device, 40, 30);
        const auto size = traced.floats("pixelSize");
        const double expected = 5 * 2 * std::tan(40 * 3.14159265358979 / 180) / 30;
        traced.everyPixel([&](int x, int y) { REQUIRE(size.at(x, y) == doctest::Approx(expected).epsilon(1e-5)); });
    });
}

TEST_CASE("pixelSize: on a slanted plane, the root of the area that the pixel's corners span there")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 0, 0, 100 }, { 100, 0, 0 });
        b.camera({ 0, 1, 2 }, { 0, 0.2f, 0 });
        TracedScene traced(b.scene, device, 64, 48);
        const auto size = traced.floats("pixelSize");
        for (int y = 24; y < 48; y += 3)
            for (int x = 0; x < 64; x += 7) {
                const auto onFloor = [&](double px, double py) {
                    const glm::dvec3 d =
                        glm::dvec3(traced.params.forward.x, traced.params.forward.y, traced.params.forward.z)
                        + (px - 32) * glm::dvec3(traced.params.right.x, traced.params.right.y, traced.params.right.z)
                        + (py - 24) * glm::dvec3(traced.params.down.x, traced.params.down.y, traced.params.down.z);
                    return glm::dvec3(0, 1, 2) - d / d.y;
                };
                const glm::dvec3 a = onFloor(x, y), c = onFloor(x + 1, y + 1), e = onFloor(x + 1, y),
                                 f = onFloor(x, y + 1);
                const double area = 0.5 * glm::length(glm::cross(c - a, f - e));
                REQUIRE(size.at(x, y) == doctest::Approx(std::sqrt(area)).epsilon(0.01));
            }
    });
}

TEST_CASE("textures are bilinear, repeated, and linear: colours after the sRGB curve, exponents as they are")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 });
        scene::Texture texture;
        texture.width = 5;
        texture.height = 3;
        std::mt19937 random(3);
        for (int i = 0; i < 15; ++i)
            texture.rgba.push_back(static_cast<std::uint32_t>(random()));
        // One that stands before it, so that offsets matter.
        b.scene.textures = { texture, texture };
        b.scene.textures[0].rgba[4] ^= 0xffffffu;
        b.scene.materials[0].diffuse = { 1, 0.5f, 0.25f };
        b.scene.materials[0].diffuseTexture = 1;
        b.scene.materials[0].emission = { 2, 2, 2 };
        b.scene.materials[0].emissionTexture = 0;
        b.scene.materials[0].specular = glm::vec3(0.3f);
        b.scene.materials[0].exponent = 200;
        b.scene.materials[0].exponentTexture = 1;
        for (const float offset : { 0.0f, -1.3f, 1000.5f }) {
            scene::Scene scene = b.scene;
            for (float& texcoord : scene.geometry.texcoords)
                texcoord = texcoord * 3 + offset;
            TracedScene traced(scene, device, 33, 25);
            const auto diffuse = traced.floats("diffuse"), emission = traced.floats("emission");
            const auto position = traced.floats("position");
            const auto id = traced.counts("objectId"), glosses = traced.counts("gloss");
            double worst = 0;
            traced.everyPixel([&](int x, int y) {
                if (id.at(x, y) == 0)
                    return;
                const double u = (0.5 + position.at(x, y) / 4) * 3 + offset,
                             v = (0.5 + position.at(x, y, 1) / 4) * 3 + offset;
                worst = std::max(worst, std::fabs(diffuse.at(x, y, 1) - 0.5 * texel(scene.textures[1], u, v, 1)));
                worst = std::max(worst, std::fabs(emission.at(x, y, 2) - 2 * texel(scene.textures[0], u, v, 2)));
                // A number and no colour.
                const shared::Gloss gloss = shared::unpackGloss(glosses.at(x, y));
                worst = std::max(worst, std::fabs(gloss.exponent / 200 - texel(scene.textures[1], u, v, 0, plain)));
                REQUIRE(gloss.kind == WEDGE_BLINN_PHONG);
            });
            CAPTURE(offset);
            CHECK(worst < (offset > 100 ? 5e-3 : 2e-4));
        }
    });
}

TEST_CASE("visible lights are seen with their profile, from their emitting side, and hide what is behind them")
{
    onEveryDevice([](const device::Device& device) {
        for (const float facing : { 1.0f, -1.0f })
            for (const bool twoSided : { false, true }) {
                SceneBuilder b;
                b.quad({ 0, 0, -2 }, { 9, 0, 0 }, { 0, 9, 0 });
                scene::AreaLight& light =
                    b.light({ 0, 0, 1 }, { 0.5f, 0, 0 }, { 0, facing * 0.25f, 0 }, scene::LightProfile::Gaussian, 6);
                light.visible = true;
                light.twoSided = twoSided;
                b.camera({ 0, 0, 4 }, { 0, 0, 0 });
                TracedScene traced(b.scene, device, 64, 48);
                const auto id = traced.counts("objectId");
                const auto emission = traced.floats("emission"), depth = traced.floats("depth");
                unsigned seen = 0;
                traced.everyPixel([&](int x, int y) {
                    const bvh::Ray ray = traced.cameraRay(x, y);
                    const double t = -3 / ray.direction.z, px = t * ray.direction.x, py = t * ray.direction.y;
                    if (std::fabs(std::fabs(px) - 0.5) < 1e-4 || std::fabs(std::fabs(py) - 0.25) < 1e-4)
                        return;
                    const bool inside = std::fabs(px) < 0.5 && std::fabs(py) < 0.25;
                    REQUIRE((id.at(x, y) == 0) == inside);
                    if (!inside)
                        return;
                    ++seen;
                    const double profile = std::exp(-0.5 * 4 * (px * px / 0.25 + py * py / 0.0625));
                    REQUIRE(
                        emission.at(x, y) == doctest::Approx(facing > 0 || twoSided ? 6 * profile : 0).epsilon(1e-4));
                    REQUIRE(depth.at(x, y) == doctest::Approx(3 * shared::vecLength(ray.direction)).epsilon(1e-5));
                });
                CHECK(seen > 100);
            }
    });
}
