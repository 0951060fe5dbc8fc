#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <glm/glm.hpp>

#include "data/generator/obj_writer.h"

namespace wedge::generator {

/// Repeatable random numbers: the standard fixes the engine's output but not its distributions'.
class Random {
public:
    explicit Random(std::uint32_t seed)
        : engine_(seed)
    {
    }
    double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_()) / 4294967296.0); }
    /// Uniform in the unit ball.
    glm::dvec3 inBall();

private:
    std::mt19937 engine_;
};

/// The surface y = height(x, z) over [-half, half]^2 in cells x cells quads, with smooth normals: 2 cells^2 triangles.
void heightField(ObjWriter& mesh, double half, int cells, const std::function<double(double, double)>& height);

/// A box of half sizes `half` around `centre`, turned by the columns of `axes`: 12 triangles.
void box(ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, const glm::dmat3& axes = glm::dmat3(1.0));

/// An open tube along a polyline with a radius at each point, with smooth normals: 2 sides (points - 1) triangles.
void tube(ObjWriter& mesh, const std::vector<glm::dvec3>& points, const std::vector<double>& radii, int sides);

/// A sphere with smooth normals: 2 slices (stacks - 1) triangles.
void sphere(ObjWriter& mesh, const glm::dvec3& centre, double radius, int stacks, int slices);

} // namespace wedge::generator
