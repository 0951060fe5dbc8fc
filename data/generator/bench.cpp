#include "data/generator/light_level.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace wedge::generator {
namespace {

constexpr std::size_t totalTriangles = 309'000;

void ground(ObjWriter& mesh)
{
    mesh.object("ground", "grass");
    heightField(mesh, 12.0, 32,
        [](double x, double z) { return 0.05 * std::sin(1.3 * x + 0.4 * z) * std::cos(0.9 * z - 0.3 * x) - 0.05; });
}

/// A bench of slats, 1.8 wide, its seat 0.45 high, its back towards -z.
void bench(ObjWriter& mesh)
{
    mesh.object("bench", "wood");
    const glm::dmat3 lean(glm::rotate(glm::dmat4(1.0), glm::radians(-14.0), glm::dvec3(1, 0, 0)));
    for (int i = 0; i < 5; ++i)
        box(mesh, { 0, 0.45, -0.2 + 0.105 * i }, { 0.9, 0.016, 0.043 });
    for (int i = 0; i < 4; ++i)
        box(mesh, glm::dvec3(0, 0.45, -0.27) + lean * glm::dvec3(0, 0.14 + 0.115 * i, 0), { 0.9, 0.045, 0.014 }, lean);
    for (const double x : { -0.78, 0.0, 0.78 }) {
        box(mesh, { x, 0.19, 0.2 }, { 0.032, 0.24, 0.032 });
        box(mesh, { x, 0.19, -0.24 }, { 0.032, 0.24, 0.032 });
        box(mesh, { x, 0.41, -0.02 }, { 0.026, 0.022, 0.24 });
        box(mesh, glm::dvec3(x, 0.43, -0.295) + lean * glm::dvec3(0, 0.28, 0), { 0.03, 0.28, 0.018 }, lean);
    }
    for (const double x : { -0.84, 0.84 }) {
        box(mesh, { x, 0.68, -0.03 }, { 0.04, 0.018, 0.25 });
        box(mesh, { x, 0.56, 0.18 }, { 0.026, 0.12, 0.026 });
    }
}

/// A bent, tapering branch from `from` to `to`; returns its axis.
std::vector<glm::dvec3> branch(
    ObjWriter& mesh, const glm::dvec3& from, const glm::dvec3& to, double thick, double thin, int sides, Random& random)
{
    constexpr int segments = 12;
    const glm::dvec3 sag = 0.12 * glm::length(to - from) * random.inBall();
    std::vector<glm::dvec3> axis;
    std::vector<double> radii;
    for (int k = 0; k <= segments; ++k) {
        const double t = static_cast<double>(k) / segments;
        axis.push_back(from + t * (to - from) + 4.0 * t * (1.0 - t) * sag);
        radii.push_back(thick + t * (thin - thick));
    }
    tube(mesh, axis, radii, sides);
    return axis;
}

/// Trunk, boughs and twigs; returns where leaves grow: the outer parts of the twigs.
std::vector<glm::dvec3> tree(ObjWriter& mesh, const glm::dvec3& foot, Random& random)
{
    constexpr double golden = 2.39996322972865; // radians: spreads the boughs evenly around the trunk
    mesh.object("tree", "bark");
    std::vector<glm::dvec3> sprouts;
    const glm::dvec3 crown = foot + glm::dvec3(0.25, 4.6, 0.15);
    const std::vector<glm::dvec3> trunk = branch(mesh, foot, crown, 0.26, 0.07, 16, random);
    for (int b = 0; b < 18; ++b) {
        const glm::dvec3 root = trunk[static_cast<std::size_t>(6 + b * 6 / 18)];
        const double angle = golden * b, reach = random.uniform(1.7, 3.1) * (1.0 - 0.012 * b);
        const glm::dvec3 end =
            root + glm::dvec3(reach * std::cos(angle), random.uniform(0.3, 1.5), reach * std::sin(angle));
        const std::vector<glm::dvec3> bough = branch(mesh, root, end, 0.075, 0.02, 8, random);
        for (int t = 0; t < 14; ++t) {
            const glm::dvec3 start = bough[static_cast<std::size_t>(4 + t * 9 / 14)];
            const glm::dvec3 tip = start + 0.75 * random.inBall() + glm::dvec3(0, 0.15, 0);
            const std::vector<glm::dvec3> twig = branch(mesh, start, tip, 0.014, 0.005, 4, random);
            sprouts.insert(sprouts.end(), twig.begin() + 3, twig.end());
        }
    }
    return sprouts;
}

/// A leaf folded along its midrib: 4 triangles.
void leaf(ObjWriter& mesh, const glm::dvec3& at, Random& random)
{
    const glm::dvec3 along = glm::normalize(random.inBall() + glm::dvec3(0, -0.25, 0));
    const glm::dvec3 wide = glm::normalize(glm::cross(along, random.inBall() + glm::dvec3(0, 1.1, 0)));
    const glm::dvec3 fold = glm::cross(wide, along);
    const double length = random.uniform(0.03, 0.058), half = 0.3 * length;
    const std::size_t base = mesh.vertex(at), tip = mesh.vertex(at + length * along);
    const std::size_t middle = mesh.vertex(at + 0.5 * length * along - 0.25 * half * fold);
    const std::size_t left = mesh.vertex(at + 0.45 * length * along + half * wide);
    const std::size_t right = mesh.vertex(at + 0.45 * length * along - half * wide);
    mesh.triangle(base, middle, left);
    mesh.triangle(left, middle, tip);
    mesh.triangle(base, right, middle);
    mesh.triangle(right, tip, middle);
}

} // namespace

GeneratedScene makeBench()
{
    GeneratedScene s;
    s.name = "bench";
    s.comment = "A garden bench in the dappled shadow of a leafy tree";
    s.materials = { matt("grass", glm::vec3(0.62f, 0.63f, 0.42f)), matt("wood", glm::vec3(0.56f, 0.36f, 0.2f)),
        matt("bark", glm::vec3(0.35f, 0.26f, 0.19f)), matt("leaves", glm::vec3(0.25f, 0.45f, 0.12f)) };
    Random random(20120601);
    ground(s.mesh);
    bench(s.mesh);
    const std::vector<glm::dvec3> sprouts = tree(s.mesh, { -1.5, -0.1, 0.6 }, random);
    s.mesh.object("leaves", "leaves");
    while (s.mesh.triangles() + 4 <= totalTriangles) {
        const auto sprout = static_cast<std::size_t>(random.uniform(0, static_cast<double>(sprouts.size())));
        leaf(s.mesh, sprouts[sprout] + 0.22 * random.inBall(), random);
    }
    s.camera.eye = { 2.5f, 1.9f, 5.2f };
    s.camera.lookAt = { -0.35f, 1.05f, -0.3f };
    s.camera.verticalFov = 42.0f;
    s.light = gaussianLight({ -1.2f, 13.0f, 4.5f }, { 0.0f, 0.0f, 0.3f }, 0.9f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.63, 0.62));
    return s;
}

} // namespace wedge::generator
