// Rays pass through cut-outs, in every traversal, where an oracle on the host says so.
#include "host/render/cutouts.h"
#include "host/render/hierarchy.h"
#include "tests/bvh_motion.h"
#include "tests/bvh_tracer.h"

#include "bvh/host_traverse.h"

#include <algorithm>
#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int textureWidth = 7, textureHeight = 5;

/// A texture of random opacities, some of them none and some full, as luminance or as alpha.
scene::Texture randomTexture(std::mt19937& random, bool alpha)
{
    scene::Texture out { "", textureWidth, textureHeight, {}, alpha };
    for (int i = 0; i < textureWidth * textureHeight; ++i) {
        const std::uint32_t opacity = i % 3 == 0 ? 0u : i % 3 == 1 ? 255u : random() % 256u;
        out.rgba.push_back(alpha ? 0x00804020u | opacity << 24 : 0xff000000u | opacity * 0x010101u);
    }
    return out;
}

/// The mesh with triangles of five materials in turn: opaque, gone, a veil, two textures.
scene::Scene withCutouts(const TestMesh& mesh)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> coordinate(-3.0f, 3.0f);
    scene::Scene out;
    out.textures = { randomTexture(random, false), randomTexture(random, true) };
    out.materials.resize(5);
    out.materials[1].opacity = 0.0f;
    out.materials[2].opacity = 0.4f;
    out.materials[3].opacityTexture = 0;
    out.materials[4].opacityTexture = 1;
    out.materials[4].opacity = 0.8f;
    out.geometry.positions = mesh.positions;
    out.geometry.indices = mesh.indices;
    for (std::size_t i = 0; i < mesh.positions.size() / 3 * 2; ++i)
        out.geometry.texcoords.push_back(coordinate(random));
    for (std::size_t t = 0; t < mesh.triangles(); ++t)
        out.geometry.materialIds.push_back(static_cast<std::uint32_t>(t % 5));
    return out;
}

Tree treeOf(const scene::Scene& scene)
{
    const render::Hierarchy built = render::buildHierarchy(scene, bvh::Mode::Default, render::Traversal::Scalar);
    Tree tree(built.bvh);
    tree.narrow = built.narrow; // whose root knows where the table is
    return tree;
}

double texelOf(const scene::Texture& texture, int x, int y)
{
    const auto wrapped = [](int i, int n) { return ((i % n) + n) % n; };
    const std::uint32_t rgba = texture.rgba[static_cast<std::size_t>(wrapped(y, textureHeight)) * textureWidth
        + static_cast<std::size_t>(wrapped(x, textureWidth))];
    return static_cast<double>(texture.hasAlpha ? rgba >> 24 : rgba & 255u) / 255.0;
}

/// Opacity of a hit from the scene itself, bilinear.
double opacityOf(const scene::Scene& scene, const Hit& hit)
{
    const scene::Material& m = scene.materials[scene.geometry.materialIds[hit.triangle]];
    if (m.opacityTexture < 0)
        return m.opacity;
    const double weights[3] = { 1.0 - hit.u - hit.v, hit.u, hit.v };
    double uv[2] = { 0, 0 };
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 2; ++axis)
            uv[axis] += weights[k] * scene.geometry.texcoords[2 * scene.geometry.indices[3 * hit.triangle + k] + axis];
    const double x = uv[0] * textureWidth - 0.5, y = uv[1] * textureHeight - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const scene::Texture& texture = scene.textures[static_cast<std::size_t>(m.opacityTexture)];
    const double lower = std::lerp(texelOf(texture, x0, y0), texelOf(texture, x0 + 1, y0), x - x0);
    const double upper = std::lerp(texelOf(texture, x0, y0 + 1), texelOf(texture, x0 + 1, y0 + 1), x - x0);
    return m.opacity * std::lerp(lower, upper, y - y0);
}

/// The number of cutout.h for a ray as its triangle test sees it.
double numberOf(const Ray& ray, float unit, std::uint32_t triangle)
{
    const Vec3 d = vecScale(ray.direction, unit), o = vecScale(ray.origin, unit);
    const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
    const auto turned = [&](Vec3 v) {
        return x >= y && x >= z ? vec3(v.y, v.z, v.x) : y >= z ? vec3(v.z, v.x, v.y) : v;
    };
    const Vec3 to = turned(o), td = turned(d);
    return shared::cutoutNumber(triangle, to.x, to.y, to.z, td.x, td.y, td.z, 0.0f);
}

struct Expected {
    Hit hit;
    bool sure; ///< no decision on the way was within rounding
    int holes; ///< on the way
};

/// Hit after hit along the ray without cut-outs, until one is seen.
Expected expectedOf(const scene::Scene& scene, const bvh::Bvh& bvh, const Ray& ray)
{
    Ray rest = ray;
    Expected out { {}, true, 0 };
    for (;;) {
        out.hit = bvh::closestHit(bvh, rest);
        if (out.hit.triangle == WEDGE_NO_TRIANGLE)
            return out;
        const double opacity = opacityOf(scene, out.hit), number = numberOf(ray, bvh.nodes[0].unit, out.hit.triangle);
        out.sure = out.sure && (opacity == 0 || opacity == 1 || std::abs(number - opacity) > 2e-4);
        if (number < opacity)
            return out;
        out.holes++;
        rest.tMin = out.hit.t;
    }
}

template <typename Test>
void onAllFamilies(Geometry geometry, const Test& test)
{
    onDevices([&](const device::Device& device) {
        for (const Family family : { Family::Wide, Family::Scalar }) {
            CAPTURE((family == Family::Wide ? "wide" : "scalar"));
            Tracer tracer(device, family, geometry, true);
            test(tracer);
        }
    });
}

} // namespace

TEST_CASE("single rays and packets of both families pass through what the oracle passes through")
{
    for (const std::size_t triangles : { 40u, 3000u }) {
        CAPTURE(triangles);
        const TestMesh mesh = soup(triangles, triangles < 100 ? 0.8f : 0.15f);
        const scene::Scene scene = withCutouts(mesh);
        const Tree tree = treeOf(scene);
        std::vector<Ray> rays = randomRays(mesh, 3000, 3);
        for (int i = 0; i < 2048; ++i) { // that packets keep together
            const int column = i % 64, row = i / 64;
            const float u = static_cast<float>(column) / 31.5f - 1.0f, v = static_cast<float>(row) / 15.5f - 1.0f;
            rays.push_back({ vec3(0, 3, 0), 0, vec3(0.3f * u, -1, 0.3f * v), infinity });
        }
        std::vector<Expected> expected;
        std::size_t sure = 0, passed = 0, hits = 0;
        for (const Ray& ray : rays) {
            expected.push_back(expectedOf(scene, tree.wide, ray));
            sure += expected.back().sure ? 1 : 0;
            passed += expected.back().holes > 0 ? 1 : 0;
            hits += expected.back().hit.triangle != WEDGE_NO_TRIANGLE ? 1 : 0;
        }
        CHECK(sure > rays.size() * 49 / 50);
        CHECK(passed > rays.size() / 5);
        CHECK(hits > rays.size() / 5);
        onAllFamilies(Geometry::Still, [&](Tracer& tracer) {
            const auto check = [&](const std::vector<Hit>& found, const std::vector<std::uint32_t>& occluded) {
                std::size_t wrong = 0, wrongAny = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const bool is = found[i].triangle == expected[i].hit.triangle;
                    const bool isHit = expected[i].hit.triangle != WEDGE_NO_TRIANGLE;
                    wrong += expected[i].sure && !is ? 1 : 0;
                    wrongAny += expected[i].sure && (occluded[i] == 1) != isHit ? 1 : 0;
                }
                CHECK(wrong <= 2); // ties and rounding at edges
                CHECK(wrongAny <= 2);
            };
            check(tracer.closest(tree, rays), tracer.any(tree, rays));
            check(tracer.closestPackets(tree, rays), tracer.anyPackets(tree, rays));
        });
    }
}

TEST_CASE("families and packets pass through the same of what moves, and a veil stops its share of rays")
{
    const TestMesh mesh = soup(400, 0.4f);
    scene::Scene scene = withCutouts(mesh);
    scene.geometry.positionsAtClose = drifting(mesh, vec3(0.3f, 0.1f, -0.2f)).close;
    const std::vector<Ray> rays = randomRays(mesh, 4000, 9);
    std::vector<float> times;
    for (std::size_t i = 0; i < rays.size(); ++i)
        times.push_back(static_cast<float>(i % 17) / 16.0f);
    const render::Hierarchy built = render::buildHierarchy(scene, bvh::Mode::Default, render::Traversal::Scalar);
    MovingTree tree(built.moving);
    tree.narrow = built.movingNarrow;
    std::vector<Hit> first;
    onAllFamilies(Geometry::Moving, [&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(tree, rays, times);
        if (first.empty())
            first = hits;
        CHECK(sameBits(first, hits));
        CHECK(sameBits(first, tracer.closestPackets(tree, rays, times)));
        const std::vector<std::uint32_t> any = tracer.any(tree, rays, times);
        CHECK(any == tracer.anyPackets(tree, rays, times));
        for (std::size_t i = 0; i < rays.size(); ++i)
            REQUIRE((hits[i].triangle != WEDGE_NO_TRIANGLE) == (any[i] == 1));
    });

    // Two triangles that all rays meet.
    TestMesh square { "square", {}, {} };
    square.add({ -2, 0, -2, 2, 0, -2, 2, 0, 2 });
    square.add({ -2, 0, -2, 2, 0, 2, -2, 0, 2 });
    scene::Scene veil = withCutouts(square);
    veil.geometry.materialIds = { 2, 2 };
    const Tree flat = treeOf(veil);
    std::vector<Ray> down;
    down.reserve(20000);
    for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 200; ++column)
            down.push_back({ vec3(0, 1, 0), 0,
                vec3(0.007f * static_cast<float>(column) - 0.7f, -1, 0.014f * static_cast<float>(row) - 0.7f), 2 });
    onAllFamilies(Geometry::Still, [&](Tracer& tracer) {
        const std::vector<std::uint32_t> any = tracer.any(flat, down);
        const double share = static_cast<double>(std::count(any.begin(), any.end(), 1u)) / 20000.0;
        CHECK(std::abs(share - 0.4) < 4 * std::sqrt(0.24 / 20000));
    });
}

TEST_CASE("a ray passes a thousand holes and meets what is behind them")
{
    TestMesh mesh { "holes", {}, {} };
    for (int i = 0; i < 1000; ++i) {
        const float y = -0.001f * static_cast<float>(i);
        mesh.add({ -1, y, -1, 1, y, -1, 0, y, 2 });
    }
    mesh.add({ -1, -2, -1, 1, -2, -1, 0, -2, 2 });
    scene::Scene scene = withCutouts(mesh);
    std::fill(scene.geometry.materialIds.begin(), scene.geometry.materialIds.end(), 1u);
    scene.geometry.materialIds.back() = 0;
    const Tree tree = treeOf(scene);
    const std::vector<Ray> rays(16, { vec3(0, 1, 0), 0, vec3(0, -1, 0), infinity });
    std::vector<Ray> shorter = rays;
    for (Ray& ray : shorter)
        ray.tMax = 2.5f;
    onAllFamilies(Geometry::Still, [&](Tracer& tracer) {
        for (const Hit& hit : tracer.closest(tree, rays))
            CHECK(hit.triangle == 1000u);
        for (const Hit& hit : tracer.closestPackets(tree, rays))
            CHECK(hit.triangle == 1000u);
        CHECK(tracer.any(tree, rays) == std::vector<std::uint32_t>(16, 1));
        CHECK(tracer.anyPackets(tree, rays) == std::vector<std::uint32_t>(16, 1));
        CHECK(tracer.any(tree, shorter) == std::vector<std::uint32_t>(16, 0));
        CHECK(tracer.anyPackets(tree, shorter) == std::vector<std::uint32_t>(16, 0));
    });
}
