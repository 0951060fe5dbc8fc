// Rays from surfaces, with the origins that surface.h gives them and both families of traversals.
#include "bvh/bvh.h"
#include "tests/render_support.h"

#include <algorithm>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::uint32_t rayCount = 1500, directionCount = 48;

/// Triangles of all shapes, about 1 across, each with a ray at a point of its own.
struct Scattered {
    SceneBuilder builder;
    std::vector<float> rays; ///< as in trace_test.cl

    /// away: distance from the origin, in units of scale.
    Scattered(double scale, double away)
    {
        std::mt19937 random(17);
        for (std::uint32_t i = 0; i < rayCount; ++i) {
            const glm::dvec3 centre = scale * (40 * uniform(random) * unitVector(random) + away * unitVector(random));
            glm::dvec3 v[3];
            const double stretch = std::pow(10.0, uniform(random, -1.5, 0)); // thin ones too
            const glm::dvec3 along = unitVector(random), across = unitVector(random);
            for (glm::dvec3& p : v)
                p = centre + scale * (along * uniform(random, -1, 1) + stretch * across * uniform(random, -1, 1));
            builder.triangle(v[0], v[1], v[2]);
            const double wa = uniform(random), wb = (1 - wa) * uniform(random);
            const glm::dvec3 target = wa * v[0] + wb * v[1] + (1 - wa - wb) * v[2];
            const glm::dvec3 from = target + 2.0 * scale * unitVector(random), d = 2.0 * (target - from);
            for (const double c : { from.x, from.y, from.z, 0.0, d.x, d.y, d.z, 1.0 })
                rays.push_back(static_cast<float>(c));
        }
    }
};

std::vector<float> directions()
{
    std::mt19937 random(19);
    std::vector<float> out;
    for (std::uint32_t k = 0; k < directionCount; ++k) {
        const glm::dvec3 d = unitVector(random);
        for (const double c : { d.x, d.y, d.z })
            out.push_back(static_cast<float>(c));
    }
    return out;
}

struct Found {
    std::vector<std::uint32_t> triangle, returns; ///< what each ray hit, and how many rays from there hit it again
    std::vector<float> points; ///< where, and the origin of the rays from there
};

Found launch(const device::Device& device, render::Traversal family, const Scattered& in, float length)
{
    const render::PreparedScene scene(in.builder.scene);
    const Defines defines =
        family == render::Traversal::Scalar ? Defines { { "WEDGE_TRAVERSAL_SCALAR", "1" } } : Defines();
    KernelBench bench(device, defines, kernelDir().empty() ? WEDGE_TEST_KERNELS : kernelDir());
    const render::Hierarchy hierarchy(bvh::build({ scene.geometry.positions, scene.geometry.indices }), family);
    const render::DeviceScene s(scene, hierarchy, device, bench.queue);
    const auto triangle = bench.filled(rayCount, 0u), returns = bench.filled(rayCount, 0u);
    const auto points = bench.filled(6 * rayCount, 0.0f);
    const auto rayBuffer = bench.buffer(in.rays), directionBuffer = bench.buffer(directions());
    device::Kernel kernel = bench.library.kernel("self_hit.cl", "selfHit");
    kernel.setArgs(s.nodes, s.blocks, s.positions, s.normals, s.texcoords, s.indices, s.materialIds, s.materials,
        s.textures, s.texels, s.srgbToLinear, s.positionsAtClose, s.normalsAtClose, rayBuffer, rayCount,
        directionBuffer, directionCount, length, triangle, returns, points);
    bench.queue.launch("self hits", device::PassKind::Trace, kernel, rayCount, 16);
    return { bench.read(triangle), bench.read(returns), bench.read(points) };
}

/// How far the i-th ray's new origin is from its hit, by the largest coordinate of the triangle.
double distanceToOrigin(const scene::Geometry& g, const Found& found, std::size_t i)
{
    double largest = 0, squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t vertex = g.indices[3 * std::size_t { found.triangle[i] } + corner];
            largest = std::max<double>(largest, std::fabs(g.positions[3 * vertex + axis]));
        }
        squared += std::pow(found.points[6 * i + 3 + axis] - found.points[6 * i + axis], 2);
    }
    return std::sqrt(squared) / largest;
}

} // namespace

TEST_CASE("rays that leave a surface do not come back to its triangle, at any scale and anywhere")
{
    struct Place {
        float scale, away;
    };
    std::vector<Place> places = { { 100, 1e4f } }; // a million from the origin
    for (const float scale : { 1e-3f, 1.0f, 1e5f })
        for (const float away : { 0.0f, 30.0f, 1000.0f })
            places.push_back({ scale, away });
    onEveryDevice([&](const device::Device& device) {
        for (const render::Traversal family : { render::Traversal::Wide, render::Traversal::Scalar })
            for (const Place& place : places) {
                CAPTURE(render::traversalName(family));
                CAPTURE(place.scale);
                CAPTURE(place.away);
                const Scattered scattered(place.scale, place.away);
                const Found found = launch(device, family, scattered, 8 * place.scale);
                unsigned hits = 0, selfHits = 0;
                double farthest = 0;
                for (std::size_t i = 0; i < rayCount; ++i) {
                    if (found.triangle[i] == WEDGE_NO_TRIANGLE)
                        continue;
                    ++hits;
                    selfHits += found.returns[i];
                    farthest = std::max(farthest, distanceToOrigin(scattered.builder.scene.geometry, found, i));
                }
                CHECK(hits > rayCount * 8 / 10);
                CHECK(selfHits == 0);
                // A few tens of roundings, and no distance of its own.
                CHECK(farthest < 8e-6);
            }
    });
}
