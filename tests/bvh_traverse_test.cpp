// What both families of traversals find, against every triangle tested in double.
#include "bvh/host_traverse.h"
#include "tests/bvh_oracle.h"
#include "tests/bvh_tracer.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

void checkAgainstBruteForce(Tracer& tracer, const TestMesh& mesh, const Tree& tree, std::span<const Ray> rays)
{
    CAPTURE(mesh.name);
    const std::vector<Hit> hits = tracer.closest(tree, rays);
    const std::vector<std::uint32_t> occluded = tracer.any(tree, rays);
    for (std::size_t i = 0; i < rays.size(); i++) {
        const std::string fault = findFault(mesh, rays[i], hits[i], occluded[i] != 0);
        INFO("ray " << i << " triangle " << hits[i].triangle << " t " << hits[i].t);
        if (!fault.empty())
            FAIL_CHECK("device: " << fault);
        const Hit host = bvh::closestHit(tree.wide, rays[i]);
        const std::string hostFault = findFault(mesh, rays[i], host, bvh::anyHit(tree.wide, rays[i]));
        if (!hostFault.empty())
            FAIL_CHECK("host: " << hostFault);
    }
}

} // namespace

TEST_CASE("Rays of all kinds find what testing every triangle finds, in every nasty mesh")
{
    onEveryTracer([](Tracer& tracer) {
        for (const TestMesh& mesh : nastyMeshes()) {
            const Tree tree(mesh);
            for (const RaySet& set : raySets(mesh, 500)) {
                CAPTURE(set.name);
                checkAgainstBruteForce(tracer, mesh, tree, set.rays);
            }
        }
    });
}

TEST_CASE("Rays in the plane of a triangle's edge on a box face hit it, whatever the other zeros")
{
    TestMesh mesh { "corner at 0", {}, {} };
    mesh.add({ 0, 0, 1, 1, 0, 1, 0, 1, 1 });
    const std::vector<Ray> rays = {
        { vec3(0, 0, 0), 0, vec3(0, 0, 1), infinity }, // through the vertex at the corner of the box
        { vec3(0, 0.25f, -1e6f), 0, vec3(-0.0f, 0, 1), infinity },
        { vec3(0.25f, 0, 0), 0, vec3(0, -0.0f, 1e-8f), infinity },
        { vec3(0.5f, 0, 0), 0, vec3(0, 0, 1e8f), infinity },
    };
    onEveryTracer([&](Tracer& tracer) {
        for (const Hit& hit : tracer.closest(Tree(mesh), rays))
            CHECK(hit.triangle == 0);
    });
}

TEST_CASE("A ray that is none hits nothing and ends")
{
    const TestMesh mesh = soup(500, 2.0f);
    const Tree tree(mesh);
    const Ray good { vec3(-3, 0.01f, 0.02f), 0, vec3(1, 0.01f, 0), infinity };
    const std::vector<Ray> rays = brokenRays(good);
    onEveryTracer([&](Tracer& tracer) {
        REQUIRE(tracer.any(tree, std::vector { good })[0] == 1);
        const std::vector<Hit> hits = tracer.closest(tree, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(tree, rays);
        for (std::size_t i = 0; i < rays.size(); i++) {
            CAPTURE(i);
            CHECK(hits[i].triangle == WEDGE_NO_TRIANGLE);
            CHECK(occluded[i] == 0);
            CHECK(bvh::closestHit(tree.wide, rays[i]).triangle == WEDGE_NO_TRIANGLE);
        }
    });
}

TEST_CASE("The interval of a ray is open at both ends")
{
    TestMesh mesh { "at z = 1", {}, {} };
    mesh.add({ -1, -1, 1, 1, -1, 1, 0, 1, 1 });
    const Tree tree(mesh);
    const Vec3 origin = vec3(0, 0, 0), direction = vec3(0, 0, 1);
    const float before = std::nextafter(1.0f, 0.0f), after = std::nextafter(1.0f, 2.0f);
    const std::vector<Ray> rays = { { origin, 0, direction, 1 }, { origin, 1, direction, 2 },
        { origin, 0, direction, after }, { origin, before, direction, 2 }, { vec3(0, 0, 1), 0, direction, 2 } };
    const bool expected[] = { false, false, true, true, false };
    onEveryTracer([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(tree, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(tree, rays);
        for (std::size_t i = 0; i < rays.size(); i++) {
            CAPTURE(i);
            CHECK((hits[i].triangle == 0) == expected[i]);
            CHECK((occluded[i] != 0) == expected[i]);
            CHECK(bvh::anyHit(tree.wide, rays[i]) == expected[i]);
        }
    });
}

TEST_CASE("u and v weigh vertices 1 and 2, on both faces")
{
    TestMesh mesh { "one", {}, {} };
    mesh.add({ 0, 0, 0, 4, 0, 0, 0, 2, 0 });
    const std::vector<Ray> rays = { { vec3(1, 1, 5), 0, vec3(0, 0, -2), infinity },
        { vec3(1, 1, -5), 0, vec3(0, 0, 2), infinity } };
    onEveryTracer([&](Tracer& tracer) {
        for (const Hit& hit : tracer.closest(Tree(mesh), rays)) {
            CHECK(hit.t == 2.5f);
            CHECK(hit.u == 0.25f);
            CHECK(hit.v == 0.5f);
        }
    });
}

TEST_CASE("Of hits at equal t the smallest triangle wins")
{
    // Three copies of a surface, the first in another place of the index list each.
    TestMesh mesh = waves(20);
    const std::vector<std::uint32_t> once = mesh.indices;
    const auto count = static_cast<std::uint32_t>(once.size() / 3);
    for (std::uint32_t copy = 1; copy < 3; copy++)
        for (std::uint32_t i = 0; i < count; i++)
            for (std::uint32_t corner = 0; corner < 3; corner++)
                mesh.indices.push_back(once[3 * ((i * 7 + copy) % count) + corner]);
    const std::vector<Ray> rays = randomRays(mesh, 4000, 3);
    const Tree tree(mesh);
    onEveryTracer([&](Tracer& tracer) {
        std::size_t found = 0, beyondFirst = 0;
        for (const Hit& hit : tracer.closest(tree, rays)) {
            found += hit.triangle != WEDGE_NO_TRIANGLE;
            beyondFirst += hit.triangle != WEDGE_NO_TRIANGLE && hit.triangle >= count;
        }
        CHECK(found > 1000);
        CHECK(beyondFirst == 0);
    });
}

TEST_CASE("Hits depend neither on the hierarchy nor on the run")
{
    const TestMesh mesh = soup(5000, 0.1f);
    const std::vector<Ray> rays = randomRays(mesh, 20000, 17);
    onEveryTracer([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(Tree(mesh), rays);
        CHECK(sameBits(hits, tracer.closest(Tree(mesh), rays)));
        for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Quality })
            CHECK(sameBits(hits, tracer.closest(Tree(mesh, bvh::config(mode)), rays)));
        CHECK(sameBits(hits, tracer.closest(Tree(mesh, { 0.1f, 5, 1 }), rays)));
        CHECK(sameBits(hits, tracer.closest(Tree(mesh, { 4.0f, 32, 7 }), rays)));
    });
}

TEST_CASE("In a large mesh the device finds what the host finds")
{
    const TestMesh mesh = soup(60000, 0.02f);
    const std::vector<Ray> rays = randomRays(mesh, 20000, 29);
    const Tree tree(mesh);
    onEveryTracer([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(tree, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(tree, rays);
        std::size_t different = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
            const Hit host = bvh::closestHit(tree.wide, rays[i]);
            different += host.triangle != hits[i].triangle;
            CHECK((hits[i].triangle != WEDGE_NO_TRIANGLE) == (occluded[i] != 0));
            if (host.triangle == hits[i].triangle && host.triangle != WEDGE_NO_TRIANGLE)
                CHECK(hits[i].t == doctest::Approx(host.t).epsilon(1e-5));
        }
        CHECK(different <= 2); // edges, where a division rounds otherwise
    });
}
