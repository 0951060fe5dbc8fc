#include "data/generator/light_level.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"

#include <cmath>
#include <numbers>

namespace wedge::generator {
namespace {

/// The inside of a shallow bowl, y = hollow r^2: (2 rings - 1) sectors triangles.
void bowl(ObjWriter& mesh, double radius, double hollow, int rings, int sectors)
{
    const std::size_t centre = mesh.vertex({ 0, 0, 0 }, { 0, 1, 0 });
    const std::size_t around = static_cast<std::size_t>(sectors);
    std::vector<std::size_t> ring, previous;
    for (int k = 1; k <= rings; ++k) {
        const double r = radius * k / rings;
        ring.clear();
        for (int i = 0; i < sectors; ++i) {
            const double phi = 2.0 * std::numbers::pi * i / sectors;
            const double x = r * std::sin(phi), z = r * std::cos(phi);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-2.0 * hollow * x, 1.0, -2.0 * hollow * z));
            ring.push_back(mesh.vertex({ x, hollow * r * r, z }, normal));
        }
        for (std::size_t i = 0; i < around; ++i) {
            const std::size_t next = (i + 1) % around;
            if (k == 1)
                mesh.triangle(centre, ring[i], ring[next]);
            else
                mesh.quad(previous[i], ring[i], ring[next], previous[next]);
        }
        previous = ring;
    }
}

} // namespace

GeneratedScene makeSpheres()
{
    struct Ball {
        glm::dvec3 centre;
        double radius;
        const char* material;
    };
    constexpr int stacks = 41, slices = 84; // 6720 triangles a sphere
    const Ball balls[] = { { { 0.0, 1.35, -0.3 }, 1.3, "amber" }, { { -1.9, 1.5, 0.9 }, 0.55, "blue" },
        { { 1.9, 1.35, 1.1 }, 0.7, "green" }, { { -0.9, 3.2, 0.2 }, 0.42, "blue" },
        { { 0.5, 3.5, -0.1 }, 0.3, "green" }, { { 0.6, 2.2, 1.5 }, 0.28, "blue" },
        { { -2.4, 2.4, -0.9 }, 0.5, "green" }, { { 2.3, 2.6, -0.7 }, 0.45, "blue" },
        { { -0.6, 1.0, 2.0 }, 0.38, "green" } };
    GeneratedScene s;
    s.name = "spheres";
    s.comment = "Spheres that shadow each other and a bowl";
    s.materials = { matt("bowl", glm::vec3(0.78f, 0.72f, 0.55f)), matt("amber", glm::vec3(0.75f, 0.42f, 0.18f)),
        matt("blue", glm::vec3(0.2f, 0.36f, 0.6f)), matt("green", glm::vec3(0.28f, 0.52f, 0.3f)) };
    s.mesh.object("bowl", "bowl");
    bowl(s.mesh, 8.0, 0.08, 49, 120);
    int number = 0;
    for (const Ball& ball : balls) {
        s.mesh.object("sphere" + std::to_string(++number), ball.material);
        sphere(s.mesh, ball.centre, ball.radius, stacks, slices);
    }
    s.camera.eye = { 0.8f, 5.2f, 7.6f };
    s.camera.lookAt = { 0.0f, 1.0f, 0.0f };
    s.camera.verticalFov = 40.0f;
    s.light = gaussianLight({ -4.0f, 9.5f, 4.0f }, { 0.0f, 1.0f, 0.0f }, 1.8f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.78, 0.42));
    return s;
}

} // namespace wedge::generator
