#include "bvh/host_traverse.h"
#include "bvh/refit.h"
#include "tests/bvh_check.h"
#include "tests/bvh_oracle.h"
#include "tests/bvh_rays.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

using namespace wedge;
using namespace wedge::test;

namespace {

/// The mesh bent and turned, every vertex elsewhere.
TestMesh moved(TestMesh mesh, float scale = 1)
{
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        float* p = &mesh.positions[i];
        const float angle = 0.8f * p[1], c = std::cos(angle), s = std::sin(angle);
        const float x = p[0], z = p[2];
        p[0] = scale * (c * x + s * z + 0.1f);
        p[1] = scale * (p[1] + 0.2f * std::sin(3.0f * x));
        p[2] = scale * (c * z - s * x);
    }
    return mesh;
}

} // namespace

TEST_CASE("To refit to where everything is changes no bit")
{
    for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Default })
        for (const TestMesh& mesh : nastyMeshes()) {
            CAPTURE(mesh.name);
            const bvh::Bvh built = bvh::build(mesh.view(), bvh::config(mode));
            bvh::Bvh fitted = built;
            REQUIRE(bvh::refit(fitted, mesh.view()));
            CHECK(sameBits(built, fitted));
            CHECK(fitted.statistics.sahCost == doctest::Approx(built.statistics.sahCost).epsilon(1e-6));
            CHECK(fitted.statistics.degenerate == built.statistics.degenerate);
        }
}

TEST_CASE("Boxes and triangles follow moved vertices, and so does the unit")
{
    for (const bvh::Mode mode : allModes)
        for (const float scale : { 1.0f, 1e6f, 1e-12f })
            for (const TestMesh& mesh : { soup(3000, 0.1f), needles(1000), waves(40) }) {
                bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
                const TestMesh after = moved(mesh, scale);
                REQUIRE(bvh::refit(hierarchy, after.view()));
                checkValid(hierarchy, after);
                // Boxes are the smallest: refitting there and back again leaves those of the build.
                if (mode == bvh::Mode::Quality)
                    continue;
                REQUIRE(bvh::refit(hierarchy, mesh.view()));
                CHECK(sameBits(hierarchy, bvh::build(mesh.view(), bvh::config(mode))));
            }
}

TEST_CASE("Rays hit moved triangles as they would in a new hierarchy")
{
    for (const bvh::Mode mode : allModes)
        for (const TestMesh& mesh : { soup(600, 0.3f), needles(150), waves(16) }) {
            bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
            const TestMesh after = moved(mesh);
            REQUIRE(bvh::refit(hierarchy, after.view()));
            const bvh::Bvh anew = bvh::build(after.view());
            CAPTURE(mesh.name);
            int faults = 0;
            for (const Ray& ray : randomRays(after, 300, 7)) {
                const Hit hit = bvh::closestHit(hierarchy, ray), expected = bvh::closestHit(anew, ray);
                const std::string fault = findFault(after, ray, hit, bvh::anyHit(hierarchy, ray));
                if (!fault.empty() && faults++ < 5)
                    FAIL_CHECK(fault);
                if (isDetermined(after, ray, hit))
                    CHECK(std::memcmp(&hit, &expected, sizeof hit) == 0);
            }
        }
}

TEST_CASE("The cost tells how far a refitted hierarchy has aged")
{
    const TestMesh mesh = soup(5000, 0.05f);
    TestMesh shuffled = mesh;
    std::mt19937 random(4);
    std::uniform_real_distribution<float> u(-1.0f, 1.0f);
    for (std::size_t i = 0; i < shuffled.positions.size(); i += 9) {
        const float by[3] = { u(random), u(random), u(random) };
        for (std::size_t j = 0; j < 9; j++)
            shuffled.positions[i + j] += by[j % 3];
    }
    bvh::Bvh hierarchy = bvh::build(mesh.view());
    REQUIRE(bvh::refit(hierarchy, shuffled.view()));
    checkValid(hierarchy, shuffled);
    CHECK(hierarchy.statistics.sahCost > 3 * bvh::build(shuffled.view()).statistics.sahCost);
}

TEST_CASE("Triangles may lose their area and get it back")
{
    const TestMesh mesh = soup(100, 0.3f);
    TestMesh flattened = mesh;
    for (std::size_t i = 0; i < 9 * 40; i++)
        flattened.positions[i] = flattened.positions[i / 9 * 9 + i % 3];
    bvh::Bvh hierarchy = bvh::build(mesh.view());
    const bvh::Bvh built = hierarchy;
    REQUIRE(bvh::refit(hierarchy, flattened.view()));
    CHECK(hierarchy.statistics.degenerate == 40);
    checkValid(hierarchy, flattened);
    REQUIRE(bvh::refit(hierarchy, mesh.view()));
    CHECK(sameBits(hierarchy, built));
}

TEST_CASE("A vertex out of range is refused, and nothing has changed")
{
    const TestMesh mesh = soup(500, 0.2f);
    bvh::Bvh hierarchy = bvh::build(mesh.view());
    const bvh::Bvh built = hierarchy;
    for (const float bad : { NAN, INFINITY, -3e38f }) {
        TestMesh after = moved(mesh);
        after.positions[777] = bad;
        CHECK_FALSE(bvh::refit(hierarchy, after.view()));
        CHECK(sameBits(hierarchy, built));
    }
    // Triangles that were left out at the build may be anything.
    const TestMesh holes = invalidVertices();
    bvh::Bvh without = bvh::build(holes.view());
    CHECK(bvh::refit(without, holes.view()));
    bvh::Bvh empty = bvh::build({});
    CHECK(bvh::refit(empty, {}));
}

TEST_CASE("A refit gives the same bits for any number of threads")
{
    const TestMesh mesh = soup(100000, 0.01f), after = moved(mesh);
    const bvh::Bvh built = bvh::build(mesh.view());
    std::vector<bvh::Bvh> results;
    for (const std::size_t threads : { 1, 2, 8 }) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(built);
        REQUIRE(bvh::refit(results.back(), after.view()));
        CHECK(sameBits(results[0], results.back()));
        CHECK(results[0].statistics.sahCost == results.back().statistics.sahCost);
    }
    checkValid(results[0], after);
}
