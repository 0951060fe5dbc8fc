// Rays with times through hierarchies over triangles that move, against every triangle where it is at the ray's time.
#include "tests/bvh_motion.h"
#include "tests/bvh_oracle.h"
#include "tests/bvh_tracer.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Whether a triangle has become smaller than the rounding of its vertices, so that nobody can say where rays hit it.
bool hasVanished(const TestMesh& mesh, std::uint32_t triangle)
{
    if (triangle == WEDGE_NO_TRIANGLE)
        return false;
    float edge = 0, coordinate = 0;
    for (std::size_t corner = 0; corner < 3; corner++)
        for (std::size_t axis = 0; axis < 3; axis++) {
            const auto at = [&](std::size_t c) {
                return mesh.positions[3 * std::size_t { mesh.indices[3 * triangle + c % 3] } + axis];
            };
            edge = std::max(edge, std::fabs(at(corner + 1) - at(corner)));
            coordinate = std::max(coordinate, std::fabs(at(corner)));
        }
    return edge < 1e-6f * coordinate;
}

/// Every way to trace rays through moving geometry on one device.
struct Ways {
    explicit Ways(const device::Device& device)
        : wide(device, Family::Wide, Geometry::Moving)
        , scalar(device, Family::Scalar, Geometry::Moving)
    {
    }

    struct Hits {
        std::vector<Hit> closest;
        std::vector<std::uint32_t> any;
    };

    /// Single rays of the wide family, with which all other ways must agree.
    Hits trace(const MovingMesh& mesh, const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        Hits hits { wide.closest(tree, rays, times), wide.any(tree, rays, times) };
        const auto compare = [&](const std::string& what, const std::vector<Hit>& found) {
            CAPTURE(what);
            REQUIRE(found.size() == rays.size());
            for (std::size_t i = 0; i < rays.size(); i++) {
                if (sameBits(hits.closest[i], found[i]))
                    continue;
                const TestMesh now = mesh.at(times[i]);
                INFO("ray " << i << " at " << times[i] << ": triangle " << hits.closest[i].triangle << " at "
                            << hits.closest[i].t << ", found " << found[i].triangle << " at " << found[i].t);
                REQUIRE(!(isDetermined(now, rays[i], hits.closest[i]) && isDetermined(now, rays[i], found[i])));
            }
        };
        compare("scalar", scalar.closest(tree, rays, times));
        compare("packets of the wide family", wide.closestPackets(tree, rays, times));
        compare("packets of the scalar family", scalar.closestPackets(tree, rays, times));
        CHECK(scalar.any(tree, rays, times) == hits.any);
        CHECK(wide.anyPackets(tree, rays, times) == hits.any);
        CHECK(scalar.anyPackets(tree, rays, times) == hits.any);
        return hits;
    }

    /// Checks all ways against every triangle. Returns how many rays hit.
    std::size_t check(
        const MovingMesh& mesh, const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        const Hits hits = trace(mesh, tree, rays, times);
        std::size_t found = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
            const TestMesh now = mesh.at(times[i]);
            const std::string fault = findFault(now, rays[i], hits.closest[i], hits.any[i] == 1);
            if (!fault.empty() && !hasVanished(now, hits.closest[i].triangle))
                FAIL_CHECK("ray " << i << " at time " << times[i] << " " << fault);
            found += hits.any[i];
        }
        return found;
    }

    Tracer wide, scalar;
};

template <typename Test>
void onAllWays(const Test& test)
{
    onDevices([&](const device::Device& device) {
        Ways ways(device);
        test(ways);
    });
}

} // namespace

TEST_CASE("Nothing at all, and nothing but what is never hit")
{
    const MovingMesh empty = moving({ "empty", {}, {} }, {});
    TestMesh one { "one triangle", {}, {} };
    one.add({ -1, -1, 0, 1, -1, 0, 0, 1, 0 });
    const MovingMesh gone = withClose(one, [](std::size_t, Vec3) { return vec3(INFINITY, 0, 0); });
    const MovingMesh point =
        withClose({ "point", std::vector<float>(9, 0.5f), { 0, 1, 2 } }, [](std::size_t, Vec3 p) { return p; });
    onAllWays([&](Ways& ways) {
        for (const MovingMesh* mesh : { &empty, &gone, &point }) {
            CAPTURE(mesh->open.name);
            const MovingTree tree(mesh->build());
            const std::vector<Ray> rays = axisRays(one, 100);
            CHECK(ways.check(*mesh, tree, rays, randomTimes(rays.size(), 3)) == 0);
        }
        CHECK(gone.build().statistics.skipped == 1);
        CHECK(point.build().statistics.degenerate == 1);
        // Without area at both ends: at all times, and at no other.
        const TestMesh segment { "segment", { 0, 0, 0, 1, 0, 0, 2, 0, 0 }, { 0, 1, 2 } };
        CHECK(moving(segment, { 0, 0, 0, 0, 1, 0, 0, 2, 0 }).build().statistics.degenerate == 1);
        CHECK(moving(segment, { 0, 0, 0, 0, 2, 0, 0, 1, 0 }).build().statistics.degenerate == 0);
    });
}

TEST_CASE("What has both ends and does not move is hit like what has one")
{
    onDevices([&](const device::Device& device) {
        Ways ways(device);
        Tracer still(device);
        for (const TestMesh& mesh : { soup(3000, 0.2f), waves(24), degenerates(), unevenSizes() }) {
            CAPTURE(mesh.name);
            const MovingMesh both = withClose(mesh, [](std::size_t, Vec3 p) { return p; });
            const MovingTree tree(both.build());
            for (const RaySet& set : raySets(mesh, 500)) {
                CAPTURE(set.name);
                const std::vector<Hit> expected = still.closest(Tree(mesh), set.rays);
                const Ways::Hits hits = ways.trace(both, tree, set.rays, randomTimes(set.rays.size(), 5));
                for (std::size_t i = 0; i < set.rays.size(); i++)
                    if (!sameBits(hits.closest[i], expected[i]))
                        CHECK(!(isDetermined(mesh, set.rays[i], hits.closest[i])
                            && isDetermined(mesh, set.rays[i], expected[i])));
            }
        }
    });
}

TEST_CASE("Boxes contain what is below them at every time, in trees of every mode")
{
    for (const MovingMesh& mesh : movingMeshes())
        for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Default, bvh::Mode::Quality }) {
            CAPTURE(mesh.open.name);
            const bvh::MovingBvh built = mesh.build(bvh::config(mode));
            CHECK(
                faultsOf(built, std::span<const shared::MovingNode>(built.nodes), mesh) == std::vector<std::string>());
            const std::vector<shared::MovingNode4> narrow = bvh::narrow(built);
            CHECK(faultsOf(built, std::span<const shared::MovingNode4>(narrow), mesh) == std::vector<std::string>());
        }
}

TEST_CASE("Rays at random times find what is there, whichever way they are traced")
{
    onAllWays([](Ways& ways) {
        for (const MovingMesh& mesh : movingMeshes()) {
            CAPTURE(mesh.open.name);
            const MovingTree tree(mesh.build());
            for (const float at : { 0.0f, 0.3f, 1.0f }) {
                const std::vector<Ray> rays = randomRays(mesh.at(at), 400, 17);
                ways.check(mesh, tree, rays, randomTimes(rays.size(), 19));
            }
        }
    });
}

TEST_CASE("Rays at the shutter's opening and closing find the mesh as it then is")
{
    onAllWays([](Ways& ways) {
        for (const MovingMesh& mesh : movingMeshes()) {
            CAPTURE(mesh.open.name);
            const MovingTree tree(mesh.build());
            for (const float time : { 0.0f, 1.0f })
                for (const RaySet& set : raySets(mesh.at(time), 100)) {
                    CAPTURE(set.name);
                    ways.check(mesh, tree, set.rays, std::vector<float>(set.rays.size(), time));
                }
        }
    });
}

TEST_CASE("Times beyond the shutter count as its ends, and those that are no numbers as its opening")
{
    const MovingMesh mesh = drifting(soup(500, 0.4f), vec3(0.5f, 0.2f, -0.3f));
    const MovingTree tree(mesh.build());
    const std::vector<Ray> rays = randomRays(mesh.open, 320, 23);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    onAllWays([&](Ways& ways) {
        for (const auto& [time, meant] :
            { std::pair(-1.0f, 0.0f), { 2.0f, 1.0f }, { infinity, 1.0f }, { nan, 0.0f } }) {
            CAPTURE(time);
            const std::vector<float> beyond(rays.size(), time), within(rays.size(), meant);
            const Ways::Hits expected = ways.trace(mesh, tree, rays, within),
                             found = ways.trace(mesh, tree, rays, beyond);
            CHECK(sameBits(expected.closest, found.closest));
            CHECK(expected.any == found.any);
        }
    });
}

TEST_CASE("Packets of neighbouring rays with times of their own see each its own moment")
{
    // Waves that rise by half their width: what a ray meets depends on its time everywhere.
    const MovingMesh mesh = withClose(waves(20), [](std::size_t, Vec3 p) { return vec3(p.x, p.y + 0.5f, p.z); });
    const MovingTree tree(mesh.build());
    std::vector<Ray> rays;
    for (unsigned i = 0; i < 1024; i++) {
        const unsigned x = (i / 16 % 8) * 4 + i % 4, y = (i / 128) * 4 + i / 4 % 4;
        const float u = (static_cast<float>(x) - 15.5f) / 16, v = (static_cast<float>(y) - 15.5f) / 16;
        rays.push_back({ vec3(0.01f, 2, 0.02f), 0, vec3(0.4f * u, -1, 0.4f * v), infinity });
    }
    const std::vector<float> times = randomTimes(rays.size(), 29);
    onAllWays([&](Ways& ways) {
        CHECK(ways.check(mesh, tree, rays, times) == rays.size());
        const std::vector<Hit> hits = ways.wide.closestPackets(tree, rays, times);
        for (std::size_t i = 0; i < rays.size(); i++)
            CHECK(std::fabs(2 - hits[i].t - 0.5f * times[i]) < 0.11f); // the height, but for the waves
    });
}

TEST_CASE("Packets see a triangle whose one corner moves, wherever it is")
{
    onAllWays([](Ways& ways) {
        for (std::size_t corner = 0; corner < 3; corner++) {
            CAPTURE(corner);
            TestMesh slim { "slim", {}, {} };
            slim.add({ -0.1f, 0, 0, 0, 0, 0.1f, 0, 0, -0.1f });
            MovingMesh mesh = withClose(slim, [&](std::size_t i, Vec3 p) { return i == corner ? vecScale(p, 20) : p; });
            const MovingTree tree(mesh.build());
            // 16 neighbours at a time, whose shaft meets that corner alone.
            std::mt19937 random(47);
            std::vector<Ray> rays;
            for (unsigned i = 0; i < 400; i++) {
                const Vec3 at = pointOn(mesh.at(static_cast<float>(i) / 400), random);
                for (unsigned k = 0; k < 16; k++)
                    rays.push_back({ vec3(at.x, 1, at.z), 0,
                        vec3(0.01f * static_cast<float>(k % 4), -1, 0.01f * static_cast<float>(k / 4)), infinity });
            }
            CHECK(ways.check(mesh, tree, rays, randomTimes(rays.size(), 59)) > 500);
        }
    });
}

TEST_CASE("No ray slips through the edges of a closed mesh while it moves")
{
    const MovingMesh mesh = withClose(waves(30), [](std::size_t i, Vec3 p) {
        const float a = 0.02f * std::sin(static_cast<float>(i));
        return vec3(p.x + a, p.y + 3 * a, p.z - a);
    });
    const MovingTree tree(mesh.build());
    std::mt19937 random(31);
    std::vector<Ray> rays;
    const std::vector<float> times = randomTimes(6000, 37);
    for (const float time : times) {
        // At an edge or a vertex, where it is at that time.
        const std::size_t triangle = random() % mesh.open.triangles(), corner = random() % 3;
        const Vec3 a = mesh.vertexAt(triangle, corner, time), b = mesh.vertexAt(triangle, (corner + 1) % 3, time);
        const Vec3 target = vecScale(vecMad(a, vecSub(b, a), static_cast<float>(random() % 3) / 2), 0.95f);
        const Vec3 origin = vec3(0.1f, 1.5f, -0.2f);
        rays.push_back({ origin, 0, vecSub(target, origin), infinity });
    }
    onAllWays([&](Ways& ways) {
        const Ways::Hits hits = ways.trace(mesh, tree, rays, times);
        CHECK(std::ranges::count(hits.any, 0u) == 0);
    });
}

TEST_CASE("Lanes without a ray, and without a time, leave the others as they are")
{
    const MovingMesh mesh = drifting(soup(1000, 0.3f), vec3(0, 0.7f, 0));
    const MovingTree tree(mesh.build());
    std::vector<Ray> rays = randomRays(mesh.at(0.5f), 640, 41);
    std::vector<float> times = randomTimes(rays.size(), 43);
    const std::vector<Ray> broken = brokenRays(rays[0]);
    for (std::size_t i = 0; i < rays.size(); i += 3) {
        rays[i] = broken[i % broken.size()];
        times[i] = std::numeric_limits<float>::quiet_NaN();
    }
    onAllWays([&](Ways& ways) {
        const Ways::Hits hits = ways.trace(mesh, tree, rays, times);
        for (std::size_t i = 0; i < rays.size(); i += 3)
            CHECK(hits.any[i] == 0);
        CHECK(std::ranges::count(hits.any, 1u) > 150);
    });
}

TEST_CASE("Of what crosses halfway, the quality mode's tree is the cheaper one")
{
    // Two heaps that change places: halfway they are one.
    const TestMesh left = soup(2000, 0.05f, 3), right = soup(2000, 0.05f, 4);
    TestMesh both { "crossing", left.positions, left.indices };
    for (std::size_t i = 0; i < right.positions.size(); i++)
        both.positions.push_back(right.positions[i]);
    for (const std::uint32_t index : right.indices)
        both.indices.push_back(index + static_cast<std::uint32_t>(left.positions.size() / 3));
    const std::size_t parted = left.positions.size() / 3;
    for (std::size_t v = 0; v < both.positions.size() / 3; v++)
        both.positions[3 * v] += v < parted ? -3.0f : 3.0f;
    const MovingMesh mesh =
        withClose(both, [&](std::size_t v, Vec3 p) { return vec3(p.x + (v < parted ? 6.0f : -6.0f), p.y, p.z); });
    const double halfway = mesh.build().statistics.sahCost;
    const double best = mesh.build(bvh::config(bvh::Mode::Quality)).statistics.sahCost;
    CHECK(best < 0.8 * halfway);
}
