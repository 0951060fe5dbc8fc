#include "tests/bvh_check.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

using namespace wedge;
using namespace wedge::test;

TEST_CASE("Every nasty mesh becomes a valid hierarchy")
{
    for (const bvh::Mode mode : allModes)
        for (const TestMesh& mesh : nastyMeshes()) {
            CAPTURE(bvh::modeName(mode));
            const bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
            checkValid(hierarchy, mesh);
            CHECK(hierarchy.statistics.triangles + hierarchy.statistics.skipped == mesh.triangles());
        }
}

TEST_CASE("The hierarchy is valid for every configuration")
{
    const TestMesh mesh = soup(3000, 0.1f);
    for (const float cost : { 0.01f, 0.5f, 100.0f })
        for (const unsigned bins : { 2u, 7u, bvh::maxBins })
            for (const unsigned blocks : { 1u, unsigned { WEDGE_BVH_MAX_LEAF_BLOCKS } })
                checkValid(bvh::build(mesh.view(), { cost, bins, blocks }), mesh);
}

TEST_CASE("Modes have names, and nothing else is one")
{
    for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Default, bvh::Mode::Quality })
        CHECK(bvh::parseMode(bvh::modeName(mode)) == mode);
    CHECK(bvh::parseMode("fast") == bvh::Mode::Fast);
    CHECK(bvh::parseMode("quality") == bvh::Mode::Quality);
    for (const char* name : { "", "Fast", "high", "default " })
        CHECK_FALSE(bvh::parseMode(name));
    CHECK(bvh::config(bvh::Mode::Fast).mortonRuns);
    CHECK(bvh::config(bvh::Mode::Quality).extraReferences > 0);
}

TEST_CASE("An empty mesh has a root without children")
{
    for (const bvh::Mode mode : allModes) {
        const bvh::Bvh hierarchy = bvh::build({}, bvh::config(mode));
        REQUIRE(hierarchy.nodes.size() == 1);
        CHECK(hierarchy.blocks.empty());
        CHECK(hierarchy.statistics.depth == 1);
        CHECK(hierarchy.statistics.stackNeeded == 0);
        for (const std::uint32_t child : hierarchy.nodes[0].child)
            CHECK(child == WEDGE_BVH_LEAF);
    }
}

TEST_CASE("The SAH cost of one triangle is one node and one block")
{
    TestMesh mesh { "one", {}, {} };
    mesh.add({ 0, 0, 0, 1, 0, 0, 0, 1, 1 });
    const bvh::Statistics statistics = bvh::build(mesh.view(), { 0.25f }).statistics;
    CHECK(statistics.sahCost == doctest::Approx(1.25));
    CHECK(statistics.nodes == 1);
    CHECK(statistics.blocks == 1);
    CHECK(statistics.bytes == sizeof(shared::BvhNode) + sizeof(shared::TriangleBlock));
}

TEST_CASE("The SAH parts two clusters and costs less than one leaf of all")
{
    TestMesh mesh { "clusters", {}, {} };
    for (int i = 0; i < 16; i++) {
        const float x = i < 8 ? -100.0f : 100.0f, y = static_cast<float>(i % 8);
        mesh.add({ x, y, 0, x + 1, y, 0, x, y, 1 });
    }
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    checkValid(hierarchy, mesh);
    CHECK(hierarchy.statistics.blocks == 2);
    // The halves have a width of 1 in 201: almost every ray that hits the root misses one or both.
    CHECK(hierarchy.statistics.sahCost < 1 + 2 * 0.1);
}

TEST_CASE("100,000 identical triangles end in full leaves under a shallow tree")
{
    for (const bvh::Mode mode : allModes) {
        const TestMesh mesh = duplicates(100000);
        const bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
        checkValid(hierarchy, mesh);
        CHECK(hierarchy.statistics.triangles == 100000);
        CHECK(hierarchy.statistics.depth < 10);
        CHECK(hierarchy.statistics.blocks < 2 * 100000 / WEDGE_BLOCK_SIZE);
    }
}

TEST_CASE("Trees that the SAH would make too deep stay within the traversal's stack")
{
    const TestMesh mesh = deep();
    for (const bvh::Config& config :
        { bvh::Config { 1e-3f, 2, 1 }, bvh::Config { 1e-3f, 2, 1, true }, bvh::Config { 1e-3f, 2, 1, false, 0.5f } }) {
        const bvh::Bvh hierarchy = bvh::build(mesh.view(), config);
        checkValid(hierarchy, mesh);
        if (!config.mortonRuns)
            CHECK(hierarchy.statistics.stackNeeded > WEDGE_BVH_STACK / 2); // else this tests nothing
        CHECK(hierarchy.statistics.stackNeeded <= WEDGE_BVH_STACK);
    }
}

TEST_CASE("Triangles with invalid vertices are skipped and counted")
{
    const TestMesh mesh = invalidVertices();
    TestMesh none { "nothing valid", {}, {} };
    none.add({ NAN, 0, 0, 1, 0, 0, 0, 1, 0 });
    for (const bvh::Mode mode : allModes) {
        const bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
        checkValid(hierarchy, mesh);
        CHECK(hierarchy.statistics.skipped == 100);
        CHECK((mode == bvh::Mode::Quality || hierarchy.statistics.references == hierarchy.statistics.triangles));
        CHECK(bvh::build(none.view(), bvh::config(mode)).statistics.skipped == 1);
        checkValid(bvh::build(none.view(), bvh::config(mode)), none);
    }
}

TEST_CASE("Triangles without area are kept, counted and flat")
{
    const TestMesh mesh = degenerates();
    for (const bvh::Mode mode : allModes) {
        const bvh::Bvh hierarchy = bvh::build(mesh.view(), bvh::config(mode));
        checkValid(hierarchy, mesh);
        CHECK(hierarchy.statistics.degenerate == 80);
        CHECK(hierarchy.statistics.triangles == 100);
    }
}

TEST_CASE("The same bits come out for any number of threads, and every time")
{
    // Above the sizes at which subtrees, chunks and the collapse go parallel.
    const TestMesh meshes[] = { soup(120000, 0.01f), waves(220), needles(10000), clusters() };
    for (std::size_t i = 0; i < std::size(meshes) * std::size(allModes); i++) {
        const TestMesh& mesh = meshes[i / 3];
        const bvh::Config config = bvh::config(allModes[i % 3]);
        std::vector<bvh::Bvh> results;
        for (const std::size_t threads : { 1, 2, 8, 8 }) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            results.push_back(bvh::build(mesh.view(), config));
        }
        checkValid(results[0], mesh);
        for (const bvh::Bvh& result : results) {
            CHECK(sameBits(results[0], result));
            CHECK(results[0].statistics.sahCost == result.statistics.sahCost);
        }
    }
}

TEST_CASE("The validator sees a broken hierarchy")
{
    const TestMesh mesh = soup(2000, 0.1f);
    const bvh::Bvh good = bvh::build(mesh.view());
    const auto broken = [&](const auto& breakIt) {
        bvh::Bvh hierarchy = good;
        breakIt(hierarchy);
        return !bvh::validate(hierarchy, mesh.view()).empty();
    };
    CHECK_FALSE(broken([](bvh::Bvh&) {}));
    CHECK(broken([](bvh::Bvh& b) { b.nodes[0].hiX[0] -= 0.05f; }));
    CHECK(broken([](bvh::Bvh& b) { b.nodes[3].loZ[1] += 0.05f; }));
    CHECK(broken([](bvh::Bvh& b) { b.nodes[0].child[0] = b.nodes[0].child[1]; }));
    CHECK(broken([](bvh::Bvh& b) { b.nodes[0].child[0] = WEDGE_BVH_LEAF; }));
    CHECK(broken([](bvh::Bvh& b) { b.nodes.push_back(b.nodes[1]); }));
    CHECK(broken([](bvh::Bvh& b) { b.blocks.pop_back(); }));
    CHECK(broken([](bvh::Bvh& b) { b.blocks[5].triangle[0] = b.blocks[6].triangle[0]; }));
    CHECK(broken([](bvh::Bvh& b) { b.blocks[5].v2y[0] *= 2; }));
    CHECK(broken([](bvh::Bvh& b) { b.nodes[0].unit *= 2; }));
}
