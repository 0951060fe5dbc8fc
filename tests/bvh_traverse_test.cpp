#include "bvh/bvh.h"
#include "bvh/host_traverse.h"
#include "host/device/buffer.h"
#include "host/device/program.h"
#include "host/device/queue.h"
#include "tests/bvh_meshes.h"
#include "tests/bvh_oracle.h"
#include "tests/bvh_rays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// Runs the kernels of trace_test.cl on one device.
class Tracer {
public:
    explicit Tracer(const device::Device& device)
        : device_(device)
        , queue_(device)
        , library_(device, {})
    {
    }

    std::vector<Hit> closest(const bvh::Bvh& hierarchy, std::span<const Ray> rays)
    {
        return run<Hit>("traceClosest", hierarchy, rays);
    }
    std::vector<std::uint32_t> any(const bvh::Bvh& hierarchy, std::span<const Ray> rays)
    {
        return run<std::uint32_t>("traceAny", hierarchy, rays);
    }

private:
    template <typename Result>
    std::vector<Result> run(const char* name, const bvh::Bvh& hierarchy, std::span<const Ray> rays)
    {
        device::Buffer<Ray> rayBuffer(device_, rays.size(), "rays");
        device::Buffer<Result> results(device_, rays.size(), "results");
        device::Buffer<shared::BvhNode> nodes(device_, hierarchy.nodes.size(), "nodes");
        device::Buffer<shared::TriangleBlock> blocks(device_, hierarchy.blocks.size(), "blocks");
        rayBuffer.upload(queue_, rays);
        nodes.upload(queue_, hierarchy.nodes);
        if (!hierarchy.blocks.empty())
            blocks.upload(queue_, hierarchy.blocks);
        device::Kernel kernel = library_.kernel("trace_test.cl", name);
        kernel.setArgs(rayBuffer, results, nodes, blocks, static_cast<std::uint32_t>(rays.size()));
        const std::size_t local = std::min<std::size_t>(64, kernel.workGroupLimit());
        queue_.launch(name, device::PassKind::Trace, kernel, rays.size(), local);
        return results.downloadAll(queue_);
    }

    device::Device device_;
    device::TimedQueue queue_;
    device::ProgramLibrary library_;
};

/// Calls test(tracer) for each usable device here.
template <typename Test>
void onEveryDevice(const Test& test)
{
    const std::vector<device::DeviceInfo> infos = device::listDevices();
    unsigned used = 0;
    for (std::size_t i = 0; i < infos.size(); i++) {
        if (!infos[i].unusable.empty())
            continue;
        CAPTURE(infos[i].name);
        Tracer tracer(device::Device::open(std::to_string(i)));
        test(tracer);
        used++;
    }
    REQUIRE(used > 0);
}

void checkAgainstBruteForce(Tracer& tracer, const TestMesh& mesh, std::span<const Ray> rays)
{
    CAPTURE(mesh.name);
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    const std::vector<Hit> hits = tracer.closest(hierarchy, rays);
    const std::vector<std::uint32_t> occluded = tracer.any(hierarchy, rays);
    for (std::size_t i = 0; i < rays.size(); i++) {
        const std::string fault = findFault(mesh, rays[i], hits[i], occluded[i] != 0);
        INFO("ray " << i << " triangle " << hits[i].triangle << " t " << hits[i].t);
        if (!fault.empty())
            FAIL_CHECK("device: " << fault);
        const Hit host = bvh::closestHit(hierarchy, rays[i]);
        const std::string hostFault = findFault(mesh, rays[i], host, bvh::anyHit(hierarchy, rays[i]));
        if (!hostFault.empty())
            FAIL_CHECK("host: " << hostFault);
    }
}

bool sameBits(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)) == 0;
}

} // namespace

TEST_CASE("Random rays find what testing every triangle finds, in every nasty mesh")
{
    onEveryDevice([](Tracer& tracer) {
        for (const TestMesh& mesh : nastyMeshes())
            checkAgainstBruteForce(tracer, mesh, randomRays(mesh, 1500, 7));
    });
}

TEST_CASE("Axis-parallel rays within the planes of box faces find what testing every triangle finds")
{
    onEveryDevice([](Tracer& tracer) {
        for (const TestMesh& mesh : nastyMeshes())
            checkAgainstBruteForce(tracer, mesh, axisRays(mesh, 800));
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
    onEveryDevice([&](Tracer& tracer) {
        for (const Hit& hit : tracer.closest(bvh::build(mesh.view()), rays))
            CHECK(hit.triangle == 0);
    });
}

TEST_CASE("A ray that is none hits nothing and ends")
{
    const TestMesh mesh = soup(500, 2.0f);
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    const Ray good { vec3(-3, 0.01f, 0.02f), 0, vec3(1, 0.01f, 0), infinity };
    std::vector<Ray> rays;
    for (const float bad : { notANumber, infinity, -infinity })
        for (int component = 0; component < 6; component++) {
            Ray ray = good;
            float* const parts[] = { &ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y,
                &ray.direction.z };
            *parts[component] = bad;
            rays.push_back(ray);
        }
    rays.push_back({ good.origin, 0, vec3(0, 0, 0), infinity });
    rays.push_back({ good.origin, 0, vec3(-0.0f, 0, -0.0f), infinity });
    rays.push_back({ good.origin, 1, good.direction, 1 });
    rays.push_back({ good.origin, 2, good.direction, 1 });
    rays.push_back({ good.origin, 0, good.direction, 0 });
    rays.push_back({ good.origin, -2, good.direction, -1 });
    rays.push_back({ good.origin, 0, good.direction, notANumber });
    onEveryDevice([&](Tracer& tracer) {
        REQUIRE(tracer.any(hierarchy, std::vector { good })[0] == 1);
        const std::vector<Hit> hits = tracer.closest(hierarchy, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(hierarchy, rays);
        for (std::size_t i = 0; i < rays.size(); i++) {
            CAPTURE(i);
            CHECK(hits[i].triangle == WEDGE_NO_TRIANGLE);
            CHECK(occluded[i] == 0);
            CHECK(bvh::closestHit(hierarchy, rays[i]).triangle == WEDGE_NO_TRIANGLE);
        }
    });
}

TEST_CASE("The interval of a ray is open at both ends")
{
    TestMesh mesh { "at z = 1", {}, {} };
    mesh.add({ -1, -1, 1, 1, -1, 1, 0, 1, 1 });
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    const Vec3 origin = vec3(0, 0, 0), direction = vec3(0, 0, 1);
    const float before = std::nextafter(1.0f, 0.0f), after = std::nextafter(1.0f, 2.0f);
    const std::vector<Ray> rays = { { origin, 0, direction, 1 }, { origin, 1, direction, 2 },
        { origin, 0, direction, after }, { origin, before, direction, 2 }, { vec3(0, 0, 1), 0, direction, 2 } };
    const bool expected[] = { false, false, true, true, false };
    onEveryDevice([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(hierarchy, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(hierarchy, rays);
        for (std::size_t i = 0; i < rays.size(); i++) {
            CAPTURE(i);
            CHECK((hits[i].triangle == 0) == expected[i]);
            CHECK((occluded[i] != 0) == expected[i]);
            CHECK(bvh::anyHit(hierarchy, rays[i]) == expected[i]);
        }
    });
}

TEST_CASE("u and v weigh vertices 1 and 2, on both faces")
{
    TestMesh mesh { "one", {}, {} };
    mesh.add({ 0, 0, 0, 4, 0, 0, 0, 2, 0 });
    const std::vector<Ray> rays = { { vec3(1, 1, 5), 0, vec3(0, 0, -2), infinity },
        { vec3(1, 1, -5), 0, vec3(0, 0, 2), infinity } };
    onEveryDevice([&](Tracer& tracer) {
        for (const Hit& hit : tracer.closest(bvh::build(mesh.view()), rays)) {
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
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    onEveryDevice([&](Tracer& tracer) {
        std::size_t found = 0, beyondFirst = 0;
        for (const Hit& hit : tracer.closest(hierarchy, rays)) {
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
    onEveryDevice([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(bvh::build(mesh.view()), rays);
        CHECK(sameBits(hits, tracer.closest(bvh::build(mesh.view()), rays)));
        CHECK(sameBits(hits, tracer.closest(bvh::build(mesh.view(), { 0.1f, 5, 1 }), rays)));
        CHECK(sameBits(hits, tracer.closest(bvh::build(mesh.view(), { 4.0f, 32, 7 }), rays)));
    });
}

TEST_CASE("No ray slips through where triangles share a vertex or an edge")
{
    // From above at the waves; the square's rim is left out. A quarter aims at vertices and edges.
    const TestMesh mesh = waves(40);
    std::mt19937 random(23);
    std::vector<Ray> rays;
    while (rays.size() < 100000) {
        bool edge = false;
        const Vec3 target = pointOn(mesh, random, &edge);
        if (std::max(std::fabs(target.x), std::fabs(target.z)) > 0.94f)
            continue;
        const Vec3 origin = vec3(0.3f * static_cast<float>(random() % 5), 3, 0.1f * static_cast<float>(random() % 7));
        rays.push_back({ origin, 0, vecSub(target, origin), infinity });
    }
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    onEveryDevice([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(hierarchy, rays);
        CHECK(std::ranges::count(hits, WEDGE_NO_TRIANGLE, &Hit::triangle) == 0);
    });
}

TEST_CASE("In a large mesh the device finds what the host finds")
{
    const TestMesh mesh = soup(60000, 0.02f);
    const std::vector<Ray> rays = randomRays(mesh, 20000, 29);
    const bvh::Bvh hierarchy = bvh::build(mesh.view());
    onEveryDevice([&](Tracer& tracer) {
        const std::vector<Hit> hits = tracer.closest(hierarchy, rays);
        const std::vector<std::uint32_t> occluded = tracer.any(hierarchy, rays);
        std::size_t different = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
            const Hit host = bvh::closestHit(hierarchy, rays[i]);
            different += host.triangle != hits[i].triangle;
            CHECK((hits[i].triangle != WEDGE_NO_TRIANGLE) == (occluded[i] != 0));
            if (host.triangle == hits[i].triangle && host.triangle != WEDGE_NO_TRIANGLE)
                CHECK(hits[i].t == doctest::Approx(host.t).epsilon(1e-5));
        }
        CHECK(different <= 2); // edges, where a division rounds otherwise
    });
}
