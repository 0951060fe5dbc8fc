#include "data/generator/shapes.h"

#include <cmath>
#include <numbers>

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;

/// A unit vector across `direction`.
glm::dvec3 across(const glm::dvec3& direction)
{
    const glm::dvec3 other = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(direction, other));
}

} // namespace

glm::dvec3 Random::inBall()
{
    for (;;) {
        const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
        if (x * x + y * y + z * z <= 1.0)
            return { x, y, z };
    }
}

void heightField(ObjWriter& mesh, double half, int cells, const std::function<double(double, double)>& height)
{
    constexpr double step = 1e-4;
    std::vector<std::size_t> grid;
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            const double x = half * (2.0 * i / cells - 1.0), z = half * (2.0 * j / cells - 1.0);
            const double slopeX = (height(x + step, z) - height(x - step, z)) / (2.0 * step);
            const double slopeZ = (height(x, z + step) - height(x, z - step)) / (2.0 * step);
            grid.push_back(mesh.vertex({ x, height(x, z), z }, glm::normalize(glm::dvec3(-slopeX, 1.0, -slopeZ))));
        }
    }
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const std::size_t at = static_cast<std::size_t>(j * (cells + 1) + i);
            const std::size_t below = at + static_cast<std::size_t>(cells) + 1;
            mesh.quad(grid[at], grid[below], grid[below + 1], grid[at + 1]);
        }
    }
}

void box(ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, const glm::dmat3& axes)
{
    std::size_t corners[8];
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec3 sign((i & 1) ? 1 : -1, (i & 2) ? 1 : -1, (i & 4) ? 1 : -1);
        corners[i] = mesh.vertex(centre + axes * (sign * half));
    }
    constexpr unsigned faces[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 2, 3, 1 },
        { 4, 5, 7, 6 } };
    for (const auto& f : faces)
        mesh.quad(corners[f[0]], corners[f[1]], corners[f[2]], corners[f[3]]);
}

void tube(ObjWriter& mesh, const std::vector<glm::dvec3>& points, const std::vector<double>& radii, int sides)
{
    const std::size_t around = static_cast<std::size_t>(sides);
    std::vector<std::size_t> ring, previous;
    glm::dvec3 side = across(glm::normalize(points[1] - points[0]));
    for (std::size_t k = 0; k < points.size(); ++k) {
        const glm::dvec3 before = points[k == 0 ? 0 : k - 1], after = points[std::min(k + 1, points.size() - 1)];
        const glm::dvec3 along = glm::normalize(after - before);
        // Carried along the line, so that the rings do not twist against each other.
        side = glm::normalize(side - along * glm::dot(side, along));
        const glm::dvec3 third = glm::cross(along, side);
        ring.clear();
        for (std::size_t i = 0; i < around; ++i) {
            const double angle = 2.0 * pi * static_cast<double>(i) / sides;
            const glm::dvec3 out = std::cos(angle) * side + std::sin(angle) * third;
            ring.push_back(mesh.vertex(points[k] + radii[k] * out, out));
        }
        for (std::size_t i = 0; k > 0 && i < around; ++i) {
            const std::size_t next = (i + 1) % around;
            mesh.quad(previous[i], previous[next], ring[next], ring[i]);
        }
        previous = ring;
    }
}

void sphere(ObjWriter& mesh, const glm::dvec3& centre, double radius, int stacks, int slices)
{
    const auto at = [&](const glm::dvec3& out) { return mesh.vertex(centre + radius * out, out); };
    const std::size_t top = at({ 0, 1, 0 }), bottom = at({ 0, -1, 0 });
    const std::size_t around = static_cast<std::size_t>(slices);
    std::vector<std::size_t> ring, previous;
    for (int k = 1; k < stacks; ++k) {
        const double theta = pi * k / stacks;
        ring.clear();
        for (int i = 0; i < slices; ++i) {
            const double phi = 2.0 * pi * i / slices;
            ring.push_back(at({ std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi) }));
        }
        for (std::size_t i = 0; i < around; ++i) {
            const std::size_t next = (i + 1) % around;
            if (k == 1)
                mesh.triangle(top, ring[i], ring[next]);
            else
                mesh.quad(previous[i], ring[i], ring[next], previous[next]);
            if (k == stacks - 1)
                mesh.triangle(ring[i], bottom, ring[next]);
        }
        previous = ring;
    }
}

} // namespace wedge::generator
