#include "data/generator/light_level.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"

#include <cmath>
#include <numbers>

namespace wedge::generator {
namespace {

constexpr int tubes = 40, segments = 125, sides = 14, groundCells = 50;

double groundHeight(double x, double z)
{
    return 0.16 * std::sin(1.7 * x + 0.3) * std::cos(1.4 * z) + 0.07 * std::sin(2.9 * z - 1.1 * x);
}

/// A tentacle that rises from the ground, leans over and curls up towards its tip.
void tentacle(ObjWriter& mesh, double x, double z, Random& random)
{
    const double length = random.uniform(2.2, 3.6), lean = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double curl = random.uniform(2.2, 4.6), sway = random.uniform(0.3, 0.9);
    const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    glm::dvec3 at(x, groundHeight(x, z) - 0.1, z);
    std::vector<glm::dvec3> axis { at };
    std::vector<double> radii { 0.085 };
    for (int k = 1; k <= segments; ++k) {
        const double t = static_cast<double>(k) / segments;
        const double pitch = 0.25 + curl * t * t; // from the vertical
        const double heading = lean + sway * std::sin(5.0 * t + phase);
        at += length / segments
            * glm::dvec3(std::sin(pitch) * std::cos(heading), std::cos(pitch), std::sin(pitch) * std::sin(heading));
        // Where it bends down again it lies on the ground, not in it.
        at.y = std::max(at.y, groundHeight(at.x, at.z) + (t > 0.5 ? 0.06 : -0.1));
        axis.push_back(at);
        radii.push_back(0.085 * (1.0 - 0.93 * t));
    }
    tube(mesh, axis, radii, sides);
}

} // namespace

GeneratedScene makeTentacles()
{
    GeneratedScene s;
    s.name = "tentacles";
    s.comment = "Thin curled tubes over wavy ground";
    s.materials = { matt("ground", glm::vec3(0.78f, 0.72f, 0.62f)), matt("tentacles", glm::vec3(0.55f, 0.3f, 0.42f)) };
    Random random(145);
    s.mesh.object("ground", "ground");
    heightField(s.mesh, 7.0, groundCells, groundHeight);
    s.mesh.object("tentacles", "tentacles");
    for (int i = 0; i < tubes; ++i) { // one in each cell of 8 x 5, somewhere around its middle
        const double x = (i % 8 - 3.5) * 0.95 + random.uniform(-0.3, 0.3);
        const double z = (i / 8 - 2.0) * 1.05 + random.uniform(-0.3, 0.3);
        tentacle(s.mesh, x, z, random);
    }
    s.camera.eye = { 1.2f, 5.6f, 7.4f };
    s.camera.lookAt = { 0.0f, 0.5f, 0.0f };
    s.camera.verticalFov = 42.0f;
    s.light = gaussianLight({ -5.0f, 10.0f, 2.5f }, { 0.0f, 0.0f, 0.0f }, 1.6f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.78, 0.55));
    return s;
}

} // namespace wedge::generator
