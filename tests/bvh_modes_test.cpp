#include "bvh/host_traverse.h"
#include "tests/bvh_check.h"
#include "tests/bvh_oracle.h"
#include "tests/bvh_rays.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("Spatial splits cut needles within their budget, and rays cost less for it")
{
    const TestMesh mesh = needles(1500);
    const auto triangles = static_cast<double>(mesh.triangles());
    const bvh::Statistics whole = bvh::build(mesh.view()).statistics;
    CHECK(whole.references == whole.triangles);
    for (const auto& [extra, share] : { std::pair { 0.2f, 0.85 }, { 1.0f, 0.45 }, { 4.0f, 0.4 } }) {
        bvh::Config config;
        config.extraReferences = extra;
        const bvh::Bvh hierarchy = bvh::build(mesh.view(), config);
        checkValid(hierarchy, mesh);
        CAPTURE(extra);
        CHECK(hierarchy.statistics.triangles == mesh.triangles());
        CHECK(hierarchy.statistics.references > mesh.triangles());
        CHECK(static_cast<double>(hierarchy.statistics.references) <= triangles * (1 + static_cast<double>(extra)));
        CHECK(hierarchy.statistics.sahCost < share * whole.sahCost);
    }
}

TEST_CASE("Moving subtrees lowers the cost where the build could not foresee it, and keeps the hierarchy valid")
{
    bvh::Config config;
    for (const TestMesh& mesh : { clusters(), soup(20000, 0.05f), needles(2000), exponential(), unevenSizes() }) {
        config.reinsertionRounds = 0;
        const double built = bvh::build(mesh.view(), config).statistics.sahCost;
        config.reinsertionRounds = 8;
        config.reinsertionShare = 0.5;
        const bvh::Bvh moved = bvh::build(mesh.view(), config);
        CAPTURE(mesh.name);
        checkValid(moved, mesh);
        CHECK(moved.statistics.sahCost < (mesh.name == "clusters" ? 0.95 : 1.001) * built);
    }
}

TEST_CASE("Any room for references makes a valid hierarchy")
{
    for (const TestMesh& mesh : { thin(), needles(300), unevenSizes(), scaled(needles(300), 1e-18f, "tiny needles"),
             scaled(needles(300), 3e17f, "huge needles") })
        for (const float extra : { 0.001f, 0.3f, 4.0f }) {
            bvh::Config config;
            config.extraReferences = extra;
            config.maxLeafBlocks = extra < 1 ? 1 : WEDGE_BVH_MAX_LEAF_BLOCKS;
            CAPTURE(extra);
            checkValid(bvh::build(mesh.view(), config), mesh);
        }
}

TEST_CASE("Cut triangles far from the origin stay covered")
{
    // A coordinate's rounding is then as large as the needles are thin.
    TestMesh mesh = needles(700);
    for (std::size_t i = 0; i < mesh.positions.size(); i++)
        mesh.positions[i] += i % 3 == 0 ? 4096.0f : -777.0f;
    bvh::Config config;
    config.extraReferences = 2;
    const bvh::Bvh hierarchy = bvh::build(mesh.view(), config);
    CHECK(hierarchy.statistics.references > mesh.triangles());
    checkValid(hierarchy, mesh);
}

TEST_CASE("All modes find the hits that every triangle tested finds, and the same bits")
{
    for (const TestMesh& mesh : { soup(700, 0.3f), needles(200), thin(), duplicates(100), waves(16), degenerates() }) {
        CAPTURE(mesh.name);
        std::vector<bvh::Bvh> hierarchies;
        for (const bvh::Mode mode : allModes)
            hierarchies.push_back(bvh::build(mesh.view(), bvh::config(mode)));
        int faults = 0;
        for (const Ray& ray : randomRays(mesh, 400, 3)) {
            const Hit hit = bvh::closestHit(hierarchies[0], ray);
            const std::string fault = findFault(mesh, ray, hit, bvh::anyHit(hierarchies[0], ray));
            if (!fault.empty() && faults++ < 5)
                FAIL_CHECK(fault);
            if (!isDetermined(mesh, ray, hit))
                continue;
            for (const bvh::Bvh& other : hierarchies) {
                const Hit same = bvh::closestHit(other, ray);
                CHECK(std::memcmp(&same, &hit, sizeof hit) == 0);
                CHECK(bvh::anyHit(other, ray) == bvh::anyHit(hierarchies[0], ray));
            }
        }
    }
}

TEST_CASE("The fast mode fills its blocks and stays near the default in cost")
{
    for (const TestMesh& mesh : { soup(20000, 0.02f), waves(100) }) {
        const bvh::Statistics fast = bvh::build(mesh.view(), bvh::config(bvh::Mode::Fast)).statistics;
        const bvh::Statistics usual = bvh::build(mesh.view()).statistics;
        CAPTURE(mesh.name);
        CHECK(fast.references == fast.triangles);
        CHECK(fast.triangles > WEDGE_BLOCK_SIZE / 2 * fast.blocks);
        CHECK(fast.sahCost < 1.6 * usual.sahCost);
        CHECK(fast.bytes < 100 * mesh.triangles());
        CHECK(usual.bytes < 100 * mesh.triangles());
    }
}
