// The two families of traversals, and packets and single rays, find the same hits to the last bit.
#include "tests/bvh_oracle.h"
#include "tests/bvh_tracer.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Every way to trace a ray on one device.
struct Ways {
    explicit Ways(const device::Device& device)
        : wide(device, Family::Wide)
        , scalar(device, Family::Scalar)
    {
    }

    /// Checks that all ways agree with single rays of the wide family. Returns how many rays hit.
    std::size_t check(const TestMesh& mesh, const Tree& tree, std::span<const Ray> rays)
    {
        const std::vector<Hit> hits = wide.closest(tree, rays);
        const auto compare = [&](const std::string& what, const std::vector<Hit>& found) {
            CAPTURE(what);
            compareHits(mesh, rays, hits, found);
        };
        const std::vector<std::uint32_t> occluded = wide.any(tree, rays);
        compare("scalar", scalar.closest(tree, rays));
        compare("packets of the wide family", wide.closestPackets(tree, rays));
        compare("packets of the scalar family", scalar.closestPackets(tree, rays));
        CHECK(scalar.any(tree, rays) == occluded);
        CHECK(wide.anyPackets(tree, rays) == occluded);
        CHECK(scalar.anyPackets(tree, rays) == occluded);
        std::size_t found = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
            found += hits[i].triangle != WEDGE_NO_TRIANGLE;
            CHECK((hits[i].triangle != WEDGE_NO_TRIANGLE) == (occluded[i] == 1));
        }
        return found;
    }

    Tracer wide, scalar;

private:
    static void compareHits(const TestMesh& mesh, std::span<const Ray> rays, const std::vector<Hit>& expected,
        const std::vector<Hit>& found)
    {
        REQUIRE(found.size() == expected.size());
        std::size_t undetermined = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
            if (sameBits(expected[i], found[i]))
                continue;
            undetermined++;
            INFO("ray " << i << ": triangle " << expected[i].triangle << " at " << expected[i].t << ", found "
                        << found[i].triangle << " at " << found[i].t);
            REQUIRE(!(isDetermined(mesh, rays[i], expected[i]) && isDetermined(mesh, rays[i], found[i])));
        }
        CHECK(undetermined <= rays.size() / 250);
    }
};

template <typename Test>
void onAllWays(const Test& test)
{
    onDevices([&](const device::Device& device) {
        Ways ways(device);
        test(ways);
    });
}

/// From one point over a grid, in the order of rows of blocks of 4 x 4: what packets are made for.
std::vector<Ray> cameraRays(Vec3 eye, float spread)
{
    std::vector<Ray> rays;
    for (unsigned i = 0; i < 4096; i++) {
        const unsigned x = (i / 16 % 16) * 4 + i % 4, y = (i / 256) * 4 + i / 4 % 4;
        const float u = (static_cast<float>(x) - 31.5f) / 32, v = (static_cast<float>(y) - 31.5f) / 32;
        rays.push_back({ eye, 0, vec3(spread * u, -1, spread * v), infinity });
    }
    return rays;
}

} // namespace

TEST_CASE("Families and packets agree on rays of all kinds in every nasty mesh")
{
    onAllWays([](Ways& ways) {
        for (const TestMesh& mesh : nastyMeshes()) {
            CAPTURE(mesh.name);
            const Tree tree(mesh);
            for (const RaySet& set : raySets(mesh, 600)) {
                CAPTURE(set.name);
                ways.check(mesh, tree, set.rays);
            }
        }
    });
}

TEST_CASE("Families and packets agree in hierarchies of every mode")
{
    const TestMesh mesh = soup(20000, 0.05f);
    const std::vector<Ray> rays = randomRays(mesh, 8000, 41);
    onAllWays([&](Ways& ways) {
        for (const bvh::Mode mode : { bvh::Mode::Fast, bvh::Mode::Default, bvh::Mode::Quality })
            CHECK(ways.check(mesh, Tree(mesh, bvh::config(mode)), rays) > 2000);
    });
}

TEST_CASE("Families and packets agree in the deepest trees, whose stacks they fill")
{
    const TestMesh mesh = deep();
    const Tree tree(mesh, { 1e-3f, 2, 1 });
    // Rays within the nested boxes, above the triangles' diagonal or below it: the first pass through all of them.
    std::vector<Ray> rays;
    for (unsigned i = 0; i < 256; i++) {
        const float a = 0.0005f * static_cast<float>(i % 16), b = 0.0005f * static_cast<float>(i / 16);
        rays.push_back({ vec3(0, 0, 0), 0, vec3(1, 0.001f + a, 0.001f + b), infinity });
    }
    onAllWays([&](Ways& ways) {
        const std::size_t hits = ways.check(mesh, tree, rays);
        CHECK(hits > 50);
        CHECK(hits < 206);
    });
}

TEST_CASE("Coherent packets agree with single rays, whatever the signs of their directions")
{
    const TestMesh mesh = waves(40);
    const Tree tree(mesh);
    onAllWays([&](Ways& ways) {
        // The eye above the middle: the packets about it have directions of both signs on two axes.
        CHECK(ways.check(mesh, tree, cameraRays(vec3(0.01f, 1, 0.02f), 0.8f)) == 4096);
        CHECK(ways.check(mesh, tree, cameraRays(vec3(0.3f, 0.02f, -0.2f), 6)) > 1000);
        // And the other way: from many points to one, as rays to a light.
        std::vector<Ray> back = cameraRays(vec3(0.01f, 1, 0.02f), 0.8f);
        for (Ray& ray : back) {
            const Vec3 surface = vecMad(ray.origin, ray.direction, 0.97f);
            ray = { surface, 1e-3f, vecSub(ray.origin, surface), 0.9999f };
        }
        ways.check(mesh, tree, back);
    });
}

TEST_CASE("Packets take any number of rays, and equal ones")
{
    const TestMesh mesh = soup(2000, 0.2f);
    const Tree tree(mesh);
    const std::vector<Ray> rays = randomRays(mesh, 100, 43);
    onAllWays([&](Ways& ways) {
        for (const std::size_t count : { 1u, 2u, 15u, 16u, 17u, 31u, 33u, 100u })
            ways.check(mesh, tree, std::span(rays).first(count));
        for (std::size_t i = 0; i < 8; i++)
            ways.check(mesh, tree, std::vector<Ray>(48, rays[i]));
    });
}

TEST_CASE("Lanes without a ray leave the others as they are")
{
    const TestMesh mesh = soup(2000, 0.3f);
    const Tree tree(mesh);
    const std::vector<Ray> good = cameraRays(vec3(0, 2, 0), 0.5f), broken = brokenRays(good[0]);
    std::mt19937 random(47);
    onAllWays([&](Ways& ways) {
        for (const unsigned oneIn : { 2u, 16u }) {
            std::vector<Ray> rays = good;
            std::vector<std::size_t> dead;
            for (std::size_t i = 0; i < rays.size(); i++)
                if (random() % oneIn == 0) {
                    rays[i] = broken[random() % broken.size()];
                    dead.push_back(i);
                }
            CHECK(ways.check(mesh, tree, rays) > 500);
            const std::vector<Hit> hits = ways.wide.closestPackets(tree, rays);
            for (const std::size_t i : dead)
                CHECK(hits[i].triangle == WEDGE_NO_TRIANGLE);
        }
        // Nothing but broken rays.
        std::vector<Ray> all = broken;
        all.insert(all.end(), broken.begin(), broken.end());
        CHECK(ways.check(mesh, tree, all) == 0);
    });
}

TEST_CASE("A packet's rays have intervals of their own")
{
    const TestMesh mesh = soup(3000, 0.3f);
    const Tree tree(mesh);
    std::mt19937 random(53);
    std::uniform_real_distribution<float> uniform(0.0f, 4.0f);
    std::vector<Ray> rays = cameraRays(vec3(0, 2, 0), 0.5f);
    for (Ray& ray : rays) {
        ray.tMin = uniform(random) - 1.0f;
        ray.tMax = uniform(random);
    }
    onAllWays([&](Ways& ways) { CHECK(ways.check(mesh, tree, rays) > 300); });
}
