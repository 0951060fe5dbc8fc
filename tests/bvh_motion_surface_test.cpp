// The surfaces that rays with times find, and frames of scenes that move.
#include "tests/render_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr std::uint32_t rayCount = 2000;

/// smallScene() in which everything turns, drifts and swells a little.
scene::Scene movingScene()
{
    scene::Scene scene = smallScene();
    scene::Geometry& g = scene.geometry;
    const glm::dmat3 turn(0.9, 0.1, -0.2, -0.1, 1.1, 0.05, 0.2, 0.1, 0.95);
    for (std::size_t i = 0; i < g.positions.size(); i += 3) {
        const glm::dvec3 p =
            turn * glm::dvec3(g.positions[i], g.positions[i + 1], g.positions[i + 2]) + glm::dvec3(0.1, 0.2, -0.1);
        const glm::dvec3 open(g.normals[i], g.normals[i + 1], g.normals[i + 2]);
        // Some turn far, so that halfway they are short.
        const glm::dvec3 n = turn * open + glm::length(open) * glm::dvec3(i % 2 ? 0.9 : 0.0, 0, 0);
        const glm::dvec3 unit = glm::length(n) > 0 ? glm::normalize(n) : n;
        for (int k = 0; k < 3; ++k) {
            g.positionsAtClose.push_back(static_cast<float>(p[k]));
            g.normalsAtClose.push_back(static_cast<float>(unit[k]));
        }
    }
    return scene;
}

struct Found {
    std::vector<std::uint32_t> triangle;
    std::vector<float> out; ///< as in motion_surface.cl

    glm::dvec3 vector(std::size_t ray, std::size_t which) const
    {
        const float* v = &out[15 * ray + 2 + 3 * which];
        return { v[0], v[1], v[2] };
    }
};

Found launch(const device::Device& device, render::Traversal family, const scene::Scene& scene, bool motion,
    const std::vector<float>& rays, const std::vector<float>& times)
{
    Defines defines;
    if (motion)
        defines.emplace_back("WEDGE_MOTION", "1");
    if (family == render::Traversal::Scalar)
        defines.emplace_back("WEDGE_TRAVERSAL_SCALAR", "1");
    KernelBench bench(device, defines, kernelDir().empty() ? WEDGE_TEST_KERNELS : kernelDir());
    const render::Hierarchy hierarchy = render::buildHierarchy(scene, bvh::Mode::Default, family);
    const render::PreparedScene prepared(scene);
    const render::DeviceScene s(prepared, hierarchy, device, bench.queue);
    CHECK(prepared.traits().moves == motion);
    const auto triangle = bench.filled(rayCount, 0u);
    const auto out = bench.filled(15 * rayCount, 0.0f);
    const auto rayBuffer = bench.buffer(rays), timeBuffer = bench.buffer(times);
    device::Kernel kernel = bench.library.kernel("motion_surface.cl", "motionSurface");
    kernel.setArgs(s.nodes, s.blocks, s.positions, s.normals, s.texcoords, s.indices, s.materialIds, s.materials,
        s.textures, s.texels, s.srgbToLinear, s.positionsAtClose, s.normalsAtClose, rayBuffer, timeBuffer, rayCount,
        triangle, out);
    bench.queue.launch("surfaces", device::PassKind::Trace, kernel, rayCount, 16);
    return { bench.read(triangle), bench.read(out) };
}

/// From all around at the middle of the scene.
std::vector<float> raysAround()
{
    std::mt19937 random(61);
    std::vector<float> rays;
    for (std::uint32_t i = 0; i < rayCount; ++i) {
        const glm::dvec3 from = 3.0 * unitVector(random), to = 0.8 * unitVector(random);
        for (const double c : { from.x, from.y, from.z, 0.0, to.x - from.x, to.y - from.y, to.z - from.z, 1e9 })
            rays.push_back(static_cast<float>(c));
    }
    return rays;
}

std::vector<float> timesAround()
{
    std::mt19937 random(67);
    std::vector<float> times { 0.0f, 1.0f };
    while (times.size() < rayCount)
        times.push_back(static_cast<float>(uniform(random)));
    return times;
}

/// Of a hit, in double: what is interpolated over the triangle of per-vertex vectors at a time.
glm::dvec3 interpolated(const scene::Geometry& g, const std::vector<float>& open, const std::vector<float>& close,
    const Found& found, std::size_t ray, double time, bool normalise)
{
    const double u = found.out[15 * ray], v = found.out[15 * ray + 1], weights[3] = { 1 - u - v, u, v };
    glm::dvec3 sum(0);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t at = 3 * std::size_t { g.indices[3 * std::size_t { found.triangle[ray] } + corner] };
        glm::dvec3 p;
        for (int k = 0; k < 3; ++k) {
            const auto i = at + static_cast<std::size_t>(k);
            p[k] = open[i] + (double { close[i] } - double { open[i] }) * time;
        }
        // Each normal is made unit and turned to the viewer's side before they are mixed.
        if (normalise && glm::length(p) > 0)
            p = glm::normalize(p) * (glm::dot(p, found.vector(ray, 2)) < 0 ? -1.0 : 1.0);
        sum += weights[corner] * p;
    }
    return sum;
}

template <class Test>
void onEveryFamily(const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const render::Traversal family : { render::Traversal::Wide, render::Traversal::Scalar }) {
            CAPTURE(render::traversalName(family));
            test(device, family);
        }
    });
}

} // namespace

TEST_CASE("surfaces that stand still are what they are without motion")
{
    scene::Scene still = smallScene(), both = still;
    both.geometry.positionsAtClose = both.geometry.positions;
    both.geometry.normalsAtClose = both.geometry.normals;
    onEveryFamily([&](const device::Device& device, render::Traversal family) {
        const Found expected = launch(device, family, still, false, raysAround(), timesAround());
        const Found found = launch(device, family, both, true, raysAround(), timesAround());
        CHECK(found.triangle == expected.triangle);
        for (std::size_t i = 0; i < found.out.size(); ++i)
            CHECK(std::fabs(found.out[i] - expected.out[i]) < 1e-6f); // normals are made unit again
    });
}

TEST_CASE("surfaces are where the ray's time says, with its normals, and know where they go")
{
    const scene::Scene scene = movingScene();
    const scene::Geometry& g = scene.geometry;
    const std::vector<float> rays = raysAround(), times = timesAround();
    onEveryFamily([&](const device::Device& device, render::Traversal family) {
        const Found found = launch(device, family, scene, true, rays, times);
        unsigned hits = 0, smooth = 0;
        for (std::size_t i = 0; i < rayCount; ++i) {
            if (found.triangle[i] == WEDGE_NO_TRIANGLE)
                continue;
            ++hits;
            CAPTURE(i);
            const float* ray = &rays[8 * i];
            const double t = found.out[15 * i + 14];
            const glm::dvec3 position = found.vector(i, 0);
            const glm::dvec3 onRay(ray[0] + t * ray[4], ray[1] + t * ray[5], ray[2] + t * ray[6]);
            CHECK(glm::length(position - interpolated(g, g.positions, g.positionsAtClose, found, i, times[i], false))
                < 2e-6);
            CHECK(glm::length(position - onRay) < 2e-5);
            const glm::dvec3 motion = interpolated(g, g.positions, g.positionsAtClose, found, i, 1, false)
                - interpolated(g, g.positions, g.positionsAtClose, found, i, 0, false);
            CHECK(glm::length(found.vector(i, 3) - motion) < 2e-6);
            const glm::dvec3 normal = interpolated(g, g.normals, g.normalsAtClose, found, i, times[i], true);
            if (glm::length(normal) > 0.5) {
                ++smooth;
                CHECK(std::fabs(glm::dot(found.vector(i, 1), glm::normalize(normal))) > 1 - 1e-6);
            }
            CHECK(std::fabs(glm::length(found.vector(i, 2)) - 1) < 1e-6);
        }
        CHECK(hits > rayCount / 2);
        CHECK(smooth > 20);
    });
}

TEST_CASE("every pass of a frame builds and runs over geometry that moves")
{
    scene::Scene scene = movingScene();
    scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
    onEveryDevice([&](const device::Device& device) {
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings settings = sized(render::axisAligned(16), 40, 30);
        settings.bounces = 2;
        const std::vector<float> image = renderPixels(renderer, settings);
        CHECK(notFinite(image) == 0);
        CHECK(*std::max_element(image.begin(), image.end()) > 0.2f);
    });
}
