#include "data/generator/textured.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace wedge::generator {
namespace {

/// Rows of vertices, each joined with the next, each row's neighbours with each other.
struct Grid {
    std::size_t columns = 0;
    std::vector<glm::dvec3> points, normals;
    std::vector<glm::dvec2> texcoords;
};

/// A quad looks towards (along a row) x (to the next row). One with two equal corners is a triangle, with three none.
void emit(ObjWriter& mesh, const Grid& grid)
{
    std::vector<std::size_t> made;
    for (std::size_t i = 0; i < grid.points.size(); ++i)
        made.push_back(mesh.vertex(grid.points[i], grid.normals[i], grid.texcoords[i]));
    const auto apart = [&](std::size_t a, std::size_t b) {
        return glm::distance(grid.points[a], grid.points[b]) > 1e-6;
    };
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
        if (apart(a, b) && apart(b, c) && apart(c, a))
            mesh.triangle(made[a], made[b], made[c]);
    };
    for (std::size_t row = 0; row + grid.columns < grid.points.size(); row += grid.columns) {
        for (std::size_t i = row; i + 1 < row + grid.columns; ++i) {
            const std::size_t above = i + grid.columns;
            triangle(i, i + 1, above + 1);
            triangle(i, above + 1, above);
        }
    }
}

/// Twice the area that a ring spans, as a vector.
glm::dvec3 spanned(const Ring& ring)
{
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i)
        sum += glm::cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
    return sum;
}

/// Where a ring is one point, the surface is level across the line of the rings.
glm::dvec3 ringNormal(const std::vector<Ring>& rings, std::size_t k, std::size_t i)
{
    const Ring &ring = rings[k], &before = rings[k == 0 ? 0 : k - 1], &after = rings[std::min(k + 1, rings.size() - 1)];
    const std::size_t sides = ring.size();
    const glm::dvec3 around = ring[(i + 1) % sides] - ring[(i + sides - 1) % sides];
    if (glm::length(around) > 1e-9)
        return glm::normalize(glm::cross(around, after[i] - before[i]));
    return glm::normalize(k == 0 ? -spanned(after) : spanned(before));
}

/// The distances of the rings from the first, on the line through their points of one side.
std::vector<double> lengthsAlong(const std::vector<Ring>& rings)
{
    std::vector<double> lengths { 0.0 };
    for (std::size_t k = 1; k < rings.size(); ++k)
        lengths.push_back(lengths.back() + glm::distance(rings[k][0], rings[k - 1][0]));
    return lengths;
}

/// Where the edges of a rounded box's face are cut, from -half to half: at the rounding's angles.
std::vector<double> cuts(double half, double radius, int steps)
{
    std::vector<double> at;
    for (int i = 0; i <= steps; ++i) // at an angle of 45 degrees from the middle of the rounding to its end
        at.push_back(-half + radius - radius * std::tan(glm::radians(45.0 * (steps - i) / steps)));
    for (int i = steps; i >= 0; --i)
        at.push_back(-at[static_cast<std::size_t>(i)]);
    return at;
}

} // namespace

void sheet(ObjWriter& mesh, int cellsU, int cellsV, const std::function<glm::dvec3(double, double)>& point,
    const glm::dvec2& repeats)
{
    constexpr double step = 1e-4;
    Grid grid;
    grid.columns = static_cast<std::size_t>(cellsU) + 1;
    for (int j = 0; j <= cellsV; ++j) {
        for (int i = 0; i <= cellsU; ++i) {
            const double u = static_cast<double>(i) / cellsU, v = static_cast<double>(j) / cellsV;
            // A little inside where the surface ends or comes to a point.
            const double a = glm::clamp(u, 2.0 * step, 1.0 - 2.0 * step),
                         b = glm::clamp(v, 2.0 * step, 1.0 - 2.0 * step);
            const glm::dvec3 alongU = point(a + step, b) - point(a - step, b);
            const glm::dvec3 alongV = point(a, b + step) - point(a, b - step);
            grid.points.push_back(point(u, v));
            grid.normals.push_back(glm::normalize(glm::cross(alongU, alongV)));
            grid.texcoords.push_back(repeats * glm::dvec2(u, v));
        }
    }
    emit(mesh, grid);
}

void rectangle(ObjWriter& mesh, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
    const glm::dvec2& repeats)
{
    sheet(
        mesh, 1, 1, [&](double u, double v) { return corner + u * edgeU + v * edgeV; }, repeats);
}

void texturedSkin(ObjWriter& mesh, const std::vector<Ring>& rings, const glm::dvec2& repeats)
{
    const std::size_t sides = rings[0].size();
    const std::vector<double> lengths = lengthsAlong(rings);
    Grid grid;
    grid.columns = sides + 1; // the first side's points again, with the other end of the texture
    for (std::size_t k = 0; k < rings.size(); ++k) {
        for (std::size_t i = 0; i <= sides; ++i) {
            grid.points.push_back(rings[k][i % sides]);
            grid.normals.push_back(ringNormal(rings, k, i % sides));
            const glm::dvec2 t(static_cast<double>(i) / static_cast<double>(sides), lengths[k] / lengths.back());
            grid.texcoords.push_back(repeats * t);
        }
    }
    emit(mesh, grid);
}

void texturedBox(
    ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, double period, const glm::dmat3& axes)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : { -1.0, 1.0 }) {
            const int first = axis == 0 ? 2 : 0, second = axis == 1 ? 2 : 1; // the texture stands on upright faces
            glm::dvec3 out(0.0), u(0.0), v(0.0);
            out[axis] = side * half[axis];
            u[first] = half[first];
            v[second] = half[second];
            if (glm::dot(glm::cross(u, v), out) < 0.0)
                u = -u;
            rectangle(mesh, centre + axes * (out - u - v), 2.0 * (axes * u), 2.0 * (axes * v),
                glm::dvec2(2.0 * half[first], 2.0 * half[second]) / period);
        }
    }
}

void roundedBox(ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, double radius, int steps,
    double period, const glm::dmat3& axes)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : { -1.0, 1.0 }) {
            const int first = axis == 0 ? 2 : 0, second = axis == 1 ? 2 : 1;
            glm::dvec3 out(0.0), u(0.0), v(0.0);
            out[axis] = side;
            u[first] = 1.0;
            v[second] = 1.0;
            if (glm::dot(glm::cross(u, v), out) < 0.0)
                u = -u;
            Grid grid;
            const std::vector<double> across = cuts(half[first], radius, steps), up = cuts(half[second], radius, steps);
            grid.columns = across.size();
            for (const double y : up) {
                for (const double x : across) {
                    const glm::dvec3 onBox = half[axis] * out + x * u + y * v; // pulled in onto the rounding
                    const glm::dvec3 core = glm::clamp(onBox, radius - half, half - radius);
                    const glm::dvec3 normal = glm::normalize(onBox - core);
                    grid.points.push_back(centre + axes * (core + radius * normal));
                    grid.normals.push_back(axes * normal);
                    grid.texcoords.push_back(glm::dvec2(x + half[first], y + half[second]) / period);
                }
            }
            emit(mesh, grid);
        }
    }
}

void leaf(ObjWriter& mesh, const Frame& base, double length, double width, double bend, int cellsU, int cellsV)
{
    const auto point = [&](double u, double v) {
        const double side = 2.0 * v - 1.0;
        const double half = 0.5 * width * std::pow(std::sin(std::numbers::pi * u), 0.8) * (1.25 - 0.5 * u);
        const double up = length * (0.25 * u - bend * u * u) + 0.25 * half * side * side; // folded along its rib
        return base.at + length * (u - 0.3 * bend * u * u) * base.along + side * half * base.left + up * base.up;
    };
    sheet(mesh, cellsU, cellsV, point);
}

glm::dmat3 turn(double degrees)
{
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0)));
}

glm::dmat4 standing(const glm::dvec3& foot, double degrees, double scale)
{
    return glm::scale(glm::translate(glm::dmat4(1.0), foot) * glm::dmat4(turn(degrees)), glm::dvec3(scale));
}

} // namespace wedge::generator
