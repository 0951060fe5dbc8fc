#pragma once

#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "data/generator/obj_writer.h"
#include "data/generator/skin.h"

namespace wedge::generator {

// Surfaces with smooth normals and texture coordinates.

/// The surface point(u, v), u and v in [0, 1], in cellsU x cellsV quads, that looks towards its derivative by u x that
/// by v; the texture repeats that often along u and v. Quads with two equal corners become one triangle.
void sheet(ObjWriter& mesh, int cellsU, int cellsV, const std::function<glm::dvec3(double, double)>& point,
    const glm::dvec2& repeats = glm::dvec2(1.0));

/// A rectangle with a corner and two edges, that looks towards edgeU x edgeV: 2 triangles.
void rectangle(ObjWriter& mesh, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
    const glm::dvec2& repeats = glm::dvec2(1.0));

/// skin() with texture coordinates: the texture repeats that often around, from a ring's first point on, and along,
/// evenly by length.
void texturedSkin(ObjWriter& mesh, const std::vector<Ring>& rings, const glm::dvec2& repeats);

/// A box of half sizes `half` around `centre`, turned by the columns of `axes`, with flat faces: 12 triangles. The
/// texture repeats every `period` metres on every face.
void texturedBox(ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, double period,
    const glm::dmat3& axes = glm::dmat3(1.0));

/// The same with edges rounded at `radius` in `steps` steps: 12 (2 steps + 1)^2 triangles.
void roundedBox(ObjWriter& mesh, const glm::dvec3& centre, const glm::dvec3& half, double radius, int steps,
    double period, const glm::dmat3& axes = glm::dmat3(1.0));

/// A leaf that begins at base.at, goes along base.along, and bends away from base.up by `bend` of its length: about
/// 2 cellsU cellsV triangles. The texture is once along and once across it.
void leaf(ObjWriter& mesh, const Frame& base, double length, double width, double bend, int cellsU, int cellsV);

/// A turn around the vertical axis, in degrees.
glm::dmat3 turn(double degrees);

/// A place turned around the vertical axis and scaled, for placed().
glm::dmat4 standing(const glm::dvec3& foot, double degrees = 0.0, double scale = 1.0);

} // namespace wedge::generator
