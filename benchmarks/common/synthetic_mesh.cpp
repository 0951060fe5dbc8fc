#include "benchmarks/common/synthetic_mesh.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/glm.hpp>

namespace wedge::benchmark {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double fieldHalf = 20; // metres
constexpr std::size_t boulders = 12, trees = 24;
constexpr double crownRadius = 2.2, crownHeight = 4.5; // metres
constexpr double leafArea = 600; // of all leaves together, square metres: crowns that let some light through

double heightAt(double x, double z)
{
    return 0.9 * std::sin(0.31 * x) * std::cos(0.27 * z) + 0.15 * std::sin(1.7 * x + 0.4) * std::sin(1.3 * z);
}

/// The standard fixes the engine's output, but not its distributions'.
class Random {
public:
    explicit Random(std::uint32_t seed)
        : engine_(seed)
    {
    }
    double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(engine_()) / 4294967296.0; }
    glm::dvec3 inBall()
    {
        for (;;) {
            const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
            if (const glm::dvec3 p(x, y, z); glm::dot(p, p) <= 1 && glm::dot(p, p) > 1e-4)
                return p;
        }
    }
    /// On the field, a little away from its border.
    glm::dvec3 onField()
    {
        const double x = uniform(-0.9, 0.9) * fieldHalf, z = uniform(-0.9, 0.9) * fieldHalf;
        return { x, heightAt(x, z), z };
    }

private:
    std::mt19937 engine_;
};

class Builder {
public:
    std::uint32_t vertex(const glm::dvec3& p)
    {
        for (int axis = 0; axis < 3; ++axis)
            mesh.positions.push_back(static_cast<float>(p[axis]));
        return static_cast<std::uint32_t>(mesh.positions.size() / 3 - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        mesh.indices.insert(mesh.indices.end(), { a, b, c });
    }
    /// A grid of rows x columns quads over the points at(row, column), rows and columns counted from 0 to their number.
    template <class Point>
    void grid(std::size_t rows, std::size_t columns, const Point& at)
    {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
        const auto stride = static_cast<std::uint32_t>(columns + 1);
        for (std::size_t row = 0; row <= rows; ++row)
            for (std::size_t column = 0; column <= columns; ++column)
                vertex(at(row, column));
        for (std::uint32_t row = 0; row < rows; ++row)
            for (std::uint32_t column = 0; column < columns; ++column) {
                const std::uint32_t a = first + row * stride + column, b = a + stride;
                triangle(a, b, a + 1);
                triangle(a + 1, b, b + 1);
            }
    }
    std::size_t triangles() const { return mesh.indices.size() / 3; }

    SyntheticMesh mesh;
};

void addGround(Builder& builder, std::size_t triangles)
{
    const auto cells = static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles) / 2));
    const auto coordinate = [&](std::size_t i) {
        return fieldHalf * (2 * static_cast<double>(i) / static_cast<double>(cells) - 1);
    };
    builder.grid(cells, cells, [&](std::size_t row, std::size_t column) {
        const double x = coordinate(column), z = coordinate(row);
        return glm::dvec3(x, heightAt(x, z), z);
    });
}

/// Spheres with bumps, of 2 by 1 quads around and from pole to pole, whose outermost rows are degenerate at the pole.
void addBoulders(Builder& builder, std::size_t triangles, Random& random)
{
    const auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles) / boulders / 4));
    for (std::size_t i = 0; i < boulders; ++i) {
        const glm::dvec3 centre = random.onField();
        const double radius = random.uniform(0.5, 1.5), phase = random.uniform(0, 2 * pi);
        builder.grid(rows, 2 * rows, [&](std::size_t row, std::size_t column) {
            // The poles are cut off at 1 part in 1000, so that no triangle is degenerate; the seam is shared exactly.
            const double theta = pi * std::clamp(static_cast<double>(row) / static_cast<double>(rows), 1e-3, 1 - 1e-3);
            const double phi = pi * static_cast<double>(column % (2 * rows)) / static_cast<double>(rows);
            const double r = radius * (1 + 0.08 * std::sin(5 * theta + phase) * std::sin(4 * phi));
            return centre
                + r * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        });
    }
}

/// Leaves of two triangles, folded along the shared edge, anywhere in the crowns.
void addLeaves(Builder& builder, std::size_t triangles, Random& random)
{
    std::vector<glm::dvec3> crowns;
    for (std::size_t i = 0; i < trees; ++i)
        crowns.push_back(random.onField() + glm::dvec3(0, crownHeight, 0));
    const double edge = std::sqrt(2 * leafArea / static_cast<double>(triangles));
    for (std::size_t left = triangles; left > 0;) {
        const glm::dvec3 centre = crowns[left / 2 % trees] + crownRadius * random.inBall();
        const glm::dvec3 along = glm::normalize(random.inBall());
        const glm::dvec3 other = random.inBall();
        const glm::dvec3 normal = glm::cross(along, other);
        const glm::dvec3 across =
            glm::normalize(glm::dot(normal, normal) > 1e-6 ? normal : glm::dvec3(along.y, along.z, along.x));
        const glm::dvec3 up = 0.3 * edge * glm::cross(along, across);
        const std::uint32_t stem = builder.vertex(centre), tip = builder.vertex(centre + edge * along);
        const glm::dvec3 middle = centre + 0.5 * edge * along + up;
        builder.triangle(stem, tip, builder.vertex(middle + edge * across));
        --left;
        if (left > 0) {
            builder.triangle(tip, stem, builder.vertex(middle - edge * across));
            --left;
        }
    }
}

} // namespace

SyntheticMesh syntheticMesh(std::size_t triangles, std::uint32_t seed)
{
    if (triangles < leastSyntheticTriangles)
        throw std::invalid_argument(
            fmt::format("syntheticMesh: {} triangles are fewer than {}", triangles, leastSyntheticTriangles));
    Random random(seed);
    Builder builder;
    builder.mesh.indices.reserve(3 * triangles);
    builder.mesh.positions.reserve(9 * triangles / 2);
    addGround(builder, triangles / 4);
    addBoulders(builder, triangles / 4, random);
    addLeaves(builder, triangles - builder.triangles(), random);
    return std::move(builder.mesh);
}

scene::Scene syntheticScene(std::size_t triangles, std::uint32_t seed)
{
    SyntheticMesh mesh = syntheticMesh(triangles, seed);
    scene::Scene out;
    out.path = fmt::format("field of {} triangles", triangles);
    scene::Geometry& geometry = out.geometry;
    geometry.positions = std::move(mesh.positions);
    geometry.indices = std::move(mesh.indices);
    geometry.normals.resize(geometry.positions.size(), 0.0f);
    geometry.texcoords.resize(geometry.positions.size() / 3 * 2, 0.0f);
    geometry.materialIds.resize(triangles, 0);
    geometry.objectIds.resize(triangles, 1);
    geometry.objectNames = { "field" };
    out.materials.emplace_back();
    out.materials[0].name = "matt";
    out.materials[0].diffuse = { 0.6f, 0.7f, 0.5f };
    scene::AreaLight light;
    light.centre = { 4, 30, -6 };
    light.halfU = { 3, 0, 0 };
    light.halfV = { 0, 0, 3 };
    light.radiance = glm::vec3(60);
    light.visible = false;
    out.areaLights.push_back(light);
    out.background = { 0.4f, 0.5f, 0.6f };
    out.camera.eye = { 0, 7, 24 };
    out.camera.lookAt = { 0, 1.5f, 0 };
    out.camera.verticalFov = 50;
    return out;
}

} // namespace wedge::benchmark
