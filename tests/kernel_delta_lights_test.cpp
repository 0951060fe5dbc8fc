// delta_lights.cl alone: point and directional lights in closed form, and shadows that the host's traversal finds.
#include "bvh/host_traverse.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 31;
const glm::dvec3 lamp(0.4, 1.9, 1.1), intensity(4, 3, 2), sunward(0.48, 0.6, 0.64), irradiance(1, 2, 3);

constexpr float exponent = 12;

/// Of what reflects at most all that arrives, docs/materials.md; for the half vector's cosine.
double blinnPhong(double cosine)
{
    const double m = exponent;
    return (m + 2) * (m + 4) / (8 * std::numbers::pi * (std::exp2(-0.5 * m) + m)) * std::pow(cosine, m);
}

/// The small scene, glossy, under a lamp and a sun.
scene::Scene underLamps()
{
    scene::Scene scene = smallScene();
    scene.areaLights.clear();
    scene.materials[0].specular = { 0.1f, 0.2f, 0.3f };
    scene.materials[0].exponent = exponent;
    scene.pointLights.push_back({ glm::vec3(lamp), glm::vec3(intensity) });
    scene.directionalLights.push_back({ -glm::vec3(sunward), glm::vec3(irradiance) });
    return scene;
}

} // namespace

TEST_CASE("deltaLights: what a point light and a directional one bring, and the rays to them")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, underLamps(), sized(render::monteCarlo(4), width, height));
        PassBench primary(frame, "primary"), bench(frame, "deltaLights");
        primary.run();
        for (const char* name : { "position", "normal", "origin", "diffuse", "specular" })
            bench.plane(name, primary.read<float>(name));
        for (const char* name : { "geometric", "objectId", "gloss" })
            bench.plane(name, primary.read<std::uint32_t>(name));
        std::mt19937 random(1);
        bench.plane("lit", someNumbers(random, 3 * frame.layout.size));
        const auto of = [&](const char* name) { return bench.pixels<float>(name); };
        const auto before = of("lit"), origin = of("origin"), normal = of("normal");
        const auto position = of("position"), diffuse = of("diffuse"), specular = of("specular");
        const auto object = bench.pixels<std::uint32_t>("objectId");
        const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
        bench.run();
        const auto after = of("lit");
        const auto rays = bench.pixels<std::uint32_t>("rays");
        const scene::Geometry& g = frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        unsigned lit = 0, shadowed = 0, differ = 0, nothing = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            const glm::dvec3 added = after.vector(x, y) - before.vector(x, y);
            if (object.at(x, y) == 0) {
                ++nothing;
                REQUIRE(added == glm::dvec3(0));
                REQUIRE(rays.at(x, y) == 0);
                return;
            }
            const glm::dvec3 at = origin.vector(x, y), n = normal.vector(x, y);
            const glm::dvec3 view = glm::normalize(eye - position.vector(x, y));
            glm::dvec3 expected(0);
            unsigned traced = 0;
            for (const bool sun : { false, true }) {
                const glm::dvec3 to = sun ? 100.0 * sunward : lamp - at, l = glm::normalize(to);
                const double cosine = glm::dot(n, l);
                traced += cosine > 0 ? 1 : 0;
                if (cosine <= 0)
                    continue;
                const bool hidden = bvh::anyHit(hierarchy, { toVec3(at), 0, toVec3(to), 1 });
                (hidden ? shadowed : lit) += 1;
                const glm::dvec3 arrives = sun ? irradiance * cosine : intensity * cosine / glm::dot(to, to);
                const double lobe = blinnPhong(std::max(glm::dot(n, glm::normalize(view + l)), 0.0));
                if (!hidden)
                    expected += arrives * (diffuse.vector(x, y) / std::numbers::pi + lobe * specular.vector(x, y));
            }
            REQUIRE(rays.at(x, y) == traced);
            differ += glm::length(added - expected) > 1e-4 * (1 + glm::length(expected)) ? 1 : 0;
        });
        CHECK(lit > 1000);
        CHECK(shadowed > 200);
        CHECK(nothing > 20);
        CHECK(differ <= 3); // rays through edges
    });
}
