// Where rounding decides: shared edges and vertices, ends of intervals, coordinates far from 0.
#include "tests/bvh_oracle.h"
#include "tests/bvh_tracer.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

/// From above at triangles of a mesh, a quarter at vertices and edges, but for those that aim outside the middle.
template <typename IsMiddle>
std::vector<Ray> raysFromAbove(
    const TestMesh& mesh, std::size_t count, Vec3 above, float step, const IsMiddle& isMiddle)
{
    std::mt19937 random(23);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const Vec3 target = pointOn(mesh, random);
        if (!isMiddle(target))
            continue;
        const Vec3 aside =
            vec3(3 * step * static_cast<float>(random() % 5), 0, step * static_cast<float>(random() % 7));
        const Vec3 origin = vecAdd(above, aside);
        rays.push_back({ origin, 0, vecSub(target, origin), infinity });
    }
    return rays;
}

std::size_t misses(const std::vector<Hit>& hits)
{
    return static_cast<std::size_t>(std::ranges::count(hits, WEDGE_NO_TRIANGLE, &Hit::triangle));
}

} // namespace

TEST_CASE("No ray slips through where triangles share a vertex or an edge")
{
    // The square's rim is left out.
    const TestMesh mesh = waves(40);
    const Tree tree(mesh);
    const std::vector<Ray> rays = raysFromAbove(
        mesh, 100000, vec3(0, 3, 0), 0.1f, [](Vec3 p) { return std::max(std::fabs(p.x), std::fabs(p.z)) <= 0.94f; });
    onEveryTracer([&](Tracer& tracer) {
        CHECK(misses(tracer.closest(tree, rays)) == 0);
        const std::span<const Ray> some = std::span(rays).first(20000);
        CHECK(misses(tracer.closestPackets(tree, some)) == 0);
        CHECK(std::ranges::count(tracer.any(tree, some), 1u) == 20000);
    });
}

TEST_CASE("No ray slips through a mesh a million units from the origin")
{
    // Floats lie 1/16 apart there: vertices are rounded to that, but shared ones alike.
    constexpr float away = 1e6f;
    for (const Vec3 to : { vec3(away, 0, 0), vec3(-away, away, -away), vec3(0, -away, 0) }) {
        TestMesh mesh = scaled(waves(40), 100, "far waves");
        for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
            mesh.positions[i] += to.x;
            mesh.positions[i + 1] += to.y;
            mesh.positions[i + 2] += to.z;
        }
        const Tree tree(mesh);
        const std::vector<Ray> rays = raysFromAbove(mesh, 16000, vec3(to.x, to.y + 300, to.z), 10,
            [&](Vec3 p) { return std::max(std::fabs(p.x - to.x), std::fabs(p.z - to.z)) <= 94; });
        onEveryTracer([&](Tracer& tracer) {
            CHECK(misses(tracer.closest(tree, rays)) == 0);
            CHECK(misses(tracer.closestPackets(tree, rays)) == 0);
        });
    }
}

TEST_CASE("A hit exactly at an end of the interval does not count, and one a float within does")
{
    for (const TestMesh& mesh : { soup(1000, 0.3f), waves(24), unevenSizes(), thin() }) {
        CAPTURE(mesh.name);
        const Tree tree(mesh);
        onEveryTracer([&](Tracer& tracer) {
            const std::vector<Ray> candidates = randomRays(mesh, 3000, 59);
            const std::vector<Hit> hits = tracer.closest(tree, candidates);
            std::vector<Ray> rays;
            std::vector<Hit> found;
            for (std::size_t i = 0; i < hits.size(); i++)
                if (hits[i].triangle != WEDGE_NO_TRIANGLE && isDetermined(mesh, candidates[i], hits[i])) {
                    rays.push_back(candidates[i]);
                    found.push_back(hits[i]);
                }
            REQUIRE(found.size() > 500);
            const auto with = [&](auto change) {
                std::vector<Ray> changed = rays;
                for (std::size_t i = 0; i < changed.size(); i++)
                    change(changed[i], found[i].t);
                return changed;
            };
            const auto before = with([](Ray& ray, float t) { ray.tMax = t; });
            const auto justBeyond = with([](Ray& ray, float t) { ray.tMax = std::nextafter(t, infinity); });
            const auto justFrom = with([](Ray& ray, float t) { ray.tMin = std::nextafter(t, 0.0f); });
            const auto after = with([](Ray& ray, float t) { ray.tMin = t; });
            for (const Hit& hit : tracer.closest(tree, before))
                CHECK(hit.triangle == WEDGE_NO_TRIANGLE);
            CHECK(std::ranges::count(tracer.any(tree, before), 1u) == 0);
            CHECK(sameBits(tracer.closest(tree, justBeyond), found));
            CHECK(std::ranges::count(tracer.any(tree, justBeyond), 0u) == 0);
            CHECK(sameBits(tracer.closest(tree, justFrom), found));
            const std::vector<Hit> next = tracer.closest(tree, after);
            for (std::size_t i = 0; i < next.size(); i++)
                CHECK(next[i].t > found[i].t);
        });
    }
}
