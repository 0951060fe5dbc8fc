#include "data/generator/light_level.h"
#include "data/generator/scene_writer.h"
#include "data/generator/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace wedge::generator {
namespace {

/// A flat sheet with columns x rows square holes, without overlaps: rows + 1 bars along x, and between them columns + 1
/// pieces across. 2 ((rows + 1) + rows (columns + 1)) triangles.
void sheet(ObjWriter& mesh, int columns, int rows, double pitch, double bar, const glm::dmat4& place)
{
    const auto rectangle = [&](double x0, double x1, double z0, double z1) {
        const auto at = [&](double x, double z) { return mesh.vertex(glm::dvec3(place * glm::dvec4(x, 0, z, 1))); };
        const std::size_t a = at(x0, z1), b = at(x1, z1), c = at(x1, z0), d = at(x0, z0);
        mesh.quad(a, b, c, d);
    };
    const double width = columns * pitch + bar, depth = rows * pitch + bar;
    for (int r = 0; r <= rows; ++r) {
        const double z = r * pitch - 0.5 * depth;
        rectangle(-0.5 * width, 0.5 * width, z, z + bar);
        for (int c = 0; r < rows && c <= columns; ++c) {
            const double x = c * pitch - 0.5 * width;
            rectangle(x, x + bar, z + bar, z + pitch);
        }
    }
}

glm::dmat4 placed(const glm::dvec3& at, double turn, const glm::dvec3& axis, double tilt)
{
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), at);
    const glm::dmat4 tilted = glm::rotate(moved, glm::radians(tilt), glm::normalize(axis));
    return glm::rotate(tilted, glm::radians(turn), glm::dvec3(0, 1, 0));
}

} // namespace

GeneratedScene makeGrids()
{
    GeneratedScene s;
    s.name = "grids";
    s.comment = "Three tilted grids of bars at different heights over a plane";
    s.materials = { matt("ground", glm::vec3(0.8f, 0.78f, 0.74f)), matt("low", glm::vec3(0.72f, 0.26f, 0.18f)),
        matt("middle", glm::vec3(0.32f, 0.55f, 0.27f)), matt("high", glm::vec3(0.2f, 0.35f, 0.62f)) };
    s.mesh.object("ground", "ground");
    const std::size_t a = s.mesh.vertex({ -25, 0, 25 }), b = s.mesh.vertex({ 25, 0, 25 });
    const std::size_t c = s.mesh.vertex({ 25, 0, -25 }), d = s.mesh.vertex({ -25, 0, -25 });
    s.mesh.quad(a, b, c, d);
    s.mesh.object("low", "low");
    sheet(s.mesh, 6, 4, 0.42, 0.14, placed({ -1.5, 0.55, 1.2 }, 20, { 1, 0, 0.4 }, 16));
    s.mesh.object("middle", "middle");
    sheet(s.mesh, 6, 4, 0.46, 0.15, placed({ 1.7, 1.25, 0.2 }, -25, { 0.3, 0, 1 }, 28));
    s.mesh.object("high", "high");
    sheet(s.mesh, 6, 4, 0.5, 0.17, placed({ -0.6, 2.1, -2.0 }, 40, { 1, 0, -0.2 }, 38));

    s.camera.eye = { -3.6f, 4.4f, 6.6f };
    s.camera.lookAt = { 0.1f, 0.6f, -0.4f };
    s.camera.verticalFov = 45.0f;
    s.light = gaussianLight({ -3.0f, 13.0f, 5.0f }, { 0.0f, 0.0f, 0.0f }, 3.0f);
    s.light.radiance = glm::vec3(radianceFor(s.light, { 0, 0, 0 }, { 0, 1, 0 }, 0.8, 0.6));
    return s;
}

} // namespace wedge::generator
