// The parts of the benchmark of rays that decide what its results mean: the rays themselves, how differences are
// judged, what is counted.
#include "benchmarks/common/synthetic_mesh.h"
#include "benchmarks/rays/compare.h"
#include "benchmarks/rays/counting.h"
#include "benchmarks/rays/ray_sets.h"
#include "benchmarks/rays/workers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <glm/glm.hpp>

namespace wedge::benchmark {
namespace {

using shared::Hit;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr Hit miss { infinity, 0, 0, WEDGE_NO_TRIANGLE };

/// Two triangles, x and z in [0, 1], at heights 0 and 1.
struct Sheets {
    std::vector<float> positions { 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 0, 0, 1, 1 };
    std::vector<std::uint32_t> indices { 0, 1, 2, 3, 4, 5 };
    bvh::Mesh mesh() const { return { positions, indices }; }
};

bvh::Ray downAt(float x, float z, float from = 2) { return { { x, from, z }, 0, { 0, -1, 0 }, infinity }; }

Disagreement judged(const bvh::Mesh& mesh, const bvh::Ray& ray, const Hit& ours, const Hit& theirs)
{
    const RaySet set { "one", false, false, { ray }, 1 };
    const Comparison comparison = compareHits(mesh, set, { ours }, { theirs });
    REQUIRE(comparison.disagreements.size() == 1);
    return comparison.disagreements[0];
}

TEST_CASE("equal hits are no difference, and t may differ by one part in ten thousand")
{
    const Sheets sheets;
    const RaySet set { "two", false, false, { downAt(0.25f, 0.25f), downAt(0.25f, 0.25f) }, 2 };
    CHECK(compareHits(sheets.mesh(), set, { miss, { 1, 0, 0, 1 } }, { miss, { 1.00005f, 0, 0, 1 } })
              .disagreements.empty());
}

TEST_CASE("a hit that only one side sees is explained at an edge alone, and double precision says who is right")
{
    const Sheets sheets;
    const Hit hit { 1, 0, 0, 1 };
    const bvh::Ray middle = downAt(0.25f, 0.25f);
    CHECK(judged(sheets.mesh(), middle, hit, miss).kind == "unexplained");
    CHECK(judged(sheets.mesh(), middle, hit, miss).right == "ours");
    CHECK(judged(sheets.mesh(), middle, miss, hit).right == "embree");

    const bvh::Ray outside = downAt(0.75f, 0.75f);
    CHECK(judged(sheets.mesh(), outside, hit, miss).kind == "unexplained");
    CHECK(judged(sheets.mesh(), outside, hit, miss).right == "embree");

    const bvh::Ray within = downAt(0.25f, 1e-7f), beyond = downAt(0.25f, -1e-7f);
    CHECK(judged(sheets.mesh(), within, hit, miss).kind == "edge");
    CHECK(judged(sheets.mesh(), within, hit, miss).right == "ours");
    CHECK(judged(sheets.mesh(), beyond, hit, miss).kind == "edge");
    CHECK(judged(sheets.mesh(), beyond, hit, miss).right == "embree");
    CHECK(judged(sheets.mesh(), downAt(0.25f, 1e-4f), hit, miss).kind == "unexplained");
}

TEST_CASE("two triangles at one distance are a tie, at two they are not")
{
    Sheets sheets;
    const bvh::Ray ray = downAt(0.25f, 0.25f);
    const Hit upper { 1, 0, 0, 1 }, lower { 2, 0, 0, 0 };
    CHECK(judged(sheets.mesh(), ray, upper, lower).kind == "unexplained");
    CHECK(judged(sheets.mesh(), ray, upper, lower).right == "ours");
    CHECK(judged(sheets.mesh(), ray, lower, upper).right == "embree");
    for (const std::size_t height : { 1u, 4u, 7u })
        sheets.positions[height] = 1;
    const Hit same { 1, 0, 0, 0 };
    CHECK(judged(sheets.mesh(), ray, upper, same).kind == "tie");
    CHECK(judged(sheets.mesh(), ray, upper, same).right == "both");
}

TEST_CASE("hits at the end of a ray, and distances of one triangle that only rounding sets apart")
{
    const Sheets sheets;
    bvh::Ray ends = downAt(0.25f, 0.25f);
    ends.tMax = 1.0000001f;
    CHECK(judged(sheets.mesh(), ends, { 1, 0, 0, 1 }, miss).kind == "end");
    ends.tMax = 1.01f;
    CHECK(judged(sheets.mesh(), ends, { 1, 0, 0, 1 }, miss).kind == "unexplained");

    // So close to the surface that what floats round is a large part of t.
    const bvh::Ray close = downAt(0.25f, 0.25f, 1.000001f);
    const float t = 1.000001f - 1.0f;
    CHECK(judged(sheets.mesh(), close, { t, 0, 0, 1 }, { 1.1f * t, 0, 0, 1 }).kind == "rounded t");
    CHECK(judged(sheets.mesh(), close, { t, 0, 0, 1 }, { 1.1f * t, 0, 0, 1 }).right == "ours");
    CHECK(judged(sheets.mesh(), downAt(0.25f, 0.25f), { 1, 0, 0, 1 }, { 1.01f, 0, 0, 1 }).kind == "unexplained");
}

TEST_CASE("occlusion is compared by what lies nearest; rays that fill packets do not count")
{
    const Sheets sheets;
    bvh::Ray dead = downAt(0.25f, 0.25f);
    dead.tMax = 0;
    const RaySet set { "shadow", true, true, { downAt(0.25f, 0.25f), dead }, 1 };
    const auto nearest = [](const bvh::Ray&) { return Hit { 1, 0, 0, 1 }; };
    const auto nothing = [](const bvh::Ray&) { return miss; };
    const Comparison one = compareOccluded(sheets.mesh(), set, { 1, 1 }, { 0, 0 }, nearest, nothing);
    REQUIRE(one.disagreements.size() == 1);
    CHECK(one.unexplained() == 1);
    CHECK(one.right("ours") == 1);
    CHECK(compareOccluded(sheets.mesh(), set, { 1, 0 }, { 0, 0 }, nothing, nothing).unexplained() == 1);
    CHECK(compareOccluded(sheets.mesh(), set, { 1, 1 }, { 1, 0 }, nearest, nearest).disagreements.empty());
}

TEST_CASE("every pixel is visited once, and 16 in a row are a block of 4x4")
{
    constexpr int width = 24, height = 16;
    std::set<std::pair<int, int>> seen;
    for (std::size_t i = 0; i < width * height; i += packetRays) {
        const Pixel first = tiledPixel(i, width);
        CHECK(first.x % 4 == 0);
        CHECK(first.y % 4 == 0);
        for (std::size_t k = 0; k < packetRays; ++k) {
            const Pixel p = tiledPixel(i + k, width);
            CHECK(p.x / 4 == first.x / 4);
            CHECK(p.y / 4 == first.y / 4);
            CHECK(seen.emplace(p.x, p.y).second);
        }
    }
    CHECK(seen.size() == width * height);
    CHECK(seen.rbegin()->first == width - 1);
}

TEST_CASE("the rays of a field: whole packets, from lifted origins, into the open")
{
    const scene::Scene scene = syntheticScene(2000);
    const bvh::Bvh built = bvh::build({ scene.geometry.positions, scene.geometry.indices });
    const RaySet primary = primaryRays(scene, 64, 48);
    CHECK(primary.live == 64 * 48);
    std::vector<Hit> hits;
    for (const bvh::Ray& ray : primary.rays)
        hits.push_back(bvh::closestHit(built, ray));
    const std::vector<Receiver> receivers = receiversOf(scene, primary, hits, 64);
    const auto seen = static_cast<std::size_t>(std::ranges::count_if(receivers, &Receiver::hit));
    CHECK(seen > 1000);

    const RaySet shadow = areaShadowRays(scene, receivers, 9), ambient = ambientRays(scene, receivers, 4);
    const RaySet diffuse = diffuseRays(receivers);
    CHECK(ambient.live == 4 * seen);
    CHECK(diffuse.live == seen);
    CHECK(shadow.live <= 9 * seen);
    CHECK(2 * shadow.live > 9 * seen);
    for (const RaySet* set : { &primary, &shadow, &ambient, &diffuse }) {
        CHECK(set->rays.size() % packetRays == 0);
        CHECK(set->live == static_cast<std::size_t>(std::ranges::count_if(set->rays, isLive)));
    }
    // Nearly no shadow ray ends at once: those would meet the surface that they start from.
    std::size_t atOnce = 0, up = 0;
    for (const bvh::Ray& ray : shadow.rays)
        if (isLive(ray)) {
            up += ray.direction.y > 0 ? 1 : 0;
            atOnce += bvh::closestHit(built, ray).t < 1e-6f ? 1 : 0;
        }
    CHECK(up == shadow.live);
    CHECK(atOnce == 0);
}

TEST_CASE("directions of diffuse rays have the density cos / pi")
{
    Receiver receiver;
    receiver.hit = true;
    receiver.surface.geometric = shared::vec3(0.6f, 0, 0.8f);
    std::vector<Receiver> receivers(20000, receiver);
    for (std::size_t i = 0; i < receivers.size(); ++i)
        receivers[i].seed = shared::hashUint(static_cast<std::uint32_t>(i));
    const RaySet set = diffuseRays(receivers);
    double cosines = 0, squares = 0;
    for (const bvh::Ray& ray : set.rays) {
        const double c = shared::vecDot(ray.direction, receiver.surface.geometric);
        CHECK(c > 0);
        cosines += c;
        squares += c * c;
    }
    // The means of cos and cos^2 are 2/3 and 1/2, with deviations of 0.24 and 0.29 a sample.
    const double n = static_cast<double>(set.rays.size());
    CHECK(std::fabs(cosines / n - 2.0 / 3) < 5 * 0.24 / std::sqrt(n));
    CHECK(std::fabs(squares / n - 0.5) < 5 * 0.29 / std::sqrt(n));
}

TEST_CASE("a ray into one leaf visits one node and one block; one that passes by, the node alone")
{
    const Sheets sheets;
    const bvh::Bvh built = bvh::build(sheets.mesh());
    RaySet set { "one", false, false, std::vector<bvh::Ray>(16, downAt(0.25f, 0.25f)), 16 };
    CHECK(countTraversal(built, set, 100).nodes == 1);
    CHECK(countTraversal(built, set, 100).blocks == 1);
    set.rays.assign(16, downAt(5, 5));
    CHECK(countTraversal(built, set, 100).nodes == 1);
    CHECK(countTraversal(built, set, 100).blocks == 0);
    CHECK(portCycles({ 2, 1 }) == doctest::Approx((2 * nodeOperations + blockOperations) / operationsPerCycle));
}

TEST_CASE("workers cover a range once, with denormals flushed")
{
    Workers workers(3);
    for (const std::size_t count : { std::size_t { 0 }, std::size_t { 1 }, std::size_t { 1000 } }) {
        std::vector<std::atomic<int>> visits(count);
        std::atomic<int> denormals { 0 };
        workers.run(count, 7, [&](std::size_t first, std::size_t last) {
            volatile float tiny = 1e-20f;
            denormals += tiny * 1e-20f != 0 ? 1 : 0;
            for (std::size_t i = first; i < last; ++i)
                ++visits[i];
        });
        CHECK(std::ranges::all_of(visits, [](const std::atomic<int>& n) { return n == 1; }));
#if defined(__x86_64__)
        CHECK(denormals == 0);
#endif
    }
}

TEST_CASE("the field has exactly the triangles asked for, all of some area, and is the same again")
{
    for (const std::size_t triangles : { leastSyntheticTriangles, std::size_t { 1001 }, std::size_t { 31623 } }) {
        const SyntheticMesh mesh = syntheticMesh(triangles), again = syntheticMesh(triangles);
        REQUIRE(mesh.indices.size() == 3 * triangles);
        CHECK(mesh.positions == again.positions);
        CHECK(mesh.indices == again.indices);
        CHECK(syntheticMesh(triangles, 2).positions != mesh.positions);
        REQUIRE(*std::ranges::max_element(mesh.indices) == mesh.positions.size() / 3 - 1);
        const bvh::Bvh built = bvh::build({ mesh.positions, mesh.indices });
        CHECK(built.statistics.skipped == 0);
        CHECK(built.statistics.degenerate == 0);
    }
    CHECK_THROWS_AS(syntheticMesh(leastSyntheticTriangles - 1), std::invalid_argument);
}

} // namespace
} // namespace wedge::benchmark
